//! Least squares on the samples of both ends: places and gains of reflectors or lines of them, by the exact near-field model.
//!
//! The search (`search`) and the coherent methods (`coherent`) fit with it. It proposes nothing and judges nothing.
//!
//! | file | content |
//! |---|---|
//! | `atom` | the dictionary: one reflector, or a line of them |
//! | `sensor` | geometry of both ends |
//! | `echo` | one reflector's echo at each channel |
//! | `echoes` | sums of reflectors' echoes in the samples, and their products with a residual |
//! | `moments` | inner products of two echoes: moments of the window |
//! | `gram` | the banded Gram matrix of atoms and their derivatives |
//! | `solver` | small systems that may be nearly singular |
//! | `refine` | Levenberg-Marquardt on positions, gains projected out |
//! | `alone` | one atom by itself |
//! | `groups` | atoms that are neighbours in range |
//! | `range_gate` | a fit within the range bins around an atom |
//! | `profile` | unexplained energy over range |
//! | `work` | a bound on work, counted and not timed |

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
