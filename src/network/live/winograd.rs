//! 3x3 convolutions by minimal [`filter`](super::filter)ing in both directions: four by four neighbouring outputs cost 36 products in place of
//! 144.
//!
//! Angles wrap around, ranges end in zeros. Lines are computed in bands that fit a processor's cache: each line of the input is read and
//! transformed into six pictures of a quarter of the width, and six lines of each picture into six of one line. The 36 pictures are multiplied
//! by kernels of a single tap; the products are transformed into lines, and those into lines of the output.

use super::filter::{Gather, Groups, OF_BIAS, OF_TAPS, OUTPUTS, PRODUCTS, Spread};
use crate::network::kernels::convolution::{Packed, padded};
use crate::network::kernels::vector::{LANES, run};
use crate::signal::simd::Simd;
use rayon::prelude::*;
use std::cell::RefCell;

/// Most groups of [`OUTPUTS`] cells of a band, and its fewest and most lines: they fit a processor's cache, and give enough bands for all processors.
const BAND_GROUPS: usize = 512;
const BAND_LINES: std::ops::RangeInclusive<usize> = 4..=16;

/// One picture for each product along the angle and, within that, in range.
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
    spread: [[Vec<f32>; PRODUCTS]; PRODUCTS],
    pictures: Pictures<Vec<f32>>,
    products: Pictures<Vec<f32>>,
    /// Four lines of each product along the angle.
    gathered: [Vec<f32>; PRODUCTS],
    sums: Vec<f32>,
}

thread_local! {
    static BAND: RefCell<Band> = RefCell::default();
}

impl Conv3x3 {
    /// Takes weights `[output, input, 3, 3]` (PyTorch's order) and `bias` `[output]`. The input's cells have `stride` channels, of which the
    /// last `stride - input` meet zeros.
    pub(super) fn new(weights: &[f32], bias: &[f32], input: usize, stride: usize) -> Self {
        let none = vec![0.0; bias.len()];
        let kernel = |along: usize, across: usize| {
            let taps = |row: &[f32], of: [f32; 3]| row.iter().zip(of).map(|(w, t)| w * t).sum::<f32>();
            let tap = |w: &[f32]| {
                let rows = [0, 3, 6].map(|row| taps(&w[row..row + 3], OF_TAPS[along]));
                taps(&rows, OF_TAPS[across])
            };
            let taps: Vec<f32> = weights.chunks_exact(9).map(tap).collect();
            let bias = if [along, across] == [OF_BIAS; 2] { bias } else { &none };
            Packed::new(&taps, bias, [input, stride], [1, 1], 1)
        };
        let kernels = std::array::from_fn(|along| std::array::from_fn(|across| kernel(along, across)));
        Conv3x3 { kernels, input: stride, output: padded(bias.len()) }
    }

    pub(super) fn output(&self) -> usize {
        self.output
    }

