//! Phases in turns, reduced modulo one before any sine is taken.
//!
//! At 20 m the carrier's phase is 5000 turns, so the rounding of a distance to f64 is 1e-12 turns. Distances and turns are therefore sums of
//! two f64 (error-free transformations, Dekker 1971) until the whole turns are removed. The radar's constants are exact in their f64
//! values. All functions are written over [`Lanes`], one lane a pair of antennas; one echo at one pair has a single lane.

use super::double::{Double, product, remainder};
use super::path::{PairBlocks, Path};
use super::simd::Lanes;
use crate::radar::{Pair, Pattern, Radar};
use crate::scene::Reflector;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// One echo at one pair of antennas: amplitude, and phase as turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Echo {
    /// Amplitude: `P_out * reflectivity / R^2` for a reflector before isotropic elements.
    pub amplitude: f64,
    pub distance_metres: f64,
    /// Phase of the carrier, in [-1/2, 1/2] times the carrier's turns per wavelength, plus that of a complex amplitude, turns.
    pub carrier_turns: f64,
    /// Phase from one sample to the next, turns in [-1/2, 1/2].
    pub beat_turns: f64,
    /// Rounding error of [`Echo::beat_turns`], significant when multiplied by a sample's number.
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

    pub fn sample(&self, n1: usize) -> Complex64 {
        Complex64::from_polar(self.amplitude, TAU * self.turns_at(n1))
    }
}

/// One echo at `W` pairs of antennas; fields as in [`Echo`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EchoLanes<const W: usize> {
    pub amplitude: Lanes<f64, W>,
    pub distance_metres: Lanes<f64, W>,
    pub carrier_turns: Lanes<f64, W>,
    pub beat_turns: Lanes<f64, W>,
    pub beat_turns_low: Lanes<f64, W>,
}

impl EchoLanes<1> {
    pub fn first(&self) -> Echo {
        Echo {
            amplitude: self.amplitude.0[0],
            distance_metres: self.distance_metres.0[0],
            carrier_turns: self.carrier_turns.0[0],
            beat_turns: self.beat_turns.0[0],
            beat_turns_low: self.beat_turns_low.0[0],
        }
    }
}

impl<const W: usize> EchoLanes<W> {
    /// Phase of the beat from sample 0 to sample `n1` without whole turns: in about [-1/2, 1/2], exact to about 1e-16.
    #[inline(always)]
    pub fn beat_turns_at<const FMA: bool>(&self, n1: f64) -> Lanes<f64, W> {
        let n1 = Lanes::splat(n1);
        let p = product::<W, FMA>(n1, self.beat_turns);
        (p.hi - p.hi.nearest()) + (p.lo + n1 * self.beat_turns_low)
    }

    /// Range in units of `1 / cells` turns of the beat. All lanes are within half a turn of the first.
    #[inline(always)]
    pub(super) fn position_in(&self, cells: f64) -> Lanes<f64, W> {
        let of = Lanes::<f64, W>::splat;
        let position = self.beat_turns * of(cells);
        let wraps = ((position - of(position.0[0])) * of(1.0 / cells)).nearest();
        position - wraps * of(cells)
    }
}

/// The forward model of an echo's samples, with the constants of one radar.
#[derive(Debug, Clone, Copy)]
pub struct EchoModel {
    power_watts: f64,
    pattern: Option<Pattern>,
    per_wavelength: Double<f64>,
    per_bin: Double<f64>,
    samples: f64,
    carrier: f64,
}

impl EchoModel {
    pub fn new(radar: &Radar) -> Self {
        EchoModel {
            power_watts: radar.transmit_power_watts,
            pattern: radar.pattern(),
            per_wavelength: Double::reciprocal(radar.wavelength_metres()),
            per_bin: Double::reciprocal(radar.range_resolution_metres()),
            samples: radar.samples as f64,
            carrier: radar.carrier.turns_per_wavelength(),
        }
    }

    /// Echo of `r` between the antennas of `pair`.
    pub fn echo(&self, pair: Pair, r: &Reflector) -> Echo {
        self.echo_lanes::<1, false>(pair, r).first()
    }

    /// Echo of `r` between the antennas of `pairs`.
    #[inline(always)]
    pub fn echo_lanes<const W: usize, const FMA: bool>(
        &self,
        pairs: impl Into<PairBlocks<W>>,
        r: &Reflector,
    ) -> EchoLanes<W> {
        self.of_path::<W, FMA>(Path::of_point::<FMA>(self.power_watts, self.pattern, &pairs.into(), r))
    }

    /// The echo of a path.
    #[inline(always)]
    pub fn of_path<const W: usize, const FMA: bool>(&self, path: Path<W>) -> EchoLanes<W> {
        let of = Lanes::<f64, W>::splat;
        let carrier = remainder::<W, FMA>(path.range_metres, self.per_wavelength, 1.0);
        let bins = remainder::<W, FMA>(path.range_metres, self.per_bin, self.samples);
        let beat = bins.hi.map(|v| v / self.samples);
        let back = product::<W, FMA>(beat, of(self.samples));
        let carrier_turns = of(self.carrier) * (carrier.hi + carrier.lo);
        EchoLanes {
            amplitude: path.amplitude,
            distance_metres: path.range_metres.hi,
            carrier_turns: path.turns.map_or(carrier_turns, |turns| carrier_turns + turns),
            beat_turns: beat,
            beat_turns_low: ((bins.hi - back.hi) - back.lo + bins.lo).map(|v| v / self.samples),
        }
    }
}
