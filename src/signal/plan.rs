//! The choice of algorithm and precision, as a value that tests can examine before it runs.

use super::path::largest_amplitude;
use super::simd::Simd;
use super::{Algorithm, Precision, closed_form};
use crate::radar::Radar;
use crate::scattering::{EchoSources, ObjectWithOccluders, Sources};
use rayon::prelude::*;
use serde::Serialize;

/// Algorithm, precision, tolerance and instructions of a simulation by [`super::beat_signal`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SynthesisPlan {
    pub algorithm: Algorithm,
    pub precision: Precision,
    /// Largest error of a sample, relative to the sum of the reflectors' amplitudes.
    pub tolerance: f64,
    pub simd: Simd,
}

/// Error of the best f64 evaluation, relative to the sum of amplitudes.
pub const BEST_TOLERANCE: f64 = 1e-15;
/// Smallest tolerance that f32 meets.
const MIN_F32_TOLERANCE: f64 = 9e-7;
/// Smallest tolerance that gridding meets; far below the thesis' floor, which is 1e-11 a sample.
pub const FLOOR_TOLERANCE: f64 = 1e-14;
/// Least number of reflectors for which gridding is cheaper than phasor split (`apertura bench` measures it).
const MIN_GRIDDED_REFLECTORS: usize = 4;
/// Most cells for which the closed form is cheaper than samples and their transform (`apertura bench` measures it).
const MAX_CLOSED_FORM_CELLS: usize = 3300;
/// Amplitudes whose squares f32 can hold.
const F32_AMPLITUDE_RANGE: std::ops::Range<f64> = 1e-12..1e12;

/// Most reflectors whose sum in f32 has at most the error [`MIN_F32_TOLERANCE`], even where all rounding errors agree, as for coincident points.
fn max_f32_reflectors(algorithm: Algorithm) -> usize {
    match algorithm {
        // One long sum.
        Algorithm::ClosedForm => 60,
        // The rounding errors of the sum are kept.
        Algorithm::Gridded => usize::MAX,
        // Sums of eight.
        Algorithm::Direct | Algorithm::Exact | Algorithm::Split => 1024,
    }
}

impl SynthesisPlan {
    /// The cheapest way to evaluate `count` reflectors whose amplitudes sum to at most `amplitude`, within `tolerance`.
    pub fn cheapest(count: usize, amplitude: f64, tolerance: f64) -> SynthesisPlan {
        let gridded = count >= MIN_GRIDDED_REFLECTORS && tolerance >= FLOOR_TOLERANCE;
        let algorithm = if gridded { Algorithm::Gridded } else { Algorithm::Split };
        let single = tolerance >= MIN_F32_TOLERANCE && holds(amplitude) && count <= max_f32_reflectors(algorithm);
        let precision = if single { Precision::F32 } else { Precision::F64 };
        SynthesisPlan { algorithm, precision, tolerance, simd: Simd::chosen() }
    }

    /// The plan for range profiles of `count` reflectors without a floor: the closed form where few cells exceed the tolerance.
    pub fn on_few_rows(self, radar: &Radar, count: usize) -> SynthesisPlan {
        let cells = count.saturating_mul(2 * closed_form::reach(self.tolerance));
        let holds = self.precision == Precision::F64 || count <= max_f32_reflectors(Algorithm::ClosedForm);
        if cells <= MAX_CLOSED_FORM_CELLS && holds && closed_form::applies(radar) {
            self.with_algorithm(Algorithm::ClosedForm)
        } else {
            self
        }
    }

    pub fn with_algorithm(self, algorithm: Algorithm) -> SynthesisPlan {
        SynthesisPlan { algorithm, ..self }
    }
}

/// The size of a sum over reflectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SumSize {
    pub algorithm: Algorithm,
    pub reflectors: usize,
    /// Bound of the sum of their amplitudes ([`amplitude_bound`]).
    pub amplitude: f64,
}

/// The reason for which f32 must not be used for `sum`: too large or too small amplitudes, or too many reflectors. `None` where it may be used.
pub fn refusal(sum: &SumSize) -> Option<&'static str> {
    if !holds(sum.amplitude) {
        Some("f64 although f32 was asked for: f32 can't hold such amplitudes")
    } else if sum.reflectors > max_f32_reflectors(sum.algorithm) {
        Some("f64 although f32 was asked for: f32 loses digits over so many reflectors")
    } else {
        None
    }
}

fn holds(amplitude: f64) -> bool {
    amplitude == 0.0 || F32_AMPLITUDE_RANGE.contains(&amplitude)
}

/// Number of elements at which [`amplitude_bound`] evaluates the echoes of bodies.
const BOUND_ELEMENTS: usize = 48;

/// Sum of the largest amplitude of each reflector at the array, and of each echo of a body at some elements: the scale of tolerances.
pub fn amplitude_bound<'a>(radar: &Radar, sources: impl Into<Sources<'a>>) -> f64 {
    let sources = sources.into();
    let of_points: f64 = sources.points.iter().map(|r| largest_amplitude(radar, r)).sum();
    if sources.scatterers.is_empty() {
        return of_points;
    }
    let mut largest: Vec<f64> = vec![0.0; sources.len() - sources.points.len()];
    let mut echoes = Vec::new();
    let last = radar.elements - 1;
    for n in (0..last).step_by((radar.elements / BOUND_ELEMENTS).max(1)).chain([last]) {
        sources.scattered(radar.pair(n), &mut echoes);
        largest.iter_mut().zip(&echoes).for_each(|(l, echo)| *l = l.max(echo.amplitude.norm()));
    }
    of_points + largest.iter().sum::<f64>()
}

/// [`amplitude_bound`] of each of these objects.
pub fn amplitude_bounds<'a>(radar: &Radar, seen: impl Iterator<Item = &'a ObjectWithOccluders>) -> Vec<f64> {
    let seen: Vec<&ObjectWithOccluders> = seen.collect();
    let bound = |one: &&ObjectWithOccluders| {
        amplitude_bound(radar, &EchoSources::of_objects(radar, std::slice::from_ref(*one)))
    };
    seen.par_iter().with_min_len(4).map(bound).collect()
}
