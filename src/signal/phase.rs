//! Phases in turns, reduced modulo one before any sine is taken.
//!
//! At 20 m the carrier has turned 5000 times: a distance rounded to f64 is already wrong by 1e-12 of a turn. Distances and turns are
//! therefore kept as a sum of two f64 (error-free transformations, Dekker 1971) until the whole turns are gone.
//! The radar's constants (wavelength, range resolution, element positions) count as exact in their f64 values.
//!
//! Everything is written over [`Lanes`], one lane an element, so that it can be compiled for wide vectors; one reflector at one
//! element is the case of a single lane.

use super::simd::Lanes;
use crate::radar::Radar;
use crate::scene::Reflector;

/// An unevaluated sum `hi + lo` with `|lo|` at most half an ulp of `hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair<V> {
    hi: V,
    lo: V,
}

impl Pair<f64> {
    fn splat<const W: usize>(self) -> Pair<Lanes<f64, W>> {
        Pair { hi: Lanes::splat(self.hi), lo: Lanes::splat(self.lo) }
    }
}

#[inline(always)]
fn sum<const W: usize>(a: Lanes<f64, W>, b: Lanes<f64, W>) -> Pair<Lanes<f64, W>> {
    let hi = a + b;
    let t = hi - a;
    Pair { hi, lo: (a - (hi - t)) + (b - t) }
}

/// `a * b` exactly: one fused multiply-add where that is an instruction, else both factors cut in halves (Veltkamp, Dekker).
#[inline(always)]
fn product<const W: usize, const FMA: bool>(a: Lanes<f64, W>, b: Lanes<f64, W>) -> Pair<Lanes<f64, W>> {
    let hi = a * b;
    if FMA {
        return Pair { hi, lo: a.mul_add::<true>(b, -hi) };
    }
    let cut = |v: Lanes<f64, W>| {
        let c = v * Lanes::splat(134_217_729.0); // 2^27 + 1
        let high = c - (c - v);
        (high, v - high)
    };
    let ((ah, al), (bh, bl)) = (cut(a), cut(b));
    Pair { hi, lo: ((ah * bh - hi) + ah * bl + al * bh) + al * bl }
}

/// `rate * distance` less the nearest multiple of `period`, a small whole number.
#[inline(always)]
fn rest<const W: usize, const FMA: bool>(
    distance: Pair<Lanes<f64, W>>,
    rate: Pair<f64>,
    period: f64,
) -> Pair<Lanes<f64, W>> {
    let rate = rate.splat();
    let p = product::<W, FMA>(distance.hi, rate.hi);
    let low = p.lo + distance.hi * rate.lo + distance.lo * rate.hi;
    let turns = (p.hi * Lanes::splat(1.0 / period)).nearest();
    // The product of two whole numbers is exact.
    Pair { hi: p.hi - turns * Lanes::splat(period), lo: low }
}

fn reciprocal(a: f64) -> Pair<f64> {
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
    pub fn turns_at(&self, n1: usize) -> f64 {
        let lanes = EchoLanes::<1> {
            amplitude: Lanes([self.amplitude]),
            distance_metres: Lanes([self.distance_metres]),
            carrier_turns: Lanes([self.carrier_turns]),
            beat_turns: Lanes([self.beat_turns]),
            beat_turns_low: Lanes([self.beat_turns_low]),
        };
        (lanes.beat_turns_at::<false>(n1 as f64) + lanes.carrier_turns).0[0]
    }
}

/// Echo of one reflector at `W` elements; fields as in [`Echo`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EchoLanes<const W: usize> {
    /// See [`Echo::amplitude`].
    pub amplitude: Lanes<f64, W>,
    /// See [`Echo::distance_metres`].
    pub distance_metres: Lanes<f64, W>,
    /// See [`Echo::carrier_turns`].
    pub carrier_turns: Lanes<f64, W>,
    /// See [`Echo::beat_turns`].
    pub beat_turns: Lanes<f64, W>,
    /// See [`Echo::beat_turns_low`].
    pub beat_turns_low: Lanes<f64, W>,
}

impl<const W: usize> EchoLanes<W> {
    /// Turns of the beat alone from sample 0 to sample `n1`, whole turns taken off: in about [-1/2, 1/2], exact to about 1e-16.
    #[inline(always)]
    pub fn beat_turns_at<const FMA: bool>(&self, n1: f64) -> Lanes<f64, W> {
        let n1 = Lanes::splat(n1);
        let p = product::<W, FMA>(n1, self.beat_turns);
        (p.hi - p.hi.nearest()) + (p.lo + n1 * self.beat_turns_low)
    }
}

/// Constants of a radar prepared for [`EchoModel::echo`].
#[derive(Debug, Clone, Copy)]
pub struct EchoModel {
    power: f64,
    per_wavelength: Pair<f64>,
    per_bin: Pair<f64>,
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

    /// Echo of `r` at the element at `element_x_metres` metres.
    pub fn echo(&self, element_x_metres: f64, r: &Reflector) -> Echo {
        let e = self.echo_lanes::<1, false>(Lanes([element_x_metres]), r);
        Echo {
            amplitude: e.amplitude.0[0],
            distance_metres: e.distance_metres.0[0],
            carrier_turns: e.carrier_turns.0[0],
            beat_turns: e.beat_turns.0[0],
            beat_turns_low: e.beat_turns_low.0[0],
        }
    }

    /// Echo of `r` at the elements at `element_x_metres` metres.
    #[inline(always)]
    pub fn echo_lanes<const W: usize, const FMA: bool>(
        &self,
        element_x_metres: Lanes<f64, W>,
        r: &Reflector,
    ) -> EchoLanes<W> {
        let of = Lanes::<f64, W>::splat;
        let dx = sum(element_x_metres, of(-r.x_metres));
        let x2 = product::<W, FMA>(dx.hi, dx.hi);
        let y2 = product::<W, FMA>(of(r.y_metres), of(r.y_metres));
        let s = sum(x2.hi, y2.hi);
        let low = s.lo + x2.lo + y2.lo + of(2.0) * dx.hi * dx.lo;
        let root = s.hi.sqrt();
        let square = product::<W, FMA>(root, root);
        let residual = (s.hi - square.hi) - square.lo + low;
        let distance = sum(root, residual.zip(root, |a, b| a / (2.0 * b)));

        let carrier = rest::<W, FMA>(distance, self.per_wavelength, 1.0);
        let bins = rest::<W, FMA>(distance, self.per_bin, self.samples);
        let beat = bins.hi.map(|v| v / self.samples);
        let back = product::<W, FMA>(beat, of(self.samples));
        let scale = self.power * r.reflectivity;
        EchoLanes {
            amplitude: distance.hi.map(|d| scale / (d * d)),
            distance_metres: distance.hi,
            carrier_turns: of(self.carrier) * (carrier.hi + carrier.lo),
            beat_turns: beat,
            beat_turns_low: ((bins.hi - back.hi) - back.lo + bins.lo).map(|v| v / self.samples),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_product_does_not_depend_on_fused_multiply_add() {
        let mut v = 0.3f64;
        for _ in 0..1000 {
            v = (v * 1.7 + 0.1) % 3e5;
            let (a, b) = (Lanes([v]), Lanes([v * v + 1.0 / 3.0]));
            assert_eq!(product::<1, true>(a, b), product::<1, false>(a, b));
        }
    }
}
