//! Layouts: samples from the bytes of a raw capture, and the choice of the right layout by evidence.
//!
//! | file | content |
//! |---|---|
//! | `words` | 16 bits to a number |
//! | `parts` | orders of real and imaginary parts, and of receivers |
//! | `shape` | a layout, and counts |
//! | `decode` | bytes to samples of receivers |
//! | [`stream`] | bytes by seeking, without the headers of packets |
//! | `marks` | headers of chirps and of packets |
//! | `spectrum` | range profiles of the samples of a layout |
//! | `evidence` | log-odds of a layout, of several kinds |
//! | `find` | the candidates and the best of them |
//! | `breaks` | where samples don't follow from those before |
//! | `counts` | samples and receivers where no text says them |
//! | `period` | the number of rows after which rows are the same again |
//! | `verdict` | the reasons of the choice, in sentences |

mod breaks;
mod counts;
mod decode;
mod evidence;
mod find;
mod marks;
mod parts;
mod period;
mod shape;
mod spectrum;
pub mod stream;
#[cfg(test)]
mod tests;
mod verdict;
mod words;

pub(super) use evidence::said;
pub use evidence::{Evidence, Kind};
pub use find::{Candidate, Found, find};
pub use parts::{Parts, ReceiverOrder};
pub use shape::{Counts, Layout};
pub(in crate::recording) use spectrum::Spectrum;
pub use verdict::Certainty;
pub use words::Words;
