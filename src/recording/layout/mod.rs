//! How the bytes of a raw capture stand for samples, and which of many ways is the right one, by evidence.
//!
//! | file | what it is |
//! |---|---|
//! | `words` | 16 bits to a number |
//! | `parts` | numbers to complex samples of receivers |
//! | [`stream`] | bytes by seeking, without the headers of packets |
//! | `marks` | headers of chirps and of packets |
//! | `spectrum` | what a layout makes of the bytes: range profiles |
//! | `evidence` | log-odds of a layout, of several kinds |
//! | `find` | the candidates and the best of them |
//! | `counts` | samples and receivers where no text says them |
//! | `verdict` | why, in sentences |

mod counts;
mod evidence;
mod find;
mod marks;
mod parts;
mod spectrum;
pub mod stream;
#[cfg(test)]
mod tests;
mod verdict;
mod words;

pub use evidence::{Evidence, Kind};
pub use find::{Candidate, Found, LayoutError, find};
pub use parts::{Parts, ReceiverOrder};
pub use verdict::Certainty;
pub use words::Words;

use ndarray::Array2;
use num_complex::Complex64;

/// How the bytes of a chirp stand for samples of its receivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Layout {
    /// 16 bits to a number.
    pub words: Words,
    /// Order of real and imaginary parts.
    pub parts: Parts,
    /// Imaginary parts come first.
    pub q_first: bool,
    /// Order of the receivers.
    pub receivers: ReceiverOrder,
    /// Bytes before each chirp that are no samples.
    pub header_bytes: usize,
    /// Whether the file holds network packets, each of [`stream::PACKET_BYTES`].
    pub packets: bool,
}

/// How many of each a capture holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Counts {
    /// Samples of a chirp, as the converter takes them.
    pub samples: usize,
    /// Receivers.
    pub receivers: usize,
    /// Chirps of a loop.
    pub chirps: usize,
    /// Loops of a frame.
    pub loops: usize,
}

impl Layout {
    /// Bytes of one chirp of all receivers, with its header.
    pub fn chirp_bytes(&self, samples: usize, receivers: usize) -> usize {
        self.header_bytes + samples * receivers * self.parts.bytes()
    }

    /// The samples of one chirp, `[receivers, samples]`: real ones where the parts are real. `bytes` begin behind the header; what they
    /// lack is zero.
    pub(crate) fn decode(&self, bytes: &[u8], samples: usize, receivers: usize) -> Array2<Complex64> {
        let numbers = parts::numbers(self, bytes, samples * receivers);
        parts::rows(self.receivers, &numbers, samples, receivers)
    }
}
