//! The table `[recording.capture]`.

use crate::recording::axes::ChirpChoice;
use crate::recording::layout::{NumberEncoding, PartOrder, ReceiverOrder};
use serde::{Deserialize, Serialize};

/// The keys of the table: the layout of a capture, and the frame, loops, chirps and receivers that are read of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Name of the `.cfg`, beside the TOML; without it this table must have the counts.
    pub config: Option<String>,
    pub sub_frame: Option<usize>,
    /// Names of the files that continue the first, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub more_files: Vec<String>,
    /// Files of the other chips of a cascade, in the order of their receivers; each holds four receivers sample by sample, in pairs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chips: Vec<String>,
    #[serde(default, rename = "words")]
    pub encoding: NumberEncoding,
    #[serde(rename = "parts")]
    pub part_order: Option<PartOrder>,
    /// Lanes of the radar in place of `parts`: 2 (xWR16xx, 18xx, 68xx) or 4 (xWR12xx, 14xx).
    pub lanes: Option<usize>,
    #[serde(default)]
    pub q_first: bool,
    pub receivers: ReceiverOrder,
    #[serde(default)]
    pub header_bytes: usize,
    pub samples: Option<usize>,
    pub receiver_count: Option<usize>,
    pub loop_chirps: Option<usize>,
    pub loops: Option<usize>,
    /// Chirps of a loop that form the line of elements, in this order; all where there is only one.
    pub chirps: Option<Vec<usize>>,
    /// Receivers that form the line of elements, as indices among those that are on; all where the key is missing.
    pub receivers_taken: Option<Vec<usize>>,
    #[serde(default)]
    pub frame: usize,
    #[serde(default, rename = "loop")]
    pub loop_choice: ChirpChoice,
    /// Treatment of the mean of each chirp's samples: leakage and offset.
    #[serde(default)]
    pub constant: Treatment,
    /// Treatment of the mean of all loops: echoes that stand still.
    #[serde(default)]
    pub static_clutter: Treatment,
}

/// Whether a component of the samples is kept or subtracted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Treatment {
    #[default]
    Keep,
    Out,
}
