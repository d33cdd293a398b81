//! Windows of both transforms.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Weights of the samples before a transform: the lower the side lobes, the wider the main lobe.
///
/// F. J. Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform", Proceedings of the IEEE, 1978.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WindowFunction {
    /// Highest side lobe 31 dB down, falling as 1/k^3: the thesis' window (section 3.1).
    #[default]
    Hann,
    /// Highest side lobe 43 dB down, but they hardly fall any further.
    Hamming,
    /// Highest side lobe 58 dB down, at half as wide a main lobe again as Hann's.
    Blackman,
    /// No weights at all: the narrowest main lobe, side lobes of 13 dB.
    Rectangular,
}

impl WindowFunction {
    /// All windows, the thesis' first.
    pub const ALL: [WindowFunction; 4] =
        [WindowFunction::Hann, WindowFunction::Hamming, WindowFunction::Blackman, WindowFunction::Rectangular];

    /// Name, as scene files have it.
    pub fn name(self) -> &'static str {
        match self {
            WindowFunction::Hann => "hann",
            WindowFunction::Hamming => "hamming",
            WindowFunction::Blackman => "blackman",
            WindowFunction::Rectangular => "rectangular",
        }
    }

    /// Weights of the cosines it is the sum of: `a - b cos(2 pi n / (len - 1)) + c cos(4 pi n / (len - 1))`.
    pub fn cosines(self) -> [f64; 3] {
        match self {
            WindowFunction::Hann => [0.5, 0.5, 0.0],
            WindowFunction::Hamming => [0.54, 0.46, 0.0],
            WindowFunction::Blackman => [0.42, 0.5, 0.08],
            WindowFunction::Rectangular => [1.0, 0.0, 0.0],
        }
    }

    /// The window for `len` points: `self` from three points on. Fewer have no weights, one as in NumPy, two since most windows would leave nothing.
    pub fn for_points(self, len: usize) -> WindowFunction {
        if len < 3 { WindowFunction::Rectangular } else { self }
    }

    /// The symmetric window of `len` points ([`WindowFunction::cosines`]); ones where [`WindowFunction::for_points`] has no other.
    pub fn weights(self, len: usize) -> Vec<f64> {
        let [a, b, c] = self.for_points(len).cosines();
        if len < 2 {
            return vec![1.0; len];
        }
        let turn = |n: usize| TAU * n as f64 / (len - 1) as f64;
        (0..len).map(|n| a - b * turn(n).cos() + c * (2.0 * turn(n)).cos()).collect()
    }
}

/// Symmetric Hann window of `len` points, `0.5 - 0.5 cos(2 pi n / (len - 1))`: zero at both ends (thesis section 3.1); ones up to two points.
pub fn hann(len: usize) -> Vec<f64> {
    WindowFunction::Hann.weights(len)
}

/// [`hann`] of `len` points, three or more, at any place between its first (0) and its last (`len - 1`).
pub fn hann_at(len: usize, n: f64) -> f64 {
    0.5 - 0.5 * (TAU * n / (len as f64 - 1.0)).cos()
}

/// Fewest points of a Hann window with more than one weight above 0.
const MIN_HANN_POINTS: usize = 4;

/// [`hann`] for a chirp of `samples`; ones where it would leave one sample or none.
pub fn chirp_window(samples: usize) -> Vec<f64> {
    if samples < MIN_HANN_POINTS { vec![1.0; samples] } else { hann(samples) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hann_falls_to_zero_at_both_ends() {
        let w = hann(12);
        assert_eq!(w[0], 0.0);
        assert!(w[11].abs() < 1e-15);
        for n in 0..12 {
            assert!((w[n] - w[11 - n]).abs() < 1e-15);
        }
        assert!((w.iter().sum::<f64>() - 5.5).abs() < 1e-12, "sum of a symmetric Hann window is (N-1)/2");
        assert!((0..12).all(|n| (hann_at(12, n as f64) - w[n]).abs() < 1e-15) && hann_at(12, 5.5) == 1.0);
        assert_eq!((hann(1), hann(2)), (vec![1.0], vec![1.0; 2]));
        assert_eq!((chirp_window(3), chirp_window(4)), (vec![1.0; 3], hann(4)));
    }
}
