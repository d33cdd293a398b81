//! Bodies: walls, boxes, posts and polygons. They shine where they face the radar and hide what stands behind them.

use super::common::{is_default, moving};
use super::shape::{Shape, direction, doubled_area, inner_corners};
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

/// A body: its shape, then what all surfaces have.
macro_rules! body {
    ($(#[$about:meta])* pub struct $name:ident { $($fields:tt)* }) => {
        moving! {
            $(#[$about])*
            pub struct $name {
                $($fields)*
                /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
                #[serde(default = "one")]
                pub reflectivity: f64,
                /// Standard deviation of the surface's height, millimetres: 0 is smooth.
                #[serde(default, skip_serializing_if = "is_default")]
                pub roughness_millimetres: f64,
                /// Seed of the surface's random heights.
                #[serde(default, skip_serializing_if = "is_default")]
                pub seed: u64,
            }
        }
    };
}

body! {
    /// A straight wall without thickness; both its sides reflect.
    pub struct Wall {
        /// x of its middle, along the array's axis, metres.
        pub x_metres: f64,
        /// y of its middle, ahead of the array, metres.
        pub y_metres: f64,
        pub length_metres: f64,
        /// Direction of its length: 0 along +x, 90 straight ahead, counter-clockwise.
        #[serde(default, skip_serializing_if = "is_default")]
        pub angle_degrees: f64,
    }
}

body! {
    /// A rectangle: a car is 4.5 m by 1.8 m.
    pub struct Block {
        /// x of its middle, along the array's axis, metres.
        pub x_metres: f64,
        /// y of its middle, ahead of the array, metres.
        pub y_metres: f64,
        pub length_metres: f64,
        /// Its width, across the length, metres.
        pub width_metres: f64,
        /// Direction of its length: 0 along +x, 90 straight ahead, counter-clockwise.
        #[serde(default, skip_serializing_if = "is_default")]
        pub angle_degrees: f64,
    }
}

body! {
    pub struct Post {
        /// x of its middle, along the array's axis, metres.
        pub x_metres: f64,
        /// y of its middle, ahead of the array, metres.
        pub y_metres: f64,
        pub radius_metres: f64,
    }
}

body! {
    /// A closed outline of straight faces, convex or not.
    pub struct Polygon {
        /// Its corners in order, either way round, (x, y) in metres.
        pub corners_metres: Vec<[f64; 2]>,
    }
}

/// Reflectivity of a body whose file gives none.
pub(super) fn one() -> f64 {
    1.0
}

impl Wall {
    /// A smooth wall of metal around (`x_metres`, `y_metres`).
    pub fn new(x_metres: f64, y_metres: f64, length_metres: f64, angle_degrees: f64) -> Self {
        Wall { x_metres, y_metres, length_metres, angle_degrees, reflectivity: 1.0, ..Wall::default() }
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
        Block { x_metres, y_metres, length_metres, width_metres, angle_degrees, reflectivity: 1.0, ..Block::default() }
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

impl Post {
    /// A smooth post of metal.
    pub fn new(x_metres: f64, y_metres: f64, radius_metres: f64) -> Self {
        Post { x_metres, y_metres, radius_metres, reflectivity: 1.0, ..Post::default() }
    }
}

impl Polygon {
    /// A smooth polygon of metal.
    pub fn new(corners_metres: Vec<[f64; 2]>) -> Self {
        Polygon { corners_metres, reflectivity: 1.0, ..Polygon::default() }
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

/// An object that is a body: its outline and its surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub shape: Shape,
    /// Reflection coefficient of the surface, of the amplitude: 1 for metal.
    pub reflectivity: f64,
    /// Standard deviation of the surface's height, millimetres: 0 is smooth.
    pub roughness_millimetres: f64,
    pub seed: u64,
}

impl Body {
    /// Points that the body's roughness scatters from; 0 for a smooth body and for posts.
    pub fn diffuse_count(&self) -> usize {
        if self.roughness_millimetres == 0.0 {
            return 0;
        }
        let length = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        let faces = self.shape.faces();
        let spacing = (faces.iter().map(|f| length(*f)).sum::<f64>() / MAX_DIFFUSE as f64).max(DIFFUSE_SPACING_METRES);
        faces.iter().map(|f| diffuse_points(length(*f), spacing)).sum()
    }

    /// Most echoes that it gives one element.
    pub fn echo_count(&self) -> usize {
        self.diffuse_count()
            + match &self.shape {
                Shape::Wall(_) => 3,
                Shape::Circle { .. } => 1,
                // Each inner corner has six more.
                Shape::Outline(corners) => 2 * corners.len() + 6 * inner_corners(corners).len(),
            }
    }

    /// Places, (x, y) in metres, that echo freely to an antenna: feet of perpendiculars on faces, ends of faces that are seen, a post's nearest point.
    pub fn echo_places_metres(&self, from_metres: [f64; 2]) -> Vec<[f64; 2]> {
        if let Shape::Circle { centre_metres: c, radius_metres } = self.shape {
            let away = (from_metres[0] - c[0]).hypot(from_metres[1] - c[1]);
            let on = |i: usize| c[i] + (from_metres[i] - c[i]) * radius_metres / away;
            return if away > radius_metres { vec![[on(0), on(1)]] } else { Vec::new() };
        }
        let mut places = Vec::new();
        for [a, b] in self.shape.faces() {
            let along = [b[0] - a[0], b[1] - a[1]];
            let to = [from_metres[0] - a[0], from_metres[1] - a[1]];
            let height = to[0] * along[1] - to[1] * along[0];
            if height == 0.0 || (height < 0.0 && !matches!(self.shape, Shape::Wall(_))) {
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

    pub(super) fn covered_element(&self, radar: &Radar) -> Option<usize> {
        let (low, high) = self.shape.extent();
        let near = super::MIN_ELEMENT_DISTANCE_METRES;
        let [hind, fore] = radar.antenna_depth_metres();
        if low[1] > fore + near || high[1] < hind - near {
            return None;
        }
        (0..radar.elements).find(|n| {
            let covers = |[x, y]: [f64; 2]| {
                x >= low[0] - near && x <= high[0] + near && self.shape.distance_metres([x, y]) < near
            };
            radar.pair(*n).places_metres().into_iter().any(covers)
        })
    }
}

/// Points that a rough face of `length_metres` scatters from, `spacing_metres` apart.
pub fn diffuse_points(length_metres: f64, spacing_metres: f64) -> usize {
    ((length_metres / spacing_metres) as usize).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;

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
    fn a_polygon_may_run_either_way_round() {
        let clockwise = Polygon::new(vec![[0.0, 5.0], [0.0, 6.0], [1.0, 6.0]]);
        assert_eq!(clockwise.outline_metres(), [[1.0, 6.0], [0.0, 6.0], [0.0, 5.0]]);
        let arrow = Polygon::new(vec![[0.0, 5.0], [2.0, 5.0], [1.0, 5.5], [1.0, 8.0]]);
        assert_eq!(inner_corners(&arrow.outline_metres()), [2]);
    }

    #[test]
    fn a_body_echoes_from_the_foot_of_the_perpendicular() {
        let places = |object: &Object, from| object.body().unwrap().echo_places_metres(from);
        let wall = Object::Wall(Wall::new(1.0, 10.0, 4.0, 0.0));
        assert_eq!(places(&wall, [0.0, 0.0]), [[-1.0, 10.0], [0.0, 10.0], [3.0, 10.0]]);
        assert_eq!(places(&wall, [5.0, 20.0]).len(), 2, "behind it and beside it");
        let car = Object::Box(Block::new([3.0, 10.0], [2.0, 2.0], 0.0));
        assert_eq!(places(&car, [0.0, 0.0]), [[2.0, 9.0], [4.0, 9.0], [2.0, 11.0]]);
        assert_eq!(places(&Object::Post(Post::new(0.0, 10.0, 1.0)), [0.0, 0.0]), [[0.0, 9.0]]);
    }
}
