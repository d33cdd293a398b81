//! From echoes to the sampled beat signal of every element (thesis equation 3.3).
//!
//! | file | what it is | use it for |
//! |---|---|---|
//! | [`direct`] | the formula as written, in f64 | the thesis' own numbers, rounding floor included |
//! | [`exact`] | the same with phases reduced to turns first | accuracy to the last bits of f64 |
//! | [`split`] | products of 16 + 32 phasors, one lane an element | few reflectors, or full precision |
//! | [`gridded`] | reflectors spread on a range grid, then transformed | many reflectors |
//! | [`closed_form`] | range profiles from three Dirichlet kernels, on rows above the tolerance | one or few reflectors, loose tolerances |
//! | [`judge`] | equation 3.3 in double-double | the reference of all others |
//!
//! [`Sources`](crate::scattering::Sources) are the scatterers: points, and bodies with their shadows.
//!
//! * [`path`] (range and amplitude of an echo at a pair of antennas) and [`phase`] are the forward model of every simulation, fit and bound.
//! * A [`SynthesisPlan`] has algorithm and precision; [`beat_signal`] runs one, [`synthesis`] the block algorithms over the array.
//! * [`simulate`] goes from a scene to samples over a [`floor`]: the thesis' rounding noise, none, or thermal noise.
//! * [`built`] adds element errors and interference; [`calibration`] estimates gains and phases; [`chirps`] has moving objects.
//! * [`echo`] is one reflector's echo as a value, the dictionary atom of sparse methods.

mod algorithm;
mod block_echoes;
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
pub mod judge;
pub mod lane_fft;
pub mod path;
pub mod phase;
pub mod plan;
pub mod rows;
mod run;
mod samples;
pub mod simd;
mod simulate;
mod simulation_error;
pub mod split;
pub mod synthesis;

pub use algorithm::{Algorithm, Precision};
pub use built::{add_interference, apply_responses, simulate_built};
pub use calibration::{Calibration, calibrate};
pub use chirps::{ChirpSamples, simulate_chirps_for};
pub use echo::ArrayEcho;
pub use floor::Floor;
pub use plan::SynthesisPlan;
pub use rows::Rows;
pub use run::beat_signal;
pub use samples::{BeatSignal, LayoutSamples, TwoEnds};
pub use simulate::{simulate, simulate_ends_for, simulate_for};
pub use simulation_error::{SimulationError, SimulationResult};
