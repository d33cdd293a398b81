//! Equation 3.3 by gridding: a type-1 non-uniform transform over range with twofold oversampling.
//!
//! Every reflector is spread over a few cells of a fine range grid with the "exponential of semicircle" kernel (Barnett, Magland and af
//! Klinteberg, SIAM J. Sci. Comput. 41, C479, 2019). The samples are the transform of the grid over that of the kernel. A reflector costs a dozen
//! cells instead of 512 samples.

use super::block_echoes::BlockEchoes;
use super::lane_fft::LaneFft;
use super::phase::EchoLanes;
use super::simd::{ComplexLanes, Lanes, Real, phasor};
use crate::radar::Radar;
use std::f64::consts::{PI, TAU};

/// Width of the widest kernel, cells; its error is near the precision of f64.
const MAX_WIDTH: usize = 16;

/// `exp(beta (sqrt(1 - (2x/width)^2) - 1))` for |x| <= width/2, as polynomials between the cells.
#[derive(Debug, Clone)]
struct SpreadingKernel {
    width: usize,
    beta: f64,
}

impl SpreadingKernel {
    /// The narrowest kernel of even width that keeps the error below `tolerance`, relative to the sum of amplitudes.
    fn for_tolerance(tolerance: f64) -> Self {
        let digits = -tolerance.max(1e-16).log10();
        let width = ((digits + 2.0).ceil() as usize).next_multiple_of(2).min(MAX_WIDTH);
        SpreadingKernel { width, beta: 2.3 * width as f64 }
    }

    fn value(&self, x: f64) -> f64 {
        let z = 2.0 * x / self.width as f64;
        if z.abs() > 1.0 { 0.0 } else { (self.beta * ((1.0 - z * z).sqrt() - 1.0)).exp() }
    }

    /// Integrals of `value(x) cos(2 pi frequency x)`: with `2x = width sin(t)` the trapezoidal rule converges geometrically.
    fn transforms(&self, frequencies: impl Iterator<Item = f64>) -> Vec<f64> {
        const TRANSFORM_STEPS: u32 = 200;
        let half = self.width as f64 / 2.0;
        let step = PI / 2.0 / f64::from(TRANSFORM_STEPS);
        // The integrand is even and vanishes at the ends: the middle counts once, all other nodes twice.
        let node = |i: u32| {
            let (sin, cos) = (f64::from(i) * step).sin_cos();
            let times = if i == 0 { 1.0 } else { 2.0 };
            [TAU * half * sin, times * step * half * (self.beta * (cos - 1.0)).exp() * cos]
        };
        let nodes: Vec<[f64; 2]> = (0..TRANSFORM_STEPS).map(node).collect();
        let transform = |frequency: f64| nodes.iter().map(|[x, weight]| weight * (frequency * x).cos()).sum();
        frequencies.map(transform).collect()
    }

    /// Coefficients, lowest first, of the polynomial through the kernel at Chebyshev points, in `t` of [-1, 1]: `x = t/2 + 1/2 - width/2 + cell`.
    fn polynomial(&self, cell: usize, terms: usize) -> Vec<f64> {
        let x = |t: f64| t / 2.0 + 0.5 - self.width as f64 / 2.0 + cell as f64;
        let angle = |node: usize| PI * (node as f64 + 0.5) / terms as f64;
        let chebyshev = (0..terms).map(|k| {
            let sum: f64 = (0..terms).map(|n| self.value(x(angle(n).cos())) * (k as f64 * angle(n)).cos()).sum();
            sum * if k == 0 { 1.0 } else { 2.0 } / terms as f64
        });
        // T_0 = 1, T_1 = t, T_{k+1} = 2 t T_k - T_{k-1}
        let mut total = vec![0.0; terms];
        let (mut before, mut now) = (vec![0.0; terms], vec![0.0; terms]);
        now[0] = 1.0;
        for (k, c) in chebyshev.enumerate() {
            total.iter_mut().zip(&now).for_each(|(t, v)| *t += c * v);
            let factor = if k == 0 { 1.0 } else { 2.0 };
            let shifted = |i: usize| if i > 0 { now[i - 1] } else { 0.0 };
            let next = (0..terms).map(|i| factor * shifted(i) - before[i]).collect();
            before = std::mem::replace(&mut now, next);
        }
        total
    }
}

/// A gridding prepared for one radar and tolerance.
#[derive(Clone)]
pub struct Gridding<T: Real> {
    samples: usize,
    grid: usize,
    width: usize,
    /// For each cell of the left half of the kernel: even and odd coefficients in `t^2`, highest first. The right half mirrors it.
    pieces: Vec<[Vec<T>; 2]>,
    /// One over the kernel's transform, by sample.
    correction: Vec<T>,
    fft: LaneFft<T>,
}

