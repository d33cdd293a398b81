//! Layouts and counts of a capture.

use super::parts::{Parts, ReceiverOrder};
use super::words::Words;

/// The layout of a chirp's bytes as samples of its receivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Layout {
    /// Encoding of numbers in 16 bits.
    pub words: Words,
    /// Order of real and imaginary parts.
    pub parts: Parts,
    /// Imaginary parts come first.
    pub q_first: bool,
    /// Order of the receivers.
    pub receivers: ReceiverOrder,
    /// Bytes before each chirp that are no samples.
    pub header_bytes: usize,
    /// Whether the file holds network packets, each of [`PACKET_BYTES`](super::stream::PACKET_BYTES).
    pub packets: bool,
}

/// Counts of samples, receivers, chirps and loops of a capture.
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
}
