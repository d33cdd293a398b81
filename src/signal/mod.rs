//! From what echoes to the sampled beat signal of every element (thesis equation 3.3).
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
//! What echoes is given as [`Sources`](crate::scattering::Sources): points, and bodies with what they hide.
//!
//! [`path`] says which range and which amplitude an echo has at a pair of antennas, [`phase`] which phases that gives: the forward
//! model, which everything that simulates, fits or bounds samples calls.
//!
//! A [`Plan`] says which of them, in which precision; [`beat_signal`] runs one, [`synthesis`] the block algorithms over the array.
//! [`simulate`] goes from a scene to samples over a floor.
//!
//! [`built`] is the signal of disturbed scenes, whose elements are off or hear another radar; [`calibration`] estimates gains and phases.
//!
//! [`chirps`] is the signal of several chirps while objects move.
//!
//! [`echo`] is one reflector's echo as a value: what sparse methods take a signal apart into.
//!
//! [`floor`] says what lies beneath the reflectors: rounding noise as in the thesis, nothing, or thermal noise.

mod algorithm;
pub mod built;
pub mod calibration;
pub mod chirps;
pub mod closed_form;
pub mod direct;
mod double;
pub mod echo;
pub mod exact;
pub mod floor;
pub mod gridded;
mod heard;
mod interference;
pub mod judge;
pub mod lane_fft;
mod over_floor;
pub mod path;
pub mod phase;
pub mod plan;
pub mod rows;
mod run;
mod samples;
pub mod simd;
mod simulate;
pub mod split;
pub mod synthesis;
mod unfinished;

pub use algorithm::{Algorithm, Precision, UnknownAlgorithm};
pub use built::{apply_responses, simulate_built};
pub use calibration::{Calibration, calibrate};
pub use chirps::{ChirpSamples, simulate_chirps, simulate_chirps_for};
pub use echo::ArrayEcho;
pub use floor::Floor;
pub use interference::add_interference;
pub use plan::Plan;
pub use rows::Rows;
pub use run::beat_signal;
pub use samples::{BeatSignal, TwoEnds};
pub use simulate::{simulate, simulate_ends, simulate_ends_for, simulate_for};
pub use unfinished::Unfinished;
