//! The table `[recording.capture]`.

use crate::recording::axes::Chirp;
use crate::recording::layout::{Parts, ReceiverOrder, Words};
use serde::Deserialize;

/// How a capture is laid out, and which part of it is looked at.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Name of the `.cfg`, beside the TOML; without one the counts are said here.
    pub config: Option<String>,
    /// Which sub-frame of an advanced frame, from 0.
    pub sub_frame: Option<usize>,
    /// Files that go on from the first, in order.
    #[serde(default)]
    pub more_files: Vec<String>,
    /// Files of the other chips of a cascade, in the order of their receivers; each holds four receivers sample by sample, in pairs.
    #[serde(default)]
    pub chips: Vec<String>,
    /// 16 bits to a number.
    #[serde(default)]
    pub words: Words,
    /// Order of real and imaginary parts.
    pub parts: Option<Parts>,
    /// Lanes of the radar in place of `parts`: 2 (xWR16xx, 18xx, 68xx) or 4 (xWR12xx, 14xx).
    pub lanes: Option<usize>,
    /// Imaginary parts come first.
    #[serde(default)]
    pub q_first: bool,
    /// How the receivers follow one another.
    pub receivers: ReceiverOrder,
    /// Bytes before each chirp that are no samples.
    #[serde(default)]
    pub header_bytes: usize,
    /// Without a `.cfg`: samples of a chirp.
    pub samples: Option<usize>,
    /// Without a `.cfg`: receivers.
    pub receiver_count: Option<usize>,
    /// Without a `.cfg`: chirps of a loop, 1 where nothing is said.
    pub loop_chirps: Option<usize>,
    /// Without a `.cfg`: loops of a frame, 1 where nothing is said.
    pub loops: Option<usize>,
    /// Which chirps of a loop form the line of elements, in this order; all where there is only one.
    pub chirps: Option<Vec<usize>>,
    /// Which receivers form it, by place among those that are on; all where nothing is said.
    pub receivers_taken: Option<Vec<usize>>,
    /// Which frame, from 0.
    #[serde(default)]
    pub frame: usize,
    /// Which loop of the frame, or how all of them are joined.
    #[serde(default, rename = "loop")]
    pub turn: Chirp,
    /// The mean of each chirp's samples: leakage and offset.
    #[serde(default)]
    pub constant: Part,
    /// The mean of all loops: what stands still.
    #[serde(default)]
    pub static_clutter: Part,
}

/// Whether a part of the samples stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// It stays.
    #[default]
    Keep,
    /// It is taken out.
    Out,
}
