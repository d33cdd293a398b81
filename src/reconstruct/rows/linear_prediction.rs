//! Linear prediction: each element as a combination of its neighbours.

use super::covariance::subarray_len;
use super::method::{Render, RowMethod};
use super::row::RowSnapshot;
use faer::Mat;
use num_complex::Complex64;

/// Nulls of the prediction error over angle, for each end and range row: forward and backward prediction of two thirds of the end's length, by a
/// singular value decomposition truncated at the noise.
///
/// D. W. Tufts and R. Kumaresan, "Estimation of frequencies of multiple sinusoids: making linear prediction perform like maximum
/// likelihood", Proc. IEEE 70, 1982.
pub const LINEAR_PREDICTION: RowMethod = RowMethod {
    name: "linear-prediction",
    description: "nulls of the prediction error over angle, for each end and range row",
    eta: 0.863, // by examples/choose_eta.rs
    estimate: spectrum,
    render: Render::Spectrum,
};

/// The peaks of [`LINEAR_PREDICTION`], rendered.
pub const LINEAR_PREDICTION_PEAKS: RowMethod = RowMethod {
    name: "linear-prediction-peaks",
    description: "the peaks of linear-prediction, moved to where their echoes fit both ends best, and the exact map of them",
    eta: 0.775, // by examples/choose_eta.rs
    render: Render::Peaks,
    ..LINEAR_PREDICTION
};

/// Coefficients `a` of `x[n] = sum_k a[k] x[n - 1 - k]`, and backward with their conjugates.
fn predictor(row: &RowSnapshot) -> Option<Vec<Complex64>> {
    let (samples, noise_variance) = (row.own(), row.noise_variance);
    let order = subarray_len(samples.len());
    let equations = samples.len() - order;
    let matrix = Mat::from_fn(2 * equations, order, |row, k| {
        if row < equations { samples[row + order - 1 - k] } else { samples[row - equations + 1 + k].conj() }
    });
    let predicted = |row: usize| {
        if row < equations { samples[row + order] } else { samples[row - equations].conj() }
    };
    let svd = matrix.thin_svd().ok()?;
    let values: Vec<f64> = svd.S().column_vector().iter().map(|v| v.re).collect();
    let largest = values.first().copied().unwrap_or(0.0);
    let noise = (10.0 * noise_variance * (2 * equations) as f64).sqrt();
    let mut solution = vec![Complex64::default(); order];
    for (i, value) in values.iter().enumerate() {
        if *value <= (largest * row.not_plane.sqrt()).max(noise) {
            break;
        }
        let part: Complex64 =
            (0..2 * equations).map(|r| svd.U()[(r, i)].conj() * predicted(r)).sum::<Complex64>() / value;
        for (k, s) in solution.iter_mut().enumerate() {
            *s += svd.V()[(k, i)] * part;
        }
    }
    Some(solution)
}

fn spectrum(row: &RowSnapshot) -> Option<Vec<f64>> {
    let predictor = predictor(row)?;
    let error_filter = std::iter::once(Complex64::from(1.0)).chain(predictor.into_iter().map(|a| -a));
    let nulls: Vec<f64> = row.spectrum.of(error_filter).into_iter().map(|v| v.norm_sqr()).collect();
    Some(row.power_of_nulls(&nulls))
}

#[cfg(test)]
mod tests {
    use super::super::row::with_waves;
    use super::*;

    /// Waves of columns 300 and 340.
    const TWO_WAVES: [(f64, f64); 2] = [(300.0 / 1024.0, 1.0), (340.0 / 1024.0, 1.0)];

    #[test]
    fn waves_are_predicted() {
        let (a, own) = with_waves(&TWO_WAVES, |row| (predictor(row).unwrap(), row.own().to_vec()));
        let predicted: Complex64 = a.iter().enumerate().map(|(k, a)| a * own[10 - k]).sum();
        assert!((predicted - own[11]).norm() < 1e-9);
    }

    #[test]
    fn waves_stand_out() {
        let power = with_waves(&TWO_WAVES, spectrum).unwrap();
        let largest = power.iter().copied().fold(0.0, f64::max);
        for column in [300, 340] {
            assert!(power[column] > 0.01 * largest && power[column] > 1e3 * power[320], "{column}");
        }
    }
}
