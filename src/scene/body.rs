//! Bodies: walls, boxes, posts and polygons. They shine where they face the radar and hide what stands behind them.

use super::SceneError;
use crate::radar::Radar;
use serde::{Deserialize, Serialize};

/// Most corners of a polygon.
pub const MAX_CORNERS: usize = 256;

/// Smallest radius of a post, metres: a thinner one is no mirror for waves of 8 mm, and a point describes it better.
pub const MIN_RADIUS_METRES: f64 = 0.01;

/// Smallest length and width of a body, metres.
pub const MIN_SIZE_METRES: f64 = 1e-3;

/// Largest size of a body, metres.
pub const MAX_SIZE_METRES: f64 = 1e4;

/// Largest height deviation of a rough surface, millimetres.
pub const MAX_ROUGHNESS_MILLIMETRES: f64 = 100.0;

/// Distance between the points that a rough surface scatters from, metres.
pub const DIFFUSE_SPACING_METRES: f64 = 0.02;

/// Most points that the rough surface of one body scatters from.
pub const MAX_DIFFUSE: usize = 300;

/// A straight wall without thickness; both its sides reflect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// x of its middle, along the array's axis, metres.
    pub x_metres: f64,
    /// y of its middle, ahead of the array, metres.
    pub y_metres: f64,
    /// From end to end, metres.
    pub length_metres: f64,
    /// Direction of its length: 0 along +x, 90 straight ahead, counter-clockwise.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub angle_degrees: f64,
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    #[serde(default = "one")]
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub roughness_millimetres: f64,
    /// Which of all surfaces of this roughness.
    #[serde(default, skip_serializing_if = "is_first")]
    pub seed: u64,
}

/// A rectangle: a car is 4.5 m by 1.8 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// x of its middle, along the array's axis, metres.
    pub x_metres: f64,
    /// y of its middle, ahead of the array, metres.
    pub y_metres: f64,
    /// Its length, metres.
    pub length_metres: f64,
    /// Its width, across the length, metres.
    pub width_metres: f64,
    /// Direction of its length: 0 along +x, 90 straight ahead, counter-clockwise.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub angle_degrees: f64,
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    #[serde(default = "one")]
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub roughness_millimetres: f64,
    /// Which of all surfaces of this roughness.
    #[serde(default, skip_serializing_if = "is_first")]
    pub seed: u64,
}

/// A round post.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Post {
    /// x of its middle, along the array's axis, metres.
    pub x_metres: f64,
    /// y of its middle, ahead of the array, metres.
    pub y_metres: f64,
    /// Its radius, metres.
    pub radius_metres: f64,
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    #[serde(default = "one")]
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub roughness_millimetres: f64,
    /// Which of all surfaces of this roughness.
    #[serde(default, skip_serializing_if = "is_first")]
    pub seed: u64,
}

/// A closed outline of straight faces, convex or not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// Its corners in order, either way round, (x, y) in metres.
    pub corners_metres: Vec<[f64; 2]>,
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    #[serde(default = "one")]
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub roughness_millimetres: f64,
    /// Which of all surfaces of this roughness.
    #[serde(default, skip_serializing_if = "is_first")]
    pub seed: u64,
}

/// What is read where no reflectivity is written.
pub(super) fn one() -> f64 {
    1.0
}

/// Whether a coordinate is farther away than any scene reaches.
pub(super) fn out_of_reach(metres: f64) -> bool {
    metres.abs() > 1e12
}

/// What a body is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    pub roughness_millimetres: f64,
    /// Which of all surfaces of this roughness.
    pub seed: u64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_first(seed: &u64) -> bool {
    *seed == 0
}

/// The outline of a body, as the radar meets it.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A wall from one end to the other, (x, y) in metres.
    Wall([[f64; 2]; 2]),
    /// Corners of a closed outline, counter-clockwise with y up, (x, y) in metres.
    Outline(Vec<[f64; 2]>),
    /// A circle.
    Circle {
        /// Its middle, (x, y) in metres.
        centre_metres: [f64; 2],
        /// Its radius, metres.
        radius_metres: f64,
    },
}

impl Wall {
    /// A smooth wall of metal around (`x_metres`, `y_metres`).
    pub fn new(x_metres: f64, y_metres: f64, length_metres: f64, angle_degrees: f64) -> Self {
        let (reflectivity, roughness_millimetres, seed) = (1.0, 0.0, 0);
        Wall { x_metres, y_metres, length_metres, angle_degrees, reflectivity, roughness_millimetres, seed }
    }

