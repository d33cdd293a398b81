//! Which algorithm, in which precision: written down as a value before anything runs, so that tests can ask what was chosen.

use super::simd::Simd;
use super::{BeatSignal, Floor, closed_form, direct, exact};
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::scene::Reflector;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A way to evaluate equation 3.3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Algorithm {
    /// The formula word for word ([`super::direct`]), rounding noise included.
    Direct,
    /// Phases reduced to turns ([`super::exact`]).
    Exact,
    /// Products of 16 + 32 phasors ([`super::split`]).
    Split,
    /// Spread on a range grid and transformed ([`super::gridded`]).
    Gridded,
    /// Range profiles from three Dirichlet kernels, on few rows ([`super::closed_form`]). Where samples are asked for, phasor split.
    ClosedForm,
}

impl Algorithm {
    /// Every algorithm.
    pub const ALL: [Algorithm; 5] =
        [Algorithm::Direct, Algorithm::Exact, Algorithm::Split, Algorithm::Gridded, Algorithm::ClosedForm];

    /// Whether it computes in blocks of elements ([`super::synthesis`]), in either precision, as fast as a tolerance allows.
    pub fn is_fast(self) -> bool {
        !matches!(self, Algorithm::Direct | Algorithm::Exact)
    }

    /// Name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Algorithm::Direct => "direct",
            Algorithm::Exact => "exact",
            Algorithm::Split => "split",
            Algorithm::Gridded => "gridded",
            Algorithm::ClosedForm => "closed-form",
        }
    }
}

impl fmt::Display for Algorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// An algorithm's name that is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown algorithm \"{0}\"; expected direct, exact, split, gridded or closed-form")]
pub struct UnknownAlgorithm(String);

impl FromStr for Algorithm {
    type Err = UnknownAlgorithm;

    fn from_str(s: &str) -> Result<Self, UnknownAlgorithm> {
        Algorithm::ALL.into_iter().find(|a| a.name() == s).ok_or_else(|| UnknownAlgorithm(s.to_owned()))
    }
}

/// Precision of everything after the phase, which is always formed in f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// Single.
    F32,
    /// Double.
    F64,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        })
    }
}

/// What is to be computed, and how: the planner's answer. Any field may be changed before it runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Recipe {
    /// The algorithm.
    pub algorithm: Algorithm,
    /// The precision.
    pub precision: Precision,
    /// Error allowed in a sample, relative to the sum of the reflectors' amplitudes.
    pub tolerance: f64,
    /// The instructions to use.
    pub simd: Simd,
}

/// Error of the best f64 evaluation, relative to the sum of amplitudes.
pub const BEST_TOLERANCE: f64 = 1e-15;
/// Smallest tolerance that f32 meets.
const F32_TOLERANCE: f64 = 9e-7;
/// Smallest tolerance that gridding meets.
const GRIDDED_TOLERANCE: f64 = 1e-14;
/// From this many reflectors on, spreading is cheaper than summing phasors (`apertura bench` measures it).
const GRIDDED_FROM: usize = 4;
/// Cells up to which the closed form is cheaper than making samples and transforming them (`apertura bench` measures it).
const CLOSED_FORM_CELLS: usize = 3300;
/// f32 holds squares of magnitudes only between these amplitudes.
const F32_AMPLITUDES: std::ops::Range<f64> = 1e-12..1e12;

/// Most reflectors whose sum in f32 stays within [`F32_TOLERANCE`] even where all roundings agree, as they do for coincident points.
fn most_in_f32(algorithm: Algorithm) -> usize {
    match algorithm {
        // One long sum; the others add up sums of a few.
        Algorithm::ClosedForm => 60,
        _ => 1024,
    }
}

impl Recipe {
    /// The cheapest way to evaluate `count` reflectors whose amplitudes sum to at most `amplitude`, within `tolerance`.
    pub fn plan(count: usize, amplitude: f64, tolerance: f64) -> Recipe {
        let single = tolerance >= F32_TOLERANCE && holds(amplitude) && count <= most_in_f32(Algorithm::Gridded);
        let gridded = count >= GRIDDED_FROM && tolerance >= GRIDDED_TOLERANCE;
        Recipe {
            algorithm: if gridded { Algorithm::Gridded } else { Algorithm::Split },
            precision: if single { Precision::F32 } else { Precision::F64 },
            tolerance,
            simd: Simd::chosen(),
        }
    }

