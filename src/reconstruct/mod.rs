//! Reconstruction of the whole array's map from the samples of the two ends.
//!
//! Every method, the baseline, model-based methods and networks alike, is a [`Reconstructor`].
//!
//! | folder | common approach of its methods |
//! |---|---|
//! | `rows` | each range row of each end by itself; then the estimates of both ends are combined |
//! | `coherent` | both ends as one aperture, place by place |
//! | `grid` | both ends together, on the cells of the whole array's polar grid |
//! | [`search`] | both ends together, off any grid |
//!
//! `fit` is the least-squares kernel of `search` and `coherent`.

mod answer;
mod attempt;
mod baseline;
mod coherent;
mod confidence;
mod echoes;
mod error;
mod family;
mod fit;
pub mod found;
mod grid;
mod hybrid;
mod judge;
#[cfg(test)]
mod layout_tests;
mod noise;
mod noise_model;
mod own_threshold;
mod polar;
mod power;
mod prior;
mod profiles;
mod reconstructor;
mod rows;
pub mod search;
mod significance;
mod trained;
mod untrained;

pub use answer::{Detection, Reconstruction, Request};
pub use attempt::{Attempt, AttemptVerdict, Proposal, Refusal};
pub use baseline::Baseline;
pub use coherent::{CoherentMethod, IAA, SBL};
pub use error::ReconstructError;
pub use family::Family;
pub use grid::{Fista, MatchedFilter, Omp, layout_matched_filter};
pub use hybrid::Hybrid;
pub use judge::{blended, network_weight};
#[cfg(feature = "live")]
pub(crate) use own_threshold::own_threshold;
pub use prior::NoisePrior;
pub use reconstructor::{LayoutSupport, MethodInfo, NEEDS_SAMPLES, Reconstructor, Weights, check_ends};
pub use rows::{
    BARTLETT, CAPON, CAPON_PEAKS, ESPRIT, LINEAR_PREDICTION, LINEAR_PREDICTION_PEAKS, MUSIC, MUSIC_PEAKS, ROOT_MUSIC,
    ROOT_MUSIC_PEAKS, RowMethod,
};
#[cfg(feature = "live")]
pub(crate) use significance::level_above_mean_decades;
pub use trained::TrainedNoise;
pub use untrained::untrained_noise;
