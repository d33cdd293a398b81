//! Magnitudes to decades, in vectors, with the extremes noted on the way.

use super::super::log_map::LOG_GUARD;
use crate::signal::simd::{ComplexLanes, Lanes, Real};
use num_complex::Complex;

/// The scale at which magnitudes are squared in f32 without overflow, and what it adds to the decades.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogScale {
    factor: f64,
    guard: f32,
    decades: f32,
}

impl LogScale {
    pub(super) fn new(bound: f64) -> Self {
        // Far below the guard every cell is an exact zero, and the guard itself must stay within f32.
        let factor = if bound > 0.0 { 1e15 / bound.max(1e-35) } else { 1.0 };
        LogScale { factor, guard: (LOG_GUARD * factor) as f32, decades: factor.log10() as f32 }
    }

    /// `log10(|v| + 1e-20)`; exact zeros are -20.
    #[inline(always)]
    pub(super) fn decades<T: Real, const W: usize, const FMA: bool>(&self, v: ComplexLanes<T, W>) -> Lanes<f32, W> {
        let v = v.scaled(Lanes::splat(T::of(self.factor)));
        let power = v.re.mul_add::<FMA>(v.re, v.im * v.im);
        let mut out = Lanes::splat(0.0);
        for i in 0..W {
            let magnitude = (power.0[i].wide() as f32).sqrt() + self.guard;
            let value = log10::<FMA>(magnitude) - self.decades;
            out.0[i] = if magnitude > 0.0 { value } else { LOG_GUARD.log10() as f32 };
        }
        out
    }
}

/// log10 of a positive normal number, within 4e-6 for results below 32.
///
/// `v = 2^e m` with m in [0.707, 1.414), and `ln m = 2 artanh((m - 1)/(m + 1))` by its series, whose argument is below 0.172.
#[inline(always)]
fn log10<const FMA: bool>(v: f32) -> f32 {
    const HALF_ROOT: i32 = 0x3f35_04f3; // bits of sqrt(1/2)
    let bits = v.to_bits() as i32;
    let exponent = (bits - HALF_ROOT) >> 23;
    let m = f32::from_bits((bits - (exponent << 23)) as u32);
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let fused = |a: f32, b: f32, c: f32| if FMA { a.mul_add(b, c) } else { a * b + c };
    let series = fused(fused(fused(fused(s2, 1.0 / 9.0, 1.0 / 7.0), s2, 1.0 / 5.0), s2, 1.0 / 3.0), s2, 1.0);
    fused(exponent as f32, std::f32::consts::LOG10_2, s * series * (2.0 * std::f32::consts::LOG10_E))
}

/// Smallest and largest value seen by each lane.
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
    pub(super) fn take(&mut self, v: Lanes<f32, W>) {
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
    for (from, to) in [(positive, high), (negative, low)] {
        for (from, to) in from.chunks(W).zip(to.chunks_mut(W)) {
            let mut v = ComplexLanes::<T, W>::zero();
            for (i, (re, im)) in v.re.0.iter_mut().zip(&mut v.im.0).enumerate() {
                // A short last chunk repeats its first cell, so that the extremes stay right.
                let c = from[if i < from.len() { i } else { 0 }];
                (*re, *im) = (c.re, c.im);
            }
            let d = log.decades::<T, W, FMA>(v);
            extremes.take(d);
            to.copy_from_slice(&d.0[..from.len()]);
        }
    }
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
