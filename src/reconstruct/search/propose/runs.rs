//! Length of runs of range bins with echoes.

use super::end_beams::beam_noise_power;
use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Least power of an echo in a range bin over that of the noise.
pub const MIN_ECHO_OVER_NOISE: f64 = 4.0;

/// Least power of an echo over the strongest, both times `R^4`.
const MIN_ECHO_POWER_RATIO: f64 = 1e-6;

/// Range bins that are added to the range `R`: near the array powers grow less than by `1/R^4`.
const ADDED_RANGE_BINS: f64 = 10.0;

/// Least length of a run that is more than a few reflectors.
pub const MIN_LONG_RUN_BINS: usize = 18;

/// Most successive range bins with an echo at an end, for `residual` `[channels * samples]`, not windowed, over white noise of `noise_variance`.
pub fn longest_run_bins(radar: &Radar, residual: &[Complex64], noise_variance: f64) -> usize {
    let ends = TwoEnds::of_flat(radar, residual);
    let noise = beam_noise_power(radar, noise_variance);
    let run_of = |end: End| {
        let profiles = channels_range_transform(radar, ends.end(end).view()).profiles;
        let power = |bin: usize| profiles.column(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
        let powers: Vec<f64> = (0..radar.samples).map(power).collect();
        let compensated = |bin: usize| powers[bin] * (bin as f64 + ADDED_RANGE_BINS).powi(4);
        let strongest = (0..radar.samples).map(compensated).fold(0.0, f64::max);
        let is_echo =
            |bin| powers[bin] > MIN_ECHO_OVER_NOISE * noise && compensated(bin) >= MIN_ECHO_POWER_RATIO * strongest;
        let echoes: Vec<bool> = (0..radar.samples).map(is_echo).collect();
        echoes.split(|echo| !*echo).map(<[bool]>::len).max().unwrap_or(0)
    };
    End::BOTH.into_iter().map(run_of).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::noise_model::NoiseModel;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_line_fills_the_bins_it_stands_in() {
        let radar = Radar::default();
        let step = radar.range_resolution_metres();
        let line = |y| Scene { objects: vec![Object::Line(Line::vertical(0.5, y, step, 80))], ..Scene::default() };
        let flat = simulate(&radar, &line(10.0), Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
        let run = longest_run_bins(&radar, &flat, NoiseModel::any().noise_variance(&radar, &flat));
        assert!((78..95).contains(&run), "{run} bins");
    }
}
