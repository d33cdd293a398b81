//! Scenes for training and validation: points along random curves, in clouds and scattered, and bodies, of every count, step and strength.
//! They cover the range of the named kinds, which stay tests, without drawing any of them.

use super::laws::{GroundPlace, MAX_DYNAMIC_DECIBELS, Steps, Strengths, Track, log_uniform};
use super::things::{self, has_room};
use crate::radar::Radar;
use crate::scene::shape::direction;
use crate::scene::{Block, Object, Point, Polygon, Post, Wall};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

const MAX_POINTS: usize = 600;
const MAX_GROUP_POINTS: usize = 300;
const MAX_BODIES: usize = 8;
const MAX_ROUGH_BODIES: usize = 2;
const MAX_GROUPS: usize = 8;
const STEP_BINS: Range<f64> = 0.2..4.0;
const STEP_METRES: Range<f64> = 0.2..1.0;
const NEAREST_METRES: f64 = 0.3;
/// Smallest distance of points from the array.
const CLEAR_METRES: f64 = 0.08;
/// Farthest place, and farthest point of a curve or a cloud, as parts of the maximum range: farther points wrap around.
const MAX_PLACE_RANGE_PART: f64 = 0.95;
const MAX_POINT_RANGE_PART: f64 = 1.25;
const MAX_PLACE_TRIES: usize = 20;

#[derive(Debug, Clone, Copy)]
pub(super) struct World {
    max_range_metres: f64,
    bin_metres: f64,
    half_aperture_metres: f64,
}

impl World {
    pub(super) fn new(radar: &Radar) -> Self {
        World {
            max_range_metres: radar.max_range_metres(),
            bin_metres: radar.range_resolution_metres(),
            half_aperture_metres: radar.aperture_metres() / 2.0,
        }
    }

    pub(super) fn objects(&self, rng: &mut ChaCha8Rng) -> Vec<Object> {
        loop {
            let (mut bodies, mut points) = (Vec::new(), Vec::new());
            for _ in 0..log_uniform(1.0..MAX_GROUPS as f64 + 1.0, rng) as usize {
                if rng.random::<f64>() < 0.2 {
                    self.add_bodies(&mut bodies, rng);
                } else {
                    self.add_points(&mut points, rng);
                }
            }
            lift_the_weakest(&mut points);
            bodies.extend(points.into_iter().map(Object::Point));
            if !bodies.is_empty() {
                return bodies;
            }
        }
    }

    fn add_points(&self, points: &mut Vec<Point>, rng: &mut ChaCha8Rng) {
        let count = log_uniform(1.0..MAX_GROUP_POINTS as f64 + 1.0, rng) as usize;
        let mut places = match rng.random_range(0..7) {
            0..=2 => self.in_field(rng, count, World::curve),
            3 | 4 => self.in_field(rng, count, World::cloud),
            _ => {
                let law = rng.random_range(0..5);
                (0..count).map(|_| self.place(law, rng)).collect()
            }
        };
        places.truncate(MAX_POINTS - points.len());
        let level = if rng.random::<bool>() { 0.0 } else { rng.random_range(-40.0..0.0) };
        let strengths = Strengths::random(rng);
        points.extend(places.into_iter().map(|[x, y]| {
            let decibels = level + strengths.decibels(rng);
            Point { reflectivity: 10f64.powf(decibels / 20.0), ..Point::new(x, y) }
        }));
    }

    /// The places in the field of the first draw with half of its places there, or of the last draw.
    fn in_field(
        &self,
        rng: &mut ChaCha8Rng,
        count: usize,
        draw: fn(&World, usize, &mut ChaCha8Rng) -> Vec<GroundPlace>,
    ) -> Vec<GroundPlace> {
        let mut places = Vec::new();
        for _ in 0..MAX_PLACE_TRIES {
            places = draw(self, count, rng);
            places.retain(|place| self.holds(*place));
            if 2 * places.len() >= count {
                break;
            }
        }
        places
    }

