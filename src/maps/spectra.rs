//! Transforms of any length without scaling or window, for methods that form their own beams.

use crate::signal::simd::Simd;
use ndarray::{Array2, ArrayView2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;
use rustfft::Fft;
use std::sync::Arc;

/// A forward DFT of fixed length, `X[k] = sum_n x[n] exp(-2 pi j k n / len)`; not scaled.
#[derive(Clone)]
pub struct Spectrum {
    fft: Arc<dyn Fft<f64>>,
}

impl Spectrum {
    pub fn new(len: usize) -> Self {
        Spectrum { fft: Simd::chosen().forward_fft(len) }
    }

    pub fn len(&self) -> usize {
        self.fft.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The transform of at most [`Spectrum::len`] values, padded with zeros.
    pub fn of(&self, values: impl IntoIterator<Item = Complex64>) -> Vec<Complex64> {
        let mut buffer: Vec<Complex64> = values.into_iter().take(self.len()).collect();
        buffer.resize(self.len(), Complex64::default());
        self.fft.process(&mut buffer);
        buffer
    }

    /// The transform with index `middle` of `values` at n = 0: its phase changes little from one k to the next, so that it can be interpolated.
    fn around(&self, middle: usize, values: impl Iterator<Item = Complex64>) -> Vec<Complex64> {
        let mut buffer = vec![Complex64::default(); self.len()];
        for (n, v) in values.enumerate() {
            let at = (n + self.len() - middle) % self.len();
            buffer[at] = v;
        }
        self.fft.process(&mut buffer);
        buffer
    }
}

/// Zero-padded two-dimensional spectrum of neighbouring channels `[channels, samples]`: `[rows, columns]`, rows over range from
/// bin 0, columns over cos(theta) rising from -1, with sample `samples / 2` and element `channels / 2` as origin of the phase.
///
/// `window` weights the samples. `rows` and `columns` must be at least the number of samples and channels.
pub fn centred_spectrum(
    samples: ArrayView2<'_, Complex64>,
    window: &[f64],
    rows: usize,
    columns: usize,
) -> Array2<Complex64> {
    let (over_range, over_angle) = (Spectrum::new(rows), Spectrum::new(columns));
    let (channels, length) = samples.dim();
    let profiles: Vec<Vec<Complex64>> = samples
        .outer_iter()
        .map(|channel| over_range.around(length / 2, channel.iter().zip(window).map(|(v, w)| v * w)))
        .collect();
    let mut spectrum = Array2::zeros((rows, columns));
    spectrum.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each(|(row, mut out)| {
        let beams = over_angle.around(channels / 2, profiles.iter().map(|p| p[row]));
        for (k, v) in beams.into_iter().enumerate() {
            out[(k + columns / 2) % columns] = v;
        }
    });
    spectrum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_plane_wave_peaks_with_phase_zero_where_it_should() {
        let (channels, length, rows, columns) = (5, 16, 64, 40);
        let (range, angle) = (11, 7);
        let samples = Array2::from_shape_fn((channels, length), |(m, n)| {
            let turns =
                (n as f64 - 8.0) * range as f64 / rows as f64 + (m as f64 - 2.0) * angle as f64 / columns as f64;
            Complex64::cis(TAU * turns)
        });
        let spectrum = centred_spectrum(samples.view(), &[1.0; 16], rows, columns);
        let (at, peak) = spectrum.indexed_iter().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
        assert_eq!(at, (range, angle + columns / 2));
        assert!((peak - Complex64::new(80.0, 0.0)).norm() < 1e-9);
    }
}
