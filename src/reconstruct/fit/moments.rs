//! Moments of a window over a chirp, from which the inner products of two echoes and of their derivatives follow.
//!
//! The product of two echoes in a chirp is a tone, whose frequency is the difference of their ranges. So the inner products are sums of the squared
//! window times powers of time times that tone. Under a window whose side lobes fall fast they vanish some bins away, and the Gram matrix is banded.

use super::sensor::W;
use crate::signal::simd::Lanes;
use num_complex::Complex64;
use rustfft::FftPlanner;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Nodes of the table for each range bin.
const NODES_PER_BIN: usize = 8;

/// Terms of the Taylor series around each node, and the largest distance from it, range bins: the last terms are below 1e-14 of the first there.
const TAYLOR_TERMS: usize = 18;
const MAX_NODE_DISTANCE_BINS: f64 = 0.3;

/// Distance in range beyond which echoes under a Hann window count as orthogonal: the transform of the squared window is 180 dB down there.
const HANN_REACH_BINS: f64 = 12.0;

/// `sum over t of w(t)^2 tau^m exp(2 pi j d tau)` for m = 0, 1, 2 over the difference d in range bins, with tau = (t - middle) / samples.
#[derive(Debug, Clone)]
pub struct Moments {
    /// Taylor coefficients of the moment of order 0 around each node, `[node][term]`.
    table: Arc<Vec<[f64; TAYLOR_TERMS]>>,
    /// Samples of a chirp: as many range bins, after which the range repeats.
    samples: usize,
    /// Largest difference, range bins, at which echoes don't count as orthogonal.
    pub reach_bins: f64,
}

/// The moments of order 0, 1 and 2, a channel in each lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentsAt {
    pub zeroth: Lanes<f64, W>,
    /// The moment of order 1 divided by j.
    pub first: Lanes<f64, W>,
    pub second: Lanes<f64, W>,
}

impl Moments {
    /// The moments of a symmetric `window`, `[samples]`.
    #[allow(clippy::needless_range_loop)] // a term is a column of the table
    pub fn new(window: &[f64]) -> Self {
        let samples = window.len();
        let nodes = samples * NODES_PER_BIN;
        let middle = (samples as f64 - 1.0) / 2.0;
        let fft = FftPlanner::new().plan_fft_inverse(nodes);
        let mut table = vec![[0.0; TAYLOR_TERMS]; nodes];
        // The phase is referred to the middle of the chirp. Nodes of the upper half are negative differences.
        let signed_node = |node: usize| if node > nodes / 2 { node as f64 - nodes as f64 } else { node as f64 };
        let d = |node: usize| signed_node(node) / NODES_PER_BIN as f64;
        let turns: Vec<Complex64> =
            (0..nodes).map(|node| Complex64::cis(-TAU * (d(node) * middle / samples as f64).fract())).collect();
        let mut factorial = 1.0;
        for term in 0..TAYLOR_TERMS {
            factorial *= term.max(1) as f64;
            let mut line = vec![Complex64::default(); nodes];
            for (t, w) in window.iter().enumerate() {
                let tau = (t as f64 - middle) / samples as f64;
                line[t] = Complex64::from(w * w * (TAU * tau).powi(term as i32) / factorial);
            }
            fft.process(&mut line);
            for (node, v) in line.iter().enumerate() {
                let turned = v * turns[node];
                // A real number times a power of j.
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
        Moments { table: Arc::new(table), samples, reach_bins: reach }
    }

    /// The moments for chirps of `samples`, an integer fraction of the number of before.
    pub fn sampled_as(&self, samples: usize) -> Self {
        Moments { samples, ..self.clone() }
    }

    /// The moments at differences of `bins`, which wrap at the number of range bins. Orders 1 and 2 are 0 unless `ALL`.
    #[inline(always)]
    pub fn at<const ALL: bool, const FMA: bool>(&self, bins: Lanes<f64, W>) -> MomentsAt {
        // The channels of an end mostly differ by so little that one node is near all.
        let (node, line, sign) = self.node(bins.0[W / 2]);
        let gaps = bins - Lanes::splat(node / NODES_PER_BIN as f64);
        if gaps.0.iter().all(|gap| gap.abs() <= MAX_NODE_DISTANCE_BINS) {
            return taylor::<ALL, FMA>(gaps, Lanes::splat(sign), |term| Lanes::splat(line[term]));
        }
        let nodes = bins.0.map(|bins| self.node(bins));
        let gaps = bins - Lanes(nodes.map(|(node, ..)| node / NODES_PER_BIN as f64));
        taylor::<ALL, FMA>(gaps, Lanes(nodes.map(|(.., sign)| sign)), |term| {
            Lanes(nodes.map(|(_, line, _)| line[term]))
        })
    }

    /// The node nearest to a difference, its coefficients, and the factor of the wraps.
    #[inline(always)]
    fn node(&self, bins: f64) -> (f64, &[f64; TAYLOR_TERMS], f64) {
        let all = self.samples as f64;
        let wraps = (bins / all).round();
        let node = (bins * NODES_PER_BIN as f64).round();
        let index = (node - wraps * all * NODES_PER_BIN as f64) as i64;
        let line = &self.table[index.rem_euclid(self.table.len() as i64) as usize];
        // The phase is that at the chirp's middle.
        let is_turned = wraps as i64 % 2 != 0 && self.samples.is_multiple_of(2);
        (node, line, if is_turned { -1.0 } else { 1.0 })
    }
}

/// The moments at distances `h` from a node, by the Taylor series and its first two derivatives.
#[inline(always)]
fn taylor<const ALL: bool, const FMA: bool>(
    h: Lanes<f64, W>,
    sign: Lanes<f64, W>,
    coefficients: impl Fn(usize) -> Lanes<f64, W>,
) -> MomentsAt {
    let zero = Lanes::splat(0.0);
    let (mut value, mut slope, mut half_curvature) = (coefficients(TAYLOR_TERMS - 1), zero, zero);
    for term in (0..TAYLOR_TERMS - 1).rev() {
        if ALL {
            half_curvature = half_curvature.mul_add::<FMA>(h, slope);
            slope = slope.mul_add::<FMA>(h, value);
        }
        value = value.mul_add::<FMA>(h, coefficients(term));
    }
    let scaled = |v: f64| sign * Lanes::splat(v);
    let second = half_curvature * scaled(-2.0 / (TAU * TAU));
    MomentsAt { zeroth: value * sign, first: slope * scaled(-1.0 / TAU), second }
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
                let scale = 1e-12 * samples as f64;
                // Beside differences that the same node serves, and beside others.
                for apart in [0.05, 3.7] {
                    let lanes = Lanes(std::array::from_fn(|lane| d + apart * (lane as f64 - 3.0)));
                    let found = moments.at::<true, false>(lanes);
                    assert!((found.zeroth.0[3] - sums[0].re).abs() < scale, "{d}: {:?} {}", found.zeroth, sums[0]);
                    assert!((found.first.0[3] - sums[1].im).abs() < scale, "{d}: {:?} {}", found.first, sums[1]);
                    assert!((found.second.0[3] - sums[2].re).abs() < scale, "{d}: {:?} {}", found.second, sums[2]);
                    assert_eq!(moments.at::<false, false>(lanes).zeroth, found.zeroth);
                }
            }
        }
    }
}
