//! The thesis' encoder-decoder. Its encoder is two parallel towers of dilated convolutions with circular padding, of 3x3 and of 5x5 kernels. Their
//! outputs are concatenated, and a decoder of transposed convolutions restores the size of the map.
//!
//! In the thesis each tower has five levels of 64 filters: 1.62 million parameters, 40.5 GMAC a map. Width and depth are configurable: two processor
//! cores can train 16 filters (3.4 GMAC). Dilation 2, circular padding on both axes and no bias are as in the author's published program.

use super::trainable_network::TrainableNetwork;
use super::weights::{WeightFile, WeightsError};
use crate::maps::network_input::mag_phase;
use crate::maps::{RangeAngleMap, channels_map};
use crate::radar::{End, Radar};
use crate::reconstruct::ReconstructError;
use crate::signal::TwoEnds;
use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig};
use burn::tensor::activation::relu;
use burn::tensor::module::max_pool2d;
use burn::tensor::ops::MaxPoolOptions;
use burn::tensor::{Device, Tensor};
use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// Prefix of the tensor names of the 3x3 tower, in the author's program and in this crate.
const TOWER_3X3_PREFIX: &str = "down.layer3x3";

/// Dilation of every convolution of the towers.
const DILATION: usize = 2;

/// Width and depth of [`Thesis`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThesisConfig {
    /// Filters of each tower, 64 in the thesis. The decoder has twice as many.
    pub filters: usize,
    /// Levels, each of which halves the map on both axes; 5 in the thesis.
    pub levels: usize,
    /// Whether training starts with mean and standard deviation [`ALIVE_OUTPUT_MOMENTS`] of the last batch norm, near those of the targets. In the
    /// author's program they are 0 and 1: half of the cells start below zero, where the final ReLU has no gradient.
    #[serde(default)]
    pub alive_output: bool,
}

impl ThesisConfig {
    /// Most filters that a recipe or a weight file may ask for.
    pub const MAX_FILTERS: usize = 512;
    /// Most levels that a recipe or a weight file may ask for.
    pub const MAX_LEVELS: usize = 8;

    /// Checks that maps of `radar` can be halved `levels` times.
    /// # Errors
    /// [`ReconstructError::Unusable`] where the numbers of samples or elements are no multiples of `2^levels`.
    pub(super) fn check(&self, radar: &Radar) -> Result<(), ReconstructError> {
        let (Radar { samples, elements, .. }, levels, least) = (radar, self.levels, 1 << self.levels);
        if samples.is_multiple_of(least) && elements.is_multiple_of(least) {
            return Ok(());
        }
        let reason = format!(
            "{levels} levels need samples and elements to be multiples of {least}; the radar has {samples} and {elements}"
        );
        Err(ReconstructError::Unusable { method: "thesis", reason })
    }
}

/// Mean and standard deviation of the output, before the ReLU, at the start of training with [`ThesisConfig::alive_output`].
const ALIVE_OUTPUT_MOMENTS: [f64; 2] = [0.45, 0.15];

impl Default for ThesisConfig {
    fn default() -> Self {
        ThesisConfig { filters: 64, levels: 5, alive_output: false }
    }
}

/// A level of a tower: convolution, batch norm, ReLU, maximum over 2x2 cells. `norm` is `None` after folding.
#[derive(Module, Debug)]
struct DownStage {
    conv: Conv2d,
    norm: Option<BatchNorm>,
}

/// A level of the decoder: transposed convolution, batch norm, ReLU. `norm` is `None` after folding.
#[derive(Module, Debug)]
struct UpStage {
    conv: ConvTranspose2d,
    norm: Option<BatchNorm>,
}

/// The encoder. The fields have the names of the tensors in weight files.
#[derive(Module, Debug)]
struct Down {
    layer3x3: Vec<DownStage>,
    layer5x5: Vec<DownStage>,
}

/// The decoder. The field has the name of the tensors in weight files.
#[derive(Module, Debug)]
struct Up {
    upconv: Vec<UpStage>,
}

/// The thesis' network, from [`mag_phase`]'s `[batch, 4, range bins, columns]` to Lambda, `[batch, 1, range bins, columns]`.
#[derive(Module, Debug)]
pub struct Thesis {
    down: Down,
    up: Up,
}

impl TrainableNetwork for Thesis {
    type Config = ThesisConfig;
    const NAME: &'static str = "thesis";
    const CHANNELS: usize = 4;

