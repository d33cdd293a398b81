//! Choice of the bodies that can shadow an object at all: those near enough to the paths between the array and the object to change its echoes.
//!
//! All ways together are the convex hull of the array and of the object. A body has no effect on a way, to the last bit, where the detour over
//! each of its corners is so long that its ripple has faded ([`MAX_FRESNEL_PARAMETER`]). A detour of a given length is an ellipse around the ends of the way, so
//! bodies farther from the hull than the width of that ellipse are left out.

use super::Wave;
use super::geometry::V;
use super::shadow::MAX_FRESNEL_PARAMETER;
use crate::radar::{BuiltArray, Radar};
use crate::scene::{Object, Shape};

/// The rectangle around all antennas.
#[derive(Debug, Clone, Copy)]
pub(super) struct Array {
    corners: [V; 4],
    /// Half a detour over which every effect has faded, metres.
    faded: f64,
}

/// A body as an obstacle.
#[derive(Debug, Clone)]
pub(super) struct Screen {
    corners: Vec<V>,
    /// Radius of a post around its corner, metres; 0 for other bodies.
    radius: f64,
    /// Greatest distance of any of its points from an antenna, metres.
    farthest: f64,
}

/// All paths between the antennas and an object.
#[derive(Debug, Clone)]
pub(super) struct Ways {
    hull: Vec<V>,
    /// Radius of a post around its corner, metres; 0 for other objects.
    radius: f64,
    /// Length of the longest way, with its way on in the mirror of a face, metres.
    longest: f64,
    faded: f64,
}

impl Array {
    /// The array of `radar`, whose elements stand where `elements` says.
    pub fn of(radar: &Radar, elements: &BuiltArray) -> Self {
        let [left, right] = radar.antenna_span_metres();
        let [hind, fore] = radar.antenna_depth_metres();
        let displaced = (0..elements.elements.len().min(radar.elements)).filter(|n| elements.is_displaced(*n));
        let places = displaced.flat_map(|n| elements.pair(radar, n).places_metres());
        let [left, hind, right, fore] = places.fold([left, hind, right, fore], |[left, hind, right, fore], [x, y]| {
            [left.min(x), hind.min(y), right.max(x), fore.max(y)]
        });
        let faded = MAX_FRESNEL_PARAMETER * MAX_FRESNEL_PARAMETER / Wave::of(radar).radians_per_metre;
        Array { corners: [V(left, hind), V(right, hind), V(right, fore), V(left, fore)], faded }
    }

    fn farthest(&self, places: &[V]) -> f64 {
        let far = |corner: V| places.iter().map(move |p| (*p - corner).norm());
        self.corners.into_iter().flat_map(far).fold(0.0, f64::max)
    }

    pub fn screen(&self, shape: &Shape) -> Screen {
        let (corners, radius) = corners_of(shape);
        let corners = hull(corners);
        let farthest = self.farthest(&corners) + radius;
        Screen { corners, radius, farthest }
    }

    pub fn ways_to(&self, object: &Object) -> Ways {
        let (places, radius, legs) = match object.body().map(|body| body.shape) {
            // Faces are mirrors: their ways go on behind them, as long as they came.
            Some(shape @ (Shape::Wall(_) | Shape::Outline(_))) => (corners_of(&shape).0, 0.0, 2.0),
            Some(circle) => {
                let (centre, radius) = corners_of(&circle);
                (centre, radius, 1.0)
            }
            None => (object.reflectors().iter().map(|r| V(r.x_metres, r.y_metres)).collect(), 0.0, 1.0),
        };
        let longest = legs * (self.farthest(&places) + radius);
        let hull = hull(places.into_iter().chain(self.corners).collect());
        Ways { hull, radius, longest, faded: self.faded }
    }
}

fn corners_of(shape: &Shape) -> (Vec<V>, f64) {
    match shape {
        Shape::Wall(ends) => (ends.map(V::from).to_vec(), 0.0),
        Shape::Outline(corners) => (corners.iter().map(|c| V::from(*c)).collect(), 0.0),
        Shape::Circle { centre_metres, radius_metres } => (vec![V::from(*centre_metres)], *radius_metres),
    }
}

impl Screen {
    /// A circle around it: its middle, and its radius in metres.
    pub fn disc(&self) -> (V, f64) {
        let middle = self.corners.iter().fold(V(0.0, 0.0), |a, b| a + *b) * (self.corners.len().max(1) as f64).recip();
        let radius = self.corners.iter().map(|c| (*c - middle).norm()).fold(0.0, f64::max);
        (middle, radius + self.radius)
    }
}

