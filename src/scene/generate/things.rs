//! Random scenes of bodies.

use super::Kind;
use crate::scene::{Block, Object, Point, Polygon, Post, Shape, Wall};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

const CAR_METRES: [f64; 2] = [4.5, 1.8];
const NEAREST_METRES: f64 = 5.0;
const MAX_RANGE_PART: f64 = 0.85;
/// Smallest distance between bodies, and from the array's axis, metres.
const APART_METRES: f64 = 0.5;
const MAX_PLACE_TRIES: usize = 100;

/// The objects of a scene of `kind`, one of [`Kind::BODY_KINDS`], before a radar of this maximum range; none for the others.
pub(super) fn objects(kind: Kind, max_range_metres: f64, rng: &mut ChaCha8Rng) -> Vec<Object> {
    let mut things = Things { far: MAX_RANGE_PART * max_range_metres, objects: Vec::new() };
    match kind {
        Kind::Bodies => {
            for _ in 0..rng.random_range(1..=3) {
                things.add(rng, any_body);
            }
            for _ in 0..rng.random_range(0..=1) {
                things.add(rng, |[x, y], _| Object::Point(Point::new(x, y)));
            }
        }
        Kind::Street => things.street(rng),
        Kind::Rails => things.rails(rng),
        Kind::Occlusion => things.occlusion(rng),
        Kind::Rough => {
            for _ in 0..rng.random_range(1..=2) {
                things.add(rng, |at, rng| {
                    let mut object = if rng.random::<f64>() < 0.5 { wall(at, 2.0..10.0, rng) } else { car(at, rng) };
                    if let Some((roughness, seed)) = object.roughness_mut() {
                        (*roughness, *seed) = (rng.random_range(0.2..1.5), u64::from(rng.random::<u32>()));
                    }
                    object
                });
            }
            things.add(rng, post);
        }
        _ => {}
    }
    things.objects
}

fn wall([x, y]: [f64; 2], lengths_metres: std::ops::Range<f64>, rng: &mut ChaCha8Rng) -> Object {
    Object::Wall(Wall::new(x, y, rng.random_range(lengths_metres), rng.random_range(0.0..180.0)))
}

fn car(at: [f64; 2], rng: &mut ChaCha8Rng) -> Object {
    Object::Box(Block::new(at, CAR_METRES, rng.random_range(0.0..180.0)))
}

fn post([x, y]: [f64; 2], rng: &mut ChaCha8Rng) -> Object {
    Object::Post(Post::new(x, y, rng.random_range(0.05..0.5)))
}

pub(super) fn ell([x, y]: [f64; 2], rng: &mut ChaCha8Rng) -> Object {
    let (long, thick): (f64, f64) = (rng.random_range(1.0..3.0), rng.random_range(0.2..0.6));
    let [cos, sin] = crate::scene::shape::direction(rng.random_range(0.0..360.0));
    let corners = [[0.0, 0.0], [long, 0.0], [long, thick], [thick, thick], [thick, long], [0.0, long]];
    let turned = corners
        .map(|[u, v]| [u - long / 2.0, v - long / 2.0])
        .map(|[u, v]| [x + u * cos - v * sin, y + u * sin + v * cos]);
    Object::Polygon(Polygon::new(turned.to_vec()))
}

fn any_body(at: [f64; 2], rng: &mut ChaCha8Rng) -> Object {
    match rng.random_range(0..4) {
        0 => wall(at, 1.0..10.0, rng),
        1 => car(at, rng),
        2 => post(at, rng),
        _ => ell(at, rng),
    }
}

struct Things {
    far: f64,
    objects: Vec<Object>,
}

/// Corners of an outline, and places between them half a metre apart.
fn samples(shape: &Shape) -> Vec<[f64; 2]> {
    if let Shape::Circle { centre_metres: [x, y], radius_metres: r } = *shape {
        return vec![[x - r, y], [x + r, y], [x, y - r], [x, y + r]];
    }
    let along = |[a, b]: [[f64; 2]; 2]| {
        let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / 0.5).ceil().max(1.0) as usize;
        (0..=steps).map(move |i| {
            let part = i as f64 / steps as f64;
            [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]
        })
    };
    shape.faces().into_iter().flat_map(along).collect()
}