    /// Its two ends, (x, y) in metres: the far end of its length last.
    pub fn ends_metres(&self) -> [[f64; 2]; 2] {
        let [dx, dy] = direction(self.angle_degrees).map(|v| v * self.length_metres / 2.0);
        [[self.x_metres - dx, self.y_metres - dy], [self.x_metres + dx, self.y_metres + dy]]
    }
}

impl Block {
    /// A smooth box of metal around (`x_metres`, `y_metres`), `length_metres` by `width_metres`.
    pub fn new([x_metres, y_metres]: [f64; 2], [length_metres, width_metres]: [f64; 2], angle_degrees: f64) -> Self {
        let (reflectivity, roughness_millimetres, seed) = (1.0, 0.0, 0);
        Block {
            x_metres,
            y_metres,
            length_metres,
            width_metres,
            angle_degrees,
            reflectivity,
            roughness_millimetres,
            seed,
        }
    }

    /// Its corners counter-clockwise, (x, y) in metres, the first one at the start of its length on the right.
    pub fn corners_metres(&self) -> [[f64; 2]; 4] {
        let along = direction(self.angle_degrees);
        let (length, width) = (self.length_metres / 2.0, self.width_metres / 2.0);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(l, w)| {
            let (l, w) = (l * length, w * width);
            [self.x_metres + l * along[0] - w * along[1], self.y_metres + l * along[1] + w * along[0]]
        })
    }
}

