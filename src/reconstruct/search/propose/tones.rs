//! Ranges from a single chirp of a single element.
//!
//! At one element each reflector is a pure tone, in the near field too. ESPRIT (R. Roy and T. Kailath, "ESPRIT: estimation of signal parameters via
//! rotational invariance techniques", 1989) on the Hankel matrix of the chirp resolves them without a grid, as finely as the noise allows. The signal
//! subspace comes from a random projection (N. Halko, P. G. Martinsson, J. A. Tropp, "Finding structure with randomness", 2011), which costs little
//! where the tones are few.

use crate::signal::floor::unit_noise;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Rows of the Hankel matrix, as a part of the chirp's samples.
const HANKEL_ROWS_PART: f64 = 0.55;

/// Least number of samples of a chirp.
const MIN_SAMPLES: usize = 32;

/// Columns of the first random projection.
const FIRST_COLUMNS: usize = 24;

/// Ratio of the numbers of columns of a projection and of a wider one.
const COLUMN_RATIO: f64 = 1.5;

/// Least number of singular values in the noise for a projection that is wide enough.
const NOISE_COLUMNS: usize = 4;

/// Columns for tones not far above the noise, beside those far above.
const WEAK_TONE_COLUMNS: usize = 16;

/// Least singular value of a tone over the mean of the largest one of noise.
const MIN_TONE_OVER_NOISE: f64 = 1.6;

/// Least norm of a projection's column with strong tones, over that of its noise.
const MIN_STRONG_OVER_NOISE: f64 = 4.0;

/// Largest growth or decay of a tone, nepers a sample. Faster ones are several tones that are not resolved.
const MAX_GROWTH_NEPERS: f64 = 2e-2;

/// A tone: `exp(j tau bins n / samples + growth n)` in sample n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Frequency, range bins from 0 to the number of samples.
    pub bins: f64,
    /// Growth of the amplitude, nepers a sample; 0 for a single echo.
    pub growth: f64,
}

/// Seed of the projection, so that the same samples have the same tones.
const SEED: u64 = 0x70_6e_65_73;

/// The tones of a chirp, `[samples]`, over white noise of `noise_variance` a sample; `None` where there are more than the chirp can resolve.
pub fn tones(chirp: &[Complex64], noise_variance: f64) -> Option<Vec<Tone>> {
    let samples = chirp.len();
    if samples < MIN_SAMPLES {
        return None;
    }
    let basis = signal_subspace(chirp, noise_variance)?;
    if basis.ncols() == 0 {
        return Some(Vec::new());
    }
    let phasors = rotation(&basis).eigenvalues().ok()?;
    let tone = |z: &Complex64| Tone { bins: (z.arg() / TAU).rem_euclid(1.0) * samples as f64, growth: z.norm().ln() };
    Some(phasors.iter().map(tone).filter(|tone| tone.growth.abs() < MAX_GROWTH_NEPERS).collect())
}

/// The least-squares matrix that maps all rows of an orthonormal basis but the last to all but the first. The Gram matrix of the former is the identity
/// minus the product of one row, so that its inverse is known.
fn rotation(basis: &Mat<Complex64>) -> Mat<Complex64> {
    let (rows, count) = (basis.nrows(), basis.ncols());
    let product = basis.subrows(0, rows - 1).adjoint() * basis.subrows(1, rows - 1);
    let last = basis.subrows(rows - 1, 1);
    // 0 where one tone is a pulse in the last row.
    let remaining = (1.0 - last.squared_norm_l2()).max(f64::EPSILON);
    let of_last = last * &product;
    Mat::from_fn(count, count, |i, j| product[(i, j)] + last[(0, i)].conj() * of_last[(0, j)] / remaining)
}