    /// Convolves a picture of `height` lines of `width` cells, a multiple of four: `read` writes line y of the input, and `take` puts a line of
    /// [`Results`] into the same line of `out`.
    ///
    /// Neither may use rayon: the thread's buffers are borrowed meanwhile.
    pub(super) fn run(
        &self,
        [height, width]: [usize; 2],
        read: impl Fn(usize, &mut [f32]) + Sync,
        out: &mut [f32],
        take: impl Fn(Results<'_>, &mut [f32]) + Sync,
    ) {
        assert!(width.is_multiple_of(OUTPUTS) && out.len().is_multiple_of(height), "a picture of another shape");
        let groups = width / OUTPUTS;
        let lines = (BAND_GROUPS / groups).clamp(*BAND_LINES.start(), *BAND_LINES.end());
        let out_line = out.len() / height;
        let simd = Simd::chosen();
        // The lines above and below the picture are zeros.
        let read = |y: usize, line: &mut [f32]| {
            if (1..=height).contains(&y) { read(y - 1, line) } else { line.fill(0.0) }
        };
        out.par_chunks_mut(lines * out_line).enumerate().for_each(|(band, out)| {
            BAND.with_borrow_mut(|kept| {
                let strips = (out.len() / out_line).div_ceil(OUTPUTS);
                kept.spread(simd, self.input, groups, strips, |y, line| read(band * lines + y, line));
                kept.multiply(simd, &self.kernels, groups * strips);
                for (strip, out) in out.chunks_mut(OUTPUTS * out_line).enumerate() {
                    kept.gather(simd, groups * self.output, strip);
                    for (line, out) in out.chunks_exact_mut(out_line).enumerate() {
                        take(Results { simd, channels: self.output, groups, line, band: kept }, out);
                    }
                }
            });
        });
    }
}

impl Band {
    fn spread(&mut self, simd: Simd, channels: usize, groups: usize, strips: usize, read: impl Fn(usize, &mut [f32])) {
        let cells = groups * OUTPUTS * channels;
        let size = groups * channels;
        // The last vector of a cell overhangs where the channels are no whole vectors; the next cell is written after it.
        self.line.resize(cells + 2 * channels + LANES, 0.0);
        self.spread.iter_mut().flatten().for_each(|line| line.resize(size + LANES, 0.0));
        self.pictures.iter_mut().flatten().for_each(|picture| picture.resize(strips * size + LANES, 0.0));
        let along = Groups { many: groups, vectors: channels.div_ceil(LANES), steps: [OUTPUTS * channels, channels] };
        let across = Groups { many: 1, vectors: size.div_ceil(LANES), steps: [0; 2] };
        for strip in 0..strips {
            // The last two lines of a strip are the first two of the next.
            self.spread.rotate_left(OUTPUTS);
            let first = if strip == 0 { 0 } else { PRODUCTS - OUTPUTS };
            for (line, to) in self.spread.iter_mut().enumerate().skip(first) {
                read(strip * OUTPUTS + line, &mut self.line[channels..channels + cells]);
                self.line.copy_within(cells..cells + channels, 0);
                self.line.copy_within(channels..2 * channels, cells + channels);
                let from = std::array::from_fn(|cell| &self.line[cell * channels..]);
                run(simd, Spread { groups: along, from, to: to.each_mut().map(Vec::as_mut_slice) });
            }
            for (along, to) in self.pictures.iter_mut().enumerate() {
                let from = self.spread.each_ref().map(|line| line[along].as_slice());
                let to = to.each_mut().map(|picture| &mut picture[strip * size..]);
                run(simd, Spread { groups: across, from, to });
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

    fn gather(&mut self, simd: Simd, size: usize, strip: usize) {
        let groups = Groups { many: 1, vectors: size / LANES, steps: [0; 2] };
        for (from, to) in self.products.iter().zip(&mut self.gathered) {
            to.resize(OUTPUTS * size, 0.0);
            let from = from.each_ref().map(|products| &products[strip * size..(strip + 1) * size]);
            run(simd, Gather { groups, from, apart: size, to });
        }
    }
}

pub(super) struct Results<'a> {
    simd: Simd,
    channels: usize,
    groups: usize,
    /// Index of the line in the strip that was gathered last.
    line: usize,
    band: &'a mut Band,
}

impl<'a> Results<'a> {
    pub(super) fn put(self, to: &mut [f32]) {
        put(self.simd, [self.channels, self.groups, self.line], &self.band.gathered, to);
    }

    /// The results in a buffer that the next line overwrites.
    pub(super) fn sums(self) -> &'a mut [f32] {
        let Results { simd, channels, groups, line, band } = self;
        band.sums.resize(groups * channels * OUTPUTS, 0.0);
        put(simd, [channels, groups, line], &band.gathered, &mut band.sums);
        &mut band.sums
    }
}

fn put(simd: Simd, [channels, groups, line]: [usize; 3], gathered: &[Vec<f32>; PRODUCTS], to: &mut [f32]) {
    let size = groups * channels;
    let from = gathered.each_ref().map(|gathered| &gathered[line * size..(line + 1) * size]);
    let groups = Groups { many: groups, vectors: channels / LANES, steps: [channels, OUTPUTS * channels] };
    run(simd, Gather { groups, from, apart: channels, to });
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
            conv.run([height, width], read, &mut out, |results, out| results.put(out));
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
