//! Registration: interpolation of one end's picture on the polar grid around another place; ranges of a reflector differ by up to 27 bins.

use super::constants::cosine_scale;
use super::grid::cosine;
use crate::radar::Radar;
use std::ops::{Add, Mul};

/// The bilinear interpolation of each cell of a polar grid with this number of columns from another polar grid.
#[derive(Debug)]
pub(super) struct Registration<const COLUMNS: usize> {
    taps: Vec<Tap>,
}

#[derive(Debug, Clone, Copy)]
struct Tap {
    /// Index of the first of the four cells; the others are in the next column and the next row. Columns and rows wrap around.
    cell: u32,
    /// Distance from the first cell, rows and columns, in units of 1 / [`PARTS_PER_CELL`].
    part: [u16; 2],
}

const PARTS_PER_CELL: f32 = u16::MAX as f32;

impl<const COLUMNS: usize> Registration<COLUMNS> {
    /// The interpolation from the polar grid around x = `to` on that around x = `from`, metres. Empty columns beyond end-fire shift as end-fire.
    pub(super) fn new(radar: &Radar, from: f64, to: f64) -> Self {
        const { assert!(COLUMNS.is_power_of_two()) };
        let bin = radar.range_resolution_metres();
        let half = (COLUMNS / 2) as f64;
        let scale = cosine_scale(radar);
        let rows = radar.samples;
        let tap = |i: usize| {
            let (r, seen) = ((i / COLUMNS) as f64 * bin, cosine(i % COLUMNS, COLUMNS) * scale);
            let u = seen.clamp(-1.0, 1.0);
            let dx = r * u + from - to;
            let distance = (dx * dx + r * r * (1.0 - u * u)).sqrt();
            let cosine_there = if distance > 0.0 { dx / distance } else { 0.0 };
            let cosine_there = if u == seen { cosine_there } else { seen };
            let (row, column) = (distance / bin, cosine_there / scale * half + half);
            let (r0, c0) = (row.floor(), column.floor());
            let part = [row - r0, column - c0].map(|part| (part as f32 * PARTS_PER_CELL).round() as u16);
            Tap { cell: (r0 as usize % rows * COLUMNS + c0.rem_euclid(COLUMNS as f64) as usize) as u32, part }
        };
        Registration { taps: (0..rows * COLUMNS).map(tap).collect() }
    }

    /// Row `row`, interpolated from `plane` `[rows, COLUMNS]`.
    #[inline]
    pub(super) fn row<T>(&self, plane: &[T], row: usize) -> impl Iterator<Item = T>
    where
        T: Copy + Add<Output = T> + Mul<f32, Output = T>,
    {
        self.taps[row * COLUMNS..(row + 1) * COLUMNS].iter().map(|tap| {
            let first = tap.cell as usize;
            let next_column = (first & !(COLUMNS - 1)) | ((first + 1) & (COLUMNS - 1));
            let [down, right] = tap.part.map(|part| f32::from(part) * (1.0 / PARTS_PER_CELL));
            let within = |cell: usize| if cell < plane.len() { cell } else { cell - plane.len() };
            let line = |below: usize| {
                plane[within(first + below)] * (1.0 - right) + plane[within(next_column + below)] * right
            };
            line(0) * (1.0 - down) + line(COLUMNS) * down
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::grid::FINE_COLUMNS;
    use crate::radar::End;

    #[test]
    fn ranges_beyond_the_last_row_wrap_around() {
        let radar = Radar::default();
        let (rows, bin) = (radar.samples, radar.range_resolution_metres());
        let x = radar.end_centre_metres(End::First);
        let registration = Registration::<FINE_COLUMNS>::new(&radar, 0.0, x);
        let row_numbers: Vec<f32> = (0..rows * FINE_COLUMNS).map(|cell| (cell / FINE_COLUMNS) as f32).collect();
        let seen: Vec<f32> = registration.row(&row_numbers, rows - 1).collect();
        let r = (rows - 1) as f64 * bin;
        for (column, row) in seen.iter().enumerate().skip(FINE_COLUMNS / 2 + 1) {
            let u = cosine(column, FINE_COLUMNS);
            let bins = (r * r - 2.0 * r * u * x + x * x).sqrt() / bin;
            // The look-up between the last row and the first blends both.
            if bins > rows as f64 {
                let wrapped = bins - rows as f64;
                assert!((f64::from(*row) - wrapped).abs() < 1e-2, "column {column}: {wrapped} bins, {row}");
            }
        }
        assert!(seen[FINE_COLUMNS - 1] < 30.0, "end-fire is {} bins off", seen[FINE_COLUMNS - 1]);
    }
}
