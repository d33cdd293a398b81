//! Input, target and estimated map of each network that can be trained.

use super::thesis::{Thesis, ThesisConfig};
use super::unet::{Unet, UnetConfig};
use crate::evaluate::TARGET_ETA;
use crate::maps::cartesian::project;
use crate::maps::network_input::mag_phase;
use crate::maps::{LogMaps, Normalisation, RangeAngleMap, channels_map};
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::signal::{BeatSignal, TwoEnds};
use burn::module::Module;
use burn::tensor::{Device, Tensor, TensorData};
use ndarray::Array2;

/// A network that can be trained.
pub trait Student: Module + Clone {
    /// Width and depth.
    type Config: Clone + Send + Sync;
    /// The network's input for one scene.
    type Input: Send;

    /// Name in weight files.
    const NAME: &'static str;

    /// Random weights.
    fn fresh(config: &Self::Config, device: &Device) -> Self;

    /// The part of the input that depends on the radar alone.
    type Tables: Send + Sync;

    /// Makes the tables.
    /// # Errors
    /// [`ReconstructError`] for a radar that the network can't use.
    fn tables(config: &Self::Config, radar: &Radar) -> Result<Self::Tables, ReconstructError>;

    /// The input made of the two ends' samples.
    /// # Errors
    /// [`ReconstructError`] on samples that the network can't use.
    fn input(tables: &Self::Tables, ends: &TwoEnds) -> Result<Self::Input, ReconstructError>;

    /// The target for the network's output, every cell in [0, 1].
    fn target(config: &Self::Config, radar: &Radar, signal: &BeatSignal) -> RangeAngleMap {
        let _ = config;
        LogMaps::of_signal(radar, signal).full.normalise(Normalisation::MinMax)
    }

    /// Estimates the maps of a batch, `[batch, rows, columns]`.
    fn estimate(&self, inputs: &[Self::Input], device: &Device) -> Tensor<3>;

    /// The map of which the squared error is taken: an estimate with every cell in [0, 1].
    fn finish(estimate: Array2<f32>) -> RangeAngleMap {
        RangeAngleMap { lambda: estimate.mapv(|v| v.clamp(0.0, 1.0)) }
    }

    /// The map that is compared with a threshold; the thesis stretches its networks' answers to [0, 1] for that.
    fn thresholded(estimate: Array2<f32>) -> RangeAngleMap {
        Self::finish(estimate)
    }
}

/// Equally shaped arrays as one tensor with a batch dimension.
pub fn stack<const D: usize>(arrays: &[Vec<f32>], shape: [usize; D], device: &Device) -> Tensor<D> {
    Tensor::from_data(TensorData::new(arrays.concat(), shape.to_vec()), device)
}

/// The thesis' four-channel input, with its size.
#[derive(Debug, Clone)]
pub struct ThesisInput {
    /// `[4, bins, columns]`, row-major.
    pub values: Vec<f32>,
    /// Range bins and columns.
    pub size: [usize; 2],
}

impl Student for Thesis {
    type Config = ThesisConfig;
    type Input = ThesisInput;
    type Tables = Radar;
    const NAME: &'static str = "thesis";

    fn fresh(config: &ThesisConfig, device: &Device) -> Self {
        Thesis::new(config, device)
    }

    fn tables(config: &ThesisConfig, radar: &Radar) -> Result<Radar, ReconstructError> {
        let least = 1 << config.levels;
        if !(radar.samples.is_multiple_of(least) && radar.elements.is_multiple_of(least)) {
            let reason = format!(
                "{} levels need samples and elements to be multiples of {least}; the radar has {} and {}",
                config.levels, radar.samples, radar.elements
            );
            return Err(ReconstructError::Unusable { method: Self::NAME, reason });
        }
        Ok(radar.clone())
    }

    fn input(radar: &Radar, ends: &TwoEnds) -> Result<ThesisInput, ReconstructError> {
        let input = mag_phase(&channels_map(radar, ends.first.view()), &channels_map(radar, ends.last.view()));
        Ok(ThesisInput { values: input.iter().map(|v| *v as f32).collect(), size: [radar.samples, radar.elements] })
    }

    fn estimate(&self, inputs: &[ThesisInput], device: &Device) -> Tensor<3> {
        let [rows, columns] = inputs.first().map_or([0, 0], |i| i.size);
        let values: Vec<f32> = inputs.iter().flat_map(|i| i.values.iter().copied()).collect();
        let x = Tensor::<4>::from_data(TensorData::new(values, vec![inputs.len(), 4, rows, columns]), device);
        self.forward(x).reshape([inputs.len(), rows, columns])
    }

    fn thresholded(estimate: Array2<f32>) -> RangeAngleMap {
        RangeAngleMap::stretched(estimate)
    }
}

/// The map of Lambda above the target threshold on the scene's own coordinates, 1 or 0, `[rows, 2 rows]` row-major.
pub fn thresholded_cartesian(radar: &Radar, map: &RangeAngleMap, rows: usize) -> Vec<f32> {
    let bright = RangeAngleMap { lambda: map.lambda.mapv(|v| f32::from(v > TARGET_ETA)) };
    project(radar, &bright, rows).lambda.iter().map(|v| f32::from(*v > 0.0)).collect()
}

/// Radar and rows of the Cartesian maps.
#[derive(Debug, Clone)]
pub struct UnetTables {
    radar: Radar,
    rows: usize,
}

impl Student for Unet {
    type Config = UnetConfig;
    type Input = Vec<f32>;
    type Tables = UnetTables;
    const NAME: &'static str = "unet";

    fn fresh(config: &UnetConfig, device: &Device) -> Self {
        Unet::new(config, device)
    }

    fn tables(config: &UnetConfig, radar: &Radar) -> Result<UnetTables, ReconstructError> {
        Ok(UnetTables { radar: radar.clone(), rows: config.rows })
    }

    fn input(tables: &UnetTables, ends: &TwoEnds) -> Result<Vec<f32>, ReconstructError> {
        let UnetTables { radar, rows } = tables;
        let half = |samples: &ndarray::Array2<num_complex::Complex64>| {
            let lambda = channels_map(radar, samples.view()).log_magnitude().normalise(Normalisation::MinMax);
            thresholded_cartesian(radar, &lambda, *rows)
        };
        Ok([half(&ends.first), half(&ends.last)].concat())
    }

    fn target(config: &UnetConfig, radar: &Radar, signal: &BeatSignal) -> RangeAngleMap {
        let full = LogMaps::of_signal(radar, signal).full.normalise(Normalisation::MinMax);
        let bright = thresholded_cartesian(radar, &full, config.rows);
        let lambda = Array2::from_shape_fn((config.rows, 2 * config.rows), |(i, j)| bright[i * 2 * config.rows + j]);
        RangeAngleMap { lambda }
    }

    fn estimate(&self, inputs: &[Vec<f32>], device: &Device) -> Tensor<3> {
        // Two maps of `rows` by `2 rows` cells.
        let rows = inputs.first().map_or(0, |i| (i.len() / 4).isqrt());
        let x = stack(inputs, [inputs.len(), 2, rows, 2 * rows], device);
        self.forward(x).reshape([inputs.len(), rows, 2 * rows])
    }
}
