//! The objects of a scene: points, lines of points, Gaussian clusters of points, and bodies.

use super::body::one;
use super::common::{moving, of_each};
use super::{Block, Body, Polygon, Post, Reflector, Shape, Wall, is_default};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// Characters of an object's name, at most.
pub const MAX_NAME_CHARACTERS: usize = 40;

/// An object of a scene, which is placed, dragged and deleted as a whole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Object {
    Point(Point),
    Line(Line),
    Gaussian(GaussianCluster),
    Wall(Wall),
    Box(Block),
    Post(Post),
    Polygon(Polygon),
}

moving! {
    pub struct Point {
        pub x_metres: f64,
        pub y_metres: f64,
        #[serde(default = "one")]
        pub reflectivity: f64,
    }
}

moving! {
    /// Reflectors at equal spacing on a straight line: the thesis' vertical line (section 3.2), or one at any slant.
    pub struct Line {
        pub x_metres: f64,
        pub y_start_metres: f64,
        pub spacing_metres: f64,
        /// Direction of the line from its first reflector: 0 along +x, 90 (the default) straight ahead (+y).
        #[serde(default = "straight_ahead", skip_serializing_if = "is_straight_ahead")]
        pub direction_degrees: f64,
        pub count: usize,
        #[serde(default = "one")]
        pub reflectivity: f64,
    }
}

moving! {
    /// Reflectors drawn from a normal distribution around a centre; the same seed gives the same cluster.
    pub struct GaussianCluster {
        pub x_metres: f64,
        pub y_metres: f64,
        /// Standard deviation along x, metres.
        pub x_std_metres: f64,
        /// Standard deviation along y, metres.
        pub y_std_metres: f64,
        pub count: usize,
        #[serde(default)]
        pub seed: u64,
        #[serde(default = "one")]
        pub reflectivity: f64,
    }
}

