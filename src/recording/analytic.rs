//! Analytic signals: real samples as complex ones.

use crate::signal::simd::Simd;
use ndarray::{Array, ArrayView, Axis, Dimension};
use num_complex::Complex64;

/// The [`analytic`] signal of each lane along the last axis of `samples`, whose length becomes `len`.
pub(super) fn analytic_lanes<D: Dimension>(samples: ArrayView<'_, Complex64, D>, len: usize) -> Array<Complex64, D> {
    let last = Axis(samples.ndim().saturating_sub(1));
    let mut shape = samples.raw_dim();
    shape[last.index()] = len;
    let mut all = Array::zeros(shape);
    for (row, mut found) in samples.lanes(last).into_iter().zip(all.lanes_mut(last)) {
        found.iter_mut().zip(analytic(&row.to_vec(), len)).for_each(|(to, v)| *to = v);
    }
    all
}

/// Subtracts the mean of each lane along the last axis.
pub(super) fn subtract_mean<D: Dimension>(samples: &mut Array<Complex64, D>) {
    let last = Axis(samples.ndim().saturating_sub(1));
    for mut row in samples.lanes_mut(last) {
        let mean = row.sum() / row.len().max(1) as f64;
        row.mapv_inplace(|v| v - mean);
    }
}

/// The analytic signal of real `samples` at `len` samples, the positive half of their spectrum; zeros where `len` is below half their number.
pub(super) fn analytic(samples: &[Complex64], len: usize) -> Vec<Complex64> {
    let half = samples.len().div_ceil(2);
    if samples.is_empty() || len < half {
        return vec![Complex64::default(); len];
    }
    let mut row = samples.to_vec();
    Simd::chosen().forward_fft::<f64>(samples.len()).process(&mut row);
    // The inverse transform is the conjugate of the forward transform of the conjugate. Factor 2: the negative half had half the amplitude.
    let scale = 2.0 / samples.len() as f64;
    let mut positive = vec![Complex64::default(); len];
    positive.iter_mut().zip(&row[..half]).for_each(|(to, v)| *to = scale * v.conj());
    positive[0] /= 2.0;
    Simd::chosen().forward_fft::<f64>(len).process(&mut positive);
    positive.into_iter().map(|v| v.conj()).collect()
}