/// An orthonormal basis of the signal subspace of the chirp's Hankel matrix, `[rows, tones]`; `None` where the matrix is too small for the tones.
fn signal_subspace(chirp: &[Complex64], noise_variance: f64) -> Option<Mat<Complex64>> {
    let rows = (HANKEL_ROWS_PART * chirp.len() as f64) as usize;
    let columns = chirp.len() - rows + 1;
    let hankel = Mat::from_fn(rows, columns, |i, j| chirp[i + j]);
    let largest_of_noise = noise_variance.sqrt() * ((rows as f64).sqrt() + (columns as f64).sqrt());
    let least = MIN_TONE_OVER_NOISE * largest_of_noise;
    let all_noise = (noise_variance * (rows * columns) as f64).sqrt();
    let max_width = columns - NOISE_COLUMNS;
    let mut width = FIRST_COLUMNS.min(max_width);
    let mut projected: Mat<Complex64> = Mat::zeros(rows, 0);
    loop {
        let known = projected.ncols();
        let random: Vec<Complex64> = (known..width).flat_map(|j| unit_noise(SEED, j).take(columns)).collect();
        let more = &hankel * Mat::from_fn(columns, width - known, |i, j| random[j * columns + i]);
        projected.resize_with(rows, width, |i, j| more[(i, j - known)]);
        let qr = projected.qr();
        let wider = ((COLUMN_RATIO * width as f64) as usize).min(max_width);
        let is_strong = |column: usize| qr.thin_R()[(column, column)].norm() > MIN_STRONG_OVER_NOISE * all_noise;
        // The last columns add far more than noise, so there are more tones than columns.
        if (width - NOISE_COLUMNS..width).all(is_strong) {
            if width == max_width {
                return None;
            }
            width = wider;
            continue;
        }
        let range = qr.compute_thin_Q();
        // Columns after the last large one contain weak tones and noise.
        let strong = (0..width).rev().find(|column| is_strong(*column)).map_or(0, |column| column + 1);
        let enough = Some(strong + WEAK_TONE_COLUMNS).filter(|enough| *enough < width);
        for count in enough.into_iter().chain([width]) {
            let range = range.subcols(0, count);
            let svd = (range.adjoint() * &hankel).thin_svd().ok()?;
            let tones = svd.S().column_vector().iter().take_while(|value| value.re > least).count();
            if tones + NOISE_COLUMNS <= count {
                return Some(range * svd.U().subcols(0, tones));
            }
        }
        if width == max_width {
            return None;
        }
        width = wider;
    }
}

/// Least-squares complex gains of `tones` in a chirp, referred to its middle.
pub fn gains_of_tones(chirp: &[Complex64], tones: &[Tone]) -> Vec<Complex64> {
    if tones.is_empty() {
        return Vec::new();
    }
    let samples = chirp.len() as f64;
    let middle = (samples - 1.0) / 2.0;
    let at =
        |tone: &Tone, n: f64| Complex64::from_polar((tone.growth * n).exp(), TAU * (tone.bins * n / samples).fract());
    let columns = Mat::from_fn(chirp.len(), tones.len(), |n, l| at(&tones[l], n as f64 - middle));
    let gains = columns.qr().solve_lstsq(Mat::from_fn(chirp.len(), 1, |n, _| chirp[n]));
    (0..tones.len()).map(|l| gains[(l, 0)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chirp(tones: &[[f64; 2]], noise: f64) -> Vec<Complex64> {
        let wave = |n: usize| -> Complex64 {
            tones.iter().map(|[bins, size]| Complex64::cis(TAU * bins * n as f64 / 512.0) * *size).sum()
        };
        unit_noise(7, 3).take(512).enumerate().map(|(n, v)| v * noise + wave(n)).collect()
    }

    #[test]
    fn close_tones_ten_decades_below_the_strongest_are_told_apart() {
        let sizes = [[10.0, 1.0], [10.2, 0.5], [10.45, -0.7], [300.25, 1e-6], [511.9, 0.1]];
        let found = tones(&chirp(&sizes, 1e-13), 1e-26).unwrap();
        assert_eq!(found.len(), sizes.len(), "{found:?}");
        for [bins, _] in sizes {
            assert!(found.iter().any(|f| (f.bins - bins).abs() < 1e-5), "{bins} in {found:?}");
        }
        let exact: Vec<Tone> = sizes.iter().map(|t| Tone { bins: t[0], growth: 0.0 }).collect();
        let middle = 511.0 / 2.0 / 512.0;
        let gains = gains_of_tones(&chirp(&sizes, 0.0), &exact);
        assert_eq!(gains.len(), sizes.len());
        for ([bins, size], gain) in sizes.iter().zip(gains) {
            assert!((gain - Complex64::cis(TAU * bins * middle) * size).norm() < 1e-9, "{bins}: {gain}");
        }
    }

    /// So many tones of unlike sizes: a comb of equal tones is a few pulses, which have no tone at all.
    fn comb(count: usize) -> Vec<[f64; 2]> {
        let size = |i: usize| 1.0 + 0.5 * (1.7 * (i * i) as f64).sin();
        (0..count).map(|i| [i as f64 * 512.0 / count as f64, size(i)]).collect()
    }

    #[test]
    fn more_tones_widen_the_projection_until_they_are_refused() {
        let found = |count| tones(&chirp(&comb(count), 1e-12), 1e-24).map(|found| found.len());
        assert_eq!([100, 300].map(found), [Some(100), None]);
    }

    #[test]
    fn noise_has_no_tone() {
        assert_eq!(tones(&chirp(&[], 1e-3), 1e-6), Some(Vec::new()));
    }
}
