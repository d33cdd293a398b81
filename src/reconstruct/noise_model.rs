//! Measurement of the noise in samples: the power of their quietest range bins, limited by the expected floor beneath the echoes.

use super::noise::measured_noise;
use super::prior::NoisePrior;
use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use crate::signal::floor::thesis_noise_of_echo;
use ndarray::{ArrayView1, ArrayView2};
use num_complex::Complex64;

pub(crate) fn ends_noise_variance(radar: &Radar, ends: &TwoEnds, noise: NoisePrior) -> f64 {
    NoiseModel::beneath(radar, ends, noise).ends_noise_variance(radar, ends)
}

/// The noise model of a reconstruction's samples.
#[derive(Debug, Clone, Copy)]
pub struct NoiseModel {
    /// Expected variance a sample, which replaces a measured one that is more than [`ROUNDING_MARGIN`] times as large and uneven.
    expected: f64,
    /// Variance a sample, where the request gives it.
    known: Option<f64>,
}

impl NoiseModel {
    /// A model without any expectation.
    pub fn any() -> Self {
        NoiseModel { expected: f64::INFINITY, known: None }
    }

    /// The model for the samples of `ends`: rounding noise is expected from the echoes themselves, even where they fill every range bin.
    pub fn beneath(radar: &Radar, ends: &TwoEnds, noise: NoisePrior) -> Self {
        if noise.is_white() {
            return NoiseModel { known: noise.variance(), ..NoiseModel::any() };
        }
        let window: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum();
        let channels = (ends.first.nrows() + ends.last.nrows()).max(1) as f64;
        let of_bin = |(bin, energy): (usize, f64)| {
            let power = energy / (window * channels);
            thesis_noise_of_echo(radar, power, radar.range_of_bin_metres(bin as f64))
        };
        let of_end =
            |end: End| range_energy(radar, ends.end(end).view()).into_iter().enumerate().map(of_bin).sum::<f64>();
        NoiseModel { expected: End::BOTH.into_iter().map(of_end).sum(), known: None }
    }

    /// Variance of the white noise in a sample of either end.
    pub fn ends_noise_variance(&self, radar: &Radar, ends: &TwoEnds) -> f64 {
        self.variance(radar, End::BOTH.into_iter().flat_map(|end| ends.end(end).outer_iter()))
    }

    /// Variance of the white noise in a sample of `flat`, laid out channel by channel.
    pub fn noise_variance(&self, radar: &Radar, flat: &[Complex64]) -> f64 {
        self.variance(radar, flat.chunks_exact(radar.samples).map(ArrayView1::from))
    }

    fn variance<'a>(&self, radar: &Radar, channels: impl Iterator<Item = ArrayView1<'a, Complex64>>) -> f64 {
        if let Some(variance) = self.known {
            return variance;
        }
        let measured = measured_noise(radar, channels);
        let is_echo = !measured.is_even && measured.variance > ROUNDING_MARGIN * self.expected;
        if is_echo { self.expected } else { measured.variance }
    }
}

/// Energy of windowed `channels`, `[channels, samples]`, in each range bin.
pub(super) fn range_energy(radar: &Radar, channels: ArrayView2<'_, Complex64>) -> Vec<f64> {
    let profiles = channels_range_transform(radar, channels).profiles;
    profiles.columns().into_iter().map(|column| column.iter().map(Complex64::norm_sqr).sum()).collect()
}

/// Ratio of the possible rounding to the expected one: echoes from beyond the maximum range have more rounding than their range bin suggests.
const ROUNDING_MARGIN: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::floor::{snr_noise_variance, thesis_noise_variance};
    use crate::signal::{Floor, simulate};

    fn lines() -> Scene {
        let line = |x, y, step, count| Object::Line(Line::vertical(x, y, step, count));
        Scene { objects: vec![line(-3.0, 2.0, 0.16, 100), line(6.0, 14.0, 0.2, 110)], ..Scene::default() }
    }

    #[test]
    fn lines_in_every_range_bin_are_no_noise() {
        let radar = Radar::default();
        let ends = simulate(&radar, &lines(), Floor::Thesis, 0).unwrap().two_ends(&radar);
        let true_variance = thesis_noise_variance(&radar, &lines().reflectors())[0];
        let measured = |noise_model: NoiseModel| noise_model.ends_noise_variance(&radar, &ends) / true_variance;
        assert!(measured(NoiseModel::any()) > 1e3, "{}", measured(NoiseModel::any()));
        let bounded = measured(NoiseModel::beneath(&radar, &ends, NoisePrior::Rounding));
        assert!((0.5..2.0).contains(&bounded), "{bounded}");
    }

    #[test]
    fn unexpected_noise_is_measured() {
        let radar = Radar::default();
        let scene = Scene::of_points([(2.0, 10.0), (-6.0, 17.0)]);
        let ends = simulate(&radar, &scene, Floor::Snr(Decibels(20.0)), 1).unwrap().two_ends(&radar);
        let true_variance = snr_noise_variance(&radar, &scene.reflectors(), Decibels(20.0))[0];
        let measured = ends_noise_variance(&radar, &ends, NoisePrior::Rounding) / true_variance;
        assert!((measured - 1.0).abs() < 0.2, "{measured}");
    }
}
