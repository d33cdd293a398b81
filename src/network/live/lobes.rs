//! The kernels of side lobes under each window, from a weight file.

use super::config::WIDE_COLUMNS;
use super::constants::WINDOW_COUNT;
use super::range_lobes::RangeLobes;
use super::reading::circulant;
use crate::network::kernels::convolution::PRODUCT_COLUMNS;
use crate::network::weights::{WeightFile, WeightsError};

/// The kernels of side lobes under one window.
#[derive(Debug)]
pub(super) struct WindowLobes {
    /// The kernel in range, along the columns.
    pub(super) columns: RangeLobes,
    /// The kernel in angle, along the rows, `[128 / 32, 128, 32]`.
    pub(super) rows: Vec<f32>,
}

impl WindowLobes {
    /// Side lobes by two kernels, decades for each circular distance: `[rows / 2 + 1]` in range, `[128 / 2 + 1]` in angle.
    fn new(column: &[f32], row: &[f32]) -> Self {
        WindowLobes { columns: RangeLobes::new(column), rows: in_blocks(&circulant(row, WIDE_COLUMNS), WIDE_COLUMNS) }
    }

    /// The kernels of a weight file: the Hann window's first, then those of the other windows where the file has them.
    pub(super) fn all(file: &WeightFile, rows: usize) -> Result<Vec<Self>, WeightsError> {
        let lengths = [rows / 2 + 1, WIDE_COLUMNS / 2 + 1];
        let mut all = vec![WindowLobes::new(
            &file.tensor("col_kernel", &lengths[..1])?,
            &file.tensor("row_kernel", &lengths[1..])?,
        )];
        if file.shape("col_kernels").is_some() {
            let others = |name: &str, length: usize| file.tensor(name, &[WINDOW_COUNT - 1, length]);
            let (columns, rows) = (others("col_kernels", lengths[0])?, others("row_kernels", lengths[1])?);
            let pairs = columns.chunks_exact(lengths[0]).zip(rows.chunks_exact(lengths[1]));
            all.extend(pairs.map(|(column, row)| WindowLobes::new(column, row)));
        }
        Ok(all)
    }
}

/// A matrix `[n, columns]` as blocks of columns, `[columns / 32, n, 32]`, for [`product`](crate::network::kernels::convolution::product).
fn in_blocks(matrix: &[f32], columns: usize) -> Vec<f32> {
    let of_block =
        |first: usize| matrix.chunks_exact(columns).flat_map(move |row| &row[first..first + PRODUCT_COLUMNS]);
    (0..columns).step_by(PRODUCT_COLUMNS).flat_map(of_block).copied().collect()
}
