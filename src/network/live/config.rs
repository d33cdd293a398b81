//! Sizes that are the same in every live network.

use super::grid::{COARSE_CHANNELS, COARSE_COLUMNS, CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS};

/// Input channels of the first convolution: fine features of [`FOLD`] columns, coarse features, rows, scalars, four of the grid, constants.
pub const INPUT_CHANNELS: usize = FINE_CHANNELS * FOLD + COARSE_CHANNELS + ROW_CHANNELS + SCALARS + 4 + CONSTANTS;
/// Fine columns in a coarse one.
pub(super) const FOLD: usize = FINE_COLUMNS / COARSE_COLUMNS;
/// Columns of the sources of side lobes in angle.
pub(super) const WIDE_COLUMNS: usize = 128;
/// Channels of the decoder's output on the fine grid.
pub(super) const DECODER_CHANNELS: usize = 8;
