//! The whole array's map of known objects, as it is *expected* over a noise floor.
//!
//! The squared error is smallest for the expectation of Lambda, not for one more draw of the noise: two independent draws differ by
//! twice the variance that a draw and its mean do.

use super::atom::Atom;
use crate::maps::tolerance::tolerance_for;
use crate::maps::{Aperture, Normalisation, RangeAngleMap, angle_transform, range_transform};
use crate::radar::{End, Radar};
use crate::reconstruct::Request;
use crate::scene::{MIN_ELEMENT_DISTANCE_METRES, Reflector};
use crate::signal::floor::thesis_noise_variance;
use crate::signal::plan::amplitude_bound;
use crate::signal::{Plan, beat_signal};
use ndarray::{Array2, Zip};
use rayon::prelude::*;
use std::f64::consts::LN_10;
use std::sync::LazyLock;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// White noise beneath the samples of the whole array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// Rounding as the thesis' program leaves it, from the objects themselves.
    Rounding,
    /// The same over the elements, scaled to this variance a sample in the mean of both ends: as it was measured.
    RoundingHeard(f64),
    /// Variance a sample.
    Variance(f64),
}

/// An atom and its reflectivity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// The atom.
    pub atom: Atom,
    /// Its reflectivity.
    pub reflectivity: f64,
}

/// A map as it is expected, and its scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Lambda, `[range bins, columns]`.
    pub map: RangeAngleMap,
    /// Decades of amplitude from Lambda 0 to 1.
    pub decades: f64,
}

/// Expected Lambda of the whole array over `objects`, as accurate as the floor of `request` can show.
pub fn expected_lambda(radar: &Radar, objects: &[Weighted], noise: Noise, request: &Request) -> Expected {
    let reflectors: Vec<Reflector> = objects
        .iter()
        .flat_map(|o| o.atom.reflectors(o.reflectivity))
        // The simulator takes reflectors that touch no element.
        .map(|r| Reflector { y_metres: r.y_metres.max(MIN_ELEMENT_DISTANCE_METRES), ..r })
        .collect();
    let tolerance = tolerance_for(request.floor, request.normalisation);
    let plan = Plan::cheapest(reflectors.len(), amplitude_bound(radar, &reflectors), tolerance);
    let signal = beat_signal(radar, &reflectors, &plan);
    let variance = match noise {
        Noise::Variance(v) => vec![v; radar.elements],
        Noise::Rounding => thesis_noise_variance(radar, &reflectors),
        Noise::RoundingHeard(v) => scaled_to(radar, v, thesis_noise_variance(radar, &reflectors)),
    };
    let cell_noise = cell_noise(radar, &variance).max(f64::MIN_POSITIVE);
    let profiles = range_transform(radar, &signal);
    let cells = angle_transform(radar, &profiles, Aperture::Full).cells;

    // The smallest of all cells: near zero each |Y|^2 has density exp(-s/N)/N, so the minimum of |Y|^2 is exponential with the sum of these.
    let mut decades = Array2::zeros(cells.dim());
    let rows: Vec<(f64, f64)> = Zip::from(decades.rows_mut())
        .and(cells.rows())
        .into_par_iter()
        .map(|(row, cells)| {
            let (mut rate, mut strongest) = (0.0, f64::NEG_INFINITY);
            for (decades, cell) in row.into_iter().zip(cells) {
                let ratio = cell.norm_sqr() / cell_noise;
                rate += if ratio < LARGE_RATIO { (-ratio).exp() } else { 0.0 };
                *decades = 0.5 * (cell_noise.log10() + mean_log(ratio) / LN_10);
                strongest = strongest.max(*decades);
            }
            (rate, strongest)
        })
        .collect();
    let rate = rows.iter().map(|r| r.0).sum::<f64>() / cell_noise;
    let strongest = rows.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
    let noise_peak = (cell_noise * ((cells.len() as f64).ln() + EULER)).log10() / 2.0;
    let peak = strongest.max(noise_peak);
    let range = match request.normalisation {
        Normalisation::DynamicRange(db) => db.amplitude_decades(),
        Normalisation::MinMax => {
            // Under a window whose side lobes don't fall to the noise the smallest cell is an echo's own.
            let weakest = decades.iter().copied().fold(f64::INFINITY, f64::min);
            let noisy = rate * 10f64.powf(2.0 * weakest) > 1.0;
            if noisy { expected_range(peak, rate) } else { (peak - weakest).max(1e-3) }
        }
    };
    let mut lambda = Array2::zeros(decades.dim());
    Zip::from(&mut lambda)
        .and(&decades)
        .par_for_each(|out, l| *out = (1.0 - (peak - l) / range).clamp(0.0, 1.0) as f32);
    Expected { map: RangeAngleMap { lambda }, decades: range }
}

