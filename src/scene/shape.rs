//! Outlines of bodies, and the plane geometry that they need.

use std::f64::consts::TAU;

pub(super) fn out_of_reach(metres: f64) -> bool {
    metres.abs() > 1e12
}

/// The outline of a body, as the radar meets it.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A wall from one end to the other, (x, y) in metres.
    Wall([[f64; 2]; 2]),
    /// Corners of a closed outline, counter-clockwise with y up, (x, y) in metres.
    Outline(Vec<[f64; 2]>),
    /// A circle; its middle is (x, y) in metres.
    Circle { centre_metres: [f64; 2], radius_metres: f64 },
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

/// Twice the area inside an outline, square metres; negative for one that runs clockwise.
pub(super) fn doubled_area(corners: &[[f64; 2]]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    let from = |c: &[f64; 2]| [c[0] - first[0], c[1] - first[1]];
    corners.windows(2).map(|w| (from(&w[0]), from(&w[1]))).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

pub(super) fn touch([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
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

    /// The line along its outline, (x, y) in metres, closed but for a wall's; 48 chords for a circle.
    pub fn line_around(&self) -> Vec<(f64, f64)> {
        let closed = match self {
            Shape::Wall([a, b]) => return vec![(a[0], a[1]), (b[0], b[1])],
            Shape::Circle { centre_metres: [x, y], radius_metres: r } => {
                let at = |i: i32| (TAU * f64::from(i) / 48.0).sin_cos();
                return (0..=48).map(at).map(|(sin, cos)| (x + r * cos, y + r * sin)).collect();
            }
            Shape::Outline(corners) => corners,
        };
        closed.iter().chain(closed.first()).map(|c| (c[0], c[1])).collect()
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

pub(crate) fn extent(corners: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    corners.iter().fold(start, |(low, high), c| ([0, 1].map(|i| low[i].min(c[i])), [0, 1].map(|i| high[i].max(c[i]))))
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
    use super::*;

    #[test]
    fn outlines_know_what_lies_inside() {
        let arrow = Shape::Outline(vec![[0.0, 5.0], [2.0, 5.0], [1.0, 5.5], [1.0, 8.0]]);
        assert!(arrow.contains([0.9, 5.6]) && !arrow.contains([1.5, 5.6]) && !arrow.contains([0.0, 0.0]));
        assert!((arrow.distance_metres([0.5, 4.0]) - 1.0).abs() < 1e-12 && arrow.distance_metres([0.9, 5.6]) == 0.0);
    }
}
