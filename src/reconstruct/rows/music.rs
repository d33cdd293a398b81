//! MUSIC: directions orthogonal to the noise subspace.

use super::covariance::{quadratic_form, smoothed, subarray_len, subspaces};
use super::method::{Render, RowMethod};
use super::row::RowSnapshot;

/// The pseudo-spectrum of each end and range row, with spatial smoothing.
///
/// R. O. Schmidt, "Multiple emitter location and signal parameter estimation", IEEE Trans. Antennas Propag. 34, 1986.
pub const MUSIC: RowMethod = RowMethod {
    name: "music",
    description: "subspace pseudo-spectrum of each end and range row, with spatial smoothing",
    eta: 0.842, // by examples/choose_eta.rs
    estimate: spectrum,
    render: Render::Spectrum,
};

/// The peaks of [`MUSIC`], rendered.
pub const MUSIC_PEAKS: RowMethod = RowMethod {
    name: "music-peaks",
    description: "the peaks of music, moved to where their echoes fit both ends best, and the exact map of them",
    eta: 0.757, // by examples/choose_eta.rs
    render: Render::Peaks,
    ..MUSIC
};

fn spectrum(row: &RowSnapshot) -> Option<Vec<f64>> {
    let covariance = smoothed(&row.snapshots, subarray_len(row.own().len()));
    let subspaces = subspaces(&covariance, row)?;
    Some(row.power_of_nulls(&quadratic_form(&subspaces.noise, row.spectrum)))
}

#[cfg(test)]
mod tests {
    use super::super::row::with_waves;
    use super::*;

    /// Columns of the peaks above 0.3 of the largest.
    fn peaks(power: &[f64]) -> Vec<usize> {
        let largest = power.iter().copied().fold(0.0, f64::max);
        let n = power.len();
        let is_peak = |k: &usize| power[*k] > power[(k + n - 1) % n] && power[*k] >= power[(k + 1) % n];
        (0..n).filter(|k| power[*k] > 0.3 * largest && is_peak(k)).collect()
    }

    #[test]
    fn resolves_two_reflectors_within_a_beamwidth() {
        // Twelve elements have a beam of 1024/12 = 85 columns; these two are 30 apart.
        with_waves(&[(100.0 / 1024.0, 1.0), (130.0 / 1024.0, 1.0)], |row| {
            assert_eq!(peaks(&row.bartlett()).len(), 1, "plain beams see one");
            assert_eq!(peaks(&spectrum(row).unwrap()), [100, 130]);
        });
    }

    #[test]
    fn a_plain_beam_is_as_wide_as_twelve_elements_make_it() {
        let power = with_waves(&[(0.25, 1.0)], |row| row.bartlett());
        assert!((power[256] - 1.0).abs() < 1e-12, "amplitude 1 at its column");
        // Half-power width of a uniform line: 0.886 / (N d / lambda) in cos, here 0.886 * 1024 / 12 columns.
        let width = power.iter().filter(|p| **p > 0.5).count();
        assert!(width.abs_diff(76) <= 1, "{width}");
    }
}
