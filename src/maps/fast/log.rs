//! Magnitudes to decades, in vectors, with their extremes.

use super::super::log_map::{LOG_GUARD, guard};
use crate::signal::simd::{ComplexLanes, Lanes, Real};
use num_complex::Complex;

/// The factor by which magnitudes are squared in f32 without overflow, and its decades.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogScale {
    factor: f64,
    guard: f32,
    decades: f32,
    /// Decades of a magnitude of zero.
    silence: f32,
}

impl LogScale {
    pub(super) fn new(bound: f64) -> Self {
        let factor = if bound > 0.0 { 1e15 / bound.max(1e-35) } else { 1.0 };
        let (guard, decades) = ((guard(bound) * factor) as f32, factor.log10() as f32);
        LogScale { factor, guard, decades, silence: silence_decades(bound) }
    }

    /// `log10(|v| + guard)`.
    #[inline(always)]
    pub(super) fn decades<T: Real, const W: usize, const FMA: bool>(&self, v: ComplexLanes<T, W>) -> Lanes<f32, W> {
        let v = v.scaled(Lanes::splat(T::of(self.factor)));
        let power = v.re.mul_add::<FMA>(v.re, v.im * v.im);
        let mut out = Lanes::splat(0.0);
        for i in 0..W {
            let magnitude = (power.0[i].wide() as f32).sqrt() + self.guard;
            let value = log10::<FMA>(magnitude) - self.decades;
            out.0[i] = if magnitude > 0.0 { value } else { self.silence };
        }
        out
    }
}

/// Decades of a magnitude of zero in a map none of whose cells is larger than `bound`.
pub fn silence_decades(bound: f64) -> f32 {
    if bound > 0.0 { guard(bound).log10() as f32 } else { LOG_GUARD.log10() as f32 }
}

/// log10 of a positive normal number, within 4e-6 for results below 32.
///
/// `v = 2^e m` with m in [0.707, 1.414), and `log10 m` by the minimax polynomial of six coefficients that is 0 at 1, with an error of at most 6.5e-7.
#[inline(always)]
fn log10<const FMA: bool>(v: f32) -> f32 {
    const HALF_ROOT: i32 = 0x3f35_04f3; // bits of sqrt(1/2)
    const COEFFICIENTS: [f32; 6] =
        [0.434_300_03, -0.217_082_32, 0.144_298_15, -0.110_625_62, 0.096_978_05, -0.062_189_55];
    let bits = v.to_bits() as i32;
    let exponent = (bits - HALF_ROOT) >> 23;
    let x = f32::from_bits((bits - (exponent << 23)) as u32) - 1.0;
    let fused = |a: f32, b: f32, c: f32| if FMA { a.mul_add(b, c) } else { a * b + c };
    let [first, middle @ .., last] = COEFFICIENTS;
    let mut sum = last;
    for c in middle.into_iter().rev() {
        sum = fused(sum, x, c);
    }
    fused(exponent as f32, std::f32::consts::LOG10_2, x * fused(sum, x, first))
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes<const W: usize> {
    min: Lanes<f32, W>,
    max: Lanes<f32, W>,
}

impl<const W: usize> Extremes<W> {
    pub(super) fn new() -> Self {
        Extremes { min: Lanes::splat(f32::INFINITY), max: Lanes::splat(f32::NEG_INFINITY) }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, v: Lanes<f32, W>) {
        self.min = v.zip(self.min, |v, min| if v < min { v } else { min });
        self.max = v.zip(self.max, |v, max| if v > max { v } else { max });
    }

    pub(super) fn reduce(self) -> (f32, f32) {
        (self.min.0.into_iter().fold(f32::INFINITY, f32::min), self.max.0.into_iter().fold(f32::NEG_INFINITY, f32::max))
    }
}

/// Decades of a transformed row, rolled by half its length.
#[inline(always)]
pub(super) fn log_rolled<T: Real, const W: usize, const FMA: bool>(
    row: &[Complex<T>],
    log: &LogScale,
    out: &mut [f32],
    extremes: &mut Extremes<W>,
) {
    let half = row.len() / 2;
    let (low, high) = out.split_at_mut(half);
    let (positive, negative) = row.split_at(row.len() - half);
    // A copy that may be in registers.
    let mut seen = *extremes;
    for (from, to) in [(positive, high), (negative, low)] {
        let ((from, from_rest), (to, to_rest)) = (from.as_chunks::<W>(), to.as_chunks_mut::<W>());
        for (from, to) in from.iter().zip(to) {
            let d = log.decades::<T, W, FMA>(parts(from));
            seen.add(d);
            *to = d.0;
        }
        if let Some(first) = from_rest.first() {
            // The last chunk is padded with its first cell, which does not change the extremes.
            let mut padded = [*first; W];
            padded[..from_rest.len()].copy_from_slice(from_rest);
            let d = log.decades::<T, W, FMA>(parts(&padded));
            seen.add(d);
            to_rest.copy_from_slice(&d.0[..from_rest.len()]);
        }
    }
    *extremes = seen;
}

#[inline(always)]
fn parts<T: Real, const W: usize>(cells: &[Complex<T>; W]) -> ComplexLanes<T, W> {
    let mut v = ComplexLanes::zero();
    for (i, c) in cells.iter().enumerate() {
        v.re.0[i] = c.re;
        v.im.0[i] = c.im;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log10_is_within_four_millionths() {
        let mut v = 1e-31f32;
        while v < 1e16 {
            for got in [log10::<true>(v), log10::<false>(v)] {
                assert!((f64::from(got) - f64::from(v).log10()).abs() < 4e-6, "{v:e}: {got}");
            }
            v *= 1.000_37;
        }
    }
}
