//! Rough surfaces: the coherent echoes fall by Ament's factor, and the lost power is scattered by Lambert's law in the plane.
//!
//! Beckmann and Spizzichino, *The Scattering of Electromagnetic Waves from Rough Surfaces* (1963). The diffuse part is a row of points at
//! jittered places, each of a phase of its own that is the same for all elements.

use super::face::Face;
use super::geometry::V;
use super::{AntennaPlaces, EchoKind, PathEcho, REFERENCE_LENGTH_METRES, Wave};
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Part of a coherent echo's amplitude that a height deviation of `deviation_metres` leaves: `exp(-2 (k s cos)^2)`, `k` the physical wave number
/// in the middle of the chirp. A table in `docs/things.md` has it in decibels.
pub fn coherent(wave: &Wave, deviation_metres: f64, cos_incidence: f64) -> f64 {
    (-(wave.radians_per_metre * deviation_metres * cos_incidence).powi(2) / 2.0).exp()
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Grain {
    place: V,
    /// Phase factor, of magnitude 1.
    phase: Complex64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct RoughFace {
    face: Face,
    deviation_metres: f64,
    share_metres: f64,
    grains: Vec<Grain>,
}

impl RoughFace {
    /// A face whose height deviates by `deviation_metres`, with `count` grains; the seed and the face's number in its body pick them.
    pub fn new(face: Face, deviation_metres: f64, count: usize, seed: u64, number: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(number);
        let share_metres = face.length_metres / count.max(1) as f64;
        let grain = |i: usize| {
            let u = (i as f64 + rng.random::<f64>()) * share_metres;
            Grain { place: face.place(u), phase: Complex64::cis(TAU * rng.random::<f64>()) }
        };
        RoughFace { face, deviation_metres, share_metres, grains: (0..count).map(grain).collect() }
    }

    pub fn echo_count(&self) -> usize {
        self.grains.len()
    }

    /// Adds the echo of every grain.
    pub fn echoes(&self, wave: &Wave, antennas: &AntennaPlaces, out: &mut Vec<PathEcho>) {
        let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(V::from);
        let outward = self.face.outward();
        out.extend(self.grains.iter().map(|grain| {
            let (to_t, to_r) = (t - grain.place, r - grain.place);
            let (leg_t, leg_r) = (to_t.norm(), to_r.norm());
            let (cos_t, cos_r) = (to_t.dot(outward) / leg_t, to_r.dot(outward) / leg_r);
            let silent = PathEcho::silent(grain.place.into(), EchoKind::Diffuse);
            let is_lit = cos_t * cos_r > 0.0 && (self.face.is_two_sided || cos_t > 0.0);
            if !is_lit {
                return silent;
            }
            let cos = (cos_t * cos_r).sqrt();
            let lost = 1.0 - coherent(wave, self.deviation_metres, cos).powi(2);
            let strength = self.face.reflectivity * cos * (lost * self.share_metres / REFERENCE_LENGTH_METRES).sqrt();
            let amplitude = grain.phase * (wave.power_watts * strength / (leg_t * leg_r));
            PathEcho { range_metres: (leg_t + leg_r) / 2.0, amplitude, cos_incidence: cos, ..silent }
        }));
    }
}
