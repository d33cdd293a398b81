//! Vectors of lanes, one lane an element of the array, and the choice of instruction set at run time.
//!
//! A [`Kernel`] is written once over [`Lanes`] and compiled for baseline x86-64 (or any other machine), for AVX2 with fused
//! multiply-add and for AVX-512. Its body must be `#[inline(always)]`, as must everything it calls, or it keeps the baseline's instructions.
//! A vector is 64 bytes on any machine, 16 f32 or 8 f64; narrower machines use several registers for it.

mod instructions;
pub mod powers;

pub use instructions::{Kernel, SIMD_VARIABLE, Simd, SimdError};
pub use rustfft::Fft;

use num_complex::Complex;
use rustfft::FftNum;
use std::ops::{Add, Mul, Neg, Sub};

/// f32 or f64: the two precisions of computations after that of the phase.
pub trait Real: FftNum + Copy + Default + PartialOrd + Sub<Output = Self> + Add<Output = Self> {
    /// Terms of the Taylor series of sine and cosine up to an eighth of a turn, lowest first.
    const SIN: &'static [f64];
    const COS: &'static [f64];
    /// Distance from 1 to the next value.
    const EPSILON: f64;
    const NAME: &'static str;
    fn of(v: f64) -> Self;
    fn wide(self) -> f64;
    /// `self * b + c`, rounded once.
    fn fused(self, b: Self, c: Self) -> Self;
}

/// Series of sin(2 pi r) / r and cos(2 pi r) in r^2: `(-1)^k (2 pi)^m / m!`.
const SIN_SERIES: [f64; 9] = series(1);
const COS_SERIES: [f64; 9] = series(0);

const fn series(odd: usize) -> [f64; 9] {
    let mut terms = [0.0; 9];
    let mut k = 0;
    while k < 9 {
        let mut term = if k % 2 == 0 { 1.0 } else { -1.0 };
        let mut m = 1;
        while m <= 2 * k + odd {
            term *= std::f64::consts::TAU / m as f64;
            m += 1;
        }
        terms[k] = term;
        k += 1;
    }
    terms
}

macro_rules! real {
    ($t:ty, $name:literal, $terms:expr) => {
        impl Real for $t {
            const SIN: &'static [f64] = SIN_SERIES.split_at($terms).0;
            const COS: &'static [f64] = COS_SERIES.split_at($terms).0;
            const EPSILON: f64 = <$t>::EPSILON as f64;
            const NAME: &'static str = $name;
            #[inline(always)]
            fn of(v: f64) -> Self {
                v as $t
            }
            #[inline(always)]
            fn wide(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn fused(self, b: Self, c: Self) -> Self {
                self.mul_add(b, c)
            }
        }
    };
}

real!(f32, "f32", 6);
real!(f64, "f64", 9);

/// Lanes of an f32 vector.
pub const LANES_F32: usize = 16;
/// Lanes of an f64 vector.
pub const LANES_F64: usize = 8;

/// `W` numbers, one a lane; arithmetic is lane by lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const W: usize>(pub [T; W]);

impl<T: Real, const W: usize> Lanes<T, W> {
    #[inline(always)]
    pub fn splat(v: T) -> Self {
        Lanes([v; W])
    }

    #[inline(always)]
    pub fn load(from: &[T]) -> Self {
        let mut lanes = [T::default(); W];
        lanes.copy_from_slice(&from[..W]);
        Lanes(lanes)
    }

    #[inline(always)]
    pub fn store(self, to: &mut [T]) {
        to[..W].copy_from_slice(&self.0);
    }

    #[inline(always)]
    pub fn map(mut self, f: impl Fn(T) -> T) -> Self {
        for v in &mut self.0 {
            *v = f(*v);
        }
        self
    }

    #[inline(always)]
    pub fn zip(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for i in 0..W {
            self.0[i] = f(self.0[i], other.0[i]);
        }
        self
    }

    /// `self * b + c`; rounded once if `FMA`.
    #[inline(always)]
    pub fn mul_add<const FMA: bool>(mut self, b: Self, c: Self) -> Self {
        for i in 0..W {
            self.0[i] = if FMA { self.0[i].fused(b.0[i], c.0[i]) } else { self.0[i] * b.0[i] + c.0[i] };
        }
        self
    }
}

impl<const W: usize> Lanes<f64, W> {
    /// Nearest whole number, ties to even, for magnitudes below 2^51. Two additions on every machine, where `round` may be a call.
    #[inline(always)]
    pub fn nearest(self) -> Self {
        const SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52: adding it leaves no bits for a fraction
        self.map(|v| (v + SHIFT) - SHIFT)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// The smallest and the largest lane.
    #[inline(always)]
    pub(in crate::signal) fn bounds(self) -> (f64, f64) {
        self.0.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
    }

    /// The sum of all lanes, by halves; `W` is a power of two.
    #[inline(always)]
    pub fn total(mut self) -> f64 {
        let mut half = W;
        while half > 1 {
            half /= 2;
            for i in 0..half {
                self.0[i] += self.0[i + half];
            }
        }
        self.0[0]
    }

    #[inline(always)]
    pub fn round_to<T: Real>(self) -> Lanes<T, W> {
        let mut out = Lanes::splat(T::default());
        for i in 0..W {
            out.0[i] = T::of(self.0[i]);
        }
        out
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<T: Real, const W: usize> $trait for Lanes<T, W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);

impl<T: Real, const W: usize> Neg for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| T::default() - v)
    }
}