    fn fresh(config: &ThesisConfig, device: &Device) -> Self {
        let ThesisConfig { filters, levels, alive_output } = *config;
        let norm = |c: usize| Some(BatchNormConfig::new(c).init(device));
        let tower = |kernel: usize| {
            let stage = |i: usize| DownStage {
                conv: Conv2dConfig::new([if i == 0 { 4 } else { filters }, filters], [kernel, kernel])
                    .with_dilation([DILATION, DILATION])
                    .with_bias(false)
                    .init(device),
                norm: norm(filters),
            };
            (0..levels).map(stage).collect()
        };
        let up = |i: usize| {
            let is_last = i + 1 == levels;
            let out = if is_last { 1 } else { 2 * filters };
            let mut norm = BatchNormConfig::new(out).init(device);
            if is_last && alive_output {
                norm.beta = Param::from_tensor(Tensor::full([out], ALIVE_OUTPUT_MOMENTS[0], device));
                norm.gamma = Param::from_tensor(Tensor::full([out], ALIVE_OUTPUT_MOMENTS[1], device));
            }
            UpStage {
                conv: ConvTranspose2dConfig::new([2 * filters, out], [4, 4])
                    .with_stride([2, 2])
                    .with_padding([1, 1])
                    .with_bias(false)
                    .init(device),
                norm: Some(norm),
            }
        };
        Thesis {
            down: Down { layer3x3: tower(3), layer5x5: tower(5) },
            up: Up { upconv: (0..levels).map(up).collect() },
        }
    }

    fn input(config: &ThesisConfig, radar: &Radar, ends: &TwoEnds) -> Result<Vec<f32>, ReconstructError> {
        config.check(radar)?;
        let [first, last] = End::BOTH.map(|end| channels_map(radar, ends.end(end).view()));
        Ok(mag_phase(&first, &last).iter().map(|v| *v as f32).collect())
    }

    fn answer(&self, x: Tensor<4>) -> Tensor<4> {
        let tower = |stages: &[DownStage]| stages.iter().fold(x.clone(), |x, stage| stage.forward(x));
        let joined = Tensor::cat(vec![tower(&self.down.layer3x3), tower(&self.down.layer5x5)], 1);
        self.up.upconv.iter().fold(joined, |x, stage| stage.forward(x))
    }

    fn thresholded(estimate: Array2<f32>) -> RangeAngleMap {
        RangeAngleMap::stretched(estimate)
    }
}

impl Thesis {
    /// Width and depth of the network whose weights are in `file`.
    /// # Errors
    /// [`WeightsError`] when the first convolution is missing or has more than [`ThesisConfig::MAX_FILTERS`] filters.
    pub fn config_of(file: &WeightFile) -> Result<ThesisConfig, WeightsError> {
        let stage = |level: usize| {
            let in_this_crate = file.shape(&format!("{TOWER_3X3_PREFIX}.{level}.conv.weight"));
            in_this_crate.or_else(|| file.shape(&format!("{TOWER_3X3_PREFIX}.{level}.0.weight")))
        };
        let problem = match stage(0) {
            Some(&[filters @ 1..=ThesisConfig::MAX_FILTERS, ..]) => {
                let levels = (0..ThesisConfig::MAX_LEVELS).take_while(|level| stage(*level).is_some()).count();
                return Ok(ThesisConfig { filters, levels, alive_output: false });
            }
            Some(shape) => format!("has shape {shape:?}; expected 1 to {} filters", ThesisConfig::MAX_FILTERS),
            None => "is missing; expected the state of the thesis' network".to_owned(),
        };
        Err(file.bad_tensor(&format!("{TOWER_3X3_PREFIX}.0.0.weight"), problem))
    }

    /// A network with the weights of `file`: a file of this crate, or the author's `MultiFilter.state_dict()`.
    /// # Errors
    /// [`WeightsError`] when a tensor is missing or has another shape than `config` expects.
    pub fn load(file: &WeightFile, config: &ThesisConfig, device: &Device) -> Result<Self, WeightsError> {
        let mut network = Thesis::fresh(config, device);
        let renamed = Thesis::in_our_names(file)?;
        WeightFile::parse(file.name(), &renamed)?.load_into(&mut network, Thesis::ignores)?;
        Ok(network)
    }

    /// The bytes of `file`, with this crate's tensor names in place of those of the author's PyTorch program.
    /// # Errors
    /// [`WeightsError`] if the header can't be written again.
    pub(super) fn in_our_names(file: &WeightFile) -> Result<Vec<u8>, WeightsError> {
        file.renamed(from_pytorch)
    }

    /// Whether a tensor called `name` is not needed: PyTorch's counts of batches.
    pub(super) fn ignores(name: &str) -> bool {
        name.ends_with("num_batches_tracked")
    }

    /// The same network for inference, with every batch norm folded into the convolution before it.
    pub fn folded(mut self) -> Self {
        let Down { layer3x3, layer5x5 } = &mut self.down;
        for DownStage { conv, norm } in layer3x3.iter_mut().chain(layer5x5) {
            fold(norm, &mut conv.weight, &mut conv.bias, 0);
        }
        for UpStage { conv, norm } in &mut self.up.upconv {
            fold(norm, &mut conv.weight, &mut conv.bias, 1);
        }
        self
    }
}

