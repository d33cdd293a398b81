//! How much of what is left is noise: what its quietest range bins hold, and no more than the floor beneath the samples can be.

use super::profile::Profile;
use crate::radar::Radar;
use crate::reconstruct::noise::noise_variance;
use crate::signal::Floor;
use crate::signal::floor::thesis_noise_of_echo;
use ndarray::ArrayView1;
use num_complex::Complex64;

/// Noise beneath the samples of both ends.
#[derive(Debug, Clone, Copy)]
pub struct Hearing {
    /// Variance a sample that is believed where more than [`MARGIN`] times as much is heard.
    expected: f64,
}

impl Hearing {
    /// Of any noise.
    pub fn any() -> Self {
        Hearing { expected: f64::INFINITY }
    }

    /// Of what lies beneath `flat`, all samples channel by channel: where that is rounding, the echoes themselves tell how much of it
    /// there is, even where they fill every range bin.
    pub fn beneath(radar: &Radar, flat: &[Complex64], floor: Floor) -> Self {
        if matches!(floor, Floor::Snr(_)) {
            return Hearing::any();
        }
        let window: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum();
        let channels = (flat.len() / radar.samples.max(1)).max(1) as f64;
        let profile = Profile::new(radar, flat);
        let of_bin = |(bin, energy): (usize, f64)| {
            let power = energy / (window * channels);
            thesis_noise_of_echo(radar, power, radar.range_of_bin_metres(bin as f64))
        };
        Hearing { expected: profile.of_both_ends().enumerate().map(of_bin).sum::<f64>() }
    }

    /// Variance of the white noise in a sample of `flat`, laid out channel by channel.
    pub fn noise_variance(&self, radar: &Radar, flat: &[Complex64]) -> f64 {
        let heard = noise_variance(radar, flat.chunks_exact(radar.samples).map(ArrayView1::from));
        if heard > MARGIN * self.expected { self.expected } else { heard }
    }
}

/// How much more rounding there may be than is expected: echoes from beyond the maximum range round more than their range bin tells.
const MARGIN: f64 = 3.0;