/// `W` complex numbers, real parts first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct ComplexLanes<T, const W: usize> {
    pub re: Lanes<T, W>,
    pub im: Lanes<T, W>,
}

impl<T: Real, const W: usize> ComplexLanes<T, W> {
    #[inline(always)]
    pub fn zero() -> Self {
        ComplexLanes::splat(Complex::default())
    }

    #[inline(always)]
    pub fn splat(v: Complex<T>) -> Self {
        ComplexLanes { re: Lanes::splat(v.re), im: Lanes::splat(v.im) }
    }

    #[inline(always)]
    pub fn conj(self) -> Self {
        ComplexLanes { re: self.re, im: -self.im }
    }

    #[inline(always)]
    pub fn times<const FMA: bool>(self, b: Self) -> Self {
        ComplexLanes {
            re: self.re.mul_add::<FMA>(b.re, -(self.im * b.im)),
            im: self.re.mul_add::<FMA>(b.im, self.im * b.re),
        }
    }

    #[inline(always)]
    pub fn plus_product<const FMA: bool>(self, a: Self, b: Self) -> Self {
        let re = a.re.mul_add::<FMA>(b.re, self.re);
        let im = a.re.mul_add::<FMA>(b.im, self.im);
        ComplexLanes { re: (-a.im).mul_add::<FMA>(b.im, re), im: a.im.mul_add::<FMA>(b.re, im) }
    }

    #[inline(always)]
    pub fn scaled(self, by: Lanes<T, W>) -> Self {
        ComplexLanes { re: self.re * by, im: self.im * by }
    }
}

impl<T: Real, const W: usize> Add for ComplexLanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        ComplexLanes { re: self.re + b.re, im: self.im + b.im }
    }
}

impl<T: Real, const W: usize> Sub for ComplexLanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        ComplexLanes { re: self.re - b.re, im: self.im - b.im }
    }
}

/// The sum of `terms[k] * x^k`, by Horner's rule.
#[inline(always)]
pub(crate) fn horner<T: Real, const W: usize, const FMA: bool>(terms: &[f64], x: Lanes<T, W>) -> Lanes<T, W> {
    let mut value = Lanes::splat(T::of(terms[terms.len() - 1]));
    for term in terms[..terms.len() - 1].iter().rev() {
        value = value.mul_add::<FMA>(x, Lanes::splat(T::of(*term)));
    }
    value
}

/// `exp(2 pi j t)` of every lane, `|t|` below 2^49. Within two units in the last place of 1.
///
/// Whole quarter turns are removed in f64; the rest, at most an eighth of a turn, is the argument of the Taylor series.
#[inline(always)]
pub fn phasor<T: Real, const W: usize, const FMA: bool>(turns: Lanes<f64, W>) -> ComplexLanes<T, W> {
    let of = |v: f64| Lanes::<f64, W>::splat(v);
    let quarters = (turns * of(4.0)).nearest();
    let rest: Lanes<T, W> = (turns - quarters * of(0.25)).round_to();
    // exp(j pi/2 quarters) is (-1)^half * j^odd, with odd in {-1, 0, 1}: no branch, no table.
    let half = (quarters * of(0.5)).nearest();
    let odd: Lanes<T, W> = (quarters - half * of(2.0)).round_to();
    let halves = half - (half * of(0.5)).nearest() * of(2.0);
    let sign: Lanes<T, W> = (of(1.0) - halves * halves * of(2.0)).round_to();

    let square = rest * rest;
    let sin = rest * horner::<T, W, FMA>(T::SIN, square) * sign;
    let cos = horner::<T, W, FMA>(T::COS, square) * sign;
    let even = Lanes::splat(T::of(1.0)) - odd * odd;
    ComplexLanes { re: even * cos - odd * sin, im: even * sin + odd * cos }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Worst;

    impl Kernel for Worst {
        type Output = [f64; 2];
        #[inline(always)]
        fn run<const FMA: bool>(self) -> [f64; 2] {
            let mut worst = [0.0f64; 2];
            for i in -4000..4000 {
                let t = f64::from(i) / 1777.0;
                let expected = (t.fract() * std::f64::consts::TAU).sin_cos();
                let wide = phasor::<f64, LANES_F64, FMA>(Lanes::splat(t));
                let narrow = phasor::<f32, LANES_F32, FMA>(Lanes::splat(t));
                worst[0] = worst[0].max((wide.re.0[7] - expected.1).hypot(wide.im.0[7] - expected.0));
                worst[1] = worst[1].max((narrow.re.0[0].wide() - expected.1).hypot(narrow.im.0[0].wide() - expected.0));
            }
            worst
        }
    }

    #[test]
    fn phasors_are_exact_on_every_instruction_set() {
        for simd in Simd::available() {
            let [wide, narrow] = simd.run(Worst);
            assert!(wide < 2e-15, "{simd:?}: {wide:e}"); // the reference itself rounds 2 pi t
            assert!(narrow < 1.5e-7, "{simd:?}: {narrow:e}");
        }
    }
}