    fn curve(&self, count: usize, rng: &mut ChaCha8Rng) -> Vec<GroundPlace> {
        let step = match rng.random::<bool>() {
            true => self.bin_metres * log_uniform(STEP_BINS, rng),
            false => log_uniform(STEP_METRES, rng),
        };
        let steps = Steps::random(rng);
        let way = Track::random(self.place(rng.random_range(0..5), rng), count as f64 * step, rng);
        let row = |count: usize, side: f64, rng: &mut ChaCha8Rng| {
            let lengths: Vec<f64> = (0..count).map(|_| step * steps.next(rng)).collect();
            way.points(lengths, side)
        };
        if rng.random::<f64>() < 0.75 {
            return row(count, 0.0, rng);
        }
        let mut places = row(count - count / 2, 0.0, rng);
        let side = if rng.random::<bool>() { 1.0 } else { -1.0 };
        places.extend(row(count / 2, side * log_uniform(0.5..16.0, rng), rng));
        places
    }

    /// Points around a place: a normal or an even distribution, or an outline, longer than wide, in any orientation.
    fn cloud(&self, count: usize, rng: &mut ChaCha8Rng) -> Vec<GroundPlace> {
        let [x, y] = self.place(rng.random_range(0..5), rng);
        let long = log_uniform(0.05..6.0f64.min(self.max_range_metres / 4.0), rng);
        let wide = long * log_uniform(0.1..1.0, rng);
        let [cos, sin] = direction(rng.random_range(0.0..360.0));
        let shape = rng.random_range(0..5);
        let offset = |rng: &mut ChaCha8Rng| -> GroundPlace {
            let even = |rng: &mut ChaCha8Rng| rng.random_range(-1.0..1.0);
            let turn = TAU * rng.random::<f64>();
            let radius = rng.random::<f64>().sqrt();
            match shape {
                0 => [StandardNormal.sample(rng), StandardNormal.sample(rng)],
                1 => [radius * turn.cos(), radius * turn.sin()],
                2 => [turn.cos(), turn.sin()],
                3 => [even(rng), even(rng)],
                // A point on one of the four sides, each as often as it is long.
                _ if rng.random::<f64>() * (long + wide) < long => [even(rng), if rng.random() { 1.0 } else { -1.0 }],
                _ => [if rng.random() { 1.0 } else { -1.0 }, even(rng)],
            }
        };
        let place = |[u, v]: GroundPlace| {
            let [u, v] = [u * long, v * wide];
            [x + u * cos - v * sin, y + u * sin + v * cos]
        };
        (0..count).map(|_| place(offset(rng))).collect()
    }

    fn add_bodies(&self, bodies: &mut Vec<Object>, rng: &mut ChaCha8Rng) {
        let count = rng.random_range(1..=4).min(MAX_BODIES - bodies.len());
        for _ in 0..count {
            let rough = bodies.iter().filter(|o| o.body().is_some_and(|b| b.roughness_millimetres > 0.0));
            let may_be_rough = rough.count() < MAX_ROUGH_BODIES;
            let made = (0..MAX_PLACE_TRIES).map(|_| self.body(may_be_rough, rng));
            bodies.extend(made.into_iter().find(|body| has_room(body, bodies, self.max_range_metres)));
        }
    }

    fn body(&self, may_be_rough: bool, rng: &mut ChaCha8Rng) -> Object {
        let at @ [x, y] = self.place(rng.random_range(0..5), rng);
        let most = (self.max_range_metres / 3.0).min(30.0);
        let along =
            if rng.random::<f64>() < 0.4 { 90.0 + rng.random_range(-15.0..15.0) } else { 360.0 * rng.random::<f64>() };
        let mut object = match rng.random_range(0..5) {
            0 => Object::Wall(Wall::new(x, y, log_uniform(0.3..most, rng), along)),
            1 => {
                let length = log_uniform(0.3..most.min(12.0), rng);
                Object::Box(Block::new(at, [length, length * log_uniform(0.15..1.0, rng)], along))
            }
            2 => Object::Post(Post::new(x, y, log_uniform(0.02..1.5, rng))),
            3 => things::ell(at, rng),
            _ => star(at, log_uniform(0.2..4.0, rng), rng),
        };
        object.set_reflectivity(log_uniform(0.1..1.0, rng));
        if let Some((roughness, seed)) = object.roughness_mut()
            && may_be_rough
            && rng.random::<f64>() < 0.3
        {
            (*roughness, *seed) = (log_uniform(0.1..2.0, rng), u64::from(rng.random::<u32>()));
        }
        object
    }

