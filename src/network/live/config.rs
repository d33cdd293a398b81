//! The size of the live network, shared by its weight file and its engine.

use super::grid::{COARSE_CHANNELS, COARSE_COLUMNS, CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS};

/// Channels of the network's first convolution: fine features folded by 4, coarse, rows, scalars, four of the grid itself, and the
/// radar's constants.
pub const INPUT_CHANNELS: usize = FINE_CHANNELS * FOLD + COARSE_CHANNELS + ROW_CHANNELS + SCALARS + 4 + CONSTANTS;
pub(super) const FOLD: usize = FINE_COLUMNS / COARSE_COLUMNS;
/// Columns of the coarse head's side-lobe sources.
pub(super) const WIDE_COLUMNS: usize = 128;
pub(super) const DECODER_CHANNELS: usize = 8;

/// Channels and residual blocks of each level.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LiveConfig {
    /// Channels of the four levels, finest first.
    pub channels: [usize; 4],
    /// Residual blocks of the four levels; the encoder has half as many (rounded up) at the middle two.
    pub blocks: [usize; 4],
    /// Channels of the fine convolution.
    pub fine: usize,
}

impl Default for LiveConfig {
    fn default() -> Self {
        LiveConfig { channels: [16, 32, 64, 96], blocks: [1, 2, 2, 3], fine: 16 }
    }
}
