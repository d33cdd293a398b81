//! Confidence of each echo found: the part of the energy, unexplained without it, that it explains.

use super::noise_model::range_energy;
use crate::radar::{End, Radar};
use crate::scene::Reflector;
use crate::signal::{ArrayEcho, TwoEnds};
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use num_complex::Complex64;
use rayon::prelude::*;

/// Range bins to each side of an echo's own that count as around it: the main lobe of a Hann window.
const AROUND_BINS: i64 = 2;

/// Added to the Gram matrix of unit echoes: two echoes that differ by less than this are one, and neither is needed.
const ONE_ECHO_RIDGE: f64 = 1e-11;

/// [`Detection::confidence`](super::Detection::confidence) of every one of `found` in `ends`, over noise of this variance a sample; one
/// entry an echo.
///
/// The confidence is the coefficient of partial determination of linear regression (M. H. Kutner, C. J. Nachtsheim, J. Neter and W. Li, "Applied
/// linear statistical models", section 7.4), of the energy around the echo's range.
pub(super) fn confidences(radar: &Radar, ends: &TwoEnds, found: &[Reflector], noise_variance: f64) -> Vec<f64> {
    let (mut left, is_measured) = (ends.flat(), ends.measured_elements());
    let echo = |r: &Reflector| {
        let place = radar.polar_of(r.x_metres, r.y_metres);
        ArrayEcho::at(radar, place.range_metres, place.cos_theta).masked(&is_measured)
    };
    let echoes: Vec<ArrayEcho> = found.par_iter().map(echo).collect();
    let count = echoes.len();
    let heard: Vec<Complex64> = echoes.par_iter().map(|e| e.correlate(&left)).collect();
    let rows: Vec<Vec<Complex64>> =
        (0..count).into_par_iter().map(|i| echoes[..=i].iter().map(|other| echoes[i].inner(other)).collect()).collect();
    let gram = Mat::from_fn(count, count, |i, j| {
        let value = if i >= j { rows[i][j] } else { rows[j][i].conj() };
        value + if i == j { ONE_ECHO_RIDGE } else { 0.0 }
    });
    let Ok(factor) = Llt::new(gram.as_ref(), Side::Lower) else { return vec![0.0; count] };
    let inverse = factor.inverse();
    let gains: Vec<Complex64> =
        (0..count).map(|i| (0..count).map(|j| inverse[(i, j)] * heard[j]).sum::<Complex64>()).collect();
    for (echo, gain) in echoes.iter().zip(&gains) {
        left.iter_mut().zip(echo.unit_samples()).for_each(|(left, unit)| *left -= gain * unit);
    }
    let window = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
    let unexplained = Unexplained::new(radar, &TwoEnds::of_flat(radar, &left), &is_measured, noise_variance * window);
    let confidence = |i: usize| {
        let worth = window * gains[i].norm_sqr() / inverse[(i, i)].re.max(f64::MIN_POSITIVE);
        let part = worth / (worth + unexplained.around(radar, &echoes[i]));
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
    };
    (0..count).map(confidence).collect()
}

/// Energy that all echoes together leave unexplained, over range.
struct Unexplained {
    /// Energy of each end, one value a range bin, windowed.
    energy: [Vec<f64>; 2],
    /// Least energy of a bin of each end: that of the noise.
    noise: [f64; 2],
}

impl Unexplained {
    /// The energy of `left`; `bin_noise` is the mean energy that noise gives to a range bin of one element.
    fn new(radar: &Radar, left: &TwoEnds, is_measured: &[bool], bin_noise: f64) -> Self {
        let (first, last) = is_measured.split_at(radar.end_elements.min(is_measured.len()));
        let noise = [first, last].map(|end| bin_noise * end.iter().filter(|h| **h).count() as f64);
        Unexplained { energy: End::BOTH.map(|end| range_energy(radar, left.end(end).view())), noise }
    }

    /// Energy within [`AROUND_BINS`] of the range of `echo` at each end; ranges wrap.
    fn around(&self, radar: &Radar, echo: &ArrayEcho) -> f64 {
        let bins = radar.samples as i64;
        let of_end = |(i, end): (usize, End)| {
            let (x, y) = (echo.reflector.x_metres - radar.end_centre_metres(end), echo.reflector.y_metres);
            let own = radar.bin_of_range(x.hypot(y)).round() as i64;
            let (from, count) =
                if bins > 2 * AROUND_BINS { (own - AROUND_BINS, 2 * AROUND_BINS + 1) } else { (0, bins) };
            let energy: f64 = (from..from + count).map(|bin| self.energy[i][bin.rem_euclid(bins) as usize]).sum();
            energy.max(count as f64 * self.noise[i])
        };
        End::BOTH.into_iter().enumerate().map(of_end).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::scene::Scene;
    use crate::signal::floor::snr_noise_variance;
    use crate::signal::{Floor, simulate};

    /// Confidence of echoes at `places` (metres) in the samples of `truth` at this signal-to-noise ratio.
    fn of(truth: &[(f64, f64)], places: &[(f64, f64)], db: f64) -> Vec<f64> {
        let radar = Radar::default();
        let scene = Scene::of_points(truth.iter().copied());
        let ends = simulate(&radar, &scene, Floor::Snr(Decibels(db)), 3).unwrap().two_ends(&radar);
        let variance = snr_noise_variance(&radar, &scene.reflectors(), Decibels(db))[0];
        let found = Scene::of_points(places.iter().copied()).reflectors();
        confidences(&radar, &ends, &found, variance)
    }

    #[test]
    fn only_an_echo_that_is_there_is_needed() {
        let truth = [(3.0, 11.0), (-6.0, 17.0)];
        let c = of(&truth, &[truth[0], truth[1], (8.0, 20.0), (3.0, 11.3)], 20.0);
        assert!(c[0] > 0.99 && c[1] > 0.99, "{c:?}");
        assert!(c[2] < 0.2 && c[3] < 0.2, "{c:?}");
    }

    #[test]
    fn two_echoes_for_one_are_each_needless() {
        let truth = [(3.0, 11.0)];
        let twice = of(&truth, &[truth[0], (3.000_000_1, 11.0)], 0.0);
        assert!(twice.len() == 2 && twice.iter().all(|c| *c < 0.5), "{twice:?}");
    }

    #[test]
    fn noise_makes_an_echo_doubtful() {
        let truth = [(3.0, 11.0)];
        let at = [20.0, -10.0, -40.0].map(|db| of(&truth, &truth, db)[0]);
        assert!(at[0] > 0.999 && at[1] > at[2] && (0.7..0.97).contains(&at[1]) && at[2] < 0.1, "{at:?}");
    }
}
