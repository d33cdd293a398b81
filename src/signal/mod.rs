//! From reflectors to the sampled beat signal of every element (thesis equation 3.3).
//!
//! | file | what it is | use it for |
//! |---|---|---|
//! | [`direct`] | the formula word for word in f64 | the thesis' own numbers, rounding floor included |
//! | [`exact`] | the same with phases reduced to turns first | accuracy to the last bits of f64 |
//! | [`split`] | products of 16 + 32 phasors, one lane an element | few reflectors, or the last bits |
//! | [`gridded`] | reflectors spread on a range grid, then transformed | many reflectors |
//! | [`closed_form`] | range profiles from three Dirichlet kernels, on the rows that matter | one or few reflectors, loose tolerances |
//! | [`judge`] | equation 3.3 in double-double | holding all others to their promise |
//!
//! [`plan`] chooses among them and says what it chose; [`synthesis`] runs the block algorithms over the array.
//!
//! [`built`] is the signal of elements that are not as they should be, and calibration.
//!
//! [`echo`] is one reflector's echo as a value: what sparse methods take a signal apart into.
//!
//! [`floor`] says what lies beneath the reflectors: rounding noise as in the thesis, nothing, or thermal noise.

pub mod built;
pub mod closed_form;
pub mod direct;
pub mod echo;
pub mod exact;
pub mod floor;
pub mod gridded;
pub mod judge;
pub mod lane_fft;
pub mod phase;
pub mod plan;
pub mod rows;
pub mod simd;
pub mod split;
pub mod synthesis;

pub use built::{Calibration, calibrate, simulate_built};
pub use echo::ArrayEcho;
pub use floor::Floor;
pub use plan::{Algorithm, Precision, Recipe};
pub use rows::Rows;

use crate::maps::Normalisation;
use crate::radar::{End, Radar};
use crate::scene::{Scene, SceneError};
use ndarray::{Array2, ArrayView2, s};
use num_complex::Complex64;

/// Sampled beat signal: complex, `[elements, samples]`, one row an element.
#[derive(Debug, Clone, PartialEq)]
pub struct BeatSignal {
    /// The samples, `[elements, samples]`.
    pub samples: Array2<Complex64>,
}

impl BeatSignal {
    /// Silence: what an empty scene returns.
    pub fn silence(radar: &Radar) -> Self {
        BeatSignal { samples: Array2::zeros((radar.elements, radar.samples)) }
    }

    /// The rows of one end, `[end_elements, samples]`.
    pub fn end(&self, radar: &Radar, end: End) -> ArrayView2<'_, Complex64> {
        let range = radar.end_range(end);
        self.samples.slice(s![range, ..])
    }

    /// What the sparse sensor keeps of the signal.
    pub fn two_ends(&self, radar: &Radar) -> TwoEnds {
        TwoEnds { first: self.end(radar, End::First).to_owned(), last: self.end(radar, End::Last).to_owned() }
    }

    /// Largest magnitude of any sample; 0 for silence.
    pub fn peak(&self) -> f64 {
        self.samples.iter().fold(0.0, |m: f64, v| m.max(v.norm()))
    }
}

/// Beat signal of the two ends alone: all that a reconstruction may look at.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoEnds {
    /// First end, `[end_elements, samples]`.
    pub first: Array2<Complex64>,
    /// Last end, `[end_elements, samples]`.
    pub last: Array2<Complex64>,
}

impl TwoEnds {
    /// The samples of one end, `[end_elements, samples]`.
    pub fn end(&self, end: End) -> &Array2<Complex64> {
        match end {
            End::First => &self.first,
            End::Last => &self.last,
        }
    }

    /// The samples of both as one vector, element after element: `[2 * end_elements * samples]`.
    pub fn flat(&self) -> Vec<Complex64> {
        self.first.iter().chain(&self.last).copied().collect()
    }

    /// The inverse of [`TwoEnds::flat`] for the ends of `radar`.
    ///
    /// # Panics
    /// When there are fewer samples than `radar`'s ends have.
    pub fn of_flat(radar: &Radar, samples: &[Complex64]) -> Self {
        let (elements, per_element) = (radar.end_elements, radar.samples);
        let end = |from: usize| {
            Array2::from_shape_fn((elements, per_element), |(n, n1)| samples[(from + n) * per_element + n1])
        };
        TwoEnds { first: end(0), last: end(elements) }
    }
}

/// Beat signal of a scene over the named floor; `seed` picks the floor's noise.
///
/// The fastest algorithm whose error stays far beneath the floor is used; `floor::Floor::Thesis` is exact phase and the noise that
/// rounding leaves in the thesis' evaluation. [`direct::beat_signal`] makes that evaluation itself, rounding and all, [`exact`] and
/// [`plan::beat_signal`] any other.
///
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn simulate(radar: &Radar, scene: &Scene, floor: Floor, seed: u64) -> Result<BeatSignal, SceneError> {
    simulate_echoes(radar, scene, floor, seed, |_| {})
}

/// As [`simulate`]; `heard` does to the echoes what the array does before its receivers add their noise.
fn simulate_echoes(
    radar: &Radar,
    scene: &Scene,
    floor: Floor,
    seed: u64,
    heard: impl FnOnce(&mut BeatSignal),
) -> Result<BeatSignal, SceneError> {
    scene.validate(radar)?;
    let reflectors = scene.reflectors();
    let recipe = Recipe::plan(reflectors.len(), plan::amplitude_bound(radar, &reflectors), simulation_tolerance(floor));
    let mut signal = plan::beat_signal(radar, &reflectors, &recipe);
    heard(&mut signal);
    match floor {
        Floor::Exact => {}
        Floor::Thesis => floor::add_noise(&mut signal, &floor::thesis_noise_variance(radar, &reflectors), seed),
        Floor::Snr(snr) => {
            let variance = floor::snr_noise_variance(radar, &reflectors, snr);
            floor::add_noise(&mut signal, &variance, seed);
        }
    }
    Ok(signal)
}

/// Samples are for any use and kept in f64, so they are never coarser than the thesis' floor asks for.
fn simulation_tolerance(floor: Floor) -> f64 {
    plan::tolerance_for(floor, Normalisation::MinMax).min(1e-12)
}
