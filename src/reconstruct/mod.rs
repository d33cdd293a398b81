//! From the samples of the two ends to an estimate of the whole array's map.
//!
//! Everything that reconstructs, the baseline, model-based methods and networks alike, is a [`Reconstructor`].

mod bartlett;
mod baseline;
mod beams;
mod capon;
mod conditioning;
mod covariance;
mod drawing;
mod fista;
pub mod found;
mod hybrid;
mod layout_filter;
mod linear_prediction;
mod matched_filter;
mod music;
pub mod nomp;
mod omp;
mod registered;
mod rendering;
mod root_music;
mod rows;

pub use bartlett::BARTLETT;
pub use baseline::Baseline;
pub use capon::CAPON;
pub use fista::Fista;
pub use hybrid::Hybrid;
pub use layout_filter::layout_matched_filter;
pub use linear_prediction::LINEAR_PREDICTION;
pub use matched_filter::MatchedFilter;
pub use music::MUSIC;
pub use omp::Omp;
pub use root_music::ROOT_MUSIC;
pub use rows::RowMethod;

#[cfg(feature = "network")]
pub(crate) use conditioning::unit_gain;
#[cfg(feature = "network")]
pub(crate) use rendering::silence;

use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::{Floor, TwoEnds};
use crate::task::{Cancelled, Task};
use ndarray::Array3;

/// What a reconstruction is told beside the samples.
#[derive(Debug, Clone)]
pub struct Request {
    /// The floor that lies beneath the samples.
    pub floor: Floor,
    /// How the map it is compared with is normalised.
    pub normalisation: Normalisation,
    /// Progress to report to, and the flag to stop at.
    pub task: Task,
}

impl Default for Request {
    /// The thesis' conventions.
    fn default() -> Self {
        Request { floor: Floor::Thesis, normalisation: Normalisation::MinMax, task: Task::default() }
    }
}

/// What a reconstruction found.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// Estimate of the whole array's Lambda, `[range bins, columns]`.
    pub lambda: RangeAngleMap,
    /// The reflectors it believes in, where the method finds any.
    pub reflectors: Vec<Reflector>,
}

/// Why a reconstruction gave nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReconstructError {
    /// Somebody asked it to stop.
    #[error("cancelled")]
    Cancelled,
    /// The samples have another shape than the radar's ends.
    #[error("{what} has shape {found:?}; expected {expected:?}")]
    Shape {
        /// Which input.
        what: &'static str,
        /// Its shape.
        found: Vec<usize>,
        /// The shape it must have.
        expected: Vec<usize>,
    },
    /// A sample is NaN or infinite.
    #[error("sample {sample} of element {element} of the {end} end is not finite")]
    NotFinite {
        /// "first" or "last".
        end: &'static str,
        /// Element within the end.
        element: usize,
        /// Sample within the chirp.
        sample: usize,
    },
    /// The method can't work on this radar or on these samples.
    #[error("{method}: {reason}")]
    Unusable {
        /// Name of the method.
        method: &'static str,
        /// Why, and what would help.
        reason: String,
    },
}

impl From<Cancelled> for ReconstructError {
    fn from(_: Cancelled) -> Self {
        ReconstructError::Cancelled
    }
}

/// Anything that turns the samples of the two ends into a map of the whole array.
pub trait Reconstructor: Send + Sync {
    /// Short name for the command line and tables.
    fn name(&self) -> &'static str;

    /// One sentence for tooltips and help.
    fn description(&self) -> &'static str;

    /// Threshold at which its output is turned into detections. Chosen on validation scenes, never on test scenes.
    fn eta(&self) -> f32;

    /// Estimates the whole array's map from `ends`.
    ///
    /// # Errors
    /// [`ReconstructError`], on samples of the wrong shape or not finite, when cancelled, or as the method says.
    fn reconstruct(&self, radar: &Radar, ends: &TwoEnds, request: &Request)
    -> Result<Reconstruction, ReconstructError>;

    /// Estimates the whole array's map from the thesis networks' own input, `[4, range bins, columns]`
    /// ([`mag_phase`](crate::maps::network_input::mag_phase)).
    ///
    /// # Errors
    /// [`ReconstructError::Unusable`] from every method that needs the samples themselves; [`ReconstructError::Shape`].
    fn reconstruct_mag_phase(&self, _: &Radar, _: &Array3<f64>) -> Result<RangeAngleMap, ReconstructError> {
        let reason =
            "it needs sub0 and sub1; polar_partial_mag_phase is the input of the thesis' networks alone".into();
        Err(ReconstructError::Unusable { method: self.name(), reason })
    }
}

/// Checks that both ends have the radar's shape and hold finite samples only.
///
/// # Errors
/// [`ReconstructError::Shape`] or [`ReconstructError::NotFinite`].
pub fn check_ends(radar: &Radar, ends: &TwoEnds) -> Result<(), ReconstructError> {
    for (end, what, samples) in [("first", "first end", &ends.first), ("last", "last end", &ends.last)] {
        let expected = [radar.end_elements, radar.samples];
        if samples.shape() != expected {
            return Err(ReconstructError::Shape { what, found: samples.shape().to_vec(), expected: expected.to_vec() });
        }
        if let Some(((element, sample), _)) =
            samples.indexed_iter().find(|(_, v)| !(v.re.is_finite() && v.im.is_finite()))
        {
            return Err(ReconstructError::NotFinite { end, element, sample });
        }
    }
    Ok(())
}
