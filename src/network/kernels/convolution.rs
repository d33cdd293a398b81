//! The kernel of the networks: a direct convolution of channels-last tensors, vectorised over output channels.
//!
//! The loop is written once over [`Vector`] and compiled for AVX-512, for AVX2 with FMA, and without either. [`Simd::chosen`] selects the one that runs.

use super::vector::{Loop, VECTOR_LANES, Vector, run};
use crate::signal::simd::Simd;
use rayon::prelude::*;
use std::ops::Range;

/// Channels rounded up to whole vectors.
pub const fn padded(channels: usize) -> usize {
    channels.div_ceil(VECTOR_LANES) * VECTOR_LANES
}

/// Weights in the order of the kernel's loop: by blocks of one or two vectors of output channels, kernel row, kernel column and input channel.
#[derive(Debug, Clone)]
pub struct Packed {
    kernel: [usize; 2],
    stride: usize,
    input: usize,
    output: usize,
    weights: Vec<f32>,
    bias: Vec<f32>,
}

impl Packed {
    /// Packs weights `[output, input, rows, columns]` (PyTorch's order) of a kernel of `[rows, columns]`, and `bias` `[output]`. Cells have
    /// `input_stride` channels, of which the last `input_stride - input` are multiplied by zeros.
    pub fn new(
        weights: &[f32],
        bias: &[f32],
        [input, input_stride]: [usize; 2],
        kernel: [usize; 2],
        stride: usize,
    ) -> Self {
        let area = kernel[0] * kernel[1];
        let output = bias.len();
        assert_eq!(weights.len(), output * input * area, "weights and bias disagree");
        let lanes = padded(output);
        let mut packed = Vec::with_capacity(lanes * input_stride * area);
        for (start, width) in blocks(lanes) {
            for tap in 0..area {
                for i in 0..input_stride {
                    packed
                        .extend((start..start + width).map(|o| {
                            if o < output && i < input { weights[(o * input + i) * area + tap] } else { 0.0 }
                        }));
                }
            }
        }
        let mut all_bias = bias.to_vec();
        all_bias.resize(lanes, 0.0);
        Packed { kernel, stride, input: input_stride, output: lanes, weights: packed, bias: all_bias }
    }

    /// Output channels, padded to whole vectors.
    pub fn output(&self) -> usize {
        self.output
    }

    /// Convolves one line of `width` output cells on this thread. `input` begins with the line's receptive field, and has rows of `row_cells` cells.
    pub fn line(&self, simd: Simd, input: &[f32], row_cells: usize, width: usize, out: &mut [f32]) {
        self.line_beside(simd, input, row_cells, width, [self.output, 0], out);
    }

    /// As [`Packed::line`], into cells of `channels` channels, from channel `first` on. Other channels of `out` are unchanged.
    pub fn line_beside(
        &self,
        simd: Simd,
        input: &[f32],
        row_cells: usize,
        width: usize,
        [channels, first]: [usize; 2],
        out: &mut [f32],
    ) {
        let [rows, columns] = self.kernel;
        // In a row of the input, the channels of a kernel's columns are contiguous.
        let count = columns * self.input;
        let runs: Vec<Run> =
            (0..rows).map(|ky| Run { value: ky * row_cells * self.input, row: ky * count, count }).collect();
        let job = LineJob { input, step: self.stride * self.input, runs: &runs, width };
        let mut at = 0;
        for (start, lanes) in blocks(self.output) {
            let size = rows * count * lanes;
            let (weights, bias) = (&self.weights[at..at + size], &self.bias[start..start + lanes]);
            dispatch(simd, &job, Block { weights, bias, start: first + start, lanes: channels }, out);
            at += size;
        }
    }
}

/// Columns of a [`product`].
pub const PRODUCT_COLUMNS: usize = 2 * VECTOR_LANES;

/// The matrix product `out` `[rows, 32]` of `left` `[rows, inner]` and `right` `[inner, 32]`, on this thread, over the inner indices in `runs`.
pub fn product(simd: Simd, left: &[f32], right: &[f32], runs: impl Iterator<Item = Range<usize>>, out: &mut [f32]) {
    let (inner, width) = (right.len() / PRODUCT_COLUMNS, out.len() / PRODUCT_COLUMNS);
    assert!(left.len() == width * inner, "matrices disagree");
    // Rows are the cells of a line to the kernel, which loads each value of `right` once for several of them.
    let runs: Vec<Run> = runs.map(|run| Run { value: run.start, row: run.start, count: run.len() }).collect();
    let job = LineJob { input: left, step: inner, runs: &runs, width };
    dispatch(
        simd,
        &job,
        Block { weights: right, bias: &[0.0; PRODUCT_COLUMNS], start: 0, lanes: PRODUCT_COLUMNS },
        out,
    );
}

