//! Errors of reading a capture.

use crate::recording::numbers::MAX_NUMBERS;
use std::io;

/// An error of reading a capture.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// The system could not read.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The number of lanes is none that a radar has.
    #[error("recording.capture.lanes is {0}; expected 2 or 4")]
    Lanes(usize),
    /// The order of real and imaginary parts is given twice or not at all.
    #[error("recording.capture.{0}; expected one of lanes and parts")]
    Parts(&'static str),
    /// Samples of all receivers don't fill the lanes.
    #[error("{receivers} receivers of {samples} samples don't fill {lanes} lanes; expected a multiple")]
    Unfilled {
        /// Receivers.
        receivers: usize,
        /// Samples of a chirp.
        samples: usize,
        /// Lanes.
        lanes: usize,
    },
    /// Counts stand in the `.cfg` and in the text, or in neither.
    #[error("recording.capture.{key} {found}; expected {expected}")]
    Count {
        /// The key.
        key: &'static str,
        /// The value found, or that the key is missing.
        found: String,
        /// The values allowed.
        expected: &'static str,
    },
    /// The chirps are missing, or are none of the loop's.
    #[error(
        "recording.capture.chirps is {found}; expected some of 0 to {last}, each once: the chirps of a loop that form the line of elements, in order"
    )]
    Chirps {
        /// The value found.
        found: String,
        /// Last chirp of the loop.
        last: usize,
    },
    /// There is no such loop.
    #[error("recording.capture.loop is {asked}; expected 0 to {last}", last = loops - 1)]
    NoLoop {
        /// The loop asked for.
        asked: usize,
        /// Loops of a frame.
        loops: usize,
    },
    /// The file holds less than a loop.
    #[error(
        "has {bytes} bytes; expected at least {expected}: a loop has {chirps} chirps of {receivers} receivers and {samples} samples"
    )]
    Size {
        /// Size found.
        bytes: u64,
        /// Bytes of a loop.
        expected: u64,
        /// Chirps of a loop.
        chirps: usize,
        /// Receivers.
        receivers: usize,
        /// Samples of a chirp.
        samples: usize,
    },
    /// There is no such frame.
    #[error("recording.capture.frame is {asked}; expected 0 to {last}, the file holds {frames} frames", last = frames.saturating_sub(1))]
    NoFrame {
        /// The frame asked for.
        asked: usize,
        /// Whole frames of the file.
        frames: u64,
    },
    /// More numbers than are read.
    #[error("a loop holds more than {MAX_NUMBERS} numbers")]
    TooLarge,
}
