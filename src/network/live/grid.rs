//! Sizes of the live network's input and output.

/// Samples of a chirp of the shipped network's radars, and range rows of its tensors.
pub const ROWS: usize = 512;
/// Columns of the network's map for any radar, and elements of the shipped network's radars.
pub const COLUMNS: usize = 1024;
/// Columns of the fine features.
pub const FINE_COLUMNS: usize = 256;
/// Columns of the coarse features.
pub const COARSE_COLUMNS: usize = 64;
/// Channels of the fine features.
pub const FINE_CHANNELS: usize = 4;
/// Channels of the coarse features.
pub const COARSE_CHANNELS: usize = 10;
/// Channels of the row features.
pub const ROW_CHANNELS: usize = 6;
/// Scalar features.
pub const SCALARS: usize = 2;
/// Constants of the radar among the features.
pub const CONSTANTS: usize = 6;

/// Elements of an end of the shipped network's radars.
pub(super) const END_ELEMENTS: usize = 12;
/// Least number of rows of a parallel task.
pub(super) const MIN_ROWS: usize = 32;

/// cos(theta) of column `k` of a grid of `columns`.
pub(super) fn cosine(k: usize, columns: usize) -> f64 {
    let half = (columns / 2) as f64;
    (k as f64 - half) / half
}
