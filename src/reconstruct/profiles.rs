//! Finely sampled range profiles with look-ups at any distance.

use crate::maps::Spectrum;
use crate::radar::{Radar, chirp_window};
use crate::signal::simd::{ComplexLanes, Lanes, Real, horner, phasor};
use ndarray::ArrayView1;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Padded range profiles of some channels under a Hann window, their phases referred to the middle of the chirp so that they vary slowly from row to row.
pub(super) struct Profiles {
    /// One profile a channel; the first row is repeated at the end.
    profiles: Vec<Vec<Complex64>>,
    rows_per_metre: f64,
    /// Turns of phase per metre of distance in the middle of the chirp: carrier and beat.
    turns_per_metre: f64,
}

impl Profiles {
    /// Profiles of `channels`, each `[samples]`, with `rows_per_bin` rows a range bin.
    pub fn new(radar: &Radar, channels: &[ArrayView1<'_, Complex64>], rows_per_bin: usize) -> Self {
        let window = chirp_window(radar.samples);
        let weight: f64 = window.iter().sum();
        let rows = rows_per_bin * radar.samples;
        let spectrum = Spectrum::new(rows);
        let middle = (radar.samples / 2) as f64;
        let profile = |channel: &ArrayView1<'_, Complex64>| {
            let mut profile = spectrum.of(channel.iter().zip(&window).map(|(v, w)| v * (w / weight)));
            for (row, v) in profile.iter_mut().enumerate() {
                *v *= Complex64::cis(TAU * (row as f64 * middle / rows as f64).fract());
            }
            profile.push(profile[0]);
            profile
        };
        Profiles {
            profiles: channels.par_iter().map(profile).collect(),
            rows_per_metre: rows as f64 / radar.max_range_metres(),
            turns_per_metre: radar.turns_per_metre(middle),
        }
    }

    /// [`Profiles::at`] of the channels from `first` on at `distances_metres`, one a lane, for as many lanes as `heard` has entries.
    #[inline(always)]
    pub fn lanes_at<const W: usize, const FMA: bool>(
        &self,
        first: usize,
        distances_metres: Lanes<f64, W>,
        heard: &mut [Complex64],
    ) {
        let rows = (self.profiles[first].len() - 1) as f64;
        let row = distances_metres * Lanes::splat(self.rows_per_metre);
        let row = row - (row * Lanes::splat(1.0 / rows)).map(f64::floor) * Lanes::splat(rows);
        let phase = self.phases::<f64, W, FMA>(-distances_metres);
        for (lane, (heard, profile)) in heard.iter_mut().zip(&self.profiles[first..]).enumerate() {
            let (low, part) = (row.0[lane] as usize, row.0[lane].fract());
            // Rounding may reach the last row, which repeats the first.
            let next = profile[(low + 1).min(profile.len() - 1)];
            let value = profile[low] * (1.0 - part) + next * part;
            *heard = value * Complex64::new(phase.re.0[lane], phase.im.0[lane]);
        }
    }

    /// [`Profiles::phase`] of several distances.
    #[inline(always)]
    pub fn phases<T: Real, const W: usize, const FMA: bool>(&self, metres: Lanes<f64, W>) -> ComplexLanes<T, W> {
        phasor::<T, W, FMA>(metres * Lanes::splat(self.turns_per_metre))
    }

    /// Profile of `channel` at `distance_metres`, linear between rows, without that distance's phase: 1 for a reflector there of amplitude 1.
    pub fn at(&self, channel: usize, distance_metres: f64) -> Complex64 {
        let profile = &self.profiles[channel];
        let rows = (profile.len() - 1) as f64;
        let row = (distance_metres * self.rows_per_metre) % rows;
        let (low, part) = (row as usize, row.fract());
        let heard = profile[low] * (1.0 - part) + profile[low + 1] * part;
        heard * self.phase(-distance_metres)
    }

    /// Phase of `distance_metres` in the middle of the chirp.
    pub fn phase(&self, distance_metres: f64) -> Complex64 {
        Complex64::cis(TAU * (self.turns_per_metre * distance_metres).fract())
    }
}

/// Response of a reflector's echo `bins` range bins off its own under a Hann window: 1 at 0, zeros from 2 on.
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

/// Power series of [`range_response`] in the square of the bins: partial sums of that of `sin(pi x) / (pi x)`.
const NEAR_SERIES: [f64; 9] = {
    let (mut sums, mut term, mut sum, mut m) = ([0.0; 9], 1.0, 0.0, 0);
    while m < sums.len() {
        sum += term;
        sums[m] = sum;
        term *= -std::f64::consts::PI * std::f64::consts::PI / ((2 * m + 2) * (2 * m + 3)) as f64;
        m += 1;
    }
    sums
};

/// [`range_response`] of several lanes, up to one bin off.
#[inline(always)]
pub(super) fn range_response_near<const W: usize, const FMA: bool>(bins: Lanes<f64, W>) -> Lanes<f64, W> {
    horner::<f64, W, FMA>(&NEAR_SERIES, bins * bins)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_profile_has_the_windows_shape_around_its_reflector() {
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

    #[test]
    fn lanes_hear_what_one_channel_hears() {
        let radar = Radar { samples: 64, ..Radar::default() };
        let signal = simulate(&radar, &Scene::of_points([(1.0, 3.0)]), Floor::Thesis, 0).unwrap();
        let profiles = Profiles::new(&radar, &[signal.samples.row(0), signal.samples.row(5)], 16);
        // Beyond the last bin ranges wrap.
        for distances in [[3.1, 0.0], [4.7999, 4.8], [5.3, 14.9]] {
            let mut heard = [Complex64::default(); 2];
            profiles.lanes_at::<2, false>(0, Lanes(distances), &mut heard);
            for (channel, (heard, distance)) in heard.iter().zip(distances).enumerate() {
                assert!((heard - profiles.at(channel, distance)).norm() < 1e-9, "{distance} m");
            }
        }
        for bins in [-1.0, -0.3, 0.0, 0.7, 1.0] {
            let near = range_response_near::<1, false>(Lanes([bins])).0[0];
            assert!((near - range_response(bins)).abs() < 1e-8, "{bins}: {near}");
        }
    }
}
