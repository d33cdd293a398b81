//! Diffraction past an obstacle between an antenna and a scatterer, as by two knife edges, left and right.
//!
//! Near the boundary of the shadow the field [`passing`] an edge falls over the width of a Fresnel zone. In the shadow its phase is that of the
//! detour over the nearer edge. An obstacle far beside the path has no effect, to the last bit.
//!
//! The *Fresnel parameter* `w` of an edge is the square root of the phase of the detour over it, radians, positive or negative by the side of the
//! path. The parameter of ITU-R P.526 is `nu = w sqrt(2/pi)`.

use super::geometry::{V, hypotenuse, root};
use super::transition::{passing, transition};
use super::{AntennaPlaces, PathEcho, Wave};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Between these magnitudes of the Fresnel parameter the ripple beside an obstacle is faded out: farther out it would belong to another range.
const FADE_PARAMETERS: [f64; 2] = [3.0, MAX_FRESNEL_PARAMETER];

/// Magnitude of the Fresnel parameter from which on an edge beside the path has no effect.
pub(super) const MAX_FRESNEL_PARAMETER: f64 = 6.0;

/// Most corners for which no memory is allocated.
const MAX_INLINE_CORNERS: usize = 16;

#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    shape: Convex,
    /// (x, y), metres.
    centre: V,
    /// Radius of a circle around the obstacle.
    radius_metres: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Convex {
    Circle,
    Corners(Vec<V>),
}

/// The field past an obstacle on the path between an antenna and the place of an echo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Factor of the field relative to free space, without the phase of the detour.
    pub factor: Complex64,
    /// Length of the path over the nearer edge minus that of the straight path, metres; 0 where the straight path is clear.
    pub detour_metres: f64,
    /// Distance of the edge from the antenna, over its distance from the end of the path.
    pub part: f64,
}

impl Passage {
    const CLEAR_PASSAGE: Passage = Passage { factor: Complex64::new(1.0, 0.0), detour_metres: 0.0, part: 0.0 };
}

impl Obstacle {
    pub fn circle(centre_metres: [f64; 2], radius_metres: f64) -> Self {
        Obstacle { shape: Convex::Circle, centre: centre_metres.into(), radius_metres }
    }

    /// A wall by its two ends, or a convex polygon by its corners in order; (x, y) in metres.
    pub fn corners(corners_metres: &[[f64; 2]]) -> Self {
        let corners: Vec<V> = corners_metres.iter().map(|c| V::from(*c)).collect();
        let sum = corners.iter().fold(V(0.0, 0.0), |a, b| a + *b);
        let centre = sum * (corners.len().max(1) as f64).recip();
        let radius_metres = corners.iter().map(|c| (*c - centre).norm()).fold(0.0, f64::max);
        Obstacle { shape: Convex::Corners(corners), centre, radius_metres }
    }

    fn passage(&self, path: &AntennaPath) -> Passage {
        let AntennaPath { antenna, unit, faded_square, ref ray } = *path;
        let full = ray.full;
        let to_centre = self.centre - antenna;
        let (along, across) = (to_centre.dot(unit), unit.cross(to_centre));
        if along + self.radius_metres < 0.0 || along - self.radius_metres > full || full == 0.0 {
            return Passage::CLEAR_PASSAGE;
        }
        let beside = across.abs() - self.radius_metres;
        if beside > 0.0 && (beside * beside >= faded_square || ray.has_faded(along, self.radius_metres, beside)) {
            return Passage::CLEAR_PASSAGE;
        }
        let mut edges = Edges::none();
        match &self.shape {
            Convex::Circle => {
                if along > 0.0 && along < full {
                    edges.add(ray, along, across - self.radius_metres);
                    edges.add(ray, along, across + self.radius_metres);
                }
            }
            Convex::Corners(corners) => {
                let seen = |c: &V| ((*c - antenna).dot(unit), unit.cross(*c - antenna));
                if corners.len() <= MAX_INLINE_CORNERS {
                    let mut few = [(0.0, 0.0); MAX_INLINE_CORNERS];
                    few.iter_mut().zip(corners).for_each(|(f, c)| *f = seen(c));
                    edges.add_outline(ray, &few[..corners.len()]);
                } else {
                    edges.add_outline(ray, &corners.iter().map(seen).collect::<Vec<_>>());
                }
            }
        }
        edges.passage(ray)
    }
}

