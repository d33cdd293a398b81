//! The whole array's map of known objects, as it is *expected* over a noise floor.
//!
//! The squared error is smallest for the expectation of Lambda, not for one more draw of the noise: two independent draws differ by
//! twice the variance that a draw and its mean do.

use super::atom::Atom;
use super::sensor::Sensor;
use crate::maps::{Aperture, Normalisation, RangeAngleMap, angle_transform, range_transform};
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::BeatSignal;
use crate::signal::floor::thesis_noise_variance;
use rayon::prelude::*;
use std::f64::consts::LN_10;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// White noise beneath the samples of the whole array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// Rounding as the thesis' program leaves it, from the objects themselves.
    Rounding,
    /// Variance a sample.
    Variance(f64),
}

/// An atom and its reflectivity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// The atom.
    pub atom: Atom,
    /// Its reflectivity.
    pub reflectivity: f64,
}

/// Beat signal of `objects` at every element of the array.
pub fn beat_signal(radar: &Radar, objects: &[Weighted]) -> BeatSignal {
    let sensor = Sensor::new(radar);
    let mut signal = BeatSignal::silence(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        let Some(row) = row.as_slice_mut() else { return };
        for o in objects {
            sensor.add_channel(&o.atom, o.reflectivity, radar.element_x_metres(n), row);
        }
    });
    signal
}

/// Expected Lambda of the whole array over `objects`.
pub fn expected_lambda(
    radar: &Radar,
    objects: &[Weighted],
    noise: Noise,
    normalisation: Normalisation,
) -> RangeAngleMap {
    let signal = beat_signal(radar, objects);
    let variance = match noise {
        Noise::Variance(v) => vec![v; radar.elements],
        Noise::Rounding => {
            let reflectors: Vec<Reflector> =
                objects.iter().flat_map(|o| o.atom.object(o.reflectivity).reflectors()).collect();
            thesis_noise_variance(radar, &reflectors)
        }
    };
    let cell_noise = cell_noise(radar, &variance).max(f64::MIN_POSITIVE);
    let profiles = range_transform(radar, &signal);
    let cells = angle_transform(radar, &profiles, Aperture::Full).cells;

    // The smallest of all cells: near zero each |Y|^2 has density exp(-s/N)/N, so the minimum of |Y|^2 is exponential with the sum of these.
    let rate: f64 = cells.as_slice().map_or(0.0, |c| {
        c.par_chunks(4096).map(|c| c.iter().map(|y| (-y.norm_sqr() / cell_noise).exp()).sum::<f64>()).sum()
    }) / cell_noise;
    let decades = cells.mapv(|y| expected_decades(y.norm_sqr(), cell_noise));
    let strongest = decades.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let noise_peak = (cell_noise * ((cells.len() as f64).ln() + EULER)).log10() / 2.0;
    let peak = strongest.max(noise_peak);
    let range = match normalisation {
        Normalisation::DynamicRange(db) => db.amplitude_decades(),
        Normalisation::MinMax => expected_range(peak, rate),
    };
    RangeAngleMap { lambda: decades.mapv(|l| (1.0 - (peak - l) / range).clamp(0.0, 1.0) as f32) }
}

/// Variance of each map cell's noise, from that of a sample of each element: the window's mean power in range and in angle.
fn cell_noise(radar: &Radar, variance: &[f64]) -> f64 {
    let range: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
    let angle: f64 = radar.window.weights(radar.elements).iter().zip(variance).map(|(w, v)| w * w * v).sum::<f64>();
    range * angle / radar.elements as f64
}

/// The range that Lambda divides by: the harmonic mean of `peak - min` where `10^(2 min)` is exponential with `rate`.
fn expected_range(peak: f64, rate: f64) -> f64 {
    const STEPS: usize = 400;
    let scale = -rate.max(f64::MIN_POSITIVE).log10() / 2.0;
    let mean_inverse: f64 = (0..STEPS)
        .map(|i| {
            let exponential = -((i as f64 + 0.5) / STEPS as f64).ln();
            1.0 / (peak - scale - exponential.log10() / 2.0).max(1e-3)
        })
        .sum::<f64>()
        / STEPS as f64;
    mean_inverse.recip()
}

/// Mean of `log10 |Y|` for complex Gaussian Y of mean power `signal` and variance `noise`: half of `ln s + E1(s / N)`, in decades.
fn expected_decades(signal: f64, noise: f64) -> f64 {
    let ratio = signal / noise;
    let nats = if ratio > 40.0 { signal.ln() } else { noise.ln() + ln_plus_e1(ratio) };
    nats / (2.0 * LN_10)
}

/// `ln x + E1(x)`, E1 the exponential integral: -EULER at 0, ln x far out (Abramowitz and Stegun 5.1.11 and 5.1.22).
fn ln_plus_e1(x: f64) -> f64 {
    if x < 1.5 {
        let (mut term, mut sum) = (1.0, 0.0);
        for k in 1..24 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum - EULER;
    }
    let mut fraction = 0.0;
    for k in (1..40).rev() {
        let k = f64::from(k);
        fraction = k / (1.0 + k / (x + fraction));
    }
    x.ln() + (-x).exp() / (x + fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_integral_has_its_tabled_values() {
        for (x, e1) in [(0.1, 1.822_923_958), (1.0, 0.219_383_934_4), (2.0, 0.048_900_510_71), (10.0, 4.156_968_93e-6)]
        {
            let found = ln_plus_e1(x) - f64::ln(x);
            assert!((found - e1).abs() < 2e-9, "{x}: {found} {e1}");
        }
        assert!((ln_plus_e1(0.0) + EULER).abs() < 1e-15);
    }
}
