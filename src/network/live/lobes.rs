//! Side lobes under each window, by the kernels of a weight file.

use super::config::WIDE_COLUMNS;
use super::constants::WINDOWS;
use super::range_lobes::RangeLobes;
use super::reading::circulant;
use crate::network::kernels::convolution::PRODUCT_COLUMNS;
use crate::network::weights::{WeightFile, WeightsError};

#[derive(Debug)]
pub(super) struct WindowLobes {
    pub(super) columns: RangeLobes,
    /// `[128 / 32, 128, 32]`: the kernel in angle.
    pub(super) rows: Vec<f32>,
}

impl WindowLobes {
    /// The side lobes by two kernels in decades over the distance: `[rows / 2 + 1]` in range, `[128 / 2 + 1]` in angle.
    fn new(column: &[f32], row: &[f32]) -> Self {
        WindowLobes { columns: RangeLobes::new(column), rows: in_blocks(&circulant(row, WIDE_COLUMNS), WIDE_COLUMNS) }
    }

    /// The kernels of a weight file: Hann's first, then those of the other windows where the file has them.
    pub(super) fn all(file: &WeightFile, rows: usize) -> Result<Vec<Self>, WeightsError> {
        let lengths = [rows / 2 + 1, WIDE_COLUMNS / 2 + 1];
        let mut all = vec![WindowLobes::new(
            &file.tensor("col_kernel", &lengths[..1])?,
            &file.tensor("row_kernel", &lengths[1..])?,
        )];
        if file.shape("col_kernels").is_some() {
            let others = |name: &str, length: usize| file.tensor(name, &[WINDOWS - 1, length]);
            let (columns, rows) = (others("col_kernels", lengths[0])?, others("row_kernels", lengths[1])?);
            let pairs = columns.chunks_exact(lengths[0]).zip(rows.chunks_exact(lengths[1]));
            all.extend(pairs.map(|(column, row)| WindowLobes::new(column, row)));
        }
        Ok(all)
    }
}

/// A matrix `[n, columns]` in the layout of [`product`](crate::network::kernels::convolution::product), block after block.
fn in_blocks(matrix: &[f32], columns: usize) -> Vec<f32> {
    let of_block =
        |first: usize| matrix.chunks_exact(columns).flat_map(move |row| &row[first..first + PRODUCT_COLUMNS]);
    (0..columns).step_by(PRODUCT_COLUMNS).flat_map(of_block).copied().collect()
}
