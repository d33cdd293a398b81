//! A straight face, a strip lower than the Fresnel zone, by physical optics: specular glint, and diffraction of both ends. There is a glint
//! while the foot of the perpendicular lies on the face; [`transition`] keeps the sum of glint and edges continuous.

use super::geometry::{V, hypotenuse, root};
use super::transition::transition;
use super::{AntennaPlaces, EchoKind, PathEcho, REFERENCE_LENGTH_METRES, Wave};
use num_complex::Complex64;
use std::f64::consts::PI;

/// An antenna on the line of a face is taken to be this far beside it, metres.
const MIN_HEIGHT_METRES: f64 = 1e-9;

/// A face from one end to the other; its outside lies to the right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    pub(super) from: V,
    /// Unit vector along it.
    pub(super) along: V,
    pub(super) length_metres: f64,
    /// Whether its inside reflects, too.
    pub(super) is_two_sided: bool,
    pub(super) reflectivity: f64,
}

impl Face {
    /// The face from one end to the other, (x, y) in metres.
    pub fn new([from, to]: [[f64; 2]; 2], is_two_sided: bool, reflectivity: f64) -> Self {
        let (from, to) = (V::from(from), V::from(to));
        // A face of no length has no echo, in any direction.
        let length_metres = (to - from).norm().max(1e-12);
        Face { from, along: (to - from) * length_metres.recip(), length_metres, is_two_sided, reflectivity }
    }

    pub(super) fn outward(&self) -> V {
        self.along.right()
    }

    pub(super) fn place(&self, u: f64) -> V {
        self.from + self.along * u
    }

    /// Its glint, the diffraction of its beginning and that of its end.
    pub fn echoes(&self, wave: &Wave, antennas: &AntennaPlaces) -> [PathEcho; 3] {
        self.lit_echoes(wave, antennas, [0.0, self.length_metres])
    }

    /// The three echoes where only the stretch `lit_metres` along the face is lit.
    pub(super) fn lit_echoes(&self, wave: &Wave, antennas: &AntennaPlaces, lit_metres: [f64; 2]) -> [PathEcho; 3] {
        let [low, high] = lit_metres;
        let seen = Heights::new(self, antennas);
        let silent = |u: f64, kind| PathEcho::silent(self.place(u).into(), kind);
        if !seen.is_lit(self.is_two_sided) || high <= low {
            return [silent(low, EchoKind::Glint), silent(low, EchoKind::Edge), silent(high, EchoKind::Edge)];
        }
        let scale = wave.power_watts * self.reflectivity / root(REFERENCE_LENGTH_METRES);
        let Foot { along_metres: foot, range_metres, legs } = seen.foot();
        let on_face = low < foot && foot <= high;
        let amplitude = if on_face { scale / root(range_metres * legs) } else { 0.0 };
        let edges = lit_metres.map(|u| seen.edge(u, range_metres, wave));
        let glint = PathEcho {
            range_metres,
            amplitude: amplitude.into(),
            cos_incidence: (seen.transmitter + seen.receiver) / (2.0 * range_metres),
            mirror_part: mirror_part(edges[0].fresnel_parameter.min(edges[1].fresnel_parameter)),
            ..silent(foot, EchoKind::Glint)
        };
        // The same comparisons as for the glint, so that rounding can't separate them.
        let signs = [if foot > low { -1.0 } else { 1.0 }, if foot <= high { -1.0 } else { 1.0 }];
        let edge = |n: usize| {
            let Edge { range_metres, value, cos_incidence, .. } = edges[n];
            let amplitude = value * (signs[n] * scale);
            PathEcho { range_metres, amplitude, cos_incidence, ..silent(lit_metres[n], EchoKind::Edge) }
        };
        [glint, edge(0), edge(1)]
    }
}

/// [`PathEcho::mirror_part`] of a glint by the Fresnel parameter of the nearer end; at `sqrt(pi)` the whole first Fresnel zone lies on the face.
fn mirror_part(fresnel_parameter: f64) -> f64 {
    let part = (fresnel_parameter / root(PI)).min(1.0);
    part * part * (3.0 - 2.0 * part)
}

/// Places of both antennas relative to a face.
struct Heights {
    /// Place of the transmitter along the face, metres.
    along_transmitter: f64,
    along_receiver: f64,
    /// Distance of the transmitter from the face's line, metres.
    transmitter: f64,
    receiver: f64,
    same_side: bool,
    /// Whether both antennas stand outside.
    outside: bool,
}

struct Foot {
    along_metres: f64,
    range_metres: f64,
    /// Product of the two legs, square metres.
    legs: f64,
}

/// Echo of an end, of a face of unit power and reflectivity, but for its sign.
struct Edge {
    range_metres: f64,
    /// Square root of the phase by which it lags behind the glint, radians.
    fresnel_parameter: f64,
    value: Complex64,
    cos_incidence: f64,
}

impl Heights {
    fn new(face: &Face, antennas: &AntennaPlaces) -> Self {
        let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(|p| V::from(p) - face.from);
        let (ht, hr) = (t.dot(face.outward()), r.dot(face.outward()));
        Heights {
            along_transmitter: t.dot(face.along),
            along_receiver: r.dot(face.along),
            transmitter: ht.abs().max(MIN_HEIGHT_METRES),
            receiver: hr.abs().max(MIN_HEIGHT_METRES),
            same_side: ht * hr > 0.0,
            outside: ht > 0.0 && hr > 0.0,
        }
    }

    fn is_lit(&self, is_two_sided: bool) -> bool {
        if is_two_sided { self.same_side } else { self.outside }
    }

    fn foot(&self) -> Foot {
        let Heights { along_transmitter: t, along_receiver: q, transmitter: ht, receiver: hr, .. } = *self;
        let range_metres = hypotenuse(t - q, ht + hr) / 2.0;
        let part = 2.0 * range_metres / (ht + hr);
        Foot { along_metres: (t * hr + q * ht) / (ht + hr), range_metres, legs: part * ht * part * hr }
    }

    fn edge(&self, u: f64, foot_range_metres: f64, wave: &Wave) -> Edge {
        let Heights { along_transmitter: t, along_receiver: q, transmitter: ht, receiver: hr, .. } = *self;
        let (rt, rr) = (hypotenuse(u - t, ht), hypotenuse(u - q, hr));
        // Sine and cosine for the mean of both angles of incidence.
        let (s, c) = ((u - t) / rt + (u - q) / rr, ht / rt + hr / rr);
        let norm = hypotenuse(s, c).recip();
        let (s, c) = (s * norm, c * norm);
        let range_metres = (rt + rr) / 2.0;
        let both = range_metres + foot_range_metres;
        let kappa = wave.radians_per_metre;
        // w^2 = kappa (range - foot_range), without its cancellation.
        let w = s.abs() * root(kappa * rt * rr / both);
        let strength = c * root(2.0 / (rt * rr * both));
        Edge { range_metres, fresnel_parameter: w, value: transition(w) * strength, cos_incidence: c }
    }
}