/// Variances of all elements, scaled so that both ends have this one in the mean.
fn scaled_to(radar: &Radar, ends_variance: f64, variance: Vec<f64>) -> Vec<f64> {
    let ends = End::BOTH.into_iter().flat_map(|end| radar.end_range(end));
    let (sum, count) = ends.fold((0.0, 0.0), |(sum, count), n| (sum + variance[n], count + 1.0));
    if sum > 0.0 { variance.iter().map(|v| v * ends_variance * count / sum).collect() } else { variance }
}

/// Variance of each map cell's noise, from that of a sample of each element: the window's mean power in range and in angle.
fn cell_noise(radar: &Radar, variance: &[f64]) -> f64 {
    let range: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
    let angle: f64 = radar.window.weights(radar.elements).iter().zip(variance).map(|(w, v)| w * w * v).sum::<f64>();
    range * angle / radar.elements as f64
}

/// The range that Lambda divides by: the harmonic mean of `peak - min` where `10^(2 min)` is exponential with `rate`.
fn expected_range(peak: f64, rate: f64) -> f64 {
    const STEPS: usize = 400;
    let scale = -rate.max(f64::MIN_POSITIVE).log10() / 2.0;
    let mean_inverse: f64 = (0..STEPS)
        .map(|i| {
            let exponential = -((i as f64 + 0.5) / STEPS as f64).ln();
            1.0 / (peak - scale - exponential.log10() / 2.0).max(1e-3)
        })
        .sum::<f64>()
        / STEPS as f64;
    mean_inverse.recip()
}

/// Power over noise from which on the noise no longer shows in the mean of the logarithm.
const LARGE_RATIO: f64 = 40.0;

/// Mean of `ln |Y|^2` for complex Gaussian Y of variance 1 around a mean of power `ratio`: [`ln_plus_e1`], from a table.
fn mean_log(ratio: f64) -> f64 {
    /// Entries for each unit of the ratio; a straight line between them is off by at most 2e-5.
    const DENSITY: f64 = 64.0;
    static TABLE: LazyLock<Vec<f64>> =
        LazyLock::new(|| (0..=(LARGE_RATIO * DENSITY) as usize + 1).map(|i| ln_plus_e1(i as f64 / DENSITY)).collect());
    if ratio >= LARGE_RATIO {
        return ratio.ln();
    }
    let at = ratio * DENSITY;
    let (low, part) = (at as usize, at.fract());
    TABLE[low] + part * (TABLE[low + 1] - TABLE[low])
}

/// `ln x + E1(x)`, E1 the exponential integral: -EULER at 0, ln x far out (Abramowitz and Stegun 5.1.11 and 5.1.22).
fn ln_plus_e1(x: f64) -> f64 {
    if x < 1.5 {
        let (mut term, mut sum) = (1.0, 0.0);
        for k in 1..24 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum - EULER;
    }
    let mut fraction = 0.0;
    for k in (1..40).rev() {
        let k = f64::from(k);
        fraction = k / (1.0 + k / (x + fraction));
    }
    x.ln() + (-x).exp() / (x + fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_integral_has_its_tabled_values() {
        for (x, e1) in [(0.1, 1.822_923_958), (1.0, 0.219_383_934_4), (2.0, 0.048_900_510_71), (10.0, 4.156_968_93e-6)]
        {
            let found = ln_plus_e1(x) - f64::ln(x);
            assert!((found - e1).abs() < 2e-9, "{x}: {found} {e1}");
        }
        assert!((ln_plus_e1(0.0) + EULER).abs() < 1e-15);
        for ratio in [0.0, 0.003, 0.7, 5.01, 39.999, 40.0, 1e6] {
            assert!((mean_log(ratio) - if ratio > 700.0 { ratio.ln() } else { ln_plus_e1(ratio) }).abs() < 2e-5);
        }
    }
}
