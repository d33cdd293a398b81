//! Measurement of the noise beneath the samples.

use crate::maps::Spectrum;
use crate::radar::Radar;
use ndarray::ArrayView1;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Largest shape of the Kaiser window: side lobes 300 dB down, below the rounding of f64.
const MAX_KAISER_BETA: f64 = 32.0;

/// Range bins for each bin of half the window's main lobe, so that a few reflectors leave bins of noise alone.
const BINS_PER_LOBE: f64 = 16.0;

/// Part of the range bins that are assumed to hold noise alone.
const QUIET_PART: f64 = 0.2;

/// Least ratio of the quietest bins' power to the quantile of [`QUIET_PART`] that counts as white noise.
const MIN_QUIET_POWER_RATIO: f64 = 0.03;

/// Noise that is assumed where too few samples separate it from side lobes, as a part of the samples' mean power: 60 dB down.
const ASSUMED_NOISE_PART: f64 = 1e-6;

pub(super) fn noise_variance<'a>(radar: &Radar, channels: impl Iterator<Item = ArrayView1<'a, Complex64>>) -> f64 {
    measured_noise(radar, channels).variance
}

/// The noise in the quietest range bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeasuredNoise {
    /// Variance a sample, if it is white noise.
    pub variance: f64,
    /// Whether the bins' powers are as even as those of white noise; side lobes differ by decades from bin to bin.
    pub is_even: bool,
}

/// Measures the noise of `channels`: the power of the quietest range bins under a window whose side lobes are lower. Where the chirp is too
/// short for such a window, noise 60 dB beneath the samples is assumed unless less is measured.
pub(super) fn measured_noise<'a>(
    radar: &Radar,
    channels: impl Iterator<Item = ArrayView1<'a, Complex64>>,
) -> MeasuredNoise {
    let beta = beta(radar.samples);
    let window = kaiser(radar.samples, beta);
    let power: f64 = window.iter().map(|w| w * w).sum();
    let spectrum = Spectrum::new(radar.samples);
    let mut bins = vec![0.0; radar.samples];
    let (mut count, mut energy) = (0.0, 0.0);
    // Elements without samples have no noise to measure.
    for channel in channels.filter(|c| c.iter().any(|v| v.norm_sqr() > 0.0)) {
        for (bin, v) in bins.iter_mut().zip(spectrum.of(channel.iter().zip(&window).map(|(v, w)| v * w))) {
            *bin += v.norm_sqr();
        }
        energy += channel.iter().map(Complex64::norm_sqr).sum::<f64>() / radar.samples as f64;
        count += 1.0;
    }
    if count == 0.0 {
        return MeasuredNoise { variance: 0.0, is_even: true };
    }
    let quiet = (QUIET_PART * bins.len() as f64) as usize;
    let strongest = bins.iter().copied().fold(0.0, f64::max);
    let quantile = *bins.select_nth_unstable_by(quiet, f64::total_cmp).1;
    let quietest = *bins[..=quiet].select_nth_unstable_by(quiet / 10, f64::total_cmp).1;
    // The mean of `count` exponential powers is nearly normal with this relative spread; its 20 % quantile is 0.84 below.
    let heard = quantile / (count * power) / (1.0 - 0.84 / f64::sqrt(count)).max(0.3);
    let is_side_lobe = quantile < strongest * side_lobe_part(beta) * 1e2;
    let variance = if is_side_lobe { heard.min(energy / count * ASSUMED_NOISE_PART) } else { heard };
    MeasuredNoise { variance, is_even: quietest > MIN_QUIET_POWER_RATIO * quantile }
}

/// Shape of the window for chirps of `samples`: the lower its side lobes, the wider its main lobe.
fn beta(samples: usize) -> f64 {
    let lobe_bins = samples as f64 / BINS_PER_LOBE;
    (PI * (lobe_bins * lobe_bins - 1.0).max(0.0).sqrt()).min(MAX_KAISER_BETA)
}

/// Power of the Kaiser window's highest side lobe, as a part of its main lobe's (the design formula of Kaiser's paper).
fn side_lobe_part(beta: f64) -> f64 {
    let decibels = if beta > 0.0 { beta / 0.1102 + 8.7 } else { 13.0 };
    10f64.powf(-decibels / 10.0)
}

/// Kaiser window (J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", 1974).
fn kaiser(len: usize, beta: f64) -> Vec<f64> {
    if len < 2 {
        return vec![1.0; len];
    }
    let middle = (len as f64 - 1.0) / 2.0;
    let largest = bessel_i0(beta);
    let weight = |n: usize| bessel_i0(beta * (1.0 - ((n as f64 - middle) / middle).powi(2)).max(0.0).sqrt()) / largest;
    let half: Vec<f64> = (0..len.div_ceil(2)).map(weight).collect();
    (0..len).map(|n| half[n.min(len - 1 - n)]).collect()
}

/// Modified Bessel function of the first kind and order 0, by its power series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..200 {
        term *= quarter / f64::from(k * k);
        sum += term;
        if term < sum * 1e-17 {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Decibels, End};
    use crate::reconstruct::noise_model::ends_noise_variance;
    use crate::scene::Scene;
    use crate::signal::floor::{snr_noise_variance, thesis_noise_variance};
    use crate::signal::{Floor, simulate};

    #[test]
    fn the_measured_noise_is_the_noise_that_was_added() {
        let radar = Radar::default();
        let scene = Scene::of_points([(2.0, 10.0), (-6.0, 17.0), (9.0, 20.0)]);
        for snr in [60.0, 0.0] {
            let signal = simulate(&radar, &scene, Floor::Snr(Decibels(snr)), 3).unwrap();
            let expected = snr_noise_variance(&radar, &scene.reflectors(), Decibels(snr))[0];
            let found = ends_noise_variance(&radar, &signal.two_ends(&radar), Floor::Snr(Decibels(snr)).into());
            assert!((found / expected - 1.0).abs() < 0.15, "{snr} dB: {found:e} {expected:e}");
        }
        let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        let of_elements = thesis_noise_variance(&radar, &scene.reflectors());
        let ends: Vec<f64> =
            End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).map(|n| of_elements[n]).collect();
        let expected = ends.iter().sum::<f64>() / ends.len() as f64;
        let found = ends_noise_variance(&radar, &signal.two_ends(&radar), Floor::Thesis.into());
        assert!((found / expected - 1.0).abs() < 0.2, "{found:e} {expected:e}");
    }

    #[test]
    fn short_chirps_are_not_taken_for_noise() {
        for samples in [1, 4, 8, 16, 32, 64] {
            let radar = Radar { samples, ..Radar::default() };
            let metres = radar.max_range_metres() / 3.0 + 2.0;
            let scene = Scene::of_points([(0.3 * metres, metres)]);
            let ends = simulate(&radar, &scene, Floor::Exact, 0).unwrap().two_ends(&radar);
            let power = ends.first.iter().map(Complex64::norm_sqr).sum::<f64>() / ends.first.len() as f64;
            let noise = ends_noise_variance(&radar, &ends, Floor::Exact.into());
            // Side lobes of few elements and samples: 55 dB beneath the echoes.
            assert!(noise <= 3e-6 * power, "{samples} samples: {noise:e} of {power:e}");
        }
    }

    #[test]
    fn bessel_function_has_its_tabled_values() {
        assert!((bessel_i0(1.0) - 1.266_065_877_752_008_3).abs() < 1e-15);
        assert!((bessel_i0(5.0) / 27.239_871_823_604_44 - 1.0).abs() < 1e-14);
    }
}