/// The straight path from an antenna to the place of an echo.
struct AntennaPath {
    /// Place of the antenna, (x, y) in metres.
    antenna: V,
    /// Direction of the path, a unit vector.
    unit: V,
    /// Square of the distance from the path beyond which an edge has no effect anywhere along it, square metres.
    faded_square: f64,
    ray: Ray,
}

impl AntennaPath {
    /// The path from `antenna` to `place` of a wave with this phase there and back a metre of range; it goes on `beyond_metres`, straight in a face's mirror.
    fn new(radians_per_metre: f64, antenna: V, place: V, beyond_metres: f64) -> Self {
        let path = place - antenna;
        let full = path.norm();
        let whole = full + beyond_metres;
        // Half the detour over an edge of Fresnel parameter FADE_PARAMETERS[1].
        let faded = FADE_PARAMETERS[1] * FADE_PARAMETERS[1] / radians_per_metre;
        let ray = Ray { full, whole, half_kappa: radians_per_metre / 2.0 };
        AntennaPath { antenna, unit: path * full.recip(), faded_square: faded * (whole + faded), ray }
    }
}

/// Lengths of a path and the wave number on it.
struct Ray {
    /// Length from the antenna to the place of the echo, metres.
    full: f64,
    /// The same with the length behind that place, metres.
    whole: f64,
    /// Wave number, radians per metre: half the phase there and back for each metre of range.
    half_kappa: f64,
}

impl Ray {
    /// Fresnel parameter of an edge `l` metres along the path and `q` metres beside it, with the sign of `q`.
    fn fresnel_parameter(&self, l: f64, q: f64) -> f64 {
        if q == 0.0 {
            return 0.0;
        }
        let l = l.clamp(0.0, self.full);
        // The hypotenuse minus l, without cancellation.
        let leg = |l: f64| q * q / (hypotenuse(l, q) + l);
        root(self.half_kappa * (leg(l) + leg(self.whole - l))).copysign(q)
    }

    /// Whether every edge has no effect that lies within `radius_metres` of the place `along` the path, measured along it, and at least `beside`
    /// metres beside it. The Fresnel parameter is least nearest to the middle of the path.
    fn has_faded(&self, along: f64, radius_metres: f64, beside: f64) -> bool {
        let middle = (self.whole / 2.0).max(along - radius_metres).min(along + radius_metres);
        // The margin keeps rounding from deciding, since the corners themselves are not evaluated here.
        self.fresnel_parameter(middle, beside) > FADE_PARAMETERS[1] * (1.0 + 1e-9)
    }
}

/// The edges of an obstacle beside a path.
struct Edges {
    max_parameter: f64,
    min_parameter: f64,
    /// Magnitude of the Fresnel parameter of the edge nearest to the path, and its place along the path, metres.
    nearest: (f64, f64),
}

impl Edges {
    fn none() -> Self {
        Edges { max_parameter: f64::NEG_INFINITY, min_parameter: f64::INFINITY, nearest: (f64::INFINITY, 0.0) }
    }

    /// Adds an edge `l` metres along the path and `q` metres beside it.
    fn add(&mut self, ray: &Ray, l: f64, q: f64) {
        let w = ray.fresnel_parameter(l, q);
        self.max_parameter = self.max_parameter.max(w);
        self.min_parameter = self.min_parameter.min(w);
        if w.abs() < self.nearest.0 {
            self.nearest = (w.abs(), l.clamp(0.0, ray.full));
        }
    }

    /// Adds the corners beside the path, (along, beside) in metres, and the outline's crossings of the lines across the path at its ends.
    fn add_outline(&mut self, ray: &Ray, corners: &[(f64, f64)]) {
        for (i, &(l, q)) in corners.iter().enumerate() {
            if l >= 0.0 && l <= ray.full {
                self.add(ray, l, q);
            }
            let (l2, q2) = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            for level in [0.0, ray.full] {
                let part = (level - l) / (l2 - l);
                if part > 0.0 && part < 1.0 {
                    self.add(ray, level, q + part * (q2 - q));
                }
            }
        }
    }

