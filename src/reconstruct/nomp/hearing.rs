//! How much of what is left is noise: what its quietest range bins hold, and no more than the floor beneath the samples can be.

use super::profile::Profile;
use crate::radar::Radar;
use crate::reconstruct::noise::noise_heard;
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
        let heard = noise_heard(radar, flat.chunks_exact(radar.samples).map(ArrayView1::from));
        let is_echo = !heard.is_even && heard.variance > MARGIN * self.expected;
        if is_echo { self.expected } else { heard.variance }
    }
}

/// How much more rounding there may be than is expected: echoes from beyond the maximum range round more than their range bin tells.
const MARGIN: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::floor::{snr_noise_variance, thesis_noise_variance};
    use crate::signal::simulate;

    /// Walls in nearly every range bin.
    fn walls() -> Scene {
        let wall = |x, y, step, count| Object::Line(Line::vertical(x, y, step, count));
        Scene { objects: vec![wall(-3.0, 2.0, 0.16, 100), wall(6.0, 14.0, 0.2, 110)], ..Scene::default() }
    }

    #[test]
    fn walls_in_every_range_bin_are_no_noise() {
        let radar = Radar::default();
        let flat = simulate(&radar, &walls(), Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
        let true_variance = thesis_noise_variance(&radar, &walls().reflectors())[0];
        let heard = |hearing: Hearing| hearing.noise_variance(&radar, &flat) / true_variance;
        assert!(heard(Hearing::any()) > 1e3, "{}", heard(Hearing::any()));
        let bounded = heard(Hearing::beneath(&radar, &flat, Floor::Thesis));
        assert!((0.5..2.0).contains(&bounded), "{bounded}");
    }

    #[test]
    fn noise_that_was_not_foretold_is_heard_all_the_same() {
        let radar = Radar::default();
        let scene = Scene::of_points([(2.0, 10.0), (-6.0, 17.0)]);
        let flat = simulate(&radar, &scene, Floor::Snr(Decibels(20.0)), 1).unwrap().two_ends(&radar).flat();
        let true_variance = snr_noise_variance(&radar, &scene.reflectors(), Decibels(20.0))[0];
        let heard = Hearing::beneath(&radar, &flat, Floor::Thesis).noise_variance(&radar, &flat) / true_variance;
        assert!((heard - 1.0).abs() < 0.2, "{heard}");
    }
}
