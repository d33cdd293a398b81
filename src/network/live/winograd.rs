//! 3x3 convolutions by minimal [`filter`](super::filter)ing in both directions: 36 products for 4 x 4 neighbouring outputs in place of 144.
//!
//! Padding is circular in angle, and with zeros in range. Lines are computed in bands that fit a processor's cache. Each line of the input is
//! transformed along the angle into six lines of a quarter of the width, and each six of those in range into six, which makes 36 pictures. These are
//! multiplied by kernels of a single tap, and the products transformed into lines of the output.

use super::filter::{BIAS_PRODUCT, Groups, InputTransform, OUTPUTS, OutputTransform, PRODUCTS, TAP_TRANSFORM};
use crate::network::kernels::convolution::{Packed, padded};
use crate::network::kernels::vector::{VECTOR_LANES, run};
use crate::signal::simd::Simd;
use rayon::prelude::*;
use std::cell::RefCell;

/// Most groups of [`OUTPUTS`] cells in a band, and least and most lines: a band fits a processor's cache, and there are enough for all processors.
const BAND_GROUPS: usize = 512;
const BAND_LINE_RANGE: std::ops::RangeInclusive<usize> = 4..=16;

/// A picture for each product along the angle and, within that, in range.
type Pictures<T> = [[T; PRODUCTS]; PRODUCTS];

/// A 3x3 convolution's weights, as 36 kernels of one tap.
#[derive(Debug)]
pub(super) struct Conv3x3 {
    kernels: Pictures<Packed>,
    input: usize,
    output: usize,
}

#[derive(Default)]
struct Band {
    line: Vec<f32>,
    /// The input lines of the next outputs, transformed along the angle.
    transformed_lines: [[Vec<f32>; PRODUCTS]; PRODUCTS],
    pictures: Pictures<Vec<f32>>,
    products: Pictures<Vec<f32>>,
    /// Four lines of each product along the angle.
    outputs: [Vec<f32>; PRODUCTS],
    sums: Vec<f32>,
}

thread_local! {
    static BAND: RefCell<Band> = RefCell::default();
}

impl Conv3x3 {
    /// A convolution with weights `[output, input, 3, 3]` (PyTorch's order) and `bias` `[output]`, of the first `input` of `stride` channels a cell.
    pub(super) fn new(weights: &[f32], bias: &[f32], input: usize, stride: usize) -> Self {
        let none = vec![0.0; bias.len()];
        let kernel = |along: usize, across: usize| {
            let taps = |row: &[f32], of: [f32; 3]| row.iter().zip(of).map(|(w, t)| w * t).sum::<f32>();
            let tap = |w: &[f32]| {
                let rows = [0, 3, 6].map(|row| taps(&w[row..row + 3], TAP_TRANSFORM[along]));
                taps(&rows, TAP_TRANSFORM[across])
            };
            let taps: Vec<f32> = weights.chunks_exact(9).map(tap).collect();
            let bias = if [along, across] == [BIAS_PRODUCT; 2] { bias } else { &none };
            Packed::new(&taps, bias, [input, stride], [1, 1], 1)
        };
        let kernels = std::array::from_fn(|along| std::array::from_fn(|across| kernel(along, across)));
        Conv3x3 { kernels, input: stride, output: padded(bias.len()) }
    }

    /// Output channels, padded to whole vectors.
    pub(super) fn output(&self) -> usize {
        self.output
    }

    /// Convolves a picture of `height` lines of `width` cells, a multiple of four. `read` writes line y of the input, and `take` writes
    /// [`ConvResults`] to the same line of `out`.
    /// Neither may use rayon, since the thread's buffers are borrowed.
    pub(super) fn run(
        &self,
        [height, width]: [usize; 2],
        read: impl Fn(usize, &mut [f32]) + Sync,
        out: &mut [f32],
        take: impl Fn(ConvResults<'_>, &mut [f32]) + Sync,
    ) {
        assert!(width.is_multiple_of(OUTPUTS) && out.len().is_multiple_of(height), "a picture of another shape");
        let groups = width / OUTPUTS;
        let lines = (BAND_GROUPS / groups).clamp(*BAND_LINE_RANGE.start(), *BAND_LINE_RANGE.end());
        let out_line = out.len() / height;
        let simd = Simd::chosen();
        // The lines above and below the picture are zeros.
        let read = |y: usize, line: &mut [f32]| {
            if (1..=height).contains(&y) { read(y - 1, line) } else { line.fill(0.0) }
        };
        out.par_chunks_mut(lines * out_line).enumerate().for_each(|(band, out)| {
            BAND.with_borrow_mut(|band_buffers| {
                let strips = (out.len() / out_line).div_ceil(OUTPUTS);
                band_buffers.transform(simd, self.input, groups, strips, |y, line| read(band * lines + y, line));
                band_buffers.multiply(simd, &self.kernels, groups * strips);
                for (strip, out) in out.chunks_mut(OUTPUTS * out_line).enumerate() {
                    band_buffers.transform_outputs(simd, groups * self.output, strip);
                    for (line, out) in out.chunks_exact_mut(out_line).enumerate() {
                        take(ConvResults { simd, channels: self.output, groups, line, band: band_buffers }, out);
                    }
                }
            });
        });
    }
}

impl Band {
    fn transform(
        &mut self,
        simd: Simd,
        channels: usize,
        groups: usize,
        strips: usize,
        read: impl Fn(usize, &mut [f32]),
    ) {
        let cells = groups * OUTPUTS * channels;
        let size = groups * channels;
        // Where channels are no whole vectors, the last vector of a cell overlaps the next cell, which is written later.
        self.line.resize(cells + 2 * channels + VECTOR_LANES, 0.0);
        self.transformed_lines.iter_mut().flatten().for_each(|line| line.resize(size + VECTOR_LANES, 0.0));
        self.pictures.iter_mut().flatten().for_each(|picture| picture.resize(strips * size + VECTOR_LANES, 0.0));
        let along =
            Groups { count: groups, vectors: channels.div_ceil(VECTOR_LANES), steps: [OUTPUTS * channels, channels] };
        let across = Groups { count: 1, vectors: size.div_ceil(VECTOR_LANES), steps: [0; 2] };
        for strip in 0..strips {
            // The last two lines of a strip are the first two of the next.
            self.transformed_lines.rotate_left(OUTPUTS);
            let first = if strip == 0 { 0 } else { PRODUCTS - OUTPUTS };
            for (line, to) in self.transformed_lines.iter_mut().enumerate().skip(first) {
                read(strip * OUTPUTS + line, &mut self.line[channels..channels + cells]);
                self.line.copy_within(cells..cells + channels, 0);
                self.line.copy_within(channels..2 * channels, cells + channels);
                let from = std::array::from_fn(|cell| &self.line[cell * channels..]);
                run(simd, InputTransform { groups: along, from, to: to.each_mut().map(Vec::as_mut_slice) });
            }
            for (along, to) in self.pictures.iter_mut().enumerate() {
                let from = self.transformed_lines.each_ref().map(|line| line[along].as_slice());
                let to = to.each_mut().map(|picture| &mut picture[strip * size..]);
                run(simd, InputTransform { groups: across, from, to });
            }
        }
    }

