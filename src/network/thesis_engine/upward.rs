//! The way up: transposed 4x4 convolutions of stride 2, each with ReLU.
//!
//! The output's cell `Y` depends on the input's cells `i` with `Y = 2 i - 1 + k` for the kernel's rows `k` from 0 to 3. So an even one depends
//! on two rows of the input, through the kernel's rows 3 and 1, and an odd one on two rows through 2 and 0; likewise for columns.

use super::layers::ThesisLayers;
use super::pictures::Bordered;
use crate::network::kernels::convolution::{Packed, padded};
use crate::network::kernels::vector::{Loop, VECTOR_LANES, Vector, run};
use crate::network::weights::WeightsError;
use crate::signal::simd::Simd;
use rayon::prelude::*;

const SIZE: usize = 4;
/// Rows of the kernel for the two input rows of an even output row, and of an odd one.
const ROWS: [[usize; 2]; 2] = [[3, 1], [2, 0]];
const _: () = assert!(SIZE * SIZE == VECTOR_LANES, "the last kernel's products of a cell are one vector");

#[derive(Debug)]
pub(super) struct UpwardLevel {
    parts: [[Packed; 2]; 2],
}

impl UpwardLevel {
    pub(super) fn new(
        layers: ThesisLayers<'_>,
        level: usize,
        [input, output]: [usize; 2],
    ) -> Result<UpwardLevel, WeightsError> {
        let [weights, bias] = layers.conv(&format!("up.upconv.{level}"), [input, output, SIZE, SIZE], 1)?;
        let part = |rows: [usize; 2], columns: [usize; 2]| {
            let weight = |o: usize, i: usize| {
                let kernel = &weights[(i * output + o) * SIZE * SIZE..];
                rows.into_iter().flat_map(move |row| columns.map(|column| kernel[row * SIZE + column]))
            };
            let taps: Vec<f32> = (0..output).flat_map(|o| (0..input).flat_map(move |i| weight(o, i))).collect();
            Packed::new(&taps, &bias, [input, padded(input)], [2, 2], 1)
        };
        Ok(UpwardLevel { parts: ROWS.map(|rows| ROWS.map(|columns| part(rows, columns))) })
    }

    pub(super) fn output(&self) -> usize {
        self.parts[0][0].output()
    }

    pub(super) fn forward(&self, from: &Bordered, to: &mut Bordered) {
        to.reset(2 * from.h, 2 * from.w, self.output());
        let simd = Simd::chosen();
        to.fill(|y, line, _| self.line(simd, from, y, line));
    }

    /// Row `y` of the output, `[2 w, output]`.
    fn line(&self, simd: Simd, from: &Bordered, y: usize, out: &mut [f32]) {
        let output = self.output();
        for (odd, part) in self.parts[y % 2].iter().enumerate() {
            // The output's even and odd cells are the halves of cells that are twice as wide.
            let seen = from.seen(y / 2 + y % 2, odd);
            part.line_beside(simd, seen, from.row_cells(), from.w, [2 * output, odd * output], out);
        }
        run(simd, Rectify(out));
    }
}

struct Rectify<'a>(&'a mut [f32]);

impl Loop for Rectify<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        // SAFETY: a vector stays inside its chunk; the caller promises the features.
        unsafe {
            let zero = V::load([0.0; VECTOR_LANES].as_ptr());
            for vector in self.0.as_chunks_mut::<VECTOR_LANES>().0 {
                V::load(vector.as_ptr()).larger(zero).store(vector.as_mut_ptr());
            }
        }
    }
}

/// The last level, whose output has one channel. A kernel that fills vectors with output channels would leave most of them empty. So each cell
/// of the input is multiplied with all sixteen taps of the kernel first, and a cell of the output adds up four of these products.
#[derive(Debug)]
pub(super) struct Last {
    products: Packed,
    bias: f32,
}

impl Last {
    pub(super) fn new(layers: ThesisLayers<'_>, level: usize, input: usize) -> Result<Last, WeightsError> {
        let [weights, bias] = layers.conv(&format!("up.upconv.{level}"), [input, 1, SIZE, SIZE], 1)?;
        let taps: Vec<f32> =
            (0..VECTOR_LANES).flat_map(|tap| weights.iter().skip(tap).step_by(VECTOR_LANES)).copied().collect();
        let products = Packed::new(&taps, &[0.0; VECTOR_LANES], [input, padded(input)], [1, 1], 1);
        Ok(Last { products, bias: bias.iter().sum() })
    }

    pub(super) fn multiply(&self, before: Option<&UpwardLevel>, from: &Bordered, products: &mut Bordered) {
        let simd = Simd::chosen();
        let twice = if before.is_some() { 2 } else { 1 };
        products.reset(twice * from.h, twice * from.w, VECTOR_LANES);
        let width = products.w;
        products.fill(|y, line, buffer| match before {
            Some(stage) => {
                buffer.resize(width * stage.output(), 0.0);
                stage.line(simd, from, y, buffer);
                self.products.line(simd, buffer, width, width, line);
            }
            None => self.products.line(simd, from.row(y), width, width, line),
        });
    }

    pub(super) fn add_up(&self, products: &Bordered) -> Vec<f32> {
        let mut map = vec![0.0; 4 * products.h * products.w];
        map.par_chunks_mut(2 * products.w).enumerate().for_each(|(y, line)| {
            let lines = [0, 1].map(|below| products.seen(y / 2 + y % 2 + below, 0).as_chunks::<VECTOR_LANES>().0);
            let rows = ROWS[y % 2].map(|row| row * SIZE);
            for (x, cells) in line.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                for (odd, cell) in cells.iter_mut().enumerate() {
                    let of_row = |below: usize| {
                        let [left, right] = ROWS[odd].map(|column| rows[below] + column);
                        lines[below][x + odd][left] + lines[below][x + odd + 1][right]
                    };
                    let sum = self.bias + (of_row(0) + of_row(1));
                    *cell = if sum > 0.0 { sum } else { 0.0 };
                }
            }
        });
        map
    }
}
