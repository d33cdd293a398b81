//! Plan and frames of listening to a capture card.

use crate::app::shared::Shared;
use crate::recording::Recording;
use std::path::PathBuf;

/// Port, settings and board for listening to a capture card.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardPlan {
    pub port: u16,
    /// The `.cfg` that set the radar up.
    pub config: PathBuf,
    /// The board with the antennas; by default the one that the `.cfg` makes likely.
    pub board: Option<&'static str>,
}

/// A frame of a card as a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveFrame {
    pub recording: Shared<Recording>,
    pub config: PathBuf,
    pub is_first: bool,
}
