//! From reflectors to the sampled beat signal of every element (thesis equation 3.3).
//!
//! | file | what it is | use it for |
//! |---|---|---|
//! | [`direct`] | the formula word for word in f64 | the thesis' own numbers, rounding floor included |
//! | [`exact`] | the same with phases reduced to turns first | accuracy to the last bits of f64 |
//! | [`judge`] | the same in double-double | holding all others to their promise |
//!
//! [`floor`] says what lies beneath the reflectors: rounding noise as in the thesis, nothing, or thermal noise.

pub mod direct;
pub mod exact;
pub mod floor;
pub mod judge;
pub mod phase;

pub use floor::Floor;

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
}

/// Beat signal of a scene over the named floor; `seed` picks the noise of [`Floor::Snr`].
///
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn simulate(radar: &Radar, scene: &Scene, floor: Floor, seed: u64) -> Result<BeatSignal, SceneError> {
    scene.validate(radar)?;
    let reflectors = scene.reflectors();
    Ok(match floor {
        Floor::Thesis => direct::beat_signal(radar, &reflectors),
        Floor::Exact => exact::beat_signal(radar, &reflectors),
        Floor::Snr(snr) => {
            let mut signal = exact::beat_signal(radar, &reflectors);
            let variance = floor::snr_noise_variance(&signal, snr);
            floor::add_noise(&mut signal, &vec![variance; radar.elements], seed);
            signal
        }
    })
}