    /// This recipe for range profiles of `count` reflectors beneath which there is no floor: with few cells above the tolerance, those alone.
    pub fn on_few_rows(self, radar: &Radar, count: usize) -> Recipe {
        let cells = count.saturating_mul(2 * closed_form::reach(self.tolerance));
        let holds = self.precision == Precision::F64 || count <= most_in_f32(Algorithm::ClosedForm);
        if cells <= CLOSED_FORM_CELLS && holds && closed_form::applies(radar) {
            self.with_algorithm(Algorithm::ClosedForm)
        } else {
            self
        }
    }

    /// This recipe with another algorithm.
    pub fn with_algorithm(self, algorithm: Algorithm) -> Recipe {
        Recipe { algorithm, ..self }
    }
}

/// The error a signal may have, relative to its amplitudes, so that a map over `floor`, normalised so, does not show it.
///
/// Normalising by the minimum makes the floor part of the picture. Over the thesis' floor (1e-11 a sample) that leaves no
/// room for f32, whose cells cancel to exact zeros; without any floor not even for gridding. Over thermal noise, or with a fixed
/// dynamic range, f32 is ample until the noise or the range comes near its own rounding.
pub fn tolerance_for(floor: Floor, normalisation: Normalisation) -> f64 {
    match (normalisation, floor) {
        (Normalisation::DynamicRange(db), _) if db.0 <= 100.0 => 1e-6,
        (Normalisation::MinMax, Floor::Snr(snr)) if snr.0 <= 40.0 => 1e-6,
        (_, Floor::Exact) => BEST_TOLERANCE,
        _ => GRIDDED_TOLERANCE,
    }
}

/// What is to be added up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sum {
    /// By which algorithm.
    pub algorithm: Algorithm,
    /// Reflectors.
    pub reflectors: usize,
    /// Bound of the sum of their amplitudes ([`amplitude_bound`]).
    pub amplitude: f64,
}

/// Why maps of this floor and normalisation must not be made in `precision`, if so.
///
/// Without a floor the smallest cells are rounding errors; normalised by them, a map in single precision shows its own rounding and nothing
/// that the scene has to do with. And f32 can't hold the squares of very large or very small amplitudes, nor very long sums.
pub fn refusal(precision: Precision, sum: &Sum, floor: Floor, normalisation: Normalisation) -> Option<&'static str> {
    match (precision, floor, normalisation) {
        (Precision::F64, ..) => None,
        (_, Floor::Exact, Normalisation::MinMax) => {
            Some("f64 although f32 was asked for: without a floor, min-max would show f32's own rounding")
        }
        _ if !holds(sum.amplitude) => Some("f64 although f32 was asked for: f32 can't hold such amplitudes"),
        _ if sum.reflectors > most_in_f32(sum.algorithm) => {
            Some("f64 although f32 was asked for: f32 loses digits over so many reflectors")
        }
        _ => None,
    }
}

/// Whether f32 can hold the squares of such amplitudes.
fn holds(amplitude: f64) -> bool {
    amplitude == 0.0 || F32_AMPLITUDES.contains(&amplitude)
}

/// Sum of the largest amplitude each reflector can have at the array: the scale that tolerances refer to.
pub fn amplitude_bound(radar: &Radar, reflectors: &[Reflector]) -> f64 {
    let half = radar.aperture_metres() / 2.0;
    let of_one = |r: &Reflector| {
        let beside = (r.x_metres.abs() - half).max(0.0);
        let square = (beside * beside + r.y_metres * r.y_metres).max(crate::scene::MIN_ELEMENT_DISTANCE_METRES.powi(2));
        radar.transmit_power_watts * r.reflectivity.abs() / square
    };
    reflectors.iter().map(of_one).sum()
}