/// Unit vector at an angle from +x, counter-clockwise: exact at multiples of 90 degrees.
pub fn direction(angle_degrees: f64) -> [f64; 2] {
    let quarters = (angle_degrees / 90.0).round();
    let (sin, cos) = (angle_degrees - 90.0 * quarters).to_radians().sin_cos();
    match quarters.rem_euclid(4.0) as u8 {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

impl Post {
    /// A smooth post of metal.
    pub fn new(x_metres: f64, y_metres: f64, radius_metres: f64) -> Self {
        Post { x_metres, y_metres, radius_metres, reflectivity: 1.0, roughness_millimetres: 0.0, seed: 0 }
    }
}

impl Polygon {
    /// A smooth polygon of metal.
    pub fn new(corners_metres: Vec<[f64; 2]>) -> Self {
        Polygon { corners_metres, reflectivity: 1.0, roughness_millimetres: 0.0, seed: 0 }
    }

    /// Its corners counter-clockwise, (x, y) in metres.
    pub fn outline_metres(&self) -> Vec<[f64; 2]> {
        let mut corners = self.corners_metres.clone();
        if doubled_area(&corners) < 0.0 {
            corners.reverse();
        }
        corners
    }

    /// The mean of its corners, (x, y) in metres.
    pub fn centre_metres(&self) -> [f64; 2] {
        let count = self.corners_metres.len().max(1) as f64;
        [0, 1].map(|i| self.corners_metres.iter().map(|c| c[i]).sum::<f64>() / count)
    }
}

/// Twice the area inside an outline, square metres; negative for one that runs clockwise.
fn doubled_area(corners: &[[f64; 2]]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    let from = |c: &[f64; 2]| [c[0] - first[0], c[1] - first[1]];
    corners.windows(2).map(|w| (from(&w[0]), from(&w[1]))).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// Whether two stretches touch or cross.
fn touch([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let side = |o: [f64; 2], u: [f64; 2], v: [f64; 2]| (u[0] - o[0]) * (v[1] - o[1]) - (u[1] - o[1]) * (v[0] - o[0]);
    let between =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (0..2).all(|i| r[i] >= p[i].min(q[i]) && r[i] <= p[i].max(q[i]));
    let [ac, ad, ca, cb] = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    (ac * ad < 0.0 && ca * cb < 0.0)
        || (ac == 0.0 && between(a, b, c))
        || (ad == 0.0 && between(a, b, d))
        || (ca == 0.0 && between(c, d, a))
        || (cb == 0.0 && between(c, d, b))
}

impl Shape {
    /// The faces of its outline, each from one end to the other with the outside to its right; none for a circle.
    pub fn faces(&self) -> Vec<[[f64; 2]; 2]> {
        match self {
            Shape::Wall(ends) => vec![*ends],
            Shape::Outline(corners) => {
                let next = corners.iter().cycle().skip(1);
                corners.iter().zip(next).map(|(a, b)| [*a, *b]).collect()
            }
            Shape::Circle { .. } => Vec::new(),
        }
    }

    /// A circle around it: its middle, (x, y) in metres, and its radius in metres.
    pub fn around(&self) -> ([f64; 2], f64) {
        let corners: &[[f64; 2]] = match self {
            Shape::Circle { centre_metres, radius_metres } => return (*centre_metres, *radius_metres),
            Shape::Wall(ends) => ends,
            Shape::Outline(corners) => corners,
        };
        let (low, high) = extent(corners);
        let centre = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
        let far = |c: &[f64; 2]| (c[0] - centre[0]).hypot(c[1] - centre[1]);
        (centre, corners.iter().map(far).fold(0.0, f64::max))
    }

    /// The smallest rectangle around it, its low and its high corner, (x, y) in metres.
    pub fn extent(&self) -> ([f64; 2], [f64; 2]) {
        match self {
            Shape::Wall(ends) => extent(ends),
            Shape::Outline(corners) => extent(corners),
            Shape::Circle { centre_metres: [x, y], radius_metres: r } => ([x - r, y - r], [x + r, y + r]),
        }
    }

    /// Whether a place lies inside; a wall has no inside.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        match self {
            Shape::Wall(_) => false,
            Shape::Circle { centre_metres, radius_metres } => {
                (x - centre_metres[0]).hypot(y - centre_metres[1]) < *radius_metres
            }
            Shape::Outline(_) => {
                let crossed = |[a, b]: &[[f64; 2]; 2]| {
                    (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                };
                self.faces().iter().filter(|f| crossed(f)).count() % 2 == 1
            }
        }
    }

    /// Distance from a place to its outline, metres; 0 inside.
    pub fn distance_metres(&self, place: [f64; 2]) -> f64 {
        if self.contains(place) {
            return 0.0;
        }
        match self {
            Shape::Circle { centre_metres, radius_metres } => {
                (place[0] - centre_metres[0]).hypot(place[1] - centre_metres[1]) - radius_metres
            }
            Shape::Wall(_) | Shape::Outline(_) => {
                self.faces().iter().map(|f| from_stretch(place, *f)).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// Distance from `place` to the stretch from `a` to `b`, metres.
pub fn from_stretch(place: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = ((place[0] - a[0]) * dx + (place[1] - a[1]) * dy) / (dx * dx + dy * dy);
    let along = if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 };
    (a[0] + along * dx - place[0]).hypot(a[1] + along * dy - place[1])
}

fn extent(corners: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    corners.iter().fold(start, |(low, high), c| ([0, 1].map(|i| low[i].min(c[i])), [0, 1].map(|i| high[i].max(c[i]))))
}

/// What is said of the number of a body that is wrong.
struct Check {
    object: usize,
    kind: &'static str,
}

impl Check {
    fn value(&self, field: &'static str, value: f64, usable: bool, expected: &'static str) -> Result<(), SceneError> {
        let Check { object, kind } = *self;
        if usable { Ok(()) } else { Err(SceneError::Value { object, kind, field, value, expected }) }
    }

    fn place(&self, field: &'static str, value: f64) -> Result<(), SceneError> {
        self.value(field, value, value.is_finite(), "a finite number")?;
        self.value(field, value, !out_of_reach(value), "a distance of at most 1e12 m")
    }

    fn size(&self, field: &'static str, value: f64) -> Result<(), SceneError> {
        let usable = (MIN_SIZE_METRES..=MAX_SIZE_METRES).contains(&value);
        self.value(field, value, usable, "0.001 to 10000 m")
    }

    fn surface(&self, s: &Surface) -> Result<(), SceneError> {
        self.value("reflectivity", s.reflectivity, s.reflectivity.is_finite(), "a finite number")?;
        let usable = s.reflectivity.abs() <= 1e100;
        self.value("reflectivity", s.reflectivity, usable, "a magnitude of at most 1e100")?;
        let rough = s.roughness_millimetres;
        self.value("roughness_millimetres", rough, (0.0..=MAX_ROUGHNESS_MILLIMETRES).contains(&rough), "0 to 100 mm")
    }

    fn outline(&self, corners: &[[f64; 2]]) -> Result<(), SceneError> {
        let Check { object, kind } = *self;
        let wrong = |fault: String| Err(SceneError::Outline { object, kind, fault });
        if !(3..=MAX_CORNERS).contains(&corners.len()) {
            return wrong(format!("it has {} corners; expected 3 to {MAX_CORNERS}", corners.len()));
        }
        for (i, corner) in corners.iter().enumerate() {
            if corner.iter().any(|v| !v.is_finite() || out_of_reach(*v)) {
                let [x, y] = corner;
                return wrong(format!("corner {} is ({x}, {y}); expected finite numbers of at most 1e12 m", i + 1));
            }
        }
        let (low, high) = extent(corners);
        if (high[0] - low[0]).max(high[1] - low[1]) > MAX_SIZE_METRES {
            return wrong("it is larger than 10000 m".to_owned());
        }
        let count = corners.len();
        let face = |i: usize| [corners[i], corners[(i + 1) % count]];
        for i in 0..count {
            let [a, b] = face(i);
            if (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-3 {
                return wrong(format!("corners {} and {} are less than 1 mm apart", i + 1, (i + 1) % count + 1));
            }
            for j in i + 1..count {
                let is_next = j == i + 1 || (i == 0 && j == count - 1);
                if !is_next && touch(face(i), face(j)) {
                    return wrong(format!("the edges from corner {} and from corner {} cross", i + 1, j + 1));
                }
            }
        }
        if doubled_area(corners).abs() < 2e-6 {
            return wrong("it encloses no area".to_owned());
        }
        Ok(())
    }
}

/// Checks the numbers of a wall, a box, a post or a polygon; `object` is used in the message only.
pub(super) fn validate(body: &Body<'_>, object: usize) -> Result<(), SceneError> {
    let check = Check { object, kind: body.kind() };
    let angle = |value: f64| check.value("angle_degrees", value, value.is_finite(), "a finite number");
    match body {
        Body::Wall(w) => {
            check.place("x_metres", w.x_metres)?;
            check.place("y_metres", w.y_metres)?;
            check.size("length_metres", w.length_metres)?;
            angle(w.angle_degrees)?;
        }
        Body::Box(b) => {
            check.place("x_metres", b.x_metres)?;
            check.place("y_metres", b.y_metres)?;
            check.size("length_metres", b.length_metres)?;
            check.size("width_metres", b.width_metres)?;
            angle(b.angle_degrees)?;
        }
        Body::Post(p) => {
            check.place("x_metres", p.x_metres)?;
            check.place("y_metres", p.y_metres)?;
            let radius = p.radius_metres;
            let usable = (MIN_RADIUS_METRES..=MAX_SIZE_METRES).contains(&radius);
            check.value("radius_metres", radius, usable, "0.01 to 10000 m; a thinner post is a point")?;
        }
        Body::Polygon(p) => check.outline(&p.corners_metres)?,
    }
    check.surface(&body.surface())
}

/// An object that is a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Body<'a> {
    /// See [`Wall`].
    Wall(&'a Wall),
    /// See [`Block`].
    Box(&'a Block),
    /// See [`Post`].
    Post(&'a Post),
    /// See [`Polygon`].
    Polygon(&'a Polygon),
}

impl Body<'_> {
    /// The word used for this kind in files and messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Body::Wall(_) => "wall",
            Body::Box(_) => "box",
            Body::Post(_) => "post",
            Body::Polygon(_) => "polygon",
        }
    }

    /// What it is made of.
    pub fn surface(&self) -> Surface {
        let (reflectivity, roughness_millimetres, seed) = match self {
            Body::Wall(w) => (w.reflectivity, w.roughness_millimetres, w.seed),
            Body::Box(b) => (b.reflectivity, b.roughness_millimetres, b.seed),
            Body::Post(p) => (p.reflectivity, p.roughness_millimetres, p.seed),
            Body::Polygon(p) => (p.reflectivity, p.roughness_millimetres, p.seed),
        };
        Surface { reflectivity, roughness_millimetres, seed }
    }

    /// Its outline.
    pub fn shape(&self) -> Shape {
        match self {
            Body::Wall(w) => Shape::Wall(w.ends_metres()),
            Body::Box(b) => Shape::Outline(b.corners_metres().to_vec()),
            Body::Post(p) => Shape::Circle { centre_metres: [p.x_metres, p.y_metres], radius_metres: p.radius_metres },
            Body::Polygon(p) => Shape::Outline(p.outline_metres()),
        }
    }

    /// Points that its roughness scatters from; 0 for a smooth one and for posts.
    pub fn diffuse_count(&self) -> usize {
        if self.surface().roughness_millimetres == 0.0 {
            return 0;
        }
        let length = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        let faces = self.shape().faces();
        let spacing = (faces.iter().map(|f| length(*f)).sum::<f64>() / MAX_DIFFUSE as f64).max(DIFFUSE_SPACING_METRES);
        faces.iter().map(|f| diffuse_points(length(*f), spacing)).sum()
    }

    /// Most echoes that it gives one element.
    pub fn echo_count(&self) -> usize {
        self.diffuse_count()
            + match self {
                Body::Wall(_) => 3,
                Body::Box(_) => 8,
                Body::Post(_) => 1,
                // Each inner corner has six more.
                Body::Polygon(p) => 2 * p.corners_metres.len() + 6 * inner_corners(&p.outline_metres()).len(),
            }
    }

    /// Where it echoes from, as an antenna at `from_metres` sees it alone: the feet of perpendiculars on its faces, the ends of faces that
    /// are seen, a post's nearest point. (x, y) in metres.
    pub fn echo_places_metres(&self, from_metres: [f64; 2]) -> Vec<[f64; 2]> {
        let shape = self.shape();
        if let Shape::Circle { centre_metres: c, radius_metres } = shape {
            let away = (from_metres[0] - c[0]).hypot(from_metres[1] - c[1]);
            let on = |i: usize| c[i] + (from_metres[i] - c[i]) * radius_metres / away;
            return if away > radius_metres { vec![[on(0), on(1)]] } else { Vec::new() };
        }
        let mut places = Vec::new();
        for [a, b] in shape.faces() {
            let along = [b[0] - a[0], b[1] - a[1]];
            let to = [from_metres[0] - a[0], from_metres[1] - a[1]];
            let height = to[0] * along[1] - to[1] * along[0];
            if height == 0.0 || (height < 0.0 && !matches!(shape, Shape::Wall(_))) {
                continue;
            }
            let part = (to[0] * along[0] + to[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
            let foot = (part > 0.0 && part < 1.0).then(|| [a[0] + part * along[0], a[1] + part * along[1]]);
            for place in [Some(a), foot, Some(b)].into_iter().flatten() {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
        }
        places
    }

    /// The first element of `radar`'s array that stands inside, or on a wall.
    pub(super) fn covered_element(&self, radar: &Radar) -> Option<usize> {
        let shape = self.shape();
        let (low, high) = shape.extent();
        let near = super::MIN_ELEMENT_DISTANCE_METRES;
        if low[1] > near || high[1] < -near {
            return None;
        }
        (0..radar.elements).find(|n| {
            let x = radar.element_x_metres(*n);
            x >= low[0] - near && x <= high[0] + near && shape.distance_metres([x, 0.0]) < near
        })
    }
}

/// Points that a rough face of `length_metres` scatters from, `spacing_metres` apart.
pub fn diffuse_points(length_metres: f64, spacing_metres: f64) -> usize {
    ((length_metres / spacing_metres) as usize).max(1)
}

/// Corners of a counter-clockwise outline that point inwards.
pub fn inner_corners(outline: &[[f64; 2]]) -> Vec<usize> {
    let count = outline.len();
    let turn = |i: usize| {
        let (a, b, c) = (outline[(i + count - 1) % count], outline[i], outline[(i + 1) % count]);
        (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    };
    (0..count).filter(|i| turn(*i) < -1e-12).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Object, Scene};
    use super::*;

    fn told(object: Object) -> String {
        let scene = Scene { objects: vec![object], ..Scene::default() };
        scene.validate(&Radar::default()).unwrap_err().to_string()
    }

    #[test]
    fn a_box_has_its_corners_counter_clockwise() {
        let corners = Block::new([1.0, 10.0], [4.0, 2.0], 90.0).corners_metres();
        assert_eq!(corners, [[2.0, 8.0], [2.0, 12.0], [0.0, 12.0], [0.0, 8.0]]);
        assert!(doubled_area(&corners) + 0.0 > 0.0);
    }

    #[test]
    fn the_angle_of_a_wall_is_counted_counter_clockwise_from_x() {
        for (angle, end) in [(0.0, [3.0, 5.0]), (90.0, [1.0, 7.0]), (180.0, [-1.0, 5.0]), (-90.0, [1.0, 3.0])] {
            assert_eq!(Wall::new(1.0, 5.0, 4.0, angle).ends_metres()[1], end, "{angle}");
        }
        let [_, [x, y]] = Wall::new(0.0, 5.0, 2.0, 30.0).ends_metres();
        assert!((x - 0.75f64.sqrt()).abs() < 1e-15 && (y - 5.5).abs() < 1e-15);
    }

    #[test]
    fn bodies_without_sense_are_named() {
        let square = |corners: &[[f64; 2]]| Object::Polygon(Polygon::new(corners.to_vec()));
        for (object, parts) in [
            (Object::Wall(Wall::new(0.0, 5.0, 0.0, 0.0)), ["object 1 (wall)", "length_metres"]),
            (Object::Wall(Wall::new(f64::NAN, 5.0, 1.0, 0.0)), ["object 1 (wall)", "x_metres is NaN"]),
            (Object::Box(Block::new([0.0, 5.0], [4.0, 0.0], 0.0)), ["object 1 (box)", "width_metres is 0"]),
            (Object::Box(Block::new([0.0, 0.5], [4.0, 3.0], 0.0)), ["object 1 (box)", "element 0 of the array"]),
            (Object::Wall(Wall::new(0.0, 0.0, 4.0, 0.0)), ["object 1 (wall)", "element 0 of the array"]),
            (Object::Post(Post::new(0.0, 5.0, 0.001)), ["object 1 (post)", "radius_metres is 0.001"]),
            (Object::Post(Post::new(0.9, 0.0, 0.2)), ["object 1 (post)", "of the array lies inside"]),
            (square(&[[0.0, 5.0], [1.0, 5.0]]), ["object 1 (polygon)", "2 corners"]),
            (square(&[[0.0, 5.0]; 10_000]), ["object 1 (polygon)", "10000 corners"]),
            (square(&[[0.0, 5.0], [1.0, 6.0], [1.0, 5.0], [0.0, 6.0]]), ["corner 1", "corner 3 cross"]),
            (square(&[[0.0, 5.0], [1.0, 5.0], [2.0, 5.0]]), ["object 1 (polygon)", "area"]),
            (square(&[[0.0, 5.0], [0.0, 5.0], [2.0, 6.0]]), ["corners 1 and 2", "apart"]),
            (square(&[[0.0, 5.0], [f64::INFINITY, 5.0], [2.0, 6.0]]), ["corner 2", "finite"]),
        ] {
            let message = told(object);
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let rough = Wall { roughness_millimetres: -1.0, ..Wall::new(0.0, 5.0, 1.0, 0.0) };
        assert!(told(Object::Wall(rough)).contains("roughness_millimetres is -1; expected 0 to 100 mm"));
    }

    #[test]
    fn a_polygon_may_run_either_way_round() {
        let clockwise = Polygon::new(vec![[0.0, 5.0], [0.0, 6.0], [1.0, 6.0]]);
        assert_eq!(clockwise.outline_metres(), [[1.0, 6.0], [0.0, 6.0], [0.0, 5.0]]);
        let arrow = Polygon::new(vec![[0.0, 5.0], [2.0, 5.0], [1.0, 5.5], [1.0, 8.0]]);
        assert_eq!(inner_corners(&arrow.outline_metres()), [2]);
    }

    #[test]
    fn outlines_know_what_lies_inside() {
        let arrow = Shape::Outline(Polygon::new(vec![[0.0, 5.0], [2.0, 5.0], [1.0, 5.5], [1.0, 8.0]]).outline_metres());
        assert!(arrow.contains([0.9, 5.6]) && !arrow.contains([1.5, 5.6]) && !arrow.contains([0.0, 0.0]));
        assert!((arrow.distance_metres([0.5, 4.0]) - 1.0).abs() < 1e-12 && arrow.distance_metres([0.9, 5.6]) == 0.0);
    }

    #[test]
    fn a_body_echoes_from_the_foot_of_the_perpendicular() {
        let wall = Wall::new(1.0, 10.0, 4.0, 0.0);
        assert_eq!(Body::Wall(&wall).echo_places_metres([0.0, 0.0]), [[-1.0, 10.0], [0.0, 10.0], [3.0, 10.0]]);
        assert_eq!(Body::Wall(&wall).echo_places_metres([5.0, 20.0]).len(), 2, "behind it and beside it");
        let car = Block::new([3.0, 10.0], [2.0, 2.0], 0.0);
        assert_eq!(Body::Box(&car).echo_places_metres([0.0, 0.0]), [[2.0, 9.0], [4.0, 9.0], [2.0, 11.0]]);
        assert_eq!(Body::Post(&Post::new(0.0, 10.0, 1.0)).echo_places_metres([0.0, 0.0]), [[0.0, 9.0]]);
    }
}
