//! Covariance of one range row from very few snapshots, by spatial smoothing.

use faer::linalg::solvers::SelfAdjointEigen;
use faer::{Mat, Side};
use num_complex::Complex64;

use super::row::RowSnapshot;
use crate::maps::Spectrum;

/// Longest sub-array: work grows with the cube of its elements.
const MAX_SUBARRAY_ELEMENTS: usize = 64;

/// Elements of the sub-arrays over which a line of `elements` is smoothed: two thirds are a compromise of aperture and averages.
pub(super) fn subarray_len(elements: usize) -> usize {
    (2 * elements / 3).clamp(2, MAX_SUBARRAY_ELEMENTS)
}

/// Covariance over sub-arrays of `subarray` neighbouring elements, forward and backward, averaged over all their places and over
/// `snapshots`, `[subarray, subarray]`.
///
/// Echoes of one chirp are coherent, so that a single snapshot has rank 1; smoothing restores a rank for each of them
/// (T.-J. Shan, M. Wax and T. Kailath, "On spatial smoothing for direction-of-arrival estimation of coherent signals", 1985;
/// S. U. Pillai and B. H. Kwon, "Forward/backward spatial smoothing techniques for coherent signal identification", 1989).
pub(super) fn smoothed(snapshots: &[&[Complex64]], subarray: usize) -> Mat<Complex64> {
    let mut sum = Mat::<Complex64>::zeros(subarray, subarray);
    let mut count = 0.0;
    for snapshot in snapshots {
        for part in snapshot.windows(subarray) {
            for j in 0..subarray {
                for i in 0..subarray {
                    let forward = part[i] * part[j].conj();
                    let backward = part[subarray - 1 - i].conj() * part[subarray - 1 - j];
                    sum[(i, j)] += forward + backward;
                }
            }
            count += 2.0;
        }
    }
    Mat::from_fn(subarray, subarray, |i, j| sum[(i, j)] / f64::max(count, 1.0))
}

/// Signal and noise subspaces of a covariance, separated by its eigenvalues.
pub(super) struct Subspaces {
    /// Projector onto the noise subspace, `E_n E_n^H`, `[n, n]`.
    pub noise: Mat<Complex64>,
    /// Eigenvectors of the signals, `[n, signals]`; from 1 to n - 1 of them.
    pub signals: Mat<Complex64>,
}

/// Least ratio of a signal's eigenvalue to the noise.
const MIN_SIGNAL_OVER_NOISE: f64 = 10.0;

/// Splits `covariance` of `row` by its eigenvalues: signals are those above the measured noise, and above the power of one echo outside its own
/// direction ([`RowSnapshot::not_plane`]). `None` where the decomposition fails.
pub(super) fn subspaces(covariance: &Mat<Complex64>, row: &RowSnapshot<'_>) -> Option<Subspaces> {
    let n = covariance.nrows();
    let eigen = SelfAdjointEigen::new(covariance.as_ref(), Side::Lower).ok()?;
    let values: Vec<f64> = eigen.S().column_vector().iter().map(|v| v.re).collect();
    let vectors = eigen.U();
    let largest = values.iter().copied().fold(0.0, f64::max);
    let threshold = (largest * row.not_plane).max(MIN_SIGNAL_OVER_NOISE * row.noise_variance);
    let count = values.iter().filter(|v| **v > threshold).count().clamp(1, n - 1);
    // Eigenvalues rise, so that the noise subspace comes first.
    let noise = vectors.subcols(0, n - count);
    Some(Subspaces { noise: noise * noise.adjoint(), signals: vectors.subcols(n - count, count).to_owned() })
}

/// Coefficients `c[m]`, m = 0..n, of `a^H Q a = c[0] + 2 Re sum_m c[m] exp(j w m)` for a plane wave a and Hermitian Q: Q's diagonal sums.
pub(super) fn diagonal_sums(q: &Mat<Complex64>) -> Vec<Complex64> {
    let n = q.nrows();
    (0..n).map(|m| (0..n - m).map(|i| q[(i, i + m)]).sum()).collect()
}

/// `a^H Q a` for the plane wave of every column, in the order of the transform; never negative.
pub(super) fn quadratic_form(q: &Mat<Complex64>, spectrum: &Spectrum) -> Vec<f64> {
    let sums = diagonal_sums(q);
    let constant = sums[0].re;
    spectrum.of(sums.iter().map(Complex64::conj)).into_iter().map(|v| (2.0 * v.re - constant).max(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::row::with_waves;
    use super::*;
    use std::f64::consts::TAU;

    fn wave(n: usize, turns: f64) -> Vec<Complex64> {
        (0..n).map(|i| Complex64::cis(TAU * turns * i as f64)).collect()
    }

    #[test]
    fn the_quadratic_form_is_what_its_definition_says() {
        let q = Mat::from_fn(5, 5, |i, j| {
            let (a, b) = (i.min(j) as f64, i.max(j) as f64);
            Complex64::new(1.0 + a * b, if i < j { b - a } else { a - b })
        });
        let spectrum = Spectrum::new(16);
        for (k, fast) in quadratic_form(&q, &spectrum).into_iter().enumerate() {
            let a = wave(5, k as f64 / 16.0);
            let slow: Complex64 =
                (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).map(|(i, j)| a[i].conj() * q[(i, j)] * a[j]).sum();
            assert!((slow.re.max(0.0) - fast).abs() < 1e-9 && slow.im.abs() < 1e-9, "{k}: {slow} {fast}");
        }
    }

    #[test]
    fn smoothing_restores_the_rank_of_coherent_waves() {
        let waves = [(0.1, 1.0), (0.16, 0.5)];
        let found = with_waves(&waves, |row| subspaces(&smoothed(&[row.own()], 8), row).unwrap());
        assert_eq!(found.signals.ncols(), 2);
        for (turns, _) in waves {
            let a = wave(8, turns);
            let left: Complex64 = (0..8)
                .flat_map(|i| (0..8).map(move |j| (i, j)))
                .map(|(i, j)| a[i].conj() * found.noise[(i, j)] * a[j])
                .sum();
            assert!(left.norm() < 1e-9, "{turns} is orthogonal to the noise subspace: {left}");
        }
    }
}