/// Folds a batch norm into the weights and the bias of the convolution before it. The weights' dimension `output_dim` is that of the output channels.
fn fold(
    norm: &mut Option<BatchNorm>,
    weight: &mut Param<Tensor<4>>,
    bias: &mut Option<Param<Tensor<1>>>,
    output_dim: usize,
) {
    let Some(norm) = norm.take() else { return };
    let scale = norm.gamma.val() / (norm.running_var.value() + norm.epsilon).sqrt();
    let shift = norm.beta.val() - norm.running_mean.value() * scale.clone();
    let mut shape = [1; 4];
    shape[output_dim] = scale.dims()[0];
    *weight = weight.clone().map(|w| w * scale.reshape(shape));
    *bias = Some(Param::from_tensor(shift));
}

impl DownStage {
    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let [kernel, _] = self.conv.kernel_size;
        let border = DILATION * (kernel / 2);
        let x = self.conv.forward(wrap(wrap(x, 2, border), 3, border));
        let x = self.norm.as_ref().map_or(x.clone(), |norm| norm.forward(x));
        max_pool2d(relu(x), MaxPoolOptions::new([2, 2]))
    }
}

impl UpStage {
    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let x = self.conv.forward(x);
        relu(self.norm.as_ref().map_or(x.clone(), |norm| norm.forward(x)))
    }
}

/// Pads both ends of dimension `dim` circularly by `n` cells. The cells repeat where the dimension is shorter than `n`.
fn wrap(x: Tensor<4>, dim: usize, n: usize) -> Tensor<4> {
    let size = x.dims()[dim];
    let n = n.min(size * 8);
    let part = n % size;
    let edge = |from: usize| (part > 0).then(|| x.clone().narrow(dim, from, part));
    let whole = std::iter::repeat_n(x.clone(), 2 * (n / size) + 1);
    Tensor::cat(edge(size - part).into_iter().chain(whole).chain(edge(0)).collect(), dim)
}

/// This crate's name of a tensor of the author's program, where a stage's convolution and batch norm are its items 0 and 1.
fn from_pytorch(name: &str) -> String {
    let mut parts: Vec<&str> = name.split('.').collect();
    if let [.., _, index, _] = parts.as_mut_slice() {
        match *index {
            "0" => *index = "conv",
            "1" => *index = "norm",
            _ => {}
        }
    }
    parts.join(".")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Written by `training/reference.py` from a PyTorch model with the author's layout: 3 filters, 3 levels, batch norm
    /// statistics away from their defaults.
    const WEIGHTS: &[u8] = include_bytes!("../../tests/data/thesis_reference_weights.safetensors");
    const REFERENCE: &[u8] = include_bytes!("../../tests/data/thesis_reference.safetensors");

    #[test]
    fn the_network_reproduces_pytorch() {
        let device = Device::flex();
        let config = ThesisConfig { filters: 3, levels: 3, alive_output: false };
        let file = WeightFile::parse("weights", WEIGHTS).unwrap();
        let network = Thesis::load(&file, &config, &device).unwrap();
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let input = reference.tensor("input", &[1, 4, 16, 32]).unwrap();
        let expected = reference.tensor("output", &[1, 1, 16, 32]).unwrap();
        let input = Tensor::<4>::from_data(burn::tensor::TensorData::new(input, vec![1, 4, 16, 32]), &device);
        for (name, network) in [("as loaded", network.clone()), ("folded", network.folded())] {
            let found = network.answer(input.clone()).into_data().try_into_vec::<f32>().unwrap();
            let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-4, "{name}: {worst}");
        }
        assert!(expected.iter().any(|v| *v > 0.1), "a reference of zeros would prove nothing");
    }

    #[test]
    fn an_alive_output_starts_above_zero_almost_everywhere() {
        // Batch norms use the batch's own statistics where gradients are recorded.
        let device = Device::flex().autodiff();
        device.seed(1);
        let positive = |alive_output: bool| {
            let network = Thesis::fresh(&ThesisConfig { filters: 2, levels: 2, alive_output }, &device);
            let input = Tensor::<4>::random([1, 4, 32, 32], burn::tensor::Distribution::Normal(0.0, 1.0), &device);
            let output = network.answer(input).into_data().try_into_vec::<f32>().unwrap();
            output.iter().filter(|v| **v > 0.0).count() as f64 / output.len() as f64
        };
        assert!(positive(false) < 0.7, "as in the author's program, half of the cells are dead");
        assert!(positive(true) > 0.95);
    }

    #[test]
    fn the_full_width_has_the_thesis_size() {
        let network = Thesis::fresh(&ThesisConfig::default(), &Device::flex());
        // Convolutions; scale and shift of the batch norms; their running mean and variance.
        assert_eq!(network.num_params(), 1_616_384 + 2306 + 2306);
    }
}
