//! Finely sampled range profiles, to be looked up at any distance.

use crate::maps::Spectrum;
use crate::radar::{Radar, hann};
use ndarray::ArrayView1;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Padded range profiles of some channels under a Hann window, their phases referred to the middle of the chirp so that they vary
/// slowly from row to row.
pub(super) struct Profiles {
    /// One a channel; the first row stands at the end once more.
    profiles: Vec<Vec<Complex64>>,
    rows_per_metre: f64,
    /// Turns that a metre of distance adds in the middle of the chirp: carrier and beat.
    turns_per_metre: f64,
}

/// Fewest samples that a Hann window leaves more than one of.
const LEAST_WINDOWED: usize = 4;

impl Profiles {
    /// Profiles of `channels`, each `[samples]`, with `rows_per_bin` rows a range bin.
    pub fn new(radar: &Radar, channels: &[ArrayView1<'_, Complex64>], rows_per_bin: usize) -> Self {
        let window = if radar.samples < LEAST_WINDOWED { vec![1.0; radar.samples] } else { hann(radar.samples) };
        let weight: f64 = window.iter().sum();
        let rows = rows_per_bin * radar.samples;
        let spectrum = Spectrum::new(rows);
        let middle = (radar.samples / 2) as f64;
        let profiles = channels
            .par_iter()
            .map(|channel| {
                let mut profile = spectrum.of(channel.iter().zip(&window).map(|(v, w)| v * (w / weight)));
                for (row, v) in profile.iter_mut().enumerate() {
                    *v *= Complex64::cis(TAU * (row as f64 * middle / rows as f64).fract());
                }
                profile.push(profile[0]);
                profile
            })
            .collect();
        Profiles {
            profiles,
            rows_per_metre: rows as f64 / radar.max_range_metres(),
            turns_per_metre: radar.carrier.turns_per_wavelength() / radar.wavelength_metres()
                + middle / radar.max_range_metres(),
        }
    }

    /// What `channel` heard from `distance_metres`, linear between rows; the phase of that distance is taken off. 1 for a reflector
    /// there whose samples have amplitude 1.
    pub fn at(&self, channel: usize, distance_metres: f64) -> Complex64 {
        let profile = &self.profiles[channel];
        let rows = (profile.len() - 1) as f64;
        let row = (distance_metres * self.rows_per_metre) % rows;
        let (low, part) = (row as usize, row.fract());
        let heard = profile[low] * (1.0 - part) + profile[low + 1] * part;
        heard * self.phase(-distance_metres)
    }

    /// Phase that `distance_metres` adds in the middle of the chirp.
    pub fn phase(&self, distance_metres: f64) -> Complex64 {
        Complex64::cis(TAU * (self.turns_per_metre * distance_metres).fract())
    }
}

/// What is left of a reflector's echo `bins` range bins off its own under a Hann window: 1 at 0, zeros from 2 on.
pub(super) fn range_response(bins: f64) -> f64 {
    let x = bins.abs();
    if x < 1e-6 {
        return 1.0;
    }
    if (x - 1.0).abs() < 1e-6 {
        return 0.5;
    }
    let turn = std::f64::consts::PI * x;
    turn.sin() / (turn * (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_profile_has_no_phase_at_its_reflector_and_the_windows_shape_around_it() {
        let radar = Radar::default();
        let scene = Scene::of_points([(3.0, 12.0)]);
        let signal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
        let x = radar.element_x_metres(7);
        let distance = (3.0 - x).hypot(12.0);
        let profiles = Profiles::new(&radar, &[signal.samples.row(7)], 16);
        let heard = profiles.at(0, distance) * distance * distance / radar.transmit_power_watts;
        assert!((heard - 1.0).norm() < 0.01, "{heard}");
        for bins in [0.4, 1.0, 1.3, 1.7] {
            let off = profiles.at(0, distance + bins * radar.range_resolution_metres());
            let part = off.norm() * distance * distance / radar.transmit_power_watts;
            assert!((part - range_response(bins)).abs() < 0.01, "{bins}: {part}");
        }
    }
}
