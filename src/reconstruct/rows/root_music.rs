//! root-MUSIC: directions as roots of a polynomial, and the whole array continued from them.

use super::covariance::{diagonal_sums, smoothed, subarray_len, subspaces};
use super::method::{Render, RowMethod};
use super::row::RowSnapshot;
use faer::Mat;
use num_complex::Complex64;

/// Directions of each end and range row from the roots of MUSIC's null polynomial; amplitudes by least squares; the row of the map is that of
/// the whole array for those waves.
///
/// A. J. Barabell, "Improving the resolution performance of eigenstructure-based direction-finding algorithms", ICASSP 1983.
pub const ROOT_MUSIC: RowMethod = RowMethod {
    name: "root-music",
    description: "directions of each end and range row as polynomial roots, and the array continued from them",
    eta: 0.665, // by examples/choose_eta.rs
    estimate: continued,
    render: Render::Spectrum,
};

/// The peaks of [`ROOT_MUSIC`], rendered.
pub const ROOT_MUSIC_PEAKS: RowMethod = RowMethod {
    name: "root-music-peaks",
    description: "the directions of root-music, moved to where their echoes fit both ends best, and the exact map of them",
    eta: 0.756, // by examples/choose_eta.rs
    render: Render::Peaks,
    ..ROOT_MUSIC
};

/// Turns of phase per element of each wave: the roots inside the unit circle that are nearest to it.
fn directions(row: &RowSnapshot) -> Option<Vec<f64>> {
    let covariance = smoothed(&row.snapshots, subarray_len(row.own().len()));
    let subspaces = subspaces(&covariance, row)?;
    let sums = diagonal_sums(&subspaces.noise);
    // z^(n-1) a^H Q a as a polynomial in z = exp(j w), lowest power first.
    let coefficients: Vec<Complex64> =
        sums.iter().skip(1).rev().map(Complex64::conj).chain(sums.iter().copied()).collect();
    let mut inside: Vec<Complex64> = roots(&coefficients)?.into_iter().filter(|z| z.norm() <= 1.0).collect();
    inside.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    Some(inside.iter().take(subspaces.signals.ncols()).map(|z| z.arg() / std::f64::consts::TAU).collect())
}

/// Roots of a polynomial, lowest power first: the eigenvalues of its companion matrix.
fn roots(coefficients: &[Complex64]) -> Option<Vec<Complex64>> {
    let degree = coefficients.len() - 1;
    let leading = coefficients[degree];
    let largest = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.norm()));
    // Without this cut the companion matrix would be full of rounding errors.
    if leading.norm() <= largest * 1e-14 {
        return None;
    }
    let companion = Mat::from_fn(degree, degree, |i, j| {
        if j == degree - 1 { -coefficients[i] / leading } else { Complex64::from(if i == j + 1 { 1.0 } else { 0.0 }) }
    });
    companion.eigenvalues().ok()
}

fn continued(row: &RowSnapshot) -> Option<Vec<f64>> {
    row.continued(&directions(row)?)
}

#[cfg(test)]
mod tests {
    use super::super::row::with_waves;
    use super::*;

    #[test]
    fn roots_of_a_known_polynomial() {
        // (z - 1)(z - 2j) = z^2 - (1 + 2j) z + 2j
        let c = [Complex64::new(0.0, 2.0), Complex64::new(-1.0, -2.0), Complex64::new(1.0, 0.0)];
        let mut found = roots(&c).unwrap();
        found.sort_by(|a, b| a.im.total_cmp(&b.im));
        assert!((found[0] - Complex64::new(1.0, 0.0)).norm() < 1e-12);
        assert!((found[1] - Complex64::new(0.0, 2.0)).norm() < 1e-12);
    }

    #[test]
    fn directions_need_no_grid() {
        let turns = [0.12345, 0.15]; // a third of a beamwidth apart
        let waves = [(turns[0], 1.0), (turns[1], 0.7)];
        let mut found = with_waves(&waves, directions).unwrap();
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2);
        for (f, t) in found.iter().zip(turns) {
            assert!((f - t).abs() < 1e-6, "{found:?}");
        }
        let power = with_waves(&waves, continued).unwrap();
        let strongest = (0..1024).max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap();
        assert_eq!(strongest, (turns[0] * 1024.0f64).round() as usize);
    }
}
