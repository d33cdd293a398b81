//! Range bins that hold an echo, and how many of them stand in a row.

use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Power of an echo in a range bin, over that of the noise.
const ABOVE_NOISE: f64 = 4.0;

/// Weakest echo, over the strongest, when ranges are evened out by the 1/R^4 law of power.
const WEAKEST: f64 = 1e-6;

/// Range bins that are added before ranges are evened out: near the array the law holds no more.
const NEAR_BINS: f64 = 10.0;

/// Wraps of the range that are told apart: what stands beyond the maximum range may be much weaker than what it is heard among.
const WRAPS: usize = 2;

/// Range bins in a row that only something longer than a few reflectors fills.
const LONG_RUN_BINS: usize = 18;

/// Which range bins of each end hold an echo, in the first wraps of the range.
#[derive(Debug, Clone, PartialEq)]
pub struct EchoBins {
    /// Bins of one wrap.
    count: usize,
    /// For each end, one entry a bin.
    bins: [Vec<bool>; 2],
    /// For each end how many bins below each hold one: one entry more than there are bins.
    running: [Vec<u32>; 2],
}

impl EchoBins {
    /// The bins of `residual` (all samples of both ends, not windowed) that stand out of noise of `noise_variance`, and no more than 60 dB below the
    /// strongest when ranges are evened out.
    pub fn of(radar: &Radar, residual: &[Complex64], noise_variance: f64) -> Self {
        let ends = TwoEnds::of_flat(radar, residual);
        let weights = radar.window.weights(radar.samples);
        let window = weights.iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
        let noise = window * radar.end_elements as f64 * noise_variance;
        let count = radar.samples;
        let bins = End::BOTH.map(|end| {
            let profiles = channels_range_transform(radar, ends.end(end).view()).profiles;
            let power = |bin: usize| profiles.column(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
            let powers: Vec<f64> = (0..count).map(power).collect();
            let even = |bin: usize| powers[bin % count] * (bin as f64 + NEAR_BINS).powi(4);
            let strongest = (0..count).map(even).fold(0.0, f64::max);
            let is_echo = |bin| powers[bin % count] > ABOVE_NOISE * noise && even(bin) >= WEAKEST * strongest;
            (0..WRAPS * count).map(is_echo).collect()
        });
        let running = bins.each_ref().map(|bins: &Vec<bool>| {
            let mut sum = 0;
            std::iter::once(0)
                .chain(bins.iter().map(|echo| {
                    sum += u32::from(*echo);
                    sum
                }))
                .collect()
        });
        EchoBins { count, bins, running }
    }

    /// Whether something longer than a few reflectors is among them.
    pub fn are_long(&self) -> bool {
        self.longest_run() >= LONG_RUN_BINS
    }

    /// The longest row of neighbouring bins that hold an echo at one of the ends, within the maximum range.
    fn longest_run(&self) -> usize {
        let run_of = |bins: &Vec<bool>| bins[..self.count].split(|echo| !*echo).map(<[bool]>::len).max().unwrap_or(0);
        self.bins.iter().map(run_of).max().unwrap_or(0)
    }

    /// Part of the bins from one to the other (both included, the second not below the first) that hold an echo at an end.
    pub fn part(&self, end: usize, from_to: [usize; 2]) -> f64 {
        let running = &self.running[end];
        let [from, to] = from_to.map(|bin| bin.min(running.len() - 2));
        f64::from(running[to + 1] - running[from]) / (to + 1 - from) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::hearing::Hearing;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_line_fills_the_bins_it_stands_in() {
        let radar = Radar::default();
        let step = radar.range_resolution_metres();
        let line = |y| Scene { objects: vec![Object::Line(Line::vertical(0.5, y, step, 80))], ..Scene::default() };
        let of = |y| {
            let flat = simulate(&radar, &line(y), Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
            EchoBins::of(&radar, &flat, Hearing::any().noise_variance(&radar, &flat))
        };
        let bins = of(10.0);
        let first = radar.bin_of_range(10.0) as usize;
        assert!((78..95).contains(&bins.longest_run()), "{}", bins.longest_run());
        for end in 0..2 {
            assert_eq!(bins.part(end, [first + 5, first + 70]), 1.0);
            assert_eq!(bins.part(end, [first + 120, first + 200]), 0.0);
            assert!((bins.part(end, [first - 40, first + 39]) - 0.5).abs() < 0.1);
        }
        // Beyond the maximum range the bins begin anew.
        let wrapped = of(radar.max_range_metres() - 40.0 * step);
        assert!(wrapped.part(0, [radar.samples - 38, radar.samples + 30]) > 0.9);
    }
}
