//! Expectation of the whole array's map of known objects over a noise floor.
//!
//! The expectation of Lambda has the least squared error. A map with simulated noise has twice the error, since both draws of the noise count.

use super::over_noise::OverNoise;
use crate::maps::fast::{FastLogMap, MapMaker, MapSources};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{End, Radar};
use crate::reconstruct::Request;
use crate::reconstruct::significance::decades_above_cells;
use crate::scene::{MIN_ELEMENT_DISTANCE_METRES, Reflector};
use crate::signal::floor::{snr_over, thesis_noise_variance};
use crate::signal::plan::amplitude_bound;
use crate::signal::simd::{LANES_F32, LANES_F64, Real};
use crate::signal::synthesis::{BlockProfiles, Synthesis};
use crate::signal::{Precision, Rows, SynthesisPlan};
use crate::task::Task;
use rayon::prelude::*;
use std::f64::consts::EULER_GAMMA;

/// Cells that are summed in f32.
const F32_SUM_CELLS: usize = 1024;

/// Noise in the samples of the whole array, white over samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// The rounding of the thesis' program, computed from the objects.
    Rounding,
    /// The same rounding, scaled to this measured variance of a sample, the mean of both ends.
    RoundingScaled(f64),
    /// This variance of a sample at all elements.
    Variance(f64),
}

/// An expected map, and its scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Lambda, `[range bins, columns]`.
    pub map: RangeAngleMap,
    /// Decades of amplitude from Lambda 0 to 1.
    pub decades: f64,
    /// Lambda that noise alone doesn't exceed ([`Reconstruction::least_eta`](crate::reconstruct::Reconstruction::least_eta)).
    pub least_eta: f32,
}

/// Expected Lambda of the whole array's map of `reflectors`, computed to the tolerance of the floor of `request`.
pub fn expected_lambda(
    radar: &Radar,
    reflectors: impl Iterator<Item = Reflector>,
    noise: Noise,
    request: &Request,
) -> Expected {
    let reflectors: Vec<Reflector> = reflectors
        // The simulator requires this distance from the elements.
        .map(|r| Reflector { y_metres: r.y_metres.max(MIN_ELEMENT_DISTANCE_METRES), ..r })
        .collect();
    let snr = match noise {
        Noise::Variance(variance) => snr_over(radar, &reflectors, variance),
        Noise::Rounding | Noise::RoundingScaled(_) => None,
    };
    let tolerance = request.noise.tolerance(request.normalisation, snr);
    let plan = SynthesisPlan::cheapest(reflectors.len(), amplitude_bound(radar, &reflectors), tolerance);
    let map = match plan.precision {
        Precision::F64 => log_map::<f64, LANES_F64>(radar, &reflectors, plan, &request.task),
        Precision::F32 => log_map::<f32, LANES_F32>(radar, &reflectors, plan, &request.task),
    };
    let variance = match noise {
        Noise::Variance(v) => vec![v; radar.elements],
        Noise::Rounding => thesis_noise_variance(radar, &reflectors),
        Noise::RoundingScaled(v) => scaled_to(radar, v, thesis_noise_variance(radar, &reflectors)),
    };
    over_noise(map, cell_noise(radar, &variance).max(f64::MIN_POSITIVE), request.normalisation)
}

/// Expected Lambda of white noise alone. Both normalisations begin at the map's peak, so that the noise's level doesn't matter.
pub fn expected_noise(radar: &Radar, normalisation: Normalisation) -> Expected {
    over_noise(FastLogMap::silence(radar), 1.0, normalisation)
}

/// The whole array's map without noise, decades of amplitude.
fn log_map<T: Real, const W: usize>(
    radar: &Radar,
    reflectors: &[Reflector],
    plan: SynthesisPlan,
    task: &Task,
) -> FastLogMap {
    let mut profiles = BlockProfiles::silence(radar);
    Synthesis::<T, W>::new(radar, plan).range_profiles(reflectors, &mut profiles, task);
    let gain = (radar.samples as f64 * radar.elements as f64).sqrt();
    let bound = gain * amplitude_bound(radar, reflectors);
    let sources = MapSources { profiles: &[&profiles], noise: None, bound };
    let mut map = FastLogMap::silence(radar);
    MapMaker::new(radar, plan.simd).fill(sources, [None, None, Some(&mut map)], &Rows::all(radar.samples));
    map
}

