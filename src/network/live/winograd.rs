//! 3x3 convolutions by minimal filtering along the angle: four neighbouring outputs of three taps cost six products in place of twelve
//! (F(4, 3) of Lavin and Gray 2016). Along range the three taps are summed as they stand.
//!
//! Angles wrap around, ranges end in zeros. Lines are computed in bands that stay in a processor's cache: each line of the input is asked for,
//! spread into six pictures of a quarter of the width, which meet six kernels of three taps in range; their results are gathered
//! into lines of the output.

use super::kernel::{Packed, padded};
use super::vector::LANES;
use crate::signal::simd::{Kernel, LANES_F32, Lanes, Simd};
use rayon::prelude::*;
use std::cell::RefCell;

/// Outputs of one filter.
const OUTPUTS: usize = 4;
/// Products that they cost.
const PRODUCTS: usize = 6;

/// What each product makes of a kernel's three taps along the angle.
const OF_TAPS: [[f32; 3]; PRODUCTS] = [
    [1.0 / 4.0, 0.0, 0.0],
    [-1.0 / 6.0, -1.0 / 6.0, -1.0 / 6.0],
    [-1.0 / 6.0, 1.0 / 6.0, -1.0 / 6.0],
    [1.0 / 24.0, 1.0 / 12.0, 1.0 / 6.0],
    [1.0 / 24.0, -1.0 / 12.0, 1.0 / 6.0],
    [0.0, 0.0, 1.0],
];

/// Groups of [`OUTPUTS`] cells that a band has at most, and its fewest and most lines: what a processor's cache holds, and enough bands for all
/// processors.
const BAND_GROUPS: usize = 512;
const BAND_LINES: std::ops::RangeInclusive<usize> = 4..=16;

/// A 3x3 convolution's weights, as six kernels of three taps in range.
#[derive(Debug)]
pub(super) struct Conv3x3 {
    kernels: [Packed; PRODUCTS],
    bias: Vec<f32>,
    input: usize,
}

/// What one processor keeps while it works on a band, and for the next.
#[derive(Default)]
struct Band {
    line: Vec<f32>,
    spread: [Vec<f32>; PRODUCTS],
    products: [Vec<f32>; PRODUCTS],
    sums: Vec<f32>,
}

thread_local! {
    static BAND: RefCell<Band> = RefCell::default();
}

impl Conv3x3 {
    /// Takes weights `[output, input, 3, 3]` (PyTorch's order) and `bias` `[output]`. The input's cells have `stride` channels, of which the
    /// last `stride - input` meet zeros.
    pub(super) fn new(weights: &[f32], bias: &[f32], input: usize, stride: usize) -> Self {
        let kernels = OF_TAPS.map(|of_taps| {
            let taps = weights.chunks_exact(3).map(|row| row.iter().zip(of_taps).map(|(w, t)| w * t).sum());
            let taps: Vec<f32> = taps.collect();
            Packed::new(&taps, &vec![0.0; bias.len()], [input, stride], [3, 1], 1)
        });
        let mut all_bias = bias.to_vec();
        all_bias.resize(padded(bias.len()), 0.0);
        Conv3x3 { kernels, bias: all_bias, input: stride }
    }

    /// Channels of an output cell.
    pub(super) fn output(&self) -> usize {
        self.bias.len()
    }

    /// Convolves a picture of `height` lines of `width` cells, a multiple of four: `read` writes line y of the input, and `take` puts a line of results
    /// `[width, output]` into the same line of `out`.
    ///
    /// Neither may use rayon: what a thread keeps for a band is borrowed meanwhile.
    pub(super) fn run(
        &self,
        [height, width]: [usize; 2],
        read: impl Fn(usize, &mut [f32]) + Sync,
        out: &mut [f32],
        take: impl Fn(&mut [f32], &mut [f32]) + Sync,
    ) {
        assert!(width.is_multiple_of(OUTPUTS) && out.len().is_multiple_of(height), "a picture of another shape");
        let groups = width / OUTPUTS;
        let lines = (BAND_GROUPS / groups).clamp(*BAND_LINES.start(), *BAND_LINES.end());
        let out_line = out.len() / height;
        let simd = Simd::chosen();
        out.par_chunks_mut(lines * out_line).enumerate().for_each(|(band, out)| {
            BAND.with_borrow_mut(|kept| {
                let first = band * lines;
                let many = out.len() / out_line;
                kept.spread(simd, self.input, groups, first..first + many + 2, |y, line| {
                    if y == 0 || y > height { line.fill(0.0) } else { read(y - 1, line) }
                });
                kept.multiply(simd, &self.kernels, groups, many);
                for (line, out) in out.chunks_exact_mut(out_line).enumerate() {
                    take(kept.gathered(simd, &self.bias, groups, line), out);
                }
            });
        });
    }
}

impl Band {
    /// Reads lines and spreads them over the six pictures.
    fn spread(
        &mut self,
        simd: Simd,
        channels: usize,
        groups: usize,
        lines: std::ops::Range<usize>,
        read: impl Fn(usize, &mut [f32]),
    ) {
        let cells = groups * OUTPUTS * channels;
        // The last vector of a cell overhangs where the channels are no whole vectors; the next cell is written after it.
        self.line.resize(cells + 2 * channels + LANES, 0.0);
        let size = groups * channels;
        self.spread.iter_mut().for_each(|picture| picture.resize(lines.len() * size + LANES, 0.0));
        for (line, y) in lines.enumerate() {
            read(y, &mut self.line[channels..channels + cells]);
            self.line.copy_within(cells..cells + channels, 0);
            self.line.copy_within(channels..2 * channels, cells + channels);
            let to = self.spread.each_mut().map(|picture| &mut picture[line * size..(line + 1) * size + LANES]);
            simd.run(Spread { line: &self.line, channels, groups, to });
        }
    }