/// Working memory of [`block_signal`].
#[derive(Debug, Clone)]
pub struct GriddedScratch<T, const W: usize> {
    grid: Vec<ComplexLanes<T, W>>,
    spare: Vec<ComplexLanes<T, W>>,
}

impl<T: Real, const W: usize> GriddedScratch<T, W> {
    pub fn new(samples: usize) -> Self {
        let zero = ComplexLanes::zero();
        GriddedScratch { grid: vec![zero; 2 * samples], spare: vec![zero; 2 * samples] }
    }
}

impl<T: Real> Gridding<T> {
    /// Prepares the kernel for `radar`. The error is below `tolerance` times the sum of amplitudes, except for the rounding of `T`.
    pub fn new(radar: &Radar, tolerance: f64) -> Self {
        let samples = radar.samples;
        let kernel = SpreadingKernel::for_tolerance(tolerance.max(T::EPSILON));
        let terms = kernel.width + 4;
        let pieces = (0..kernel.width / 2)
            .map(|cell| {
                let all = kernel.polynomial(cell, terms);
                [0, 1].map(|odd| all.iter().skip(odd).step_by(2).rev().map(|c| T::of(*c)).collect())
            })
            .collect();
        let grid = 2 * samples;
        let half = samples / 2;
        let of_offset = kernel.transforms((0..=samples - half).map(|offset| offset as f64 / grid as f64));
        let correction =
            (0..samples).map(|n| T::of(of_offset.get(n.abs_diff(half)).map_or(0.0, |v| v.recip()))).collect();
        Gridding { samples, grid, width: kernel.width, pieces, correction, fft: LaneFft::new(grid) }
    }
}

/// Reflectors in a partial sum in f64: sums of partial sums have smaller rounding errors than one long sum.
const PARTIAL_SUM_TERMS: usize = 64;
/// Most reflectors whose sum meets f32's tolerance even if all rounding errors agree; longer sums add these at the end (Kahan, Commun. ACM 8, 1965).
const MAX_UNCORRECTED_TERMS: usize = 16;

/// Beat signal of `echoes`, written to `out`, one vector a sample.
#[inline(always)]
pub(super) fn block_signal<T: Real, const W: usize, const FMA: bool>(
    plan: &Gridding<T>,
    echoes: &BlockEchoes<'_, W>,
    scratch: &mut GriddedScratch<T, W>,
    out: &mut [ComplexLanes<T, W>],
) {
    let GriddedScratch { grid, spare } = scratch;
    grid.fill(ComplexLanes::zero());
    if echoes.len() > MAX_UNCORRECTED_TERMS {
        spare.fill(ComplexLanes::zero());
    }
    if T::EPSILON > f64::EPSILON && echoes.len() > MAX_UNCORRECTED_TERMS {
        for i in 0..echoes.len() {
            spread::<T, W, FMA, true>(plan, &echoes.echo::<FMA>(i), grid, spare);
        }
        grid.iter_mut().zip(spare.iter()).for_each(|(cell, lost)| *cell = *cell + *lost);
    } else {
        for begin in (0..echoes.len()).step_by(PARTIAL_SUM_TERMS) {
            if begin > 0 {
                for (total, cell) in spare.iter_mut().zip(grid.iter_mut()) {
                    *total = *total + *cell;
                    *cell = ComplexLanes::zero();
                }
            }
            for i in begin..echoes.len().min(begin + PARTIAL_SUM_TERMS) {
                spread::<T, W, FMA, false>(plan, &echoes.echo::<FMA>(i), grid, &mut []);
            }
        }
        if echoes.len() > PARTIAL_SUM_TERMS {
            grid.iter_mut().zip(spare.iter()).for_each(|(cell, total)| *cell = *cell + *total);
        }
    }
    plan.fft.process::<W, FMA>(grid, spare);
    let half = plan.samples / 2;
    for (n, (sample, correction)) in out.iter_mut().zip(&plan.correction).enumerate() {
        let cell = if n < half { plan.grid + n - half } else { n - half };
        let factor = Lanes::splat(*correction);
        // The grid has conjugates: the forward transform is the conjugate of the inverse one.
        *sample = ComplexLanes { re: grid[cell].re * factor, im: -(grid[cell].im * factor) };
    }
}

