//! Phases in turns, reduced modulo one before any sine is taken.
//!
//! At 20 m the carrier has turned 5000 times: a distance rounded to f64 is already wrong by 1e-12 of a turn. Distances and turns are
//! therefore kept as a sum of two f64 (error-free transformations, Dekker 1971) until the whole turns are gone.
//! The radar's constants (wavelength, range resolution, element positions) count as exact in their f64 values.

use crate::radar::Radar;
use crate::scene::Reflector;

/// An unevaluated sum `hi + lo` with `|lo|` at most half an ulp of `hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    hi: f64,
    lo: f64,
}

#[inline(always)]
fn sum(a: f64, b: f64) -> Pair {
    let hi = a + b;
    let t = hi - a;
    Pair { hi, lo: (a - (hi - t)) + (b - t) }
}

#[inline(always)]
fn product(a: f64, b: f64) -> Pair {
    let hi = a * b;
    Pair { hi, lo: a.mul_add(b, -hi) }
}

#[inline(always)]
fn reciprocal(a: f64) -> Pair {
    let hi = 1.0 / a;
    Pair { hi, lo: (-hi).mul_add(a, 1.0) / a }
}

/// Echo of one reflector at one element: amplitude, and phase as turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Echo {
    /// `P_out * reflectivity / R^2`.
    pub amplitude: f64,
    /// Distance R in metres.
    pub distance_metres: f64,
    /// Turns of the carrier, in [-1/2, 1/2] times the carrier's turns per wavelength.
    pub carrier_turns: f64,
    /// Turns from one sample to the next, in [-1/2, 1/2].
    pub beat_turns: f64,
    /// What [`Echo::beat_turns`] lacks to be exact; matters when multiplied by a sample's number.
    pub beat_turns_low: f64,
}

impl Echo {
    /// Phase at sample `n1` in turns, in about [-2, 2]: exact to about 1e-16.
    #[inline(always)]
    pub fn turns_at(&self, n1: usize) -> f64 {
        let n1 = n1 as f64;
        let p = product(n1, self.beat_turns);
        (p.hi - p.hi.round()) + (p.lo + n1 * self.beat_turns_low) + self.carrier_turns
    }
}

/// Constants of a radar prepared for [`EchoModel::echo`].
#[derive(Debug, Clone, Copy)]
pub struct EchoModel {
    power: f64,
    per_wavelength: Pair,
    per_bin: Pair,
    samples: f64,
    carrier: f64,
}

impl EchoModel {
    /// Prepares the constants of `radar`.
    pub fn new(radar: &Radar) -> Self {
        EchoModel {
            power: radar.transmit_power_watts,
            per_wavelength: reciprocal(radar.wavelength_metres()),
            per_bin: reciprocal(radar.range_resolution_metres()),
            samples: radar.samples as f64,
            carrier: radar.carrier.turns_per_wavelength(),
        }
    }

    /// Echo of `r` at the element at `element_x` metres.
    #[inline(always)]
    pub fn echo(&self, element_x: f64, r: &Reflector) -> Echo {
        let dx = sum(element_x, -r.x_metres);
        let (x2, y2) = (product(dx.hi, dx.hi), product(r.y_metres, r.y_metres));
        let s = sum(x2.hi, y2.hi);
        let low = s.lo + x2.lo + y2.lo + 2.0 * dx.hi * dx.lo;
        let root = s.hi.sqrt();
        let distance = sum(root, ((-root).mul_add(root, s.hi) + low) / (2.0 * root));

        let whole = |rate: Pair, period: f64| {
            let p = product(distance.hi, rate.hi);
            let low = p.lo + distance.hi * rate.lo + distance.lo * rate.hi;
            Pair { hi: p.hi - (p.hi / period).round() * period, lo: low }
        };
        let carrier = whole(self.per_wavelength, 1.0);
        let bins = whole(self.per_bin, self.samples);
        let beat = bins.hi / self.samples;
        Echo {
            amplitude: self.power * r.reflectivity / (distance.hi * distance.hi),
            distance_metres: distance.hi,
            carrier_turns: self.carrier * (carrier.hi + carrier.lo),
            beat_turns: beat,
            beat_turns_low: ((-beat).mul_add(self.samples, bins.hi) + bins.lo) / self.samples,
        }
    }
}
