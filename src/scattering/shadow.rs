//! Diffraction past an obstacle between an antenna and a scatterer: two knife edges, left and right.
//!
//! Near the boundary of a shadow [`passing`] falls over the width of a Fresnel zone. The phase in the shadow is that of the detour over the
//! nearer edge. An obstacle far beside the way has no effect, to the last bit.

use super::geometry::{V, hypotenuse, root};
use super::transition::{passing, transition};
use super::{AntennaPlaces, PathEcho, Wave};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Between these values of Fresnel's measure the ripple beside an obstacle fades out: farther out it belongs at another range.
const FADE: [f64; 2] = [3.0, FADED];

/// Fresnel's measure from which on an edge has no effect at all.
pub(super) const FADED: f64 = 6.0;

const MAX_INLINE_CORNERS: usize = 16;

/// A convex obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    shape: Convex,
    centre: V,
    radius_metres: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Convex {
    Circle,
    Corners(Vec<V>),
}

/// The field past an obstacle on one way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Factor of the field, but for the phase of the detour.
    pub factor: Complex64,
    /// Length of the way over the nearer edge above that of the straight way, metres; 0 where the straight way is clear.
    pub detour_metres: f64,
    /// Place of the edge: its distance from the antenna over the rest of the way.
    pub part: f64,
}

impl Passage {
    const CLEAR: Passage = Passage { factor: Complex64::new(1.0, 0.0), detour_metres: 0.0, part: 0.0 };
}

impl Obstacle {
    /// A post.
    pub fn circle(centre_metres: [f64; 2], radius_metres: f64) -> Self {
        Obstacle { shape: Convex::Circle, centre: centre_metres.into(), radius_metres }
    }

    /// A wall's two ends, or the corners of a convex outline in order; (x, y) in metres.
    pub fn corners(corners_metres: &[[f64; 2]]) -> Self {
        let corners: Vec<V> = corners_metres.iter().map(|c| V::from(*c)).collect();
        let sum = corners.iter().fold(V(0.0, 0.0), |a, b| a + *b);
        let centre = sum * (corners.len().max(1) as f64).recip();
        let radius_metres = corners.iter().map(|c| (*c - centre).norm()).fold(0.0, f64::max);
        Obstacle { shape: Convex::Corners(corners), centre, radius_metres }
    }

    fn passage(&self, way: &Way) -> Passage {
        let Way { antenna, unit, widest_square, ref ray } = *way;
        let full = ray.full;
        let to_centre = self.centre - antenna;
        let (along, across) = (to_centre.dot(unit), unit.cross(to_centre));
        if along + self.radius_metres < 0.0 || along - self.radius_metres > full || full == 0.0 {
            return Passage::CLEAR;
        }
        let beside = across.abs() - self.radius_metres;
        if beside > 0.0 && (beside * beside >= widest_square || ray.has_faded(along, self.radius_metres, beside)) {
            return Passage::CLEAR;
        }
        let mut edges = Edges::none();
        match &self.shape {
            Convex::Circle => {
                if along > 0.0 && along < full {
                    edges.meet(ray, along, across - self.radius_metres);
                    edges.meet(ray, along, across + self.radius_metres);
                }
            }
            Convex::Corners(corners) => {
                let seen = |c: &V| ((*c - antenna).dot(unit), unit.cross(*c - antenna));
                if corners.len() <= MAX_INLINE_CORNERS {
                    let mut few = [(0.0, 0.0); MAX_INLINE_CORNERS];
                    few.iter_mut().zip(corners).for_each(|(f, c)| *f = seen(c));
                    edges.meet_outline(ray, &few[..corners.len()]);
                } else {
                    edges.meet_outline(ray, &corners.iter().map(seen).collect::<Vec<_>>());
                }
            }
        }
        edges.passage(ray)
    }
}

/// One way, from an antenna to the place of an echo.
struct Way {
    antenna: V,
    unit: V,
    /// Square of the distance from the way beyond which an edge's ripple has faded anywhere along it, square metres.
    widest_square: f64,
    ray: Ray,
}

impl Way {
    /// The way from `antenna` to `place` at a wave of `radians_per_metre` there and back. `beyond_metres` is its length behind `place`, straight in
    /// the mirror of a face.
    fn new(radians_per_metre: f64, antenna: V, place: V, beyond_metres: f64) -> Self {
        let way = place - antenna;
        let full = way.norm();
        let whole = full + beyond_metres;
        // A detour in the middle of the way has w = FADE[1].
        let faded = FADE[1] * FADE[1] / radians_per_metre;
        let ray = Ray { full, whole, half_kappa: radians_per_metre / 2.0 };
        Way { antenna, unit: way * full.recip(), widest_square: faded * (whole + faded), ray }
    }
}

struct Ray {
    full: f64,
    whole: f64,
    half_kappa: f64,
}