/// Runs a recipe: the whole array's beat signal, noiseless.
///
/// The reflectors must have passed [`crate::scene::Scene::validate`].
pub fn beat_signal(radar: &Radar, reflectors: &[Reflector], recipe: &Recipe) -> BeatSignal {
    use super::simd::{LANES_F32, LANES_F64};
    use super::synthesis::Synthesis;
    let elements = 0..radar.elements;
    match (recipe.algorithm, recipe.precision) {
        (Algorithm::Direct, _) => direct::beat_signal(radar, reflectors),
        (Algorithm::Exact, _) => exact::beat_signal(radar, reflectors),
        (_, Precision::F32) => {
            BeatSignal { samples: Synthesis::<f32, LANES_F32>::new(radar, *recipe).samples(reflectors, elements) }
        }
        (_, Precision::F64) => {
            BeatSignal { samples: Synthesis::<f64, LANES_F64>::new(radar, *recipe).samples(reflectors, elements) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::judge;
    use super::*;
    use crate::scene::Scene;

    fn worst_error(radar: &Radar, reflectors: &[Reflector], recipe: &Recipe) -> f64 {
        let signal = beat_signal(radar, reflectors, recipe);
        let mut worst = 0.0f64;
        let mut peak = 0.0f64;
        for element in [0, 1, 7, 300, 511, 700, 1016, 1023] {
            for (a, b) in signal.samples.row(element).iter().zip(judge::element_signal(radar, reflectors, element)) {
                worst = worst.max((a - b).norm());
                peak = peak.max(b.norm());
            }
        }
        worst / peak
    }

    fn scattered(count: usize) -> Vec<Reflector> {
        let at = |i: usize| (f64::from(i as u32 * 37 % 61) - 30.0, 2.0 + f64::from(i as u32 * 53 % 33) + 0.37);
        Scene::of_points((0..count).map(at)).reflectors()
    }

    #[test]
    fn every_algorithm_keeps_its_promise_on_every_instruction_set() {
        let radar = Radar::default();
        for count in [1, 10, 60] {
            let reflectors = scattered(count);
            for simd in Simd::available() {
                for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
                    for algorithm in [Algorithm::Split, Algorithm::Gridded] {
                        let plan = Recipe::plan(count, 1.0, tolerance);
                        let recipe = Recipe { simd, algorithm, ..plan };
                        let error = worst_error(&radar, &reflectors, &recipe);
                        assert!(error < tolerance, "{count} reflectors, {recipe:?}: {error:e}");
                    }
                }
            }
            let best = Recipe::plan(count, 1.0, BEST_TOLERANCE);
            assert_eq!((best.algorithm, best.precision), (Algorithm::Split, Precision::F64));
            let error = worst_error(&radar, &reflectors, &best);
            assert!(error < 1e-14, "{count}: {error:e}");
        }
    }

    #[test]
    fn the_two_way_carrier_and_wrapping_ranges_keep_the_promise() {
        let radar = Radar { carrier: crate::radar::Carrier::TwoWay, ..Radar::default() };
        let max = radar.max_range_metres();
        let reflectors =
            Scene::of_points([(0.5, max / 2.0), (3.0, max - 0.01), (-20.0, 3.0 * max), (1e5, 1e4)]).reflectors();
        for (algorithm, bound) in [(Algorithm::Split, 1e-14), (Algorithm::Gridded, 2e-13)] {
            let recipe = Recipe::plan(4, 1.0, 1e-14).with_algorithm(algorithm);
            let error = worst_error(&radar, &reflectors, &recipe);
            assert!(error < bound, "{recipe:?}: {error:e}");
        }
    }

    #[test]
    fn f32_never_meets_min_max_over_a_rounding_floor() {
        use crate::radar::Decibels;
        for (floor, normalisation, precision) in [
            (Floor::Thesis, Normalisation::MinMax, Precision::F64),
            (Floor::Exact, Normalisation::MinMax, Precision::F64),
            (Floor::Snr(Decibels(80.0)), Normalisation::MinMax, Precision::F64),
            (Floor::Snr(Decibels(20.0)), Normalisation::MinMax, Precision::F32),
            (Floor::Exact, Normalisation::DynamicRange(Decibels(60.0)), Precision::F32),
            (Floor::Exact, Normalisation::DynamicRange(Decibels(200.0)), Precision::F64),
        ] {
            let recipe = Recipe::plan(10, 1.0, tolerance_for(floor, normalisation));
            assert_eq!(recipe.precision, precision, "{floor} {normalisation}");
        }
        let exact = Recipe::plan(1000, 1.0, tolerance_for(Floor::Exact, Normalisation::MinMax));
        assert_eq!(exact.algorithm, Algorithm::Split, "without a floor, gridding's own error would show");
        assert_eq!(Recipe::plan(10, 1e30, 1e-6).precision, Precision::F64, "squares of 1e30 overflow f32");
    }
}
