//! 3x3 convolutions by minimal filtering: four by four neighbouring outputs of three by three taps cost 36 products in place of 144
//! (F(4 x 4, 3 x 3) of Lavin and Gray 2016).
//!
//! Angles wrap around, ranges end in zeros. Lines are computed in bands that stay in a processor's cache: each line of the input is asked for
//! and spread into six pictures of a quarter of the width, six lines of each of those into six of one line. The 36 pictures meet a kernel of
//! a single tap each; their results are gathered into lines, and those into lines of the output.

use super::kernel::{Packed, padded};
use super::vector::LANES;
use crate::signal::simd::{Kernel, LANES_F32, Lanes, Simd};
use rayon::prelude::*;
use std::cell::RefCell;

/// Neighbouring outputs of one filter.
const OUTPUTS: usize = 4;
/// Products that they cost, and inputs that they see.
const PRODUCTS: usize = 6;
/// Products of a filter in both directions.
const PICTURES: usize = PRODUCTS * PRODUCTS;

/// What each product makes of a kernel's three taps in one direction.
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

/// A 3x3 convolution's weights, as 36 kernels of one tap: for each product in range those along the angle.
#[derive(Debug)]
pub(super) struct Conv3x3 {
    kernels: Vec<Packed>,
    bias: Vec<f32>,
    input: usize,
}

/// What one processor keeps while it works on a band, and for the next.
#[derive(Default)]
struct Band {
    line: Vec<f32>,
    /// The lines that the next outputs see, spread along the angle.
    spread: [[Vec<f32>; PRODUCTS]; PRODUCTS],
    pictures: Vec<Vec<f32>>,
    products: Vec<Vec<f32>>,
    /// Results gathered in range.
    gathered: [[Vec<f32>; PRODUCTS]; OUTPUTS],
    sums: Vec<f32>,
}

thread_local! {
    static BAND: RefCell<Band> = RefCell::default();
}

impl Conv3x3 {
    /// Takes weights `[output, input, 3, 3]` (PyTorch's order) and `bias` `[output]`. The input's cells have `stride` channels, of which the
    /// last `stride - input` meet zeros.
    pub(super) fn new(weights: &[f32], bias: &[f32], input: usize, stride: usize) -> Self {
        let kernel = |picture: usize| {
            let [in_range, along_angle] = [OF_TAPS[picture / PRODUCTS], OF_TAPS[picture % PRODUCTS]];
            let along = |row: &[f32]| row.iter().zip(along_angle).map(|(w, t)| w * t).sum::<f32>();
            let tap = |w: &[f32]| w.chunks_exact(3).zip(in_range).map(|(row, t)| along(row) * t).sum();
            let taps: Vec<f32> = weights.chunks_exact(9).map(tap).collect();
            Packed::new(&taps, &vec![0.0; bias.len()], [input, stride], [1, 1], 1)
        };
        let mut all_bias = bias.to_vec();
        all_bias.resize(padded(bias.len()), 0.0);
        Conv3x3 { kernels: (0..PICTURES).map(kernel).collect(), bias: all_bias, input: stride }
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
                    kept.gather(simd, groups * self.output(), strip);
                    for (line, out) in out.chunks_exact_mut(out_line).enumerate() {
                        take(kept.results(simd, &self.bias, line), out);
                    }
                }
            });
        });
    }
}

impl Band {
    /// Reads lines and spreads them over the pictures, of which each strip of four lines becomes one line.
    fn spread(
        &mut self,
        simd: Simd,
        channels: usize,
        groups: usize,
        strips: usize,
        read: impl Fn(usize, &mut [f32]),
    ) {
        let cells = groups * OUTPUTS * channels;
        let size = groups * channels;
        // The last vector of a cell overhangs where the channels are no whole vectors; the next cell is written after it.
        self.line.resize(cells + 2 * channels + LANES, 0.0);
        self.spread.iter_mut().flatten().for_each(|line| line.resize(size + LANES, 0.0));
        self.pictures.resize_with(PICTURES, Vec::new);
        self.pictures.iter_mut().for_each(|picture| picture.resize(strips * size + LANES, 0.0));
        for strip in 0..strips {
            // The last two lines of a strip are the first two of the next.
            self.spread.rotate_left(OUTPUTS);
            let first = if strip == 0 { 0 } else { PRODUCTS - OUTPUTS };
            for (line, to) in self.spread.iter_mut().enumerate().skip(first) {
                read(strip * OUTPUTS + line, &mut self.line[channels..channels + cells]);
                self.line.copy_within(cells..cells + channels, 0);
                self.line.copy_within(channels..2 * channels, cells + channels);
                simd.run(Spread { line: &self.line, channels, groups, to: to.each_mut().map(Vec::as_mut_slice) });
            }
            let parts = self.pictures.iter_mut().map(|picture| &mut picture[strip * size..(strip + 1) * size + LANES]);
            simd.run(SpreadInRange { lines: &self.spread, size, to: parts.collect() });
        }
    }