/// Adds `more` to `to`; returns the rounding error (Knuth's two-sum).
#[inline(always)]
fn add_exactly<T: Real, const W: usize>(to: &mut ComplexLanes<T, W>, more: ComplexLanes<T, W>) -> ComplexLanes<T, W> {
    let before = *to;
    let sum = before + more;
    let added = sum - before;
    *to = sum;
    (before - (sum - added)) + (more - added)
}

/// The kernel over its cells, `t` in [-1, 1] from one side of a cell to the other.
#[inline(always)]
fn kernel_values<T: Real, const W: usize, const FMA: bool>(
    plan: &Gridding<T>,
    t: Lanes<T, W>,
) -> [Lanes<T, W>; MAX_WIDTH] {
    let t2 = t * t;

    let mut values = [Lanes::splat(T::default()); MAX_WIDTH];
    for (cell, [even, odd]) in plan.pieces.iter().enumerate() {
        let horner = |terms: &[T]| {
            let mut v = Lanes::splat(terms[0]);
            for term in &terms[1..] {
                v = v.mul_add::<FMA>(t2, Lanes::splat(*term));
            }
            v
        };
        let (even, odd) = (horner(even), horner(odd) * t);
        values[cell] = even + odd;
        values[plan.width - 1 - cell] = even - odd;
    }
    values
}

/// Adds one echo to `grid`, and with `KEEPS_ERRORS` the rounding error of each cell to `lost`.
#[inline(always)]
fn spread<T: Real, const W: usize, const FMA: bool, const KEEPS_ERRORS: bool>(
    plan: &Gridding<T>,
    echo: &EchoLanes<W>,
    grid: &mut [ComplexLanes<T, W>],
    lost: &mut [ComplexLanes<T, W>],
) {
    let of = Lanes::<f64, W>::splat;
    let cells = plan.grid as f64;
    // Samples are counted from the middle of the chirp, where the kernel's transform is largest.
    let middle = (plan.samples / 2) as f64;
    let p = phasor::<T, W, FMA>(echo.beat_turns_at::<FMA>(middle) + echo.carrier_turns);
    let amplitude = echo.amplitude.round_to();
    let value = ComplexLanes { re: p.re * amplitude, im: -(p.im * amplitude) };

    let edge = echo.position_in(cells) - of(plan.width as f64 / 2.0);
    let left = (edge + of(0.5)).nearest();
    // In [-1, 1] up to rounding; `left` lies within half a cell of `edge + 1/2`.
    let t: Lanes<T, W> = ((left - edge - echo.beat_turns_low * of(cells)) * of(2.0) - of(1.0)).round_to();
    let values = kernel_values::<T, W, FMA>(plan, t);

    let (lowest, highest) = left.bounds();
    // Neighbouring elements nearly always have the same left cell. Elsewhere each group of lanes is spread by itself.
    let mut start = lowest;
    while start <= highest {
        let value = if lowest == highest {
            value
        } else {
            value.scaled(left.map(|l| f64::from(u8::from(l == start))).round_to())
        };
        let mut cell = (start.rem_euclid(cells)) as usize;
        for kernel in &values[..plan.width] {
            if cell >= plan.grid {
                cell -= plan.grid;
            }
            let sum = &mut grid[cell];
            if KEEPS_ERRORS {
                lost[cell] = lost[cell] + add_exactly(sum, value.scaled(*kernel));
            } else {
                sum.re = value.re.mul_add::<FMA>(*kernel, sum.re);
                sum.im = value.im.mul_add::<FMA>(*kernel, sum.im);
            }
            cell += 1;
        }
        start += 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_follow_the_kernel() {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
            let kernel = SpreadingKernel::for_tolerance(tolerance);
            let mut worst = 0.0f64;
            for cell in 0..kernel.width {
                let p = kernel.polynomial(cell, kernel.width + 4);
                for i in -50..=50 {
                    let t = f64::from(i) / 50.0;
                    let value = p.iter().rev().fold(0.0, |v, c| v * t + c);
                    let x = t / 2.0 + 0.5 - kernel.width as f64 / 2.0 + cell as f64;
                    worst = worst.max((value - kernel.value(x)).abs());
                }
            }
            assert!(worst < tolerance.max(1e-14), "width {}: {worst:e}", kernel.width);
        }
    }

    #[test]
    fn the_kernel_transform_of_known_sums() {
        // Poisson: the sum over whole numbers is the sum of the transform at whole frequencies, all but the first tiny.
        let kernel = SpreadingKernel::for_tolerance(1e-12);
        let sum: f64 = (-8..=8).map(|i| kernel.value(f64::from(i))).sum();
        assert!((sum - kernel.transforms(std::iter::once(0.0))[0]).abs() < 1e-13 * sum);
    }
}
