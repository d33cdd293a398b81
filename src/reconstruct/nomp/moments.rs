//! Moments of a window over a chirp: what the inner product of two echoes comes to.
//!
//! Two echoes of a chirp differ by a tone of some range bins; their inner product and those of their derivatives are sums of the
//! squared window times powers of time times that tone. Under a window whose side lobes fall fast they vanish some bins away, so that
//! the Gram matrix of many echoes is banded.

use num_complex::Complex64;
use rustfft::FftPlanner;
use std::f64::consts::TAU;

/// Nodes of the table for each range bin.
const NODES_PER_BIN: usize = 8;

/// Terms of the Taylor series around each node: the twelfth is below 1e-15 of the first half way to the next node.
const TERMS: usize = 12;

/// Bins beyond which echoes under a Hann window count as orthogonal: the square of the window falls by 180 dB there.
const HANN_REACH_BINS: f64 = 12.0;

/// `sum over t of w(t)^2 tau^m exp(2 pi j d tau)` for m = 0, 1, 2 over the difference d in range bins, with tau = (t - middle) / samples.
#[derive(Debug, Clone)]
pub struct Moments {
    /// Taylor coefficients of the moment of order 0 around every node.
    table: Vec<[f64; TERMS]>,
    bins: f64,
    /// What a wrap of the range by all bins does to the phase at the chirp's middle.
    wrap_sign: f64,
    /// Largest difference in bins at which echoes are not orthogonal.
    pub reach_bins: f64,
}

/// The moments of order 0, 1 and 2; the middle one times j.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentsAt {
    /// Of order 0.
    pub zeroth: f64,
    /// Of order 1, over j.
    pub first: f64,
    /// Of order 2.
    pub second: f64,
}

impl Moments {
    /// Of a symmetric window of any length.
    #[allow(clippy::needless_range_loop)] // a term is a column of the table
    pub fn new(window: &[f64]) -> Self {
        let samples = window.len();
        let nodes = samples * NODES_PER_BIN;
        let middle = (samples as f64 - 1.0) / 2.0;
        let fft = FftPlanner::new().plan_fft_inverse(nodes);
        let mut table = vec![[0.0; TERMS]; nodes];
        // Referred to the middle of the chirp; nodes in the upper half stand for negative differences.
        let d = |node: usize| signed(node, nodes) / NODES_PER_BIN as f64;
        let turns: Vec<Complex64> =
            (0..nodes).map(|node| Complex64::cis(-TAU * (d(node) * middle / samples as f64).fract())).collect();
        let mut factorial = 1.0;
        for term in 0..TERMS {
            factorial *= term.max(1) as f64;
            let mut line = vec![Complex64::default(); nodes];
            for (t, w) in window.iter().enumerate() {
                let tau = (t as f64 - middle) / samples as f64;
                line[t] = Complex64::from(w * w * (TAU * tau).powi(term as i32) / factorial);
            }
            fft.process(&mut line);
            for (node, v) in line.iter().enumerate() {
                let turned = v * turns[node];
                // j^term times a real number, or that times j.
                table[node][term] = match term % 4 {
                    0 => turned.re,
                    1 => -turned.im,
                    2 => -turned.re,
                    _ => turned.im,
                };
            }
        }
        let ends = window.first().copied().unwrap_or(0.0).abs();
        let largest = window.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
        let reach = if ends < 1e-9 * largest { HANN_REACH_BINS } else { f64::INFINITY };
        let wrap_sign = if samples.is_multiple_of(2) { -1.0 } else { 1.0 };
        Moments { table, bins: samples as f64, wrap_sign, reach_bins: reach }
    }

    /// At a difference of `bins`, which may exceed the number of range bins: ranges wrap.
    #[inline(always)]
    pub fn at(&self, bins: f64) -> MomentsAt {
        let wraps = (bins / self.bins).round();
        let bins = bins - wraps * self.bins;
        let sign = if wraps as i64 % 2 == 0 { 1.0 } else { self.wrap_sign };
        let at = bins * NODES_PER_BIN as f64;
        let node = at.round();
        let h = (at - node) / NODES_PER_BIN as f64;
        let len = self.table.len();
        let index = (node as i64).rem_euclid(len as i64) as usize;
        let a = &self.table[index];
        let (mut zeroth, mut slope, mut bend) = (a[TERMS - 1], 0.0, 0.0);
        for c in a[..TERMS - 1].iter().rev() {
            bend = bend * h + slope;
            slope = slope * h + zeroth;
            zeroth = zeroth * h + c;
        }
        MomentsAt { zeroth: zeroth * sign, first: -slope * sign / TAU, second: -2.0 * bend * sign / (TAU * TAU) }
    }
}

fn signed(node: usize, nodes: usize) -> f64 {
    if node > nodes / 2 { node as f64 - nodes as f64 } else { node as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::hann;

    #[test]
    fn the_table_is_the_sum_written_out() {
        for (samples, flat) in [(512, false), (512, true), (63, false)] {
            let window = if flat { vec![1.0; samples] } else { hann(samples) };
            let moments = Moments::new(&window);
            let middle = (samples as f64 - 1.0) / 2.0;
            for d in [0.0, 0.03, -0.44, 1.7, -5.21, 17.3, -30.9, samples as f64 - 0.7, 1.4 * samples as f64] {
                let mut sums = [Complex64::default(); 3];
                for (t, w) in window.iter().enumerate() {
                    let tau = (t as f64 - middle) / samples as f64;
                    let tone = Complex64::cis(TAU * d * tau) * w * w;
                    for (m, sum) in sums.iter_mut().enumerate() {
                        *sum += tone * tau.powi(m as i32);
                    }
                }
                let found = moments.at(d);
                let scale = 1e-12 * samples as f64;
                assert!((found.zeroth - sums[0].re).abs() < scale, "{d}: {} {}", found.zeroth, sums[0]);
                assert!((found.first - sums[1].im).abs() < scale, "{d}: {} {}", found.first, sums[1]);
                assert!((found.second - sums[2].re).abs() < scale, "{d}: {} {}", found.second, sums[2]);
            }
        }
    }
}