    /// The pictures, each through its kernel.
    fn multiply(&mut self, simd: Simd, kernels: &[Packed], cells: usize) {
        self.products.resize_with(PICTURES, Vec::new);
        for ((kernel, picture), out) in kernels.iter().zip(&self.pictures).zip(&mut self.products) {
            out.resize(cells * kernel.output(), 0.0);
            kernel.line(simd, picture, cells, cells, out);
        }
    }

    /// Gathers a strip's products in range.
    fn gather(&mut self, simd: Simd, size: usize, strip: usize) {
        self.gathered.iter_mut().flatten().for_each(|line| line.resize(size, 0.0));
        let from = self.products.iter().map(|products| &products[strip * size..(strip + 1) * size]).collect();
        simd.run(GatherInRange { from, to: &mut self.gathered });
    }

    /// A line of results of the strip that was gathered last.
    fn results(&mut self, simd: Simd, bias: &[f32], line: usize) -> &mut [f32] {
        let from = self.gathered[line].each_ref().map(Vec::as_slice);
        self.sums.resize(from[0].len() * OUTPUTS, 0.0);
        simd.run(Gather { from, bias, to: &mut self.sums });
        &mut self.sums
    }
}

type Vector = Lanes<f32, LANES_F32>;

/// `a * by + plus`.
#[inline(always)]
fn times<const FMA: bool>(a: Vector, by: f32, plus: Vector) -> Vector {
    a.mul_add::<FMA>(Lanes::splat(by), plus)
}

/// Six neighbouring inputs to the factors of their products. Vectors are handed over one by one, here and below: an array of them would go
/// through memory.
#[inline(always)]
fn factors<const FMA: bool>(d: impl Fn(usize) -> Vector, mut take: impl FnMut(usize, Vector)) {
    let (d1, d2, d3, d4) = (d(1), d(2), d(3), d(4));
    let (even, odd) = (times::<FMA>(d2, -4.0, d4), times::<FMA>(d1, -4.0, d3));
    let (far, near) = (d4 - d2, d3 - d1);
    take(0, times::<FMA>(d(0), 4.0, times::<FMA>(d2, -5.0, d4)));
    take(1, even + odd);
    take(2, even - odd);
    take(3, times::<FMA>(near, 2.0, far));
    take(4, times::<FMA>(near, -2.0, far));
    take(5, times::<FMA>(d1, 4.0, times::<FMA>(d3, -5.0, d(5))));
}

/// Six products to the four results.
#[inline(always)]
fn results<const FMA: bool>(m: impl Fn(usize) -> Vector, mut take: impl FnMut(usize, Vector)) {
    let (m1, m2, m3, m4) = (m(1), m(2), m(3), m(4));
    let (sum, gap) = (m1 + m2, m1 - m2);
    let (wide_sum, wide_gap) = (m3 + m4, m3 - m4);
    take(0, m(0) + sum + wide_sum);
    take(1, times::<FMA>(wide_gap, 2.0, gap));
    take(2, times::<FMA>(wide_sum, 4.0, sum));
    take(3, times::<FMA>(wide_gap, 8.0, gap + m(5)));
}

/// Six neighbouring cells of a line, every fourth of which begins a group, to the factors of the group's products.
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
        let Spread { line, channels, groups, to } = self;
        for group in 0..groups {
            let cells = &line[OUTPUTS * group * channels..];
            for channel in (0..channels).step_by(LANES) {
                let at = group * channels + channel;
                factors::<FMA>(
                    |cell| Vector::load(&cells[cell * channels + channel..]),
                    |product, factor| factor.store(&mut to[product][at..]),
                );
            }
        }
    }
}

/// The same of neighbouring lines that are spread along the angle, `size` numbers each.
struct SpreadInRange<'a> {
    lines: &'a [[Vec<f32>; PRODUCTS]; PRODUCTS],
    size: usize,
    to: Vec<&'a mut [f32]>,
}

impl Kernel for SpreadInRange<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(mut self) {
        for picture in 0..PRODUCTS {
            for at in (0..self.size).step_by(LANES) {
                factors::<FMA>(
                    |line| Vector::load(&self.lines[line][picture][at..]),
                    |product, factor| factor.store(&mut self.to[product * PRODUCTS + picture][at..]),
                );
            }
        }
    }
}

/// Products of all pictures to four lines.
struct GatherInRange<'a> {
    from: Vec<&'a [f32]>,
    to: &'a mut [[Vec<f32>; PRODUCTS]; OUTPUTS],
}

impl Kernel for GatherInRange<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for picture in 0..PRODUCTS {
            for at in (0..self.from[0].len()).step_by(LANES) {
                results::<FMA>(
                    |product| Vector::load(&self.from[product * PRODUCTS + picture][at..]),
                    |line, result| result.store(&mut self.to[line][picture][at..]),
                );
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
        let Gather { from, bias, to } = self;
        let channels = bias.len();
        for (group, to) in to.chunks_exact_mut(OUTPUTS * channels).enumerate() {
            for channel in (0..channels).step_by(LANES) {
                let at = group * channels + channel;
                let bias = Vector::load(&bias[channel..]);
                results::<FMA>(
                    |product| Vector::load(&from[product][at..]),
                    |cell, result| (result + bias).store(&mut to[cell * channels + channel..]),
                );
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
