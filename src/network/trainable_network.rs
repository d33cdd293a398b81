//! Input, target and estimated map of each network that can be trained.

use crate::evaluate::TARGET_ETA;
use crate::maps::cartesian::project;
use crate::maps::{LogMaps, Normalisation, RangeAngleMap};
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::signal::{BeatSignal, TwoEnds};
use burn::module::Module;
use burn::tensor::{Device, Tensor, TensorData};
use ndarray::Array2;

/// A network that can be trained.
pub trait TrainableNetwork: Module + Clone {
    /// Width and depth.
    type Config: Clone + Send + Sync;

    /// Name in weight files.
    const NAME: &'static str;
    /// Channels of the input.
    const CHANNELS: usize;

    /// Random weights.
    fn fresh(config: &Self::Config, device: &Device) -> Self;

    /// The input made of the two ends' samples, `[channels, rows, columns]` row-major.
    fn input(config: &Self::Config, radar: &Radar, ends: &TwoEnds) -> Result<Vec<f32>, ReconstructError>;

    /// The target for the network's output, every cell in [0, 1].
    fn target(config: &Self::Config, radar: &Radar, signal: &BeatSignal) -> RangeAngleMap {
        let _ = config;
        LogMaps::of_signal(radar, signal).full.normalise(Normalisation::MinMax)
    }

    /// The network's answer `[batch, 1, rows, columns]` to a batch of inputs.
    fn answer(&self, inputs: Tensor<4>) -> Tensor<4>;

    /// Estimates the maps of a batch, `[batch, rows, columns]`.
    fn estimate(&self, inputs: &[Vec<f32>], [rows, columns]: [usize; 2], device: &Device) -> Tensor<3> {
        let shape = [inputs.len(), Self::CHANNELS, rows, columns];
        let inputs = Tensor::from_data(TensorData::new(inputs.concat(), shape), device);
        self.answer(inputs).reshape([shape[0], rows, columns])
    }

    /// The map of which the squared error is taken: an estimate with every cell in [0, 1].
    fn finish(estimate: Array2<f32>) -> RangeAngleMap {
        RangeAngleMap { lambda: estimate.mapv(|v| v.clamp(0.0, 1.0)) }
    }

    /// The map that is compared with a threshold; the thesis stretches its networks' answers to [0, 1] for that.
    fn thresholded(estimate: Array2<f32>) -> RangeAngleMap {
        Self::finish(estimate)
    }
}

/// The map of Lambda above the target threshold on the scene's own coordinates, 1 or 0, `[rows, 2 rows]` row-major.
pub fn thresholded_cartesian(radar: &Radar, map: &RangeAngleMap, rows: usize) -> Vec<f32> {
    let bright = RangeAngleMap { lambda: map.lambda.mapv(|v| f32::from(v > TARGET_ETA)) };
    project(radar, &bright, rows).lambda.iter().map(|v| f32::from(*v > 0.0)).collect()
}
