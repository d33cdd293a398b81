//! A capture card that is listened to.

use crate::app::shared::Shared;
use crate::recording::Recording;
use std::path::PathBuf;

/// What a card is listened to with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardPlan {
    /// The UDP port of this machine.
    pub port: u16,
    /// The `.cfg` that set the radar up.
    pub config: PathBuf,
    /// The board whose antennas are taken; by default the one that the `.cfg` makes likely.
    pub board: Option<&'static str>,
}

/// A frame of a card as a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveFrame {
    /// What it holds.
    pub recording: Shared<Recording>,
    /// The `.cfg`.
    pub config: PathBuf,
    /// Whether it is the first since the listening began.
    pub is_first: bool,
}
