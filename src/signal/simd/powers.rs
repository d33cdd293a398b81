//! Powers and logarithms of ten over whole slices, written without branches so that the compiler vectorises them.

use super::{Kernel, Simd};

struct Each<'a, F>(&'a mut [f32], F);

impl<F: Fn(f32) -> f32> Kernel for Each<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for v in self.0 {
            *v = self.1(*v);
        }
    }
}

pub fn each(values: &mut [f32], f: impl Fn(f32) -> f32) {
    Simd::chosen().run(Each(values, f));
}

/// Ten to the power of `v`; relative error below 5e-6 for values between -37 and 37.
#[inline(always)]
pub fn power_of_ten(v: f32) -> f32 {
    let x = (v * std::f32::consts::LOG2_10).clamp(-125.0, 126.0);
    // Adding 1.5 * 2^23 rounds to the nearest integer.
    const ROUNDING_SUMMAND: f32 = 12_582_912.0;
    let rounded = x + ROUNDING_SUMMAND;
    let whole = rounded - ROUNDING_SUMMAND;
    let f = (x - whole) * std::f32::consts::LN_2;
    let series =
        1.0 + f * (1.0 + f * (1.0 / 2.0 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f * (1.0 / 720.0))))));
    // The lowest bits of `rounded` are that integer. A cast would check for overflow, which can't be vectorised.
    series * f32::from_bits((rounded.to_bits() << 23).wrapping_add(127 << 23))
}

/// log10 of a positive, normal number; absolute error below 6e-6 between -36 and 36.
#[inline(always)]
pub fn logarithm(v: f32) -> f32 {
    // Shifted so that the mantissa lies in [sqrt(1/2), sqrt(2)).
    let shifted = v.to_bits().wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32) >> 23;
    let mantissa = f32::from_bits((shifted & 0x007f_ffff).wrapping_add(0x3f35_04f3));
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let s2 = s * s;
    let ln = 2.0 * s * (1.0 + s2 * (1.0 / 3.0 + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0 + s2 * (1.0 / 9.0)))));
    exponent as f32 * std::f32::consts::LOG10_2 + ln * std::f32::consts::LOG10_E
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten() {
        let x: Vec<f32> = (-3600..=3600).map(|i| i as f32 / 100.0).collect();
        for simd in Simd::available() {
            let mut y = x.clone();
            simd.run(Each(&mut y, power_of_ten));
            for (x, y) in x.iter().zip(y) {
                let exact = 10f64.powf(f64::from(*x));
                assert!((f64::from(y) / exact - 1.0).abs() < 5e-6, "{simd}: 10^{x}: {y}");
            }
        }
    }

    #[test]
    fn logarithms() {
        let x: Vec<f32> = (-3600..=3600).map(|i| 10f32.powf(i as f32 / 100.0)).collect();
        for simd in Simd::available() {
            let mut y = x.clone();
            simd.run(Each(&mut y, logarithm));
            for (x, y) in x.iter().zip(y) {
                assert!((f64::from(y) - f64::from(*x).log10()).abs() < 6e-6, "{simd}: log10 {x}: {y}");
            }
        }
    }
}