impl Ray {
    /// Fresnel's measure of an edge `l` along the way and `q` beside it, with the sign of `q`.
    fn measure(&self, l: f64, q: f64) -> f64 {
        if q == 0.0 {
            return 0.0;
        }
        let l = l.clamp(0.0, self.full);
        let leg = |l: f64| q * q / (hypotenuse(l, q) + l);
        root(self.half_kappa * (leg(l) + leg(self.whole - l))).copysign(q)
    }

    /// Whether the ripple has faded of everything within `radius_metres` of a place `along` the way and farther than `beside` beside it.
    /// The measure is least nearest to the middle of the way.
    fn has_faded(&self, along: f64, radius_metres: f64, beside: f64) -> bool {
        let middle = (self.whole / 2.0).max(along - radius_metres).min(along + radius_metres);
        // Rounding may not decide here, where the corners are not looked at.
        self.measure(middle, beside) > FADE[1] * (1.0 + 1e-9)
    }
}

struct Edges {
    top: f64,
    low: f64,
    /// Measure and place along the way of the edge nearest to it.
    nearest: (f64, f64),
}

impl Edges {
    fn none() -> Self {
        Edges { top: f64::NEG_INFINITY, low: f64::INFINITY, nearest: (f64::INFINITY, 0.0) }
    }

    fn meet(&mut self, ray: &Ray, l: f64, q: f64) {
        let w = ray.measure(l, q);
        self.top = self.top.max(w);
        self.low = self.low.min(w);
        if w.abs() < self.nearest.0 {
            self.nearest = (w.abs(), l.clamp(0.0, ray.full));
        }
    }

    /// Meets the corners beside the way, and the outline where it crosses the ends of the way.
    fn meet_outline(&mut self, ray: &Ray, corners: &[(f64, f64)]) {
        for (i, &(l, q)) in corners.iter().enumerate() {
            if l >= 0.0 && l <= ray.full {
                self.meet(ray, l, q);
            }
            let (l2, q2) = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            for level in [0.0, ray.full] {
                let part = (level - l) / (l2 - l);
                if part > 0.0 && part < 1.0 {
                    self.meet(ray, level, q + part * (q2 - q));
                }
            }
        }
    }

    fn passage(&self, ray: &Ray) -> Passage {
        let Edges { top, low, nearest: (_, l) } = *self;
        if top < low {
            return Passage::CLEAR;
        }
        let part = l / (ray.whole - l).max(1e-9);
        if top > 0.0 && low < 0.0 {
            // The fields past both edges, the farther one turned by the phase between the two detours.
            let (shorter, longer) = (top.min(-low), top.max(-low));
            let turn = Complex64::cis((shorter - longer) * (shorter + longer));
            let detour_metres = shorter * shorter / ray.half_kappa;
            return Passage { factor: transition(shorter) + transition(longer) * turn, detour_metres, part };
        }
        let near = top.abs().min(low.abs());
        let left = ((FADE[1] - near) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
        if left == 0.0 {
            return Passage::CLEAR;
        }
        let fade = left * left * (3.0 - 2.0 * left);
        let factor = 1.0 + (passing(top) + passing(-low) - 1.0) * fade;
        Passage { factor, detour_metres: 0.0, part }
    }
}

pub(super) fn behind(obstacles: &[Obstacle], wave: &Wave, antennas: &AntennaPlaces, mut echo: PathEcho) -> PathEcho {
    if obstacles.is_empty() {
        return echo;
    }
    let place = V::from(echo.place_metres);
    let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(V::from);
    let beyond = |other: V| if echo.is_mirrored { (place - other).norm() } else { 0.0 };
    let way = |from: V, other: V| Way::new(wave.radians_per_metre, from, place, beyond(other));
    let there = way(t, r);
    let back = (antennas.transmitter_metres != antennas.receiver_metres).then(|| way(r, t));
    for obstacle in obstacles {
        let passed = obstacle.passage(&there);
        let passed_back = back.as_ref().map(|way| obstacle.passage(way));
        if passed != Passage::CLEAR || passed_back.is_some_and(|back| back != Passage::CLEAR) {
            echo = past(passed, passed_back, echo);
        }
    }
    echo
}

/// The echo, of which the way there passes an obstacle; `back` is the way back where it is another.
///
/// A glint's way passes the obstacle, the mirror and the obstacle's image in it: two edges that act as one where the obstacle touches the
/// face, and apart where it is far from it.
fn past(there: Passage, back: Option<Passage>, echo: PathEcho) -> PathEcho {
    let (is_one, back) = (back.is_none(), back.unwrap_or(there));
    let more = (there.detour_metres + back.detour_metres) / 2.0;
    let (factor, power) = if echo.is_mirrored {
        let correlation = (there.part * back.part).max(0.0).sqrt().min(1.0);
        let power = -(0.25 + correlation.asin() / TAU).log2();
        // Each way is raised to its own power: neither turns by half a turn, their product may.
        let raised = there.factor.powf(power / 2.0);
        (raised * if is_one { raised } else { back.factor.powf(power / 2.0) }, power)
    } else {
        (there.factor * back.factor, 2.0)
    };
    PathEcho { range_metres: echo.range_metres + more * power / 2.0, ..echo.times(factor) }
}