impl Ways {
    /// The convex hull of all ways, counter-clockwise, without a post's radius.
    pub fn hull(&self) -> &[V] {
        &self.hull
    }

    /// Distance from the hull, metres, beyond which no body has an effect on a way.
    pub fn widest(&self) -> f64 {
        self.margin(f64::INFINITY) + self.radius
    }

    /// Whether `screen` may have an effect on any of the ways.
    pub fn may_pass(&self, screen: &Screen) -> bool {
        let margin = self.margin(screen.farthest) + screen.radius + self.radius;
        let apart =
            |of: &[V]| of.iter().zip(of.iter().cycle().skip(1)).any(|(a, b)| self.are_apart(screen, *b - *a, margin));
        !(apart(&self.hull) || apart(&screen.corners))
    }

    /// Distance from a way beyond which bodies at most `along` metres along it have no effect, metres.
    fn margin(&self, along: f64) -> f64 {
        // The ellipse of all places over which a detour is twice `faded`, widest in the middle of the way.
        let (half, faded) = (self.longest / 2.0, self.faded);
        let beside = (half - along.min(half)) / (half + faded);
        (faded * (self.longest + faded) * (1.0 - beside * beside)).sqrt()
    }

    /// Whether a strip of this width along `edge` parts `screen` from the ways.
    fn are_apart(&self, screen: &Screen, edge: V, margin: f64) -> bool {
        let length = edge.norm();
        if length == 0.0 {
            return false;
        }
        let across = edge.right() * length.recip();
        let span = |of: &[V]| {
            of.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                let at = p.dot(across);
                (low.min(at), high.max(at))
            })
        };
        let ((low, high), (a, b)) = (span(&self.hull), span(&screen.corners));
        a - high >= margin || low - b >= margin
    }
}

/// The convex hull of `places`, counter-clockwise (Andrew's monotone chain).
fn hull(mut places: Vec<V>) -> Vec<V> {
    places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    places.dedup();
    if places.len() < 3 {
        return places;
    }
    let half = |places: &mut dyn Iterator<Item = V>| {
        let mut chain: Vec<V> = Vec::new();
        for place in places {
            while let [.., a, b] = chain[..]
                && (b - a).cross(place - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(place);
        }
        chain.pop();
        chain
    };
    let mut low = half(&mut places.iter().copied());
    low.extend(half(&mut places.iter().rev().copied()));
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::ElementError;
    use crate::scene::{Block, Point, Post, Wall};

    #[test]
    fn a_hull_has_the_outermost_places_alone() {
        let places = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0]];
        let expected = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(V::from);
        assert_eq!(hull(places.map(V::from).to_vec()), expected);
        assert_eq!(hull(vec![V(1.0, 2.0); 5]), [V(1.0, 2.0)]);
    }

    #[test]
    fn an_element_half_a_metre_off_its_place_has_ways_of_its_own() {
        let radar = Radar { elements: 64, ..Radar::default() };
        let mut elements = BuiltArray { elements: vec![ElementError::default(); 64] };
        let point = Object::Point(Point::new(0.0, 12.0));
        let post = Object::Post(Post::new(0.55, 1.0, 0.1)).body().unwrap().shape;
        let may_hide = |elements: &BuiltArray| {
            let array = Array::of(&radar, elements);
            array.ways_to(&point).may_pass(&array.screen(&post))
        };
        assert!(!may_hide(&elements));
        elements.elements[63].position_millimetres = 550.0;
        assert!(may_hide(&elements), "it looks past the post");
        elements.elements[63] = ElementError { forward_millimetres: -600.0, ..ElementError::default() };
        let array = Array::of(&radar, &elements);
        assert_eq!(array.corners[0].1, -0.6, "and one that stands back has longer ones");
    }

    #[test]
    fn a_body_beside_the_ways_is_left_out() {
        let array = Array::of(&Radar::default(), &BuiltArray::default());
        let wall = Object::Wall(Wall::new(-8.0, 20.0, 16.0, 75.0));
        let may = |x: f64| {
            let car = Object::Box(Block::new([x, 9.0], [4.5, 1.8], 90.0));
            array.ways_to(&wall).may_pass(&array.screen(&car.body().unwrap().shape))
        };
        assert!(may(-4.0) && may(-1.8));
        assert!(!may(2.8), "the circle around the wall reaches to x = 0");
    }
}