/// Convolves `input`, with rows of `row_cells` cells, into `out` `[height, width, output]`, in parallel.
pub fn convolve(weights: &Packed, input: &[f32], row_cells: usize, width: usize, out: &mut [f32]) {
    convolve_with(Simd::chosen(), weights, input, row_cells, width, out);
}

fn convolve_with(simd: Simd, weights: &Packed, input: &[f32], row_cells: usize, width: usize, out: &mut [f32]) {
    let line = width * weights.output;
    out.par_chunks_mut(line).enumerate().for_each(|(y, out)| {
        weights.line(simd, &input[y * weights.stride * row_cells * weights.input..], row_cells, width, out);
    });
}

fn blocks(lanes: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..lanes).step_by(2 * VECTOR_LANES).map(move |start| (start, (lanes - start).min(2 * VECTOR_LANES)))
}

#[derive(Clone, Copy)]
struct LineJob<'a> {
    input: &'a [f32],
    /// Distance in `input` between the first values of two neighbouring output cells.
    step: usize,
    runs: &'a [Run],
    width: usize,
}

/// Contiguous values of the input, and the rows of weights that they are multiplied by.
struct Run {
    /// Index of the first value, for the line's first cell.
    value: usize,
    /// Index of the first row of weights.
    row: usize,
    count: usize,
}

/// A block of output channels: its weights, its first channel, and the number of channels of an output cell.
#[derive(Clone, Copy)]
struct Block<'a> {
    weights: &'a [f32],
    bias: &'a [f32],
    start: usize,
    lanes: usize,
}

struct Line<'a, 'b> {
    job: &'a LineJob<'b>,
    block: Block<'a>,
    out: &'a mut [f32],
}

impl Loop for Line<'_, '_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let Line { job, block, out } = self;
        // SAFETY: `dispatch` checked the slices; the caller promises the features.
        unsafe {
            match V::TILE {
                [8, 2] => line::<V, 8, 2>(job, block, out),
                [6, 1] => line::<V, 6, 1>(job, block, out),
                _ => line::<V, 2, 1>(job, block, out),
            }
        }
    }
}

fn dispatch(simd: Simd, job: &LineJob, block: Block, out: &mut [f32]) {
    job.check(&block, out);
    run(simd, Line { job, block, out });
}

impl LineJob<'_> {
    /// Checks the lengths and offsets that the unchecked loops rely on.
    fn check(&self, block: &Block, out: &[f32]) {
        let lanes = block.bias.len();
        assert!(lanes == VECTOR_LANES || lanes == 2 * VECTOR_LANES, "a block is one or two vectors");
        for Run { value, row, count } in self.runs {
            let last = (self.width - 1) * self.step + value + count;
            assert!(self.width > 0 && self.input.len() >= last, "the input ends inside the line");
            assert!(block.weights.len() >= (row + count) * lanes, "too few weights");
        }
        assert!(block.start + lanes <= block.lanes && out.len() >= self.width * block.lanes, "the output is too short");
    }
}

/// Computes a line in tiles of `CELLS` cells times `VECTORS` vectors, [`Vector::TILE`].
/// # Safety
/// [`LineJob::check`] must have passed, and the CPU must have the vector's features.
#[inline(always)]
unsafe fn line<V: Vector, const CELLS: usize, const VECTORS: usize>(job: &LineJob, block: Block, out: &mut [f32]) {
    let vectors = block.bias.len() / VECTOR_LANES;
    let whole = job.width >= CELLS;
    let cells = if whole { CELLS } else { 1 };
    for x in (0..job.width).step_by(cells) {
        // The last tile overlaps the one before it where tiles don't divide the line.
        let x = x.min(job.width - cells);
        let mut first = 0;
        while first < vectors {
            let is_full = vectors - first >= VECTORS;
            // SAFETY: the caller checked the slices; a tile stays inside the line and the block.
            unsafe {
                match (whole, is_full) {
                    (true, true) => tile::<V, CELLS, VECTORS>(job, x, block, first, out),
                    (true, false) => tile::<V, CELLS, 1>(job, x, block, first, out),
                    (false, true) => tile::<V, 1, VECTORS>(job, x, block, first, out),
                    (false, false) => tile::<V, 1, 1>(job, x, block, first, out),
                }
            }
            first += if is_full { VECTORS } else { 1 };
        }
    }
}

