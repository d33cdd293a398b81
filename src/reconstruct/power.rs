//! From an estimate of the whole array's power to Lambda, over the floor that lies beneath it.

use super::answer::{Reconstruction, Request};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Radar;
use ndarray::{Array2, Zip};

/// Magnitude in the whole array's map of a focused reflector whose samples have amplitude 1: the sum of both windows, scaled.
pub(super) fn focused_gain(radar: &Radar) -> f64 {
    let mean = |n: usize| radar.window.weights(n).iter().sum::<f64>() / (n as f64).sqrt();
    mean(radar.samples) * mean(radar.elements)
}

/// Mean square of a noise cell of the whole array's map for noise of variance 1 a sample.
fn cell_noise(radar: &Radar) -> f64 {
    let mean = |n: usize| radar.window.weights(n).iter().map(|w| w * w).sum::<f64>() / n as f64;
    mean(radar.samples) * mean(radar.elements)
}

/// Lambda of the estimated power `|Y|^2`, `[range bins, columns]`, of the whole array's map.
///
/// The noise that was measured in the samples is laid beneath: an estimate of zero shows as a typical noise cell, and with
/// `MinMax` Lambda 0 is where the smallest of so many noise cells is to be expected. Without it a method's own dynamic range,
/// which says nothing about the scene, would decide the squared error.
pub(super) fn lambda_of_power(
    radar: &Radar,
    mut power: Array2<f64>,
    noise_variance: f64,
    request: &Request,
) -> RangeAngleMap {
    let mut peak = 0.0f64;
    for v in &mut power {
        *v = if v.is_finite() { v.max(0.0) } else { 0.0 };
        peak = peak.max(*v);
    }
    // 400 dB below the peak no f64 sample has anything to say.
    let noise = (noise_variance * cell_noise(radar)).max(peak * 1e-40).max(f64::MIN_POSITIVE);
    let decades = |power: f64| 0.5 * power.log10();
    // The mean of log10|n| lies 0.125 decades below the root mean square of complex normal n.
    let typical = noise * 10f64.powf(-0.25);
    let floor = decades(noise) - 0.5 * (power.len() as f64).log10();
    let scale = LambdaScale::new(floor, decades(peak + typical), request.normalisation);
    let mut lambda = Array2::zeros(power.dim());
    Zip::from(&mut lambda).and(&power).par_for_each(|out, p| *out = scale.lambda(decades(p + typical)) as f32);
    RangeAngleMap { lambda }
}

/// A reconstruction that knows no reflectors, only power.
pub(super) fn of_power(radar: &Radar, power: Array2<f64>, noise_variance: f64, request: &Request) -> Reconstruction {
    Reconstruction { lambda: lambda_of_power(radar, power, noise_variance, request), reflectors: Vec::new(), eta: None }
}
