//! Conversion of an estimate of the whole array's power to Lambda, over the noise floor.

use super::answer::{Reconstruction, Request};
use super::significance::{cell_noise, least_eta};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Radar;
use ndarray::{Array2, Zip};

/// Magnitude in the whole array's map of a focused reflector whose samples have amplitude 1: the sum of both windows, scaled.
pub(super) fn focused_gain(radar: &Radar) -> f64 {
    let mean = |n: usize| radar.window.weights(n).iter().sum::<f64>() / (n as f64).sqrt();
    mean(radar.samples) * mean(radar.elements)
}

/// Lambda of the estimated power `|Y|^2`, `[range bins, columns]`, of the whole array's map.
///
/// The noise measured in the samples is added: an estimate of zero becomes a typical noise cell, and with `MinMax` Lambda 0 is the expected
/// smallest of so many noise cells. Without it a method's own dynamic range, which is unrelated to the scene, would decide the squared error.
/// Lambda 1 is at least the expected largest of so many noise cells: an estimate of zero everywhere is a typical noise cell everywhere, and not
/// the peak.
/// Also returns the Lambda that noise alone does not exceed.
pub(super) fn lambda_of_power(
    radar: &Radar,
    mut power: Array2<f64>,
    noise_variance: f64,
    request: &Request,
) -> (RangeAngleMap, f32) {
    let mut peak = 0.0f64;
    for v in &mut power {
        *v = if v.is_finite() { v.max(0.0) } else { 0.0 };
        peak = peak.max(*v);
    }
    // 400 dB below the peak is beyond the precision of f64 samples.
    let noise = (noise_variance * cell_noise(radar)).max(peak * 1e-40).max(f64::MIN_POSITIVE);
    let decades = |power: f64| 0.5 * power.log10();
    // The mean of log10|n| lies 0.125 decades below the root mean square of complex normal n.
    let typical = noise * 10f64.powf(-0.25);
    let floor = decades(noise) - 0.5 * (power.len() as f64).log10();
    let largest_noise = noise * ((power.len().max(1) as f64).ln() + EULER);
    let top = decades(peak + typical).max(decades(largest_noise));
    let scale = LambdaScale::new(floor, top, request.normalisation);
    let mut lambda = Array2::zeros(power.dim());
    Zip::from(&mut lambda).and(&power).par_for_each(|out, p| *out = scale.lambda(decades(p + typical)) as f32);
    (RangeAngleMap { lambda }, least_eta(radar, noise_variance, scale))
}

/// Euler's constant: the largest of n exponential powers of mean 1 is `ln n` and this on average.
const EULER: f64 = 0.577_215_664_901_532_9;

pub(super) fn of_power(radar: &Radar, power: Array2<f64>, noise_variance: f64, request: &Request) -> Reconstruction {
    let (lambda, least) = lambda_of_power(radar, power, noise_variance, request);
    Reconstruction { least_eta: Some(least), ..Reconstruction::of_map(lambda) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::Normalisation;
    use crate::radar::Decibels;

    #[test]
    fn a_power_of_zero_is_drawn_beneath_every_threshold() {
        let radar = Radar::default();
        for normalisation in [Normalisation::MinMax, Normalisation::DynamicRange(Decibels(60.0))] {
            let request = Request { normalisation, ..Request::default() };
            let nothing = Array2::zeros((radar.samples, radar.elements));
            let found = of_power(&radar, nothing, 1e-5, &request);
            let most = found.lambda.lambda.iter().copied().fold(0.0, f32::max);
            assert!(most < 0.9 && found.least_eta == Some(1.0), "{normalisation}: {most}, {:?}", found.least_eta);
        }
    }
}