/// Expected Lambda of `map`, decades of amplitude, over noise of the mean power `cell_noise` in a cell.
fn over_noise(mut map: FastLogMap, cell_noise: f64, normalisation: Normalisation) -> Expected {
    let over = OverNoise::new(cell_noise);
    // Near zero the power of each cell has the density exp(-s/N)/N, so the least power of all cells is exponential with the sum of these as its rate.
    let rate = map.cells.as_slice().map_or(0.0, |cells| {
        let rows =
            cells.par_chunks(F32_SUM_CELLS).map(|row| row.iter().map(|d| over.cell(*d).zero_density).sum::<f32>());
        rows.map(f64::from).sum::<f64>()
    }) / cell_noise;
    let [weakest, strongest] = [map.min, map.max].map(|decades| f64::from(over.cell(decades).decades));
    let noise_peak = (cell_noise * ((map.cells.len() as f64).ln() + EULER_GAMMA)).log10() / 2.0;
    let peak = strongest.max(noise_peak);
    let range = match normalisation {
        Normalisation::DynamicRange(db) => db.amplitude_decades(),
        Normalisation::MinMax => {
            // Under a window whose side lobes exceed the noise everywhere, the weakest cell is one of echoes.
            let is_noise = rate * 10f64.powf(2.0 * weakest) > 1.0;
            if is_noise { expected_range(peak, rate) } else { (peak - weakest).max(1e-3) }
        }
    };
    let least_eta = 1.0 - (peak - decades_above_cells(cell_noise, map.cells.len())) / range;
    let least_eta = least_eta.clamp(0.0, 1.0) as f32;
    let (peak, scale) = (peak as f32, range.recip() as f32);
    map.cells.par_mapv_inplace(|d| (1.0 - (peak - over.cell(d).decades) * scale).clamp(0.0, 1.0));
    Expected { map: RangeAngleMap { lambda: map.cells }, decades: range, least_eta }
}

/// `variance` of the elements, scaled so that its mean over both ends is `ends_variance`.
fn scaled_to(radar: &Radar, ends_variance: f64, variance: Vec<f64>) -> Vec<f64> {
    let ends = End::BOTH.into_iter().flat_map(|end| radar.end_range(end));
    let (sum, count) = ends.fold((0.0, 0.0), |(sum, count), n| (sum + variance[n], count + 1.0));
    if sum > 0.0 { variance.iter().map(|v| v * ends_variance * count / sum).collect() } else { variance }
}

/// Mean power of the noise in a cell of the map, from its `variance` in a sample of each element.
fn cell_noise(radar: &Radar, variance: &[f64]) -> f64 {
    let range: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>() / radar.samples as f64;
    let angle: f64 = radar.window.weights(radar.elements).iter().zip(variance).map(|(w, v)| w * w * v).sum::<f64>();
    range * angle / radar.elements as f64
}

/// Expected decades from Lambda 0 to 1: the harmonic mean of `peak - min`, where `10^(2 min)` is exponentially distributed with `rate`.
fn expected_range(peak: f64, rate: f64) -> f64 {
    // Quantiles of the minimum in the mean.
    const QUANTILES: usize = 400;
    let scale = -rate.max(f64::MIN_POSITIVE).log10() / 2.0;
    let mean_inverse: f64 = (0..QUANTILES)
        .map(|i| {
            let exponential = -((i as f64 + 0.5) / QUANTILES as f64).ln();
            1.0 / (peak - scale - exponential.log10() / 2.0).max(1e-3)
        })
        .sum::<f64>()
        / QUANTILES as f64;
    mean_inverse.recip()
}