    fn multiply(&mut self, simd: Simd, kernels: &Pictures<Packed>, cells: usize) {
        let products = self.products.iter_mut().flatten();
        for ((kernel, picture), out) in kernels.iter().flatten().zip(self.pictures.iter().flatten()).zip(products) {
            out.resize(cells * kernel.output(), 0.0);
            kernel.line(simd, picture, cells, cells, out);
        }
    }

    fn transform_outputs(&mut self, simd: Simd, size: usize, strip: usize) {
        let groups = Groups { count: 1, vectors: size / VECTOR_LANES, steps: [0; 2] };
        for (from, to) in self.products.iter().zip(&mut self.outputs) {
            to.resize(OUTPUTS * size, 0.0);
            let from = from.each_ref().map(|products| &products[strip * size..(strip + 1) * size]);
            run(simd, OutputTransform { groups, from, output_step: size, to });
        }
    }
}

pub(super) struct ConvResults<'a> {
    simd: Simd,
    channels: usize,
    groups: usize,
    /// Index of the line in the strip that was computed last.
    line: usize,
    band: &'a mut Band,
}

impl<'a> ConvResults<'a> {
    pub(super) fn write_outputs(self, to: &mut [f32]) {
        write_outputs(self.simd, [self.channels, self.groups, self.line], &self.band.outputs, to);
    }

    /// The results, in a buffer that the next line overwrites.
    pub(super) fn sums(self) -> &'a mut [f32] {
        let ConvResults { simd, channels, groups, line, band } = self;
        band.sums.resize(groups * channels * OUTPUTS, 0.0);
        write_outputs(simd, [channels, groups, line], &band.outputs, &mut band.sums);
        &mut band.sums
    }
}

fn write_outputs(simd: Simd, [channels, groups, line]: [usize; 3], outputs: &[Vec<f32>; PRODUCTS], to: &mut [f32]) {
    let size = groups * channels;
    let from = outputs.each_ref().map(|outputs| &outputs[line * size..(line + 1) * size]);
    let groups = Groups { count: groups, vectors: channels / VECTOR_LANES, steps: [channels, OUTPUTS * channels] };
    run(simd, OutputTransform { groups, from, output_step: channels, to });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::kernels::convolution::tests::numbers;

    #[test]
    fn every_shape_agrees_with_the_definition() {
        for (input, output, height, width) in [(16, 16, 21, 64), (38, 16, 5, 8), (12, 20, 9, 256), (96, 96, 3, 4)] {
            let (x, w, bias) = (numbers(height * width * input, 1), numbers(output * input * 9, 2), numbers(output, 3));
            let conv = Conv3x3::new(&w, &bias, input, input);
            let mut out = vec![f32::NAN; height * width * conv.output()];
            let line = width * input;
            let read = |y: usize, to: &mut [f32]| to.copy_from_slice(&x[y * line..(y + 1) * line]);
            conv.run([height, width], read, &mut out, |results, out| results.write_outputs(out));
            for (cell, found) in out.chunks_exact(conv.output()).enumerate() {
                let (y, column) = (cell / width, cell % width);
                for (o, found) in found.iter().enumerate().take(output) {
                    let mut expected = f64::from(bias[o]);
                    for (ky, kx) in (0..3).flat_map(|ky| (0..3).map(move |kx| (ky, kx))) {
                        let from = (y + ky).wrapping_sub(1);
                        if from < height {
                            let at = (from * width + (column + kx + width - 1) % width) * input;
                            let weight = |i: usize| f64::from(w[((o * input + i) * 3 + ky) * 3 + kx]);
                            expected += (0..input).map(|i| f64::from(x[at + i]) * weight(i)).sum::<f64>();
                        }
                    }
                    assert!((f64::from(*found) - expected).abs() < 2e-4, "{input} {output}: {found} for {expected}");
                }
            }
        }
    }
}
