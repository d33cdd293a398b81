//! ESPRIT: directions from the phase step of the signal subspace between neighbouring elements.

use super::covariance::{smoothed, subarray_len, subspaces};
use super::method::{Render, RowMethod};
use super::row::RowSnapshot;
use faer::linalg::solvers::{SelfAdjointEigen, Solve};
use faer::{Mat, Side};
use num_complex::Complex64;

/// Directions of each end and range row by total least squares, from a covariance averaged forward and backward; their peaks rendered.
///
/// R. Roy and T. Kailath, "ESPRIT: estimation of signal parameters via rotational invariance techniques", IEEE Trans. Acoust., Speech,
/// Signal Process. 37, 1989.
pub const ESPRIT: RowMethod = RowMethod {
    name: "esprit",
    description: "directions from how the signals turn from element to element, moved to where their echoes fit both ends best, and \
        the exact map of them",
    eta: 0.752, // by examples/choose_eta.rs
    estimate: |row| row.continued(&directions(row)?),
    render: Render::Peaks,
};

/// Turns of phase per element within which two waves are one: the averaged covariance has eigenvalues in pairs `z`, `1 / conj(z)` of one phase.
const SAME_TURNS: f64 = 1e-6;

/// Turns of phase per element of each wave.
fn directions(row: &RowSnapshot) -> Option<Vec<f64>> {
    let subspaces = subspaces(&smoothed(&row.snapshots, subarray_len(row.own().len())), row)?;
    let signals = subspaces.signals;
    let (n, count) = (signals.nrows(), signals.ncols());
    // All elements but the last, beside all but the first: the same signals, one step on.
    let both =
        Mat::from_fn(n - 1, 2 * count, |i, j| if j < count { signals[(i, j)] } else { signals[(i + 1, j - count)] });
    let product = both.adjoint() * &both;
    let eigen = SelfAdjointEigen::new(product.as_ref(), Side::Lower).ok()?;
    // Eigenvalues rise: the first vectors are orthogonal to both halves together.
    let null = eigen.U().subcols(0, count);
    let (upper, lower) = (null.subrows(0, count), null.subrows(count, count));
    // -upper lower^-1, transposed: its eigenvalues are the same.
    let turned = lower.transpose().to_owned().partial_piv_lu().solve(upper.transpose().to_owned());
    let is_finite = |i: usize| (0..count).all(|j| turned[(i, j)].re.is_finite() && turned[(i, j)].im.is_finite());
    if !(0..count).all(is_finite) {
        return None;
    }
    let steps = turned.eigenvalues().ok()?;
    let turns = |step: &Complex64| (-step).arg() / std::f64::consts::TAU;
    let mut turns: Vec<f64> = steps.iter().map(turns).collect();
    turns.sort_by(f64::total_cmp);
    turns.dedup_by(|a, b| (*a - *b).abs() < SAME_TURNS);
    Some(turns)
}

#[cfg(test)]
mod tests {
    use super::super::row::with_waves;
    use super::*;

    #[test]
    fn rows_of_noise_have_a_finite_spectrum() {
        for seed in 0..20 {
            let waves: Vec<(f64, f64)> =
                (0..9).map(|i| (f64::from(i * i + seed).sin() / 2.0, 1.0 + f64::from(i * seed).cos())).collect();
            let power = with_waves(&waves, |row| row.continued(&directions(row)?)).unwrap();
            assert!(power.iter().all(|p| p.is_finite()), "{seed}");
        }
    }

    #[test]
    fn directions_of_two_waves_within_a_beamwidth_are_exact() {
        let turns = [0.12345, 0.15]; // a third of a beamwidth apart
        let mut found = with_waves(&[(turns[0], 1.0), (turns[1], 0.7)], directions).unwrap();
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2);
        assert!(found.iter().zip(turns).all(|(f, t)| (f - t).abs() < 1e-6), "{found:?}");
    }
}
