//! Least-squares fits of places and gains of reflectors, or of rows of them, to the samples of both ends, by the exact near-field model.
//!
//! The search (`search`) and the coherent methods (`coherent`) use it; candidates and decisions are theirs.
//!
//! | file | content |
//! |---|---|
//! | `atom` | one reflector, or a row of them |
//! | `sensor` | geometry of both ends' channels |
//! | `echo` | phase, amplitude and derivatives of a reflector's echo at each channel |
//! | `echoes` | samples without echoes, and the echoes' products with them |
//! | `moments` | moments of the window, for inner products of two echoes |
//! | `gram` | the banded Gram matrix of atoms and their derivatives |
//! | `solver` | small systems that may be nearly singular |
//! | `refine` | Levenberg-Marquardt steps of places, gains projected out |
//! | `alone` | the fit of a single atom |
//! | `groups` | atoms that are neighbours in range |
//! | `range_gate` | a fit within the range bins around an atom |
//! | `profile` | energy of a residual over range |
//! | `work` | a budget of work, counted and not timed |

mod alone;
mod atom;
mod echo;
mod echoes;
mod gram;
mod groups;
mod moments;
mod profile;
mod range_gate;
mod refine;
mod sensor;
mod solver;
mod work;

pub use atom::Atom;
pub use echoes::Samples;
pub use groups::{BinSpans, bin_spans, distance_bins, groups};
pub use profile::{Profile, union_of};
pub use range_gate::{RangeGate, Spectra};
pub use refine::{Fit, Fitter, Gains, Limits, Tie};
pub use solver::damped_step;
