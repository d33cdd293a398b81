//! Sums of two f64 for lanes: error-free transformations (Dekker 1971).

use super::simd::Lanes;

/// An unevaluated sum `hi + lo` with `|lo|` at most half an ulp of `hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Double<V> {
    pub hi: V,
    pub lo: V,
}

impl Double<f64> {
    pub fn reciprocal(a: f64) -> Self {
        let hi = 1.0 / a;
        Double { hi, lo: (-hi).mul_add(a, 1.0) / a }
    }

    fn splat<const W: usize>(self) -> Double<Lanes<f64, W>> {
        Double { hi: Lanes::splat(self.hi), lo: Lanes::splat(self.lo) }
    }
}

impl<const W: usize> Double<Lanes<f64, W>> {
    /// The mean of two numbers, exactly `a` where both are `a`.
    #[inline(always)]
    pub fn mean(a: Self, b: Self) -> Self {
        let total = sum(a.hi, b.hi);
        let total = sum(total.hi, total.lo + (a.lo + b.lo));
        let half = Lanes::splat(0.5);
        Double { hi: total.hi * half, lo: total.lo * half }
    }
}

#[inline(always)]
pub(super) fn sum<const W: usize>(a: Lanes<f64, W>, b: Lanes<f64, W>) -> Double<Lanes<f64, W>> {
    let hi = a + b;
    let t = hi - a;
    Double { hi, lo: (a - (hi - t)) + (b - t) }
}

/// `a * b` exactly: by a fused multiply-add where that is an instruction, else by both halves of the factors' digits (Veltkamp, Dekker).
#[inline(always)]
pub(super) fn product<const W: usize, const FMA: bool>(a: Lanes<f64, W>, b: Lanes<f64, W>) -> Double<Lanes<f64, W>> {
    let hi = a * b;
    if FMA {
        return Double { hi, lo: a.mul_add::<true>(b, -hi) };
    }
    let halves = |v: Lanes<f64, W>| {
        let c = v * Lanes::splat(134_217_729.0); // 2^27 + 1
        let high = c - (c - v);
        (high, v - high)
    };
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    Double { hi, lo: ((ah * bh - hi) + ah * bl + al * bh) + al * bl }
}

/// `rate * distance` minus the nearest multiple of `period`, a small whole number.
#[inline(always)]
pub(super) fn remainder<const W: usize, const FMA: bool>(
    distance: Double<Lanes<f64, W>>,
    rate: Double<f64>,
    period: f64,
) -> Double<Lanes<f64, W>> {
    let rate = rate.splat();
    let p = product::<W, FMA>(distance.hi, rate.hi);
    let low = p.lo + distance.hi * rate.lo + distance.lo * rate.hi;
    let turns = (p.hi * Lanes::splat(1.0 / period)).nearest();
    // The product of two whole numbers is exact.
    Double { hi: p.hi - turns * Lanes::splat(period), lo: low }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_product_does_not_depend_on_fused_multiply_add() {
        let mut v = 0.3f64;
        for _ in 0..1000 {
            v = (v * 1.7 + 0.1) % 3e5;
            let (a, b) = (Lanes([v]), Lanes([v * v + 1.0 / 3.0]));
            assert_eq!(product::<1, true>(a, b), product::<1, false>(a, b));
        }
    }
}