    /// A place in the field, whose range follows one of five laws.
    fn place(&self, law: u32, rng: &mut ChaCha8Rng) -> GroundPlace {
        let far = MAX_PLACE_RANGE_PART * self.max_range_metres;
        loop {
            let range = match law {
                0 => log_uniform(NEAREST_METRES..far, rng),
                1 => far * rng.random::<f64>().sqrt(),
                _ => rng.random_range(NEAREST_METRES..far),
            };
            let cos = if rng.random() { rng.random_range(-1.0..1.0f64) } else { rng.random_range(0.0..PI).cos() };
            let place = [range * cos, range * (1.0 - cos * cos).sqrt()];
            if self.holds(place) {
                return place;
            }
        }
    }

    fn holds(&self, [x, y]: GroundPlace) -> bool {
        let beside = (x.abs() - self.half_aperture_metres).max(0.0);
        y >= 0.0 && beside.hypot(y) >= CLEAR_METRES && x.hypot(y) <= MAX_POINT_RANGE_PART * self.max_range_metres
    }
}

fn star([x, y]: GroundPlace, radius_metres: f64, rng: &mut ChaCha8Rng) -> Object {
    let count = rng.random_range(3..=8);
    let corner = |i: usize| {
        let turn = TAU * (i as f64 + rng.random_range(-0.2..0.2)) / count as f64;
        let radius = radius_metres * rng.random_range(0.4..1.0);
        [x + radius * turn.cos(), y + radius * turn.sin()]
    };
    Object::Polygon(Polygon::new((0..count).map(corner).collect()))
}

/// Raises points that lie more than [`MAX_DYNAMIC_DECIBELS`] below the strongest.
fn lift_the_weakest(points: &mut [Point]) {
    let strongest = points.iter().map(|p| p.reflectivity).fold(0.0, f64::max);
    let least = strongest * 10f64.powf(-MAX_DYNAMIC_DECIBELS / 20.0);
    points.iter_mut().for_each(|p| p.reflectivity = p.reflectivity.max(least));
}

#[cfg(test)]
mod tests {
    use super::super::{Generator, Kind, Purpose, Reading};
    use super::*;
    use crate::radar::presets::RadarPreset;
    use crate::scene::{Reflector, Scene};
    use rand::SeedableRng;

    fn scenes(radar: &Radar, count: u32) -> Vec<Scene> {
        let generator = Generator::new(radar, Reading::Program, Purpose::Training, 5);
        (0..count).map(|number| generator.scene(Kind::World, number)).collect()
    }

    #[test]
    fn every_scene_is_valid_and_within_its_bounds() {
        let narrow = Radar { bandwidth_hz: 1e8, ..Radar::default() };
        let wide = Radar { bandwidth_hz: 6e9, ..Radar::default() };
        let physical = RadarPreset::by_id("table-3.1-physical").unwrap().radar.clone();
        for (radar, count) in [(Radar::default(), 1000), (narrow, 200), (wide, 200), (physical, 100)] {
            let far = MAX_POINT_RANGE_PART * radar.max_range_metres() * (1.0 + 1e-9);
            for (number, scene) in scenes(&radar, count).iter().enumerate() {
                scene.validate(&radar).unwrap_or_else(|e| panic!("{number}: {e}"));
                assert!(!scene.is_silent() && scene.reflector_count() <= MAX_POINTS, "{number}");
                assert!(scene.objects.len() - scene.reflector_count() <= MAX_BODIES, "{number}");
                assert!(scene.echo_count() <= MAX_POINTS + MAX_BODIES * 64 + MAX_ROUGH_BODIES * 310, "{number}");
                let is_within = |r: &Reflector| r.y_metres >= 0.0 && r.x_metres.hypot(r.y_metres) <= far;
                assert!(scene.reflectors().iter().all(is_within), "{number}");
            }
        }
    }

