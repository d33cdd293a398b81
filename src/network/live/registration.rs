//! What one end sees, gathered onto the polar grid that another place sees: the same reflector lies up to 27 range bins apart in the two.

use super::constants::cosine_scale;
use super::grid::cosine;
use crate::radar::Radar;
use std::ops::{Add, Mul};

/// For each cell of a polar grid of so many columns, where it lies on another: bilinear look-ups.
#[derive(Debug)]
pub(super) struct Registration<const COLUMNS: usize> {
    taps: Vec<Tap>,
}

#[derive(Debug, Clone, Copy)]
struct Tap {
    /// The first of the four; the others are beside it and below. Angles wrap around, and so do ranges beyond the last.
    cell: u32,
    /// How far it is to the next row and to the next column, in parts of [`WHOLE_PARTS`].
    part: [u16; 2],
}

const WHOLE_PARTS: f32 = u16::MAX as f32;

impl<const COLUMNS: usize> Registration<COLUMNS> {
    /// For each cell of the polar grid around x = `from`, where it lies on the polar grid around x = `to`; metres. Columns beyond end-fire, where no
    /// reflector is, lie as far off as end-fire does.
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
            let there = if distance > 0.0 { dx / distance } else { 0.0 };
            let there = if u == seen { there } else { seen };
            let (row, column) = (distance / bin, there / scale * half + half);
            let (r0, c0) = (row.floor(), column.floor());
            let part = [row - r0, column - c0].map(|part| (part as f32 * WHOLE_PARTS).round() as u16);
            Tap { cell: (r0 as usize % rows * COLUMNS + c0.rem_euclid(COLUMNS as f64) as usize) as u32, part }
        };
        Registration { taps: (0..rows * COLUMNS).map(tap).collect() }
    }

    /// What row `row` of the grid sees of `plane` `[rows, COLUMNS]`.
    #[inline]
    pub(super) fn row<T>(&self, plane: &[T], row: usize) -> impl Iterator<Item = T>
    where
        T: Copy + Add<Output = T> + Mul<f32, Output = T>,
    {
        self.taps[row * COLUMNS..(row + 1) * COLUMNS].iter().map(|tap| {
            let first = tap.cell as usize;
            let beside = (first & !(COLUMNS - 1)) | ((first + 1) & (COLUMNS - 1));
            let [down, right] = tap.part.map(|part| f32::from(part) * (1.0 / WHOLE_PARTS));
            let within = |cell: usize| if cell < plane.len() { cell } else { cell - plane.len() };
            let line =
                |below: usize| plane[within(first + below)] * (1.0 - right) + plane[within(beside + below)] * right;
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
        for column in FINE_COLUMNS / 2 + 1..FINE_COLUMNS {
            let u = cosine(column, FINE_COLUMNS);
            let bins = (r * r - 2.0 * r * u * x + x * x).sqrt() / bin;
            // Between the last row and the first the look-up blends both.
            if bins > rows as f64 {
                assert!(
                    (f64::from(seen[column]) - (bins - rows as f64)).abs() < 1e-2,
                    "column {column}: {} bins, {}",
                    bins,
                    seen[column]
                );
            }
        }
        assert!(seen[FINE_COLUMNS - 1] < 30.0, "end-fire is {} bins off", seen[FINE_COLUMNS - 1]);
    }
}
