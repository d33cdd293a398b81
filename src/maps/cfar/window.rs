//! The window around a cell, and sums or counts of its training cells for every cell of a map.
//!
//! There are no differences of sums, as in a summed-area table: a map may span 30 decades of power, but a double has 16 digits.

use ndarray::{Array2, ArrayView2, Axis, Zip};
use std::ops::Range;

/// Cells a side, `[range bins, columns]`.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    guard: [usize; 2],
    /// Guard and training cells.
    reach: [usize; 2],
}

impl Window {
    pub fn new(guard: [usize; 2], training: [usize; 2]) -> Window {
        let reach = [0, 1].map(|axis| guard[axis] + training[axis]);
        Window { guard, reach }
    }

    fn rows(bin: usize, side: usize, bins: usize) -> Range<usize> {
        bin.saturating_sub(side)..(bin + side + 1).min(bins)
    }

    pub fn cells(&self, bin: usize, bins: usize) -> usize {
        let [all, guarded] = [self.reach[0], self.guard[0]].map(|side| Self::rows(bin, side, bins).len());
        (all - guarded) * (2 * self.reach[1] + 1) + guarded * 2 * (self.reach[1] - self.guard[1])
    }

    /// The rows of training cells, each with whether it also has guard cells.
    fn training_rows(&self, bin: usize, bins: usize) -> impl Iterator<Item = (usize, bool)> + use<> {
        let guarded = Self::rows(bin, self.guard[0], bins);
        Self::rows(bin, self.reach[0], bins).map(move |row| (row, guarded.contains(&row)))
    }

    /// Indices of the training columns in the window.
    fn shifts(&self, is_guarded: bool) -> impl Iterator<Item = usize> + use<> {
        let [guard, reach] = [self.guard[1], self.reach[1]];
        (0..=2 * reach).filter(move |shift| !is_guarded || shift.abs_diff(reach) > guard)
    }

    /// The training cells around a cell of a map of `[range bins, columns]`.
    pub fn around(self, [bin, column]: [usize; 2], [bins, columns]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
        let left = column + columns - self.reach[1];
        self.training_rows(bin, bins).flat_map(move |(row, is_guarded)| {
            self.shifts(is_guarded).map(move |shift| [row, (left + shift) % columns])
        })
    }

    /// The rows, circularly padded by the window's reach at both ends.
    fn wrapped(&self, power: ArrayView2<'_, f64>) -> Array2<f64> {
        let (bins, columns) = power.dim();
        let first = columns - self.reach[1];
        Array2::from_shape_fn((bins, columns + 2 * self.reach[1]), |(row, i)| power[[row, (first + i) % columns]])
    }

    /// Whether each cell exceeds the sum of its training cells times a factor of its range bin.
    pub fn above_sum(&self, power: ArrayView2<'_, f64>, factor: impl Fn(usize) -> f64 + Sync) -> Array2<bool> {
        let (bins, columns) = power.dim();
        let wrapped = self.wrapped(power);
        let along = |is_guarded: bool| {
            let mut sums = Array2::<f64>::zeros((bins, columns));
            Zip::from(sums.rows_mut()).and(wrapped.rows()).par_for_each(|mut sums, row| {
                let (Some(sums), Some(row)) = (sums.as_slice_mut(), row.as_slice()) else { return };
                for shift in self.shifts(is_guarded) {
                    sums.iter_mut().zip(&row[shift..]).for_each(|(sum, cell)| *sum += cell);
                }
            });
            sums
        };
        // Sums over the columns of a row, with and without the guarded columns.
        let [whole, unguarded] = [along(false), along(true)];
        self.for_each_bin(power, |bin, row, above| {
            let mut sums = vec![0.0f64; columns];
            for (other, is_guarded) in self.training_rows(bin, bins) {
                let part = if is_guarded { unguarded.row(other) } else { whole.row(other) };
                sums.iter_mut().zip(part).for_each(|(sum, cell)| *sum += cell);
            }
            let factor = factor(bin);
            above.iter_mut().zip(row).zip(&sums).for_each(|((above, cell), sum)| *above = *cell > factor * sum);
        })
    }

    /// Whether each cell exceeds a factor times its training cell of a rank, from 1; rank and factor by range bin.
    pub fn above_rank(&self, power: ArrayView2<'_, f64>, of: impl Fn(usize) -> (usize, f64) + Sync) -> Array2<bool> {
        let (bins, columns) = power.dim();
        let wrapped = self.wrapped(power);
        self.for_each_bin(power, |bin, row, above| {
            let (rank, factor) = of(bin);
            let limits: Vec<f64> = row.iter().map(|cell| cell / factor).collect();
            let mut counts = vec![0u32; columns];
            for (other, is_guarded) in self.training_rows(bin, bins) {
                let other = wrapped.row(other);
                let Some(other) = other.as_slice() else { return };
                for shift in self.shifts(is_guarded) {
                    let pairs = counts.iter_mut().zip(&limits).zip(&other[shift..]);
                    pairs.for_each(|((count, limit), cell)| *count += u32::from(cell < limit));
                }
            }
            above.iter_mut().zip(counts).for_each(|(above, count)| *above = count as usize >= rank);
        })
    }

    fn for_each_bin(
        &self,
        power: ArrayView2<'_, f64>,
        work: impl Fn(usize, ndarray::ArrayView1<'_, f64>, &mut [bool]) + Sync + Send,
    ) -> Array2<bool> {
        let mut mask = Array2::from_elem(power.dim(), false);
        Zip::indexed(mask.axis_iter_mut(Axis(0))).and(power.rows()).par_for_each(|bin, mut mask, row| {
            if let Some(mask) = mask.as_slice_mut() {
                work(bin, row, mask);
            }
        });
        mask
    }
}