    fn passage(&self, ray: &Ray) -> Passage {
        let Edges { max_parameter, min_parameter, nearest: (_, l) } = *self;
        if max_parameter < min_parameter {
            return Passage::CLEAR_PASSAGE;
        }
        let part = l / (ray.whole - l).max(1e-9);
        if max_parameter > 0.0 && min_parameter < 0.0 {
            // In the shadow: the sum of the fields past both edges, the second with the phase between the two detours.
            let (shorter, longer) = (max_parameter.min(-min_parameter), max_parameter.max(-min_parameter));
            let turn = Complex64::cis((shorter - longer) * (shorter + longer));
            let detour_metres = shorter * shorter / ray.half_kappa;
            return Passage { factor: transition(shorter) + transition(longer) * turn, detour_metres, part };
        }
        let near = max_parameter.abs().min(min_parameter.abs());
        let remaining = ((FADE_PARAMETERS[1] - near) / (FADE_PARAMETERS[1] - FADE_PARAMETERS[0])).clamp(0.0, 1.0);
        if remaining == 0.0 {
            return Passage::CLEAR_PASSAGE;
        }
        let fade = remaining * remaining * (3.0 - 2.0 * remaining);
        let factor = 1.0 + (passing(max_parameter) + passing(-min_parameter) - 1.0) * fade;
        Passage { factor, detour_metres: 0.0, part }
    }
}

/// The echo after diffraction past each of `obstacles`, on the path from the transmitter and on that to the receiver.
pub(super) fn behind(obstacles: &[Obstacle], wave: &Wave, antennas: &AntennaPlaces, mut echo: PathEcho) -> PathEcho {
    if obstacles.is_empty() {
        return echo;
    }
    let place = V::from(echo.place_metres);
    let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(V::from);
    let beyond = |other: V| if echo.mirror_part > 0.0 { (place - other).norm() * echo.mirror_part } else { 0.0 };
    let path = |from: V, other: V| AntennaPath::new(wave.radians_per_metre, from, place, beyond(other));
    let there = path(t, r);
    let back = (antennas.transmitter_metres != antennas.receiver_metres).then(|| path(r, t));
    for obstacle in obstacles {
        let passed = obstacle.passage(&there);
        let passed_back = back.as_ref().map(|path| obstacle.passage(path));
        if passed != Passage::CLEAR_PASSAGE || passed_back.is_some_and(|back| back != Passage::CLEAR_PASSAGE) {
            echo = diffracted(passed, passed_back, echo);
        }
    }
    echo
}

/// The echo after diffraction past one obstacle. `back` is the passage on the path back, `None` where it is the same as `there`.
///
/// The path of a glint passes the obstacle, and then the obstacle's image in the mirror. The two edges act as one where the obstacle touches the
/// face, and independently where it is far from the face. At an end of the face the glint has the factor of the edge, so that the sum of both stays
/// continuous where the glint leaves the face.
fn diffracted(there: Passage, back: Option<Passage>, echo: PathEcho) -> PathEcho {
    let (is_one, back) = (back.is_none(), back.unwrap_or(there));
    let mean_detour_metres = (there.detour_metres + back.detour_metres) / 2.0;
    let (factor, power) = if echo.mirror_part > 0.0 {
        let correlation = (there.part * back.part).max(0.0).sqrt().min(1.0);
        // At grazing incidence the field past two edges is the probability that two correlated normal variables are both positive: 1/4 for
        // independent edges, 1/2 for one. The exponent makes 1/2 of one edge that value.
        let mirror_power = -(0.25 + correlation.asin() / TAU).log2();
        let power = mirror_power + (2.0 - mirror_power) * (1.0 - echo.mirror_part);
        // Each path's factor is raised on its own: the phase of neither reaches half a turn, that of their product may.
        let raised = there.factor.powf(power / 2.0);
        (raised * if is_one { raised } else { back.factor.powf(power / 2.0) }, power)
    } else {
        (there.factor * back.factor, 2.0)
    };
    PathEcho { range_metres: echo.range_metres + mean_detour_metres * power / 2.0, ..echo.times(factor) }
}
