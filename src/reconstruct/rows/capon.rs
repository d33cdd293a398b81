//! Capon's minimum-variance beamformer.

use super::covariance::{quadratic_form, smoothed, subarray_len};
use super::method::{Render, RowMethod};
use super::row::RowSnapshot;
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use num_complex::Complex64;

/// Beams that pass one direction unchanged and suppress all others as far as possible, per end and range row.
///
/// J. Capon, "High-resolution frequency-wavenumber spectrum analysis", Proc. IEEE 57, 1969; with spatial smoothing and diagonal
/// loading by the noise, since one row of one chirp gives one snapshot.
pub const CAPON: RowMethod = RowMethod {
    name: "capon",
    description: "minimum-variance beams of each end and range row, with spatial smoothing",
    eta: 0.851, // by examples/choose_eta.rs
    estimate: spectrum,
    render: Render::Spectrum,
};

/// The peaks of [`CAPON`], rendered.
pub const CAPON_PEAKS: RowMethod = RowMethod {
    name: "capon-peaks",
    description: "the peaks of capon, moved to where their echoes fit both ends best, and the exact map of them",
    eta: 0.806, // by examples/choose_eta.rs
    render: Render::Peaks,
    ..CAPON
};

/// Added to the covariance's diagonal beside the noise, as a part of its mean, for the elements' small departures from a plane wave.
const LOADING_PART: f64 = 1e-6;

fn spectrum(row: &RowSnapshot) -> Option<Vec<f64>> {
    let n = subarray_len(row.own().len());
    let covariance = smoothed(&row.snapshots, n);
    let mean = (0..n).map(|i| covariance[(i, i)].re).sum::<f64>() / n as f64;
    let loading = mean * LOADING_PART + row.noise_variance;
    let loaded = Mat::from_fn(n, n, |i, j| covariance[(i, j)] + Complex64::from(if i == j { loading } else { 0.0 }));
    let inverse = Llt::new(loaded.as_ref(), Side::Lower).ok()?.inverse();
    Some(quadratic_form(&inverse, row.spectrum).into_iter().map(|v| 1.0 / v.max(f64::MIN_POSITIVE)).collect())
}
