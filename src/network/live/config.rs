//! Sizes that every live network has.

use super::grid::{COARSE_CHANNELS, COARSE_COLUMNS, CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS};

/// Channels of the network's first convolution: fine features folded by 4, coarse, rows, scalars, four of the grid itself, and the
/// radar's constants.
pub const INPUT_CHANNELS: usize = FINE_CHANNELS * FOLD + COARSE_CHANNELS + ROW_CHANNELS + SCALARS + 4 + CONSTANTS;
pub(super) const FOLD: usize = FINE_COLUMNS / COARSE_COLUMNS;
/// Columns of the coarse head's side-lobe sources.
pub(super) const WIDE_COLUMNS: usize = 128;
pub(super) const DECODER_CHANNELS: usize = 8;
