//! Layouts: samples from the bytes of a raw capture, and the choice of the right layout by evidence.
//!
//! | file | content |
//! |---|---|
//! | `shape` | a layout: encoding, orders of parts and of receivers; counts; bytes to samples of receivers |
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
mod evidence;
mod find;
mod marks;
mod period;
mod shape;
mod spectrum;
pub mod stream;
#[cfg(test)]
mod tests;
mod verdict;

pub(super) use evidence::said;
pub use evidence::{Evidence, Kind};
pub use find::{Candidate, Found, find};
pub use shape::{Counts, Layout, Parts, ReceiverOrder, Words};
pub(in crate::recording) use spectrum::Spectrum;
pub use verdict::Certainty;
