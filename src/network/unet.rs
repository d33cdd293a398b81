//! The thesis' failure (its section 3.3 and figure 3-2): a U-Net between thresholded Cartesian maps learns to answer zeros.
//!
//! Both ends' maps are thresholded and projected onto the scene; the target is the whole array's map treated alike. Only a few cells in a
//! thousand are bright, so an output of zeros has nearly no mean square error, and training ends there: the gradient of the few bright cells is
//! small against that of the many dark ones. The program includes it to show this.

use super::trainable_network::{TrainableNetwork, thresholded_cartesian};
use crate::maps::{LogMaps, Normalisation, RangeAngleMap, channels_map};
use crate::radar::{End, Radar};
use crate::reconstruct::ReconstructError;
use crate::signal::{BeatSignal, TwoEnds};
use burn::module::Module;
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::tensor::activation::{relu, sigmoid};
use burn::tensor::module::max_pool2d;
use burn::tensor::ops::MaxPoolOptions;
use burn::tensor::{Device, Tensor};
use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// Width and depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnetConfig {
    /// Channels of the finest level; every level below has twice as many.
    pub channels: usize,
    /// Number of halvings.
    pub levels: usize,
    /// Rows of the Cartesian maps; they have twice as many columns.
    pub rows: usize,
}

impl Default for UnetConfig {
    fn default() -> Self {
        UnetConfig { channels: 8, levels: 3, rows: 128 }
    }
}

#[derive(Module, Debug)]
struct Pair {
    conv1: Conv2d,
    conv2: Conv2d,
}

impl Pair {
    fn new(input: usize, output: usize, device: &Device) -> Self {
        let conv = |i: usize| {
            Conv2dConfig::new([i, output], [3, 3]).with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1)).init(device)
        };
        Pair { conv1: conv(input), conv2: conv(output) }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        relu(self.conv2.forward(relu(self.conv1.forward(x))))
    }
}

/// The U-Net, `[batch, 2, rows, 2 rows]` to `[batch, 1, rows, 2 rows]`, every cell in [0, 1].
#[derive(Module, Debug)]
pub struct Unet {
    down: Vec<Pair>,
    bottom: Pair,
    up: Vec<ConvTranspose2d>,
    join: Vec<Pair>,
    head: Conv2d,
}

impl TrainableNetwork for Unet {
    type Config = UnetConfig;
    const NAME: &'static str = "unet";
    const CHANNELS: usize = 2;

    fn fresh(config: &UnetConfig, device: &Device) -> Self {
        let width = |level: usize| config.channels << level;
        let levels = config.levels;
        let up = |level: usize| {
            ConvTranspose2dConfig::new([width(level + 1), width(level)], [2, 2]).with_stride([2, 2]).init(device)
        };
        Unet {
            down: (0..levels).map(|l| Pair::new(if l == 0 { 2 } else { width(l - 1) }, width(l), device)).collect(),
            bottom: Pair::new(width(levels - 1), width(levels), device),
            up: (0..levels).map(up).collect(),
            join: (0..levels).map(|l| Pair::new(2 * width(l), width(l), device)).collect(),
            head: Conv2dConfig::new([width(0), 1], [1, 1]).init(device),
        }
    }

    fn input(config: &UnetConfig, radar: &Radar, ends: &TwoEnds) -> Result<Vec<f32>, ReconstructError> {
        let half = |end| {
            let map = channels_map(radar, ends.end(end).view()).log_magnitude().normalise(Normalisation::MinMax);
            thresholded_cartesian(radar, &map, config.rows)
        };
        Ok(End::BOTH.map(half).concat())
    }

    fn target(config: &UnetConfig, radar: &Radar, signal: &BeatSignal) -> RangeAngleMap {
        let full = LogMaps::of_signal(radar, signal).full.normalise(Normalisation::MinMax);
        let bright = thresholded_cartesian(radar, &full, config.rows);
        let lambda = Array2::from_shape_fn((config.rows, 2 * config.rows), |(i, j)| bright[i * 2 * config.rows + j]);
        RangeAngleMap { lambda }
    }

    fn answer(&self, mut x: Tensor<4>) -> Tensor<4> {
        let mut kept = Vec::new();
        for pair in &self.down {
            let y = pair.forward(x);
            x = max_pool2d(y.clone(), MaxPoolOptions::new([2, 2]));
            kept.push(y);
        }
        x = self.bottom.forward(x);
        for ((up, join), y) in self.up.iter().zip(&self.join).zip(kept).rev() {
            x = join.forward(Tensor::cat(vec![y, up.forward(x)], 1));
        }
        sigmoid(self.head.forward(x))
    }
}