fn straight_ahead() -> f64 {
    90.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_straight_ahead(direction_degrees: &f64) -> bool {
    *direction_degrees == straight_ahead()
}

impl Line {
    /// A line straight ahead from (`x_metres`, `y_start_metres`), of reflectivity 1.
    pub fn vertical(x_metres: f64, y_start_metres: f64, spacing_metres: f64, count: usize) -> Self {
        let (direction_degrees, reflectivity) = (straight_ahead(), 1.0);
        Line { x_metres, y_start_metres, spacing_metres, direction_degrees, count, reflectivity, ..Line::default() }
    }

    /// Step from one reflector to the next, (x, y) in metres. Exactly (0, spacing) straight ahead.
    pub fn step_metres(&self) -> [f64; 2] {
        // Counted from straight ahead, where sine and cosine are exact.
        let (sin, cos) = (self.direction_degrees - straight_ahead()).to_radians().sin_cos();
        [-self.spacing_metres * sin, self.spacing_metres * cos]
    }

    /// Reflector `index` of the line, (x, y) in metres.
    pub fn place_metres(&self, index: f64) -> [f64; 2] {
        let [dx, dy] = self.step_metres();
        [self.x_metres + index * dx, index * dy + self.y_start_metres]
    }

    /// The last reflector, (x, y) in metres; the first one's place for an empty line.
    pub fn end_metres(&self) -> [f64; 2] {
        self.place_metres(self.count.saturating_sub(1) as f64)
    }
}

impl GaussianCluster {
    /// A cluster of reflectivity 1 and seed 0 around a centre, with standard deviations along x and y.
    pub fn new([x_metres, y_metres]: [f64; 2], [x_std_metres, y_std_metres]: [f64; 2], count: usize) -> Self {
        let reflectivity = 1.0;
        GaussianCluster { x_metres, y_metres, x_std_metres, y_std_metres, count, reflectivity, ..Self::default() }
    }
}

impl Point {
    /// A point of reflectivity 1.
    pub fn new(x_metres: f64, y_metres: f64) -> Self {
        Point { x_metres, y_metres, reflectivity: 1.0, ..Point::default() }
    }
}

impl Object {
    /// The word used for this kind in files and messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Object::Point(_) => "point",
            Object::Line(_) => "line",
            Object::Gaussian(_) => "gaussian",
            Object::Wall(_) => "wall",
            Object::Box(_) => "box",
            Object::Post(_) => "post",
            Object::Polygon(_) => "polygon",
        }
    }

    /// The noun in messages: a file's "gaussian" is a cluster.
    pub fn noun(&self) -> &'static str {
        match self {
            Object::Gaussian(_) => "cluster",
            other => other.kind(),
        }
    }

    /// Its name; its kind and number, from 1, where it has none.
    pub fn called(&self, index: usize) -> String {
        if self.name().is_empty() { format!("{} {}", self.noun(), index + 1) } else { self.name().to_owned() }
    }

    /// Its name; empty where it has none.
    pub fn name(&self) -> &str {
        of_each!(self, one => &one.name)
    }

    /// Sets the object's name, or takes it away where the text is empty; of a longer text the first [`MAX_NAME_CHARACTERS`] are kept.
    pub fn set_name(&mut self, name: &str) {
        let name: String = name.chars().filter(|c| !c.is_control()).take(MAX_NAME_CHARACTERS).collect();
        of_each!(self, one => one.name = name);
    }

    /// The object as a body; `None` for objects made of points.
    pub fn body(&self) -> Option<Body> {
        let (shape, roughness_millimetres, seed) = match self {
            Object::Point(_) | Object::Line(_) | Object::Gaussian(_) => return None,
            Object::Wall(w) => (Shape::Wall(w.ends_metres()), w.roughness_millimetres, w.seed),
            Object::Box(b) => (Shape::Outline(b.corners_metres().to_vec()), b.roughness_millimetres, b.seed),
            Object::Post(p) => {
                let circle = Shape::Circle { centre_metres: [p.x_metres, p.y_metres], radius_metres: p.radius_metres };
                (circle, p.roughness_millimetres, p.seed)
            }
            Object::Polygon(p) => (Shape::Outline(p.outline_metres()), p.roughness_millimetres, p.seed),
        };
        Some(Body { shape, reflectivity: self.reflectivity(), roughness_millimetres, seed })
    }

    /// Number of reflectors; bodies have none.
    pub fn reflector_count(&self) -> usize {
        match self {
            Object::Point(_) => 1,
            Object::Line(l) => l.count,
            Object::Gaussian(g) => g.count,
            Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => 0,
        }
    }

    /// Most echoes that it gives one element: one a reflector, or those of a body.
    pub fn echo_count(&self) -> usize {
        self.body().map_or_else(|| self.reflector_count(), |body| body.echo_count())
    }

    /// Reflectivity sigma of each of its reflectors; the reflection coefficient of a body.
    pub fn reflectivity(&self) -> f64 {
        of_each!(self, one => one.reflectivity)
    }

    /// The reflectors this object stands for, in a fixed order; a body is none.
    pub fn reflectors(&self) -> Vec<Reflector> {
        match self {
            Object::Point(p) => vec![Reflector::at([p.x_metres, p.y_metres], p.reflectivity)],
            Object::Line(l) => (0..l.count).map(|i| Reflector::at(l.place_metres(i as f64), l.reflectivity)).collect(),
            Object::Gaussian(g) => {
                let mut rng = ChaCha8Rng::seed_from_u64(g.seed);
                let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
                let mut place = || [g.x_metres + g.x_std_metres * normal(), g.y_metres + g.y_std_metres * normal()];
                (0..g.count).map(|_| Reflector::at(place(), g.reflectivity)).collect()
            }
            Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => Vec::new(),
        }
    }

    /// Its reflectors, or the places of a body's echoes at the array's middle, each with its reflectivity.
    pub fn marks(&self) -> Vec<Reflector> {
        let Some(body) = self.body() else { return self.reflectors() };
        let places = body.echo_places_metres([0.0, 0.0]).into_iter();
        places.map(|place| Reflector::at(place, body.reflectivity)).collect()
    }

    /// Sets the reflectivity sigma of each of its reflectors, or the reflection coefficient of a body.
    pub fn set_reflectivity(&mut self, reflectivity: f64) {
        of_each!(self, one => one.reflectivity = reflectivity);
    }

    /// Roughness of the surface in millimetres, and its seed, to be changed; `None` for objects made of points.
    pub fn roughness_mut(&mut self) -> Option<(&mut f64, &mut u64)> {
        match self {
            Object::Point(_) | Object::Line(_) | Object::Gaussian(_) => None,
            Object::Wall(w) => Some((&mut w.roughness_millimetres, &mut w.seed)),
            Object::Box(b) => Some((&mut b.roughness_millimetres, &mut b.seed)),
            Object::Post(p) => Some((&mut p.roughness_millimetres, &mut p.seed)),
            Object::Polygon(p) => Some((&mut p.roughness_millimetres, &mut p.seed)),
        }
    }

    /// The place that its file gives: the point, a line's first reflector, the middle of a cluster or a body. (x, y) in metres.
    pub fn anchor_metres(&self) -> [f64; 2] {
        match self {
            Object::Point(p) => [p.x_metres, p.y_metres],
            Object::Line(l) => [l.x_metres, l.y_start_metres],
            Object::Gaussian(g) => [g.x_metres, g.y_metres],
            Object::Wall(w) => [w.x_metres, w.y_metres],
            Object::Box(b) => [b.x_metres, b.y_metres],
            Object::Post(p) => [p.x_metres, p.y_metres],
            Object::Polygon(p) => p.centre_metres(),
        }
    }

    /// Moves the whole object so that its anchor is at `place_metres`.
    pub fn set_anchor(&mut self, place_metres: [f64; 2]) {
        let [x, y] = match self {
            Object::Point(p) => [&mut p.x_metres, &mut p.y_metres],
            Object::Line(l) => [&mut l.x_metres, &mut l.y_start_metres],
            Object::Gaussian(g) => [&mut g.x_metres, &mut g.y_metres],
            Object::Wall(w) => [&mut w.x_metres, &mut w.y_metres],
            Object::Box(b) => [&mut b.x_metres, &mut b.y_metres],
            Object::Post(p) => [&mut p.x_metres, &mut p.y_metres],
            Object::Polygon(p) => {
                let centre = p.centre_metres();
                let by = [0, 1].map(|i| place_metres[i] - centre[i]);
                p.corners_metres.iter_mut().for_each(|c| *c = [c[0] + by[0], c[1] + by[1]]);
                return;
            }
        };
        [*x, *y] = place_metres;
    }

    /// Moves the whole object.
    pub fn translate(&mut self, dx_metres: f64, dy_metres: f64) {
        if let Object::Polygon(p) = self {
            p.corners_metres.iter_mut().for_each(|c| *c = [c[0] + dx_metres, c[1] + dy_metres]);
            return;
        }
        let [x, y] = self.anchor_metres();
        self.set_anchor([x + dx_metres, y + dy_metres]);
    }

    /// Its handle: the point, the middle of the line, the centre of the cluster or the body. (x, y) in metres.
    pub fn centre_metres(&self) -> [f64; 2] {
        match self {
            Object::Line(l) => l.place_metres(l.count.saturating_sub(1) as f64 / 2.0),
            other => other.anchor_metres(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_starts_at_its_start() {
        let line = Object::Line(Line { reflectivity: 0.5, ..Line::vertical(2.0, 5.0, 0.1, 3) });
        let r = line.reflectors();
        assert_eq!(r.len(), 3);
        assert_eq!((r[2].x_metres, r[2].y_metres, r[2].reflectivity), (2.0, 5.2, 0.5));
        assert_eq!(line.centre_metres(), [2.0, 5.1]);
    }

    #[test]
    fn a_slanted_line_leads_where_it_says() {
        for (direction_degrees, end) in
            [(0.0, [4.0, 5.0]), (90.0, [2.0, 7.0]), (225.0, [2.0 - 2f64.sqrt(), 5.0 - 2f64.sqrt()])]
        {
            let line = Line { direction_degrees, ..Line::vertical(2.0, 5.0, 0.5, 5) };
            let found = line.end_metres();
            assert!((found[0] - end[0]).hypot(found[1] - end[1]) < 1e-12, "{direction_degrees}: {found:?}");
        }
    }

    #[test]
    fn a_cluster_is_the_same_every_time() {
        let mut g = Object::Gaussian(GaussianCluster { seed: 3, ..GaussianCluster::new([0.0, 10.0], [1.0, 2.0], 5) });
        let before = g.reflectors();
        assert_eq!(before, g.reflectors());
        g.translate(1.0, -1.0);
        for (a, b) in before.iter().zip(g.reflectors()) {
            assert!((b.x_metres - a.x_metres - 1.0).abs() < 1e-12 && (b.y_metres - a.y_metres + 1.0).abs() < 1e-12);
        }
    }
}