/// Whether an object stands in the field, nearer than `far_metres`, and apart from all others.
pub(super) fn has_room(object: &Object, others: &[Object], far_metres: f64) -> bool {
    let shape = |o: &Object| o.body().map(|body| body.shape);
    let Some(own) = shape(object) else {
        return !others.iter().filter_map(shape).any(|s| s.distance_metres(object.centre_metres()) < APART_METRES);
    };
    let places = samples(&own);
    let is_near = |other: &Shape| {
        places.iter().any(|p| other.distance_metres(*p) < APART_METRES)
            || samples(other).iter().any(|p| own.distance_metres(*p) < APART_METRES)
    };
    places.iter().all(|[x, y]| *y > APART_METRES && x.hypot(*y) < far_metres)
        && !others.iter().filter_map(shape).any(|other| is_near(&other))
}

impl Things {
    fn has_room(&self, object: &Object) -> bool {
        has_room(object, &self.objects, self.far / MAX_RANGE_PART)
    }

    fn add(&mut self, rng: &mut ChaCha8Rng, make: impl Fn([f64; 2], &mut ChaCha8Rng) -> Object) {
        for _ in 0..MAX_PLACE_TRIES {
            let range = rng.random_range(NEAREST_METRES..self.far);
            let [cos, sin] = crate::scene::shape::direction(rng.random_range(15.0..165.0));
            let object = make([range * cos, range * sin], rng);
            if self.has_room(&object) {
                return self.objects.push(object);
            }
        }
    }

    fn put(&mut self, object: Object) {
        if self.has_room(&object) {
            self.objects.push(object);
        }
    }

    fn street(&mut self, rng: &mut ChaCha8Rng) {
        for x in [-1.8, 1.8] {
            let y = rng.random_range(7.0..0.6 * self.far);
            let at = [x + rng.random_range(-0.5..0.5), y];
            self.put(Object::Box(Block::new(at, CAR_METRES, rng.random_range(80.0..100.0))));
        }
        for side in [-1.0, 1.0] {
            let at = [side * rng.random_range(6.0..10.0), rng.random_range(10.0..0.6 * self.far)];
            let (length, angle) = (rng.random_range(5.0..15.0), rng.random_range(75.0..105.0));
            self.put(Object::Wall(Wall::new(at[0], at[1], length, angle)));
        }
        if rng.random::<f64>() < 0.5 {
            let y = rng.random_range(0.75..0.95) * self.far;
            self.put(Object::Wall(Wall::new(0.0, y, rng.random_range(4.0..10.0), rng.random_range(-10.0..10.0))));
        }
        for i in 0..rng.random_range(2..=4) {
            let side = if i % 2 == 0 { -1.0 } else { 1.0 };
            let at = [side * rng.random_range(4.0..5.5), rng.random_range(5.0..0.8 * self.far)];
            self.put(Object::Post(Post::new(at[0], at[1], rng.random_range(0.05..0.2))));
        }
    }

    fn rails(&mut self, rng: &mut ChaCha8Rng) {
        let tilt = rng.random_range(-3.0..3.0);
        for side in [-1.0, 1.0] {
            let (x, length) = (side * rng.random_range(3.0..6.0), rng.random_range(0.5..0.75) * self.far);
            let reflectivity = rng.random_range(0.4..1.0);
            let rail = Wall { reflectivity, ..Wall::new(x, 4.0 + length / 2.0, length, 90.0 + tilt) };
            self.put(Object::Wall(rail));
        }
        let car = [rng.random_range(-1.0..1.0), rng.random_range(8.0..0.7 * self.far)];
        self.put(Object::Box(Block::new(car, CAR_METRES, 90.0 + tilt)));
        for _ in 0..rng.random_range(1..=3) {
            self.add(rng, post);
        }
    }

    fn occlusion(&mut self, rng: &mut ChaCha8Rng) {
        let [cos, sin] = crate::scene::shape::direction(rng.random_range(60.0..120.0));
        let near = rng.random_range(5.0..0.4 * self.far);
        let at = |range: f64, beside: f64| [range * cos - beside * sin, range * sin + beside * cos];
        self.put(match rng.random::<f64>() < 0.7 {
            true => Object::Box(Block::new(at(near, 0.0), CAR_METRES, rng.random_range(0.0..180.0))),
            false => Object::Post(Post::new(near * cos, near * sin, rng.random_range(0.5..1.2))),
        });
        for _ in 0..2 {
            for _ in 0..MAX_PLACE_TRIES {
                let place = at(rng.random_range(near + 4.0..self.far), rng.random_range(-2.5..2.5));
                let behind = any_body(place, rng);
                if self.has_room(&behind) {
                    self.objects.push(behind);
                    break;
                }
            }
        }
        let [x, y] = at(rng.random_range(near + 4.0..self.far), rng.random_range(-2.0..2.0));
        self.put(Object::Point(Point::new(x, y)));
    }
}