    /// The six pictures, each through its kernel.
    fn multiply(&mut self, simd: Simd, kernels: &[Packed; PRODUCTS], groups: usize, lines: usize) {
        for ((kernel, picture), out) in kernels.iter().zip(&self.spread).zip(&mut self.products) {
            out.resize(lines * groups * kernel.output(), 0.0);
            // Lines follow each other without a gap, so that the band is one long line to the kernel.
            kernel.line(simd, picture, groups, lines * groups, out);
        }
    }

    /// A line of results.
    fn gathered(&mut self, simd: Simd, bias: &[f32], groups: usize, line: usize) -> &mut [f32] {
        let size = groups * bias.len();
        self.sums.resize(size * OUTPUTS, 0.0);
        let from = self.products.each_ref().map(|products| &products[line * size..(line + 1) * size]);
        simd.run(Gather { from, bias, to: &mut self.sums });
        &mut self.sums
    }
}

type Vector = Lanes<f32, LANES_F32>;

/// Six neighbouring cells of a line, every fourth of which begins a group, to the six factors of the group's products.
struct Spread<'a> {
    line: &'a [f32],
    channels: usize,
    groups: usize,
    to: [&'a mut [f32]; PRODUCTS],
}

impl Kernel for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Spread { line, channels, groups, to: [to0, to1, to2, to3, to4, to5] } = self;
        let times = |a: Vector, by: f32, plus: Vector| a.mul_add::<FMA>(Lanes::splat(by), plus);
        for group in 0..groups {
            let cells = &line[OUTPUTS * group * channels..];
            for channel in (0..channels).step_by(LANES) {
                let d = |cell: usize| Vector::load(&cells[cell * channels + channel..]);
                let (d1, d2, d3, d4) = (d(1), d(2), d(3), d(4));
                let (even, odd) = (times(d2, -4.0, d4), times(d1, -4.0, d3));
                let (far, near) = (d4 - d2, d3 - d1);
                // Written out, as an array of vectors would go through memory.
                let at = group * channels + channel;
                times(d(0), 4.0, times(d2, -5.0, d4)).store(&mut to0[at..]);
                (even + odd).store(&mut to1[at..]);
                (even - odd).store(&mut to2[at..]);
                times(near, 2.0, far).store(&mut to3[at..]);
                times(near, -2.0, far).store(&mut to4[at..]);
                times(d1, 4.0, times(d3, -5.0, d(5))).store(&mut to5[at..]);
            }
        }
    }
}

/// Six products of every group to its four results.
struct Gather<'a> {
    from: [&'a [f32]; PRODUCTS],
    bias: &'a [f32],
    to: &'a mut [f32],
}

impl Kernel for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Gather { from: [from0, from1, from2, from3, from4, from5], bias, to } = self;
        let channels = bias.len();
        let times = |a: Vector, by: f32, plus: Vector| a.mul_add::<FMA>(Lanes::splat(by), plus);
        for (group, to) in to.chunks_exact_mut(OUTPUTS * channels).enumerate() {
            for channel in (0..channels).step_by(LANES) {
                let at = group * channels + channel;
                let (m1, m2, m3, m4) = (
                    Vector::load(&from1[at..]),
                    Vector::load(&from2[at..]),
                    Vector::load(&from3[at..]),
                    Vector::load(&from4[at..]),
                );
                let bias = Vector::load(&bias[channel..]);
                let (sum, gap) = (m1 + m2 + bias, m1 - m2 + bias);
                let (wide_sum, wide_gap) = (m3 + m4, m3 - m4);
                (Vector::load(&from0[at..]) + sum + wide_sum).store(&mut to[channel..]);
                times(wide_gap, 2.0, gap).store(&mut to[channels + channel..]);
                times(wide_sum, 4.0, sum).store(&mut to[2 * channels + channel..]);
                times(wide_gap, 8.0, gap + Vector::load(&from5[at..])).store(&mut to[3 * channels + channel..]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(n: usize, seed: u32) -> Vec<f32> {
        (0..n as u32).map(|i| ((i ^ seed).wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 23) as f32 - 1.0).collect()
    }

    #[test]
    fn every_shape_agrees_with_the_definition() {
        for (input, output, height, width) in [(16, 16, 21, 64), (38, 16, 5, 8), (12, 20, 9, 256), (96, 96, 3, 4)] {
            let (x, w, bias) = (numbers(height * width * input, 1), numbers(output * input * 9, 2), numbers(output, 3));
            let conv = Conv3x3::new(&w, &bias, input, input);
            let mut out = vec![f32::NAN; height * width * conv.output()];
            let line = width * input;
            let read = |y: usize, to: &mut [f32]| to.copy_from_slice(&x[y * line..(y + 1) * line]);
            conv.run([height, width], read, &mut out, |sums, out| out.copy_from_slice(sums));
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
