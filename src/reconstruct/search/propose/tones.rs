//! Ranges from a single chirp of a single element.
//!
//! One element has every reflector at one distance: its chirp is a sum of as many pure tones, for any near field across the array. ESPRIT (R.
//! Roy and T. Kailath, "ESPRIT: estimation of signal parameters via rotational invariance techniques", 1989) on the Hankel matrix of the chirp
//! separates them without a grid and without a search, as finely as the noise allows. The signal subspace comes from a random projection (N.
//! Halko, P. G. Martinsson, J. A. Tropp, "Finding structure with randomness", 2011), which costs little where the tones are few.

use crate::signal::floor::unit_noise;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Part of the chirp's samples that are rows of the Hankel matrix.
const ROWS: f64 = 0.55;

/// Fewest samples of a chirp for this method.
const LEAST_SAMPLES: usize = 32;

/// Columns of the first random projection.
const FIRST_COLUMNS: usize = 24;

/// Growth of the projection where its columns were not enough.
const GROWTH: f64 = 1.5;

/// Singular values that must lie in the noise before the projection counts as wide enough.
const SPARE: usize = 4;

/// Columns that are enough for tones not far above the noise.
const WEAK: usize = 16;

/// A singular value above this many times the largest that noise has in the mean belongs to a tone.
const ABOVE_NOISE: f64 = 1.6;

/// A column of the projection above this many times all noise in it holds tones.
const FAR_ABOVE_NOISE: f64 = 4.0;

/// Largest growth or decay of a tone a sample: faster ones stand for several tones that are not separated.
const STEADY: f64 = 2e-2;

/// A tone: `exp(j tau bins n / samples + growth n)` in sample n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Frequency, range bins from 0 to the number of samples.
    pub bins: f64,
    /// Relative growth a sample. That of an echo is 0; several that are not told apart sound like one that grows or decays.
    pub growth: f64,
}

/// Seed of the projection: the same samples have the same tones.
const SEED: u64 = 0x70_6e_65_73;

/// The tones of a chirp over white noise of `noise_variance` a sample; `None` where there are more than the chirp can tell
/// apart.
pub fn tones(chirp: &[Complex64], noise_variance: f64) -> Option<Vec<Tone>> {
    let samples = chirp.len();
    if samples < LEAST_SAMPLES {
        return None;
    }
    let basis = signal_subspace(chirp, noise_variance)?;
    if basis.ncols() == 0 {
        return Some(Vec::new());
    }
    let phasors = rotation(&basis).eigenvalues().ok()?;
    let tone = |z: &Complex64| Tone { bins: (z.arg() / TAU).rem_euclid(1.0) * samples as f64, growth: z.norm().ln() };
    Some(phasors.iter().map(tone).filter(|tone| tone.growth.abs() < STEADY).collect())
}

/// The least-squares solution of a map from all rows of an orthonormal basis but the last to all but the first. The Gram matrix of the former is
/// the identity less one row's product, so that its inverse is known.
fn rotation(basis: &Mat<Complex64>) -> Mat<Complex64> {
    let (rows, count) = (basis.nrows(), basis.ncols());
    let turned = basis.subrows(0, rows - 1).adjoint() * basis.subrows(1, rows - 1);
    let last = basis.subrows(rows - 1, 1);
    // The difference is 0 where one tone is a pulse in the last row.
    let left = (1.0 - last.squared_norm_l2()).max(f64::EPSILON);
    let missed = last * &turned;
    Mat::from_fn(count, count, |i, j| turned[(i, j)] + last[(0, i)].conj() * missed[(0, j)] / left)
}

/// An orthonormal basis of the part of the chirp's Hankel matrix above the noise, a column for each tone.
fn signal_subspace(chirp: &[Complex64], noise_variance: f64) -> Option<Mat<Complex64>> {
    let rows = (ROWS * chirp.len() as f64) as usize;
    let columns = chirp.len() - rows + 1;
    let hankel = Mat::from_fn(rows, columns, |i, j| chirp[i + j]);
    let largest_of_noise = noise_variance.sqrt() * ((rows as f64).sqrt() + (columns as f64).sqrt());
    let least = ABOVE_NOISE * largest_of_noise;
    let all_noise = (noise_variance * (rows * columns) as f64).sqrt();
    let most_width = columns - SPARE;
    let mut width = FIRST_COLUMNS.min(most_width);
    let mut projected: Mat<Complex64> = Mat::zeros(rows, 0);
    loop {
        let known = projected.ncols();
        let random: Vec<Complex64> = (known..width).flat_map(|j| unit_noise(SEED, j).take(columns)).collect();
        let more = &hankel * Mat::from_fn(columns, width - known, |i, j| random[j * columns + i]);
        projected.resize_with(rows, width, |i, j| more[(i, j - known)]);
        let qr = projected.qr();
        let wider = ((GROWTH * width as f64) as usize).min(most_width);
        let brought = |column: usize| qr.thin_R()[(column, column)].norm();
        // The last columns still add far more than noise: there are more tones than columns.
        if (width - SPARE..width).all(|column| brought(column) > FAR_ABOVE_NOISE * all_noise) {
            if width == most_width {
                return None;
            }
            width = wider;
            continue;
        }
        let range = qr.compute_thin_Q();
        // Columns after the last large one hold weak tones and noise.
        let strong =
            (0..width).rev().find(|column| brought(*column) > FAR_ABOVE_NOISE * all_noise).map_or(0, |c| c + 1);
        let enough = Some(strong + WEAK).filter(|enough| *enough < width);
        for kept in enough.into_iter().chain([width]) {
            let range = range.subcols(0, kept);
            let svd = (range.adjoint() * &hankel).thin_svd().ok()?;
            let count = svd.S().column_vector().iter().take_while(|value| value.re > least).count();
            if count + SPARE <= kept {
                return Some(range * svd.U().subcols(0, count));
            }
        }
        if width == most_width {
            return None;
        }
        width = wider;
    }
}

/// Gains of these tones in a chirp, taken at its middle.
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
    fn more_tones_widen_the_projection() {
        assert_eq!(tones(&chirp(&comb(100), 1e-12), 1e-24).unwrap().len(), 100);
    }

    #[test]
    fn too_many_tones_are_refused() {
        assert_eq!(tones(&chirp(&comb(300), 1e-12), 1e-24), None);
    }

    #[test]
    fn noise_has_no_tone() {
        assert_eq!(tones(&chirp(&[], 1e-3), 1e-6), Some(Vec::new()));
    }
}
