//! Layouts: samples from the bytes of a raw capture, and the choice of the right layout by evidence.
//!
//! | file | content |
//! |---|---|
//! | `shape` | a layout: encoding, orders of parts and of receivers; counts; bytes to samples of receivers |
//! | [`stream`] | bytes by seeking, without the headers of packets |
//! | `marks` | headers of chirps |
//! | `spectrum` | range profiles of the samples of a layout |
//! | `evidence` | log-odds of a layout, of several kinds |
//! | `find` | the candidates and the best of them |
//! | `breaks` | beginnings of rows, where linear prediction fails |
//! | `counts` | numbers of samples, receivers and chirps without a `.cfg` |
//! | `period` | the number of rows after which rows are the same again |
//! | `verdict` | certainty of the choice, and its reasons in sentences |

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

pub(super) use evidence::config_claims;
pub use evidence::{Evidence, EvidenceKind};
pub use find::{Candidate, Found, find};
pub use shape::{Counts, Layout, NumberEncoding, PartOrder, ReceiverOrder};
pub(in crate::recording) use spectrum::Spectrum;
pub use verdict::Certainty;
