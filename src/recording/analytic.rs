//! Real samples as complex ones.

use crate::signal::simd::Simd;
use num_complex::Complex64;

/// The analytic signal of real samples, of `len` samples, half as many at least: the positive half of their spectrum, transformed back.
pub(super) fn analytic(samples: &[Complex64], len: usize) -> Vec<Complex64> {
    let half = samples.len().div_ceil(2);
    if samples.is_empty() || len < half {
        return vec![Complex64::default(); len];
    }
    let mut line = samples.to_vec();
    Simd::chosen().forward_fft::<f64>(samples.len()).process(&mut line);
    // Back by the conjugate of the forward transform of the conjugate; half the amplitude stands in the other half of the spectrum.
    let scale = 2.0 / samples.len() as f64;
    let mut positive = vec![Complex64::default(); len];
    positive.iter_mut().zip(&line[..half]).for_each(|(to, v)| *to = scale * v.conj());
    positive[0] /= 2.0;
    Simd::chosen().forward_fft::<f64>(len).process(&mut positive);
    positive.into_iter().map(|v| v.conj()).collect()
}