    #[test]
    fn a_scene_follows_from_seed_purpose_and_number() {
        let of =
            |purpose, seed| Generator::new(&Radar::default(), Reading::Program, purpose, seed).scene(Kind::World, 7);
        let scene = of(Purpose::Training, 5);
        assert_eq!(scene, of(Purpose::Training, 5));
        for other in [of(Purpose::Training, 6), of(Purpose::Validation, 5)] {
            assert!(other.objects != scene.objects && other.noise_seed != scene.noise_seed);
        }
    }

    fn part(scenes: &[Scene], is: impl Fn(&Scene) -> bool) -> f64 {
        scenes.iter().filter(|scene| is(scene)).count() as f64 / scenes.len() as f64
    }

    #[test]
    fn counts_and_strengths_cover_their_ranges() {
        let scenes = scenes(&Radar::default(), 1000);
        for (counts, least, most) in [(1..2, 0.01, 0.2), (2..10, 0.05, 0.4), (10..100, 0.2, 0.6), (300..601, 0.02, 0.3)]
        {
            let share = part(&scenes, |s| counts.contains(&s.reflector_count()));
            assert!((least..most).contains(&share), "{counts:?}: {share}");
        }
        let decibels = |s: &Scene| {
            let sigma: Vec<f64> = s.reflectors().iter().map(|r| r.reflectivity).collect();
            let most = sigma.iter().copied().fold(0.0, f64::max);
            20.0 * (most / sigma.iter().copied().fold(f64::INFINITY, f64::min)).log10()
        };
        for (range, least) in
            [(0.0..0.1, 0.04), (0.1..20.0, 0.05), (20.0..40.0, 0.1), (40.0..59.9, 0.1), (59.9..60.01, 0.02)]
        {
            let share = part(&scenes, |s| s.reflector_count() > 1 && range.contains(&decibels(s)));
            assert!(share > least, "{range:?} dB: {share}");
        }
        assert!(scenes.iter().all(|s| s.reflector_count() == 0 || decibels(s) < 60.01));
        for kind in ["wall", "box", "post", "polygon"] {
            let share = part(&scenes, |s| s.objects.iter().any(|o| o.kind() == kind));
            assert!((0.05..0.5).contains(&share), "{kind}: {share}");
        }
        assert!((0.2..0.6).contains(&part(&scenes, Scene::has_bodies)));
    }

    #[test]
    fn places_cover_all_ranges_and_directions() {
        let radar = Radar::default();
        let scenes = scenes(&radar, 1000);
        let has = |is: &dyn Fn(f64, f64) -> bool| {
            part(&scenes, |s| {
                s.reflectors().iter().any(|r| {
                    let range = r.x_metres.hypot(r.y_metres);
                    is(range / radar.max_range_metres(), r.x_metres / range)
                })
            })
        };
        for (name, share) in [
            ("near", has(&|range, _| range < 0.05)),
            ("beyond the maximum range", has(&|range, _| range > 1.0)),
            ("at the left end-fire", has(&|_, cos| cos < -0.99)),
            ("at the right end-fire", has(&|_, cos| cos > 0.99)),
            ("at broadside", has(&|_, cos| cos.abs() < 0.01)),
        ] {
            assert!(share > 0.05, "{name}: {share}");
        }
    }

    #[test]
    fn steps_of_every_law_cover_their_range() {
        let world = World::new(&Radar::default());
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut means = Vec::new();
        let (mut equal, mut uneven) = (0, 0);
        for _ in 0..1000 {
            let places = world.curve(20, &mut rng);
            let steps: Vec<f64> =
                places.windows(2).take(9).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).collect();
            let mean = steps.iter().sum::<f64>() / steps.len() as f64;
            let off = steps.iter().map(|s| (s / mean - 1.0).abs()).fold(0.0, f64::max);
            equal += u32::from(off < 1e-6);
            uneven += u32::from(off > 0.6);
            means.push(mean);
        }
        assert!(equal > 200 && uneven > 200, "{equal} curves of equal steps, {uneven} of Poisson's");
        let among = |range: Range<f64>| means.iter().filter(|m| range.contains(*m)).count();
        let bin = world.bin_metres;
        for range in [0.15 * bin..0.4 * bin, 0.4 * bin..bin, bin..2.0 * bin, 0.2..0.45, 0.45..1.2] {
            let found = among(range.clone());
            assert!(found > 60, "{range:?} m: {found}");
        }
    }
}