/// Computes `CELLS` neighbouring cells times `VECTORS` vectors of output channels, from vector `first` of the block on, in registers.
/// # Safety
/// [`LineJob::check`] must have passed, `x + CELLS` be at most the line's width and `first + VECTORS` at most the block's vectors.
#[inline(always)]
unsafe fn tile<V: Vector, const CELLS: usize, const VECTORS: usize>(
    job: &LineJob,
    x: usize,
    block: Block,
    first: usize,
    out: &mut [f32],
) {
    // SAFETY: all offsets lie within the slices that `LineJob::check` has checked.
    unsafe {
        let from = first * VECTOR_LANES;
        let bias: [V; VECTORS] = std::array::from_fn(|v| V::load(block.bias.as_ptr().add(from + v * VECTOR_LANES)));
        let mut sums = [bias; CELLS];
        for run in job.runs {
            let mut w = block.weights.as_ptr().add(run.row * block.bias.len() + from);
            let mut value = job.input.as_ptr().add(run.value + x * job.step);
            for _ in 0..run.count {
                let weight: [V; VECTORS] = std::array::from_fn(|v| V::load(w.add(v * VECTOR_LANES)));
                for (p, sums) in sums.iter_mut().enumerate() {
                    let value = *value.add(p * job.step);
                    for (sum, weight) in sums.iter_mut().zip(weight) {
                        *sum = sum.add_product(value, weight);
                    }
                }
                value = value.add(1);
                w = w.add(block.bias.len());
            }
        }
        for (p, sums) in sums.into_iter().enumerate() {
            let to = out.as_mut_ptr().add((x + p) * block.lanes + block.start + from);
            for (v, sum) in sums.into_iter().enumerate() {
                sum.store(to.add(v * VECTOR_LANES));
            }
        }
    }
}

#[cfg(test)]
pub(in crate::network) mod tests {
    use super::*;

    pub(in crate::network) fn numbers(n: usize, seed: u32) -> Vec<f32> {
        (0..n as u32).map(|i| ((i ^ seed).wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 23) as f32 - 1.0).collect()
    }

    #[test]
    fn every_shape_agrees_with_the_definition() {
        for (c, o, k, stride, width, height) in
            [(3, 16, 3, 1, 21, 4), (5, 40, 3, 1, 13, 3), (4, 64, 2, 2, 9, 2), (7, 2, 1, 1, 5, 3)]
        {
            let cells = width * stride + k - stride;
            let x = numbers((height * stride + k) * cells * c, 1);
            let (w, bias) = (numbers(o * c * k * k, 2), numbers(o, 3));
            let packed = Packed::new(&w, &bias, [c, c], [k, k], stride);
            for simd in Simd::available() {
                let mut out = vec![f32::NAN; height * width * packed.output()];
                convolve_with(simd, &packed, &x, cells, width, &mut out);
                for y in 0..height {
                    for column in 0..width {
                        for ch in 0..o {
                            let mut expected = bias[ch];
                            for (ky, kx) in (0..k).flat_map(|ky| (0..k).map(move |kx| (ky, kx))) {
                                let at = ((y * stride + ky) * cells + column * stride + kx) * c;
                                let weight = |i: usize| w[((ch * c + i) * k + ky) * k + kx];
                                expected += (0..c).map(|i| x[at + i] * weight(i)).sum::<f32>();
                            }
                            let found = out[(y * width + column) * packed.output() + ch];
                            assert!((found - expected).abs() < 1e-4, "{simd}: {c} {o} {k}: {found} for {expected}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn product_of_small_matrices() {
        let (rows, inner) = (5, 7);
        let (left, right) = (numbers(rows * inner, 1), numbers(inner * 32, 2));
        for simd in Simd::available() {
            let mut out = vec![f32::NAN; rows * 32];
            product(simd, &left, &right, [0..2, 3..7].into_iter(), &mut out);
            for (at, found) in out.iter().enumerate() {
                let seen = (0..inner).filter(|i| *i != 2);
                let expected: f32 = seen.map(|i| left[at / 32 * inner + i] * right[i * 32 + at % 32]).sum();
                assert!((found - expected).abs() < 1e-5);
            }
        }
    }
}
