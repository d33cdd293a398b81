//! What lies beneath the reflectors of a map.
//!
//! A map normalised by its minimum shows its floor as much as its peaks, so the floor is always named: no function picks one silently.

use super::BeatSignal;
use crate::radar::{Decibels, Radar};
use crate::scene::Reflector;
use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What lies beneath the reflectors.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Floor {
    /// The rounding noise that the thesis' f64 evaluation leaves: the floor of its tables.
    #[default]
    Thesis,
    /// None: the formula as exactly as f64 holds it.
    Exact,
    /// Thermal noise at this signal-to-noise ratio, measured per sample over the whole array.
    Snr(Decibels),
}

/// A floor's name that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown floor \"{0}\"; expected thesis, exact or snr=DB with DB between -100 and 300")]
pub struct FloorError(String);

impl FromStr for Floor {
    type Err = FloorError;

    fn from_str(s: &str) -> Result<Self, FloorError> {
        match s {
            "thesis" => Ok(Floor::Thesis),
            "exact" => Ok(Floor::Exact),
            _ => s
                .strip_prefix("snr=")
                .and_then(|db| db.parse::<f64>().ok())
                .filter(|db| (-100.0..=300.0).contains(db))
                .map(|db| Floor::Snr(Decibels(db)))
                .ok_or_else(|| FloorError(s.to_owned())),
        }
    }
}

impl fmt::Display for Floor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Floor::Thesis => f.write_str("thesis"),
            Floor::Exact => f.write_str("exact"),
            Floor::Snr(db) => write!(f, "snr={}", db.0),
        }
    }
}

/// Variance of the white complex noise, for each element, that leaves the floor of the thesis' f64 evaluation: the sum over
/// reflectors of `1.5 * amplitude^2 * ulp(2 pi |s q| R / lambda)^2 / 12`. Measured to give the same minimum, median and metrics.
pub fn thesis_noise_variance(radar: &Radar, reflectors: &[Reflector]) -> Vec<f64> {
    let radians_per_metre =
        radar.carrier.turns_per_wavelength().abs() * std::f64::consts::TAU / radar.wavelength_metres();
    (0..radar.elements)
        .into_par_iter()
        .map(|n| {
            let element_x = radar.element_x_metres(n);
            let of_one = |r: &Reflector| {
                let dx = element_x - r.x_metres;
                let square = dx * dx + r.y_metres * r.y_metres;
                let amplitude = radar.transmit_power_watts * r.reflectivity / square;
                let ulp = ulp(radians_per_metre * square.sqrt());
                1.5 / 12.0 * (amplitude * ulp).powi(2)
            };
            reflectors.iter().map(of_one).sum()
        })
        .collect()
}

/// Variance of thermal noise at `snr`: the mean power of all samples over the ratio. Silence has no noise.
pub fn snr_noise_variance(signal: &BeatSignal, snr: Decibels) -> f64 {
    let power = signal.samples.iter().map(Complex64::norm_sqr).sum::<f64>();
    power / signal.samples.len().max(1) as f64 / snr.power_ratio()
}

/// White complex noise of unit variance for one element, the same for the same seed whatever thread asks.
pub fn unit_noise(seed: u64, element: usize) -> impl Iterator<Item = Complex64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(element as u64);
    let scale = std::f64::consts::FRAC_1_SQRT_2;
    std::iter::from_fn(move || {
        let re: f64 = StandardNormal.sample(&mut rng);
        let im: f64 = StandardNormal.sample(&mut rng);
        Some(Complex64::new(re * scale, im * scale))
    })
}

/// Adds white complex noise of the given variance for each element.
pub fn add_noise(signal: &mut BeatSignal, variance: &[f64], seed: u64) {
    signal.samples.outer_iter_mut().into_par_iter().zip(variance).enumerate().for_each(|(n, (mut row, variance))| {
        let deviation = variance.sqrt();
        for (sample, noise) in row.iter_mut().zip(unit_noise(seed, n)) {
            *sample += noise * deviation;
        }
    });
}

/// Distance from `v` to the next f64 above it; 0 for 0.
fn ulp(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.next_up() - v }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip_and_bad_names_are_told() {
        for name in ["thesis", "exact", "snr=20", "snr=-3.5"] {
            assert_eq!(name.parse::<Floor>().unwrap().to_string(), name);
        }
        for bad in ["", "snr", "snr=", "snr=nan", "snr=1e9", "Thesis"] {
            assert!(bad.parse::<Floor>().is_err(), "{bad}");
        }
    }

    #[test]
    fn noise_has_unit_variance_and_repeats() {
        let a: Vec<_> = unit_noise(1, 3).take(20_000).collect();
        let power = a.iter().map(Complex64::norm_sqr).sum::<f64>() / a.len() as f64;
        assert!((power - 1.0).abs() < 0.03, "{power}");
        assert!(unit_noise(1, 3).take(5).eq(a[..5].iter().copied()));
        assert!(!unit_noise(1, 4).take(5).eq(a[..5].iter().copied()));
    }
}
