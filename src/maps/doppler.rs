//! The range-Doppler map: echo power over range and radial velocity.
//!
//! A windowed transform over the samples of every chirp gives range, as in every map. A windowed transform over the chirps gives the phase from
//! chirp to chirp, which is proportional to radial velocity ([`Radar::unambiguous_velocity_metres_per_second`]). Powers are averaged over the
//! elements.
//!
//! Rows are range bins; columns are velocities, 0 in column `chirps / 2`, away from the radar to the right.

use super::{LogMap, channels_range_transform, guard};
use crate::files::npz::{NpzError, write_npz};
use crate::radar::Radar;
use crate::scene::{Scene, SceneError, npz};
use crate::signal::simd::Simd;
use crate::signal::{ChirpSamples, Floor, SimulationError, SimulationResult, simulate_chirps_for};
use crate::task::Task;
use ndarray::{Array1, Array2, ArrayView3, Axis, s};
use num_complex::Complex64;
use rayon::prelude::*;
use std::path::Path;

const BLOCK_BINS: usize = 8;

/// Power over range and radial velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeDopplerMap {
    /// Mean power over the elements, `[range bins, velocities]`.
    pub power: Array2<f64>,
}

/// The range-Doppler map of a scene over `floor`, with noise by `seed`.
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn range_doppler(radar: &Radar, scene: &Scene, floor: Floor, seed: u64) -> Result<RangeDopplerMap, SceneError> {
    range_doppler_for(&Task::default(), radar, scene, floor, seed).map_err(SimulationError::of_scene)
}

/// As [`range_doppler`].
/// # Errors
/// [`SimulationError`] when the scene can't be simulated, and after a cancellation of `task`.
pub fn range_doppler_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    floor: Floor,
    seed: u64,
) -> SimulationResult<RangeDopplerMap> {
    let samples = simulate_chirps_for(task, radar, scene, floor, seed)?;
    let map = RangeDopplerMap::of(radar, samples);
    task.check()?;
    Ok(map)
}

impl RangeDopplerMap {
    /// The map of the samples of all chirps. Both transforms have the radar's window and are orthonormal.
    pub fn of(radar: &Radar, samples: ChirpSamples) -> RangeDopplerMap {
        let (chirps, elements, bins) = samples.samples.dim();
        let empty = || RangeDopplerMap { power: Array2::zeros((bins, chirps)) };
        // The samples in the order of the axes, in any memory layout.
        let Ok(rows) = samples.samples.to_shape((chirps * elements, bins)) else { return empty() };
        let profiles = channels_range_transform(radar, rows.view()).profiles;
        drop(rows);
        drop(samples);
        let Ok(profiles) = profiles.into_shape_with_order((chirps, elements, bins)) else { return empty() };
        let mut map = empty();
        let turns_back = radar.middle_turns_per_metre() < 0.0;
        let transform = ChirpTransform::new(radar, chirps, elements);
        let blocks = map.power.axis_chunks_iter_mut(Axis(0), BLOCK_BINS).into_par_iter().enumerate();
        blocks.for_each(|(block, mut power)| {
            let profiles = profiles.slice(s![.., .., block * BLOCK_BINS..block * BLOCK_BINS + power.nrows()]);
            for (bin, bin_powers) in transform.powers(profiles).into_iter().enumerate() {
                for (frequency, value) in bin_powers.into_iter().enumerate() {
                    let turns = if turns_back { chirps - frequency } else { frequency };
                    power[[bin, (chirps / 2 + turns) % chirps]] = value;
                }
            }
        });
        map
    }

    /// Decades of amplitude of every cell.
    pub fn log_magnitude(&self) -> LogMap {
        let guard = guard(self.power.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max).sqrt());
        LogMap::new(self.power.mapv(|power| (power.sqrt() + guard).log10()))
    }

    /// Range bin and column of the strongest cell.
    pub fn peak(&self) -> (usize, usize) {
        let strongest = self.power.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1));
        strongest.map_or((0, 0), |(cell, _)| cell)
    }
}

struct ChirpTransform {
    fft: std::sync::Arc<dyn rustfft::Fft<f64>>,
    window: Vec<f64>,
    elements: usize,
}

impl ChirpTransform {
    fn new(radar: &Radar, chirps: usize, elements: usize) -> Self {
        let scale = (chirps as f64).sqrt().recip();
        let window = radar.window.weights(chirps).into_iter().map(|w| w * scale).collect();
        ChirpTransform { fft: Simd::chosen().forward_fft(chirps), window, elements }
    }

    /// Mean power at each frequency of each bin of `[chirps, elements, bins]`.
    fn powers(&self, profiles: ArrayView3<'_, Complex64>) -> Vec<Vec<f64>> {
        let chirps = self.window.len();
        let mut powers = vec![vec![0.0; chirps]; profiles.dim().2];
        let mut lines = vec![vec![Complex64::default(); chirps]; profiles.dim().2];
        let mut scratch = vec![Complex64::default(); self.fft.get_inplace_scratch_len()];
        for element in 0..self.elements {
            for (chirp, weight) in self.window.iter().enumerate() {
                for (line, value) in lines.iter_mut().zip(profiles.slice(s![chirp, element, ..])) {
                    line[chirp] = value * weight;
                }
            }
            for (line, power) in lines.iter_mut().zip(&mut powers) {
                self.fft.process_with_scratch(line, &mut scratch);
                power.iter_mut().zip(line).for_each(|(power, v)| *power += v.norm_sqr() / self.elements as f64);
            }
        }
        powers
    }
}

/// Writes the map with its axes: `power` (f64 `[range bins, velocities]`, mean over the elements), `range_metres`,
/// `velocity_metres_per_second` (away from the radar is positive), `unambiguous_velocity_metres_per_second`, `chirps`,
/// `chirp_interval_seconds`, and the places of the scene's points as [`npz::X_KEY`] and [`npz::Y_KEY`].
/// # Errors
/// [`NpzError`] where the file can't be written; nothing is left half-written.
pub fn write_range_doppler(path: &Path, radar: &Radar, scene: &Scene, map: &RangeDopplerMap) -> Result<(), NpzError> {
    let (bins, chirps) = map.power.dim();
    let axis = |len: usize, of: &dyn Fn(f64) -> f64| (0..len).map(|i| of(i as f64)).collect::<Array1<f64>>();
    write_npz(path, |out| {
        npz::add_positions(out, scene)?;
        out.add("power", &map.power)?;
        out.add("range_metres", &axis(bins, &|bin| radar.range_of_bin_metres(bin)))?;
        let velocity = |column| radar.velocity_of_column_metres_per_second(column);
        out.add("velocity_metres_per_second", &axis(chirps, &velocity))?;
        let max = radar.unambiguous_velocity_metres_per_second();
        out.add("unambiguous_velocity_metres_per_second", &ndarray::arr0(max))?;
        out.add("chirps", &ndarray::arr0(radar.chirps as i64))?;
        out.add("chirp_interval_seconds", &ndarray::arr0(radar.chirp_interval_seconds))
    })
}

#[cfg(test)]
mod tests;
