//! The bare two-dimensional transform, the unit of every run time.

use crate::platform::Instant;
use crate::signal::simd::Simd;
use num_complex::Complex32;
use rustfft::Fft;
use std::sync::Arc;
use std::time::Duration;

const ROWS: usize = 512;
const COLUMNS: usize = 1024;
/// Side of the squares of the blocked transpose, cells.
const TILE: usize = 16;

/// A 512 x 1024 single-precision complex transform on one thread: rows, blocked transpose, columns. No window, no logarithm.
pub struct BareTransform {
    over_rows: Arc<dyn Fft<f32>>,
    over_columns: Arc<dyn Fft<f32>>,
    scratch: Vec<Complex32>,
    data: Vec<Complex32>,
    turned: Vec<Complex32>,
}

impl Default for BareTransform {
    fn default() -> Self {
        let (over_rows, over_columns) = (Simd::chosen().forward_fft(COLUMNS), Simd::chosen().forward_fft(ROWS));
        let scratch = over_rows.get_inplace_scratch_len().max(over_columns.get_inplace_scratch_len());
        BareTransform {
            over_rows,
            over_columns,
            scratch: vec![Complex32::default(); scratch],
            data: (0..ROWS * COLUMNS).map(|i| Complex32::new((i as f32).sin(), 0.5)).collect(),
            turned: vec![Complex32::default(); ROWS * COLUMNS],
        }
    }
}

impl BareTransform {
    pub fn run(&mut self) -> Duration {
        let start = Instant::now();
        self.over_rows.process_with_scratch(&mut self.data, &mut self.scratch);
        for row in (0..ROWS).step_by(TILE) {
            for column in (0..COLUMNS).step_by(TILE) {
                for r in row..row + TILE {
                    for c in column..column + TILE {
                        self.turned[c * ROWS + r] = self.data[r * COLUMNS + c];
                    }
                }
            }
        }
        self.over_columns.process_with_scratch(&mut self.turned, &mut self.scratch);
        let took = start.elapsed();
        // The factor keeps the values bounded over repeats.
        self.data.iter_mut().zip(&self.turned).for_each(|(d, t)| *d = t * 1e-3);
        took
    }
}
