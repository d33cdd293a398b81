//! Two estimates of the noise floor, as inputs of the live network.

use crate::maps::windowed_range_transform;
use crate::radar::Radar;
use ndarray::{Array2, s};
use num_complex::Complex64;

/// The amplitude of the rounding noise of the thesis' program in samples with these range profiles, decades: each range's power times the squared ulp
/// of its carrier phase ([`crate::signal::floor::thesis_noise_variance`]).
pub(super) fn rounding_floor(radar: &Radar, profiles: &[Array2<Complex64>; 2]) -> f32 {
    let (mut weighted, mut total) = (0.0, 0.0);
    let radians_per_metre = radar.carrier_radians_per_metre().abs();
    for row in 0..radar.samples {
        let power: f64 = profiles.iter().map(|z| z.slice(s![row, ..]).iter().map(|v| v.norm_sqr()).sum::<f64>()).sum();
        let range = (row + 1) as f64 * radar.range_resolution_metres();
        let exponent = (radians_per_metre * range).log2().floor() as i32 - 52;
        weighted += power * 2f64.powi(2 * exponent);
        total += power;
    }
    (0.5 * (weighted / total / 8.0).log10()) as f32
}

/// The amplitude of the weakest range bin under a Blackman-Harris window, whose side lobes are at -92 dB, decades.
pub(super) fn measured_floor(radar: &Radar, ends: &[Array2<Complex64>; 2]) -> f32 {
    let window: Vec<f64> = (0..radar.samples)
        .map(|n| {
            let k = std::f64::consts::TAU * n as f64 / radar.samples as f64;
            0.35875 - 0.48829 * k.cos() + 0.14128 * (2.0 * k).cos() - 0.01168 * (3.0 * k).cos()
        })
        .collect();
    let mean_square = window.iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
    let mut power = vec![0.0; radar.samples];
    for end in ends {
        for channel in windowed_range_transform(radar, end.view(), &window).profiles.outer_iter() {
            power.iter_mut().zip(channel).for_each(|(p, v)| *p += v.norm_sqr());
        }
    }
    let weakest = power.into_iter().fold(f64::INFINITY, f64::min) / (2 * radar.end_elements) as f64 / mean_square;
    (0.5 * (weakest + 1e-300).log10()) as f32
}
