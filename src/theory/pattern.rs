//! The transform of a window: the main lobe and side lobes of every blob.
//!
//! F. J. Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform", Proceedings of the IEEE, 1978.

use crate::radar::{Decibels, WindowFunction};
use std::f64::consts::PI;

/// Steps per bin in the search of lobes.
const FINE_STEPS: f64 = 64.0;

/// The transform of a symmetric window over a few points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowPattern {
    cosines: [f64; 3],
    len: usize,
}

impl WindowPattern {
    /// The pattern of `window` over `len` points, as [`WindowFunction::for_points`] has it for so few.
    pub fn new(window: WindowFunction, len: usize) -> Self {
        WindowPattern { cosines: window.for_points(len).cosines(), len: len.max(1) }
    }

    /// `sum_n w[n] cos(2 pi (n - (len - 1)/2) bins / len)`, real since the window is symmetric; exact.
    pub fn at(&self, bins: f64) -> f64 {
        let [a, b, c] = self.cosines;
        let len = self.len as f64;
        let dirichlet = |bins: f64| {
            let below = (PI * bins / len).sin();
            // At whole periods the ratio of both sines' slopes.
            if below.abs() < 1e-9 {
                len * (PI * bins).cos() / (PI * bins / len).cos()
            } else {
                (PI * bins).sin() / below
            }
        };
        let apart = len / (len - 1.0).max(1.0);
        let pair = |offset: f64| (dirichlet(bins - offset) + dirichlet(bins + offset)) / 2.0;
        a * dirichlet(bins)
            + if b == 0.0 { 0.0 } else { b * pair(apart) }
            + if c == 0.0 { 0.0 } else { c * pair(2.0 * apart) }
    }

    /// Width of the main lobe `down` below its top, in bins of the window's own length; `None` where it never falls so low (one weight).
    pub fn main_lobe_bins(&self, down: Decibels) -> Option<f64> {
        let level = self.at(0.0) / 10f64.powf(down.amplitude_decades());
        let outside = self.first(|at| self.at(at) < level)?;
        let (mut low, mut high) = (outside - 1.0 / FINE_STEPS, outside);
        for _ in 0..40 {
            let middle = (low + high) / 2.0;
            if self.at(middle) < level { high = middle } else { low = middle }
        }
        Some(low + high)
    }

    /// The first step away from the main lobe's middle, and at most half the period, that `is`.
    fn first(&self, is: impl Fn(f64) -> bool) -> Option<f64> {
        (1..(self.len as f64 / 2.0 * FINE_STEPS) as usize).map(|step| step as f64 / FINE_STEPS).find(|at| is(*at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_the_transform_of_their_weights() {
        for window in WindowFunction::ALL {
            for len in [1, 2, 3, 12, 33] {
                let pattern = WindowPattern::new(window, len);
                for bins in [0.0, 0.3, 1.0, 1.5, 7.25, len as f64 - 0.1, len as f64, 40.3] {
                    let turn = |n: usize| 2.0 * PI * (n as f64 - (len as f64 - 1.0) / 2.0) * bins / len as f64;
                    let sum: f64 = window.weights(len).iter().enumerate().map(|(n, w)| w * turn(n).cos()).sum();
                    assert!((pattern.at(bins) - sum).abs() < 1e-9 * len as f64, "{window:?} of {len} at {bins}");
                }
            }
        }
    }

    #[test]
    fn lobes_are_as_wide_and_as_low_as_in_the_textbook() {
        // Harris, table 1: 3 dB width in bins, first null in bins, and highest side lobe below the peak.
        for (window, width, null, decibels) in [
            (WindowFunction::Rectangular, 0.89, 1.0, 13.3),
            (WindowFunction::Hann, 1.44, 2.0, 31.5),
            (WindowFunction::Hamming, 1.30, 2.0, 42.7),
            (WindowFunction::Blackman, 1.68, 3.0, 58.1),
        ] {
            let pattern = WindowPattern::new(window, 1024);
            assert!((pattern.main_lobe_bins(Decibels(3.01)).unwrap() - width).abs() < 0.04, "{window:?}");
            let lobe = (0..1024).map(|i| pattern.at(null + f64::from(i) / 32.0).abs()).fold(0.0, f64::max);
            let level = 20.0 * (pattern.at(0.0) / lobe).log10();
            assert!((level - decibels).abs() < 0.8, "{window:?}: {level} dB");
        }
        assert_eq!(WindowPattern::new(WindowFunction::Hann, 3).main_lobe_bins(Decibels(3.0)), None, "one weight");
    }
}
