//! The live network as a burn module.

pub use super::config::INPUT_CHANNELS;
use super::config::{DECODER_CHANNELS, FOLD, LiveConfig, WIDE_COLUMNS};
use super::constants::{SPACING_AT, WINDOWS, WINDOWS_AT};
use super::features::LiveInput;
use super::grid::{COARSE, COARSE_CHANNELS, COLUMNS, CONSTANTS, FINE, FINE_CHANNELS, ROW_CHANNELS, ROWS, SCALARS};
use super::layers::{ResidualBlock, WrapConv, blocks, small, through, zeroed};
use crate::network::weights::WeightFile;
use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Int, Tensor, TensorData};
use std::f64::consts::LN_10;

/// The live network. See the [room](super) for what it is made of.
#[derive(Module, Debug)]
pub struct LiveNetwork {
    stem: WrapConv,
    enc0: Vec<ResidualBlock>,
    down1: Conv2d,
    enc1: Vec<ResidualBlock>,
    down2: Conv2d,
    enc2: Vec<ResidualBlock>,
    down3: Conv2d,
    enc3: Vec<ResidualBlock>,
    up2: Conv2d,
    dec2: Vec<ResidualBlock>,
    up1: Conv2d,
    dec1: Vec<ResidualBlock>,
    up0: Conv2d,
    dec0: Vec<ResidualBlock>,
    widen: WrapConv,
    fine1: WrapConv,
    fine2: Conv2d,
    row_sources: Conv2d,
    col_kernel: Param<Tensor<1>>,
    row_kernel: Param<Tensor<1>>,
    col_kernels: Param<Tensor<2>>,
    row_kernels: Param<Tensor<2>>,
    scalar1: Linear,
    scalar2: Linear,
}

/// What the network says about a batch of scenes, in decades above the samples' gain.
#[derive(Debug, Clone)]
pub struct LiveOutput {
    /// log10 |Y| of the whole array, `[batch, 512, 1024]`.
    pub decades: Tensor<3>,
    /// The smallest cell that the true map is expected to have, `[batch]`. Noise decides it, so it is predicted apart.
    pub minimum: Tensor<1>,
}

/// [`LiveInput`]s as tensors.
#[derive(Debug, Clone)]
pub struct LiveBatch {
    fine: Tensor<4>,
    coarse: Tensor<4>,
    rows: Tensor<3>,
    scalars: Tensor<2>,
    constants: Tensor<2>,
}

impl LiveBatch {
    /// Puts inputs side by side on a device.
    pub fn new(inputs: &[LiveInput], device: &Device) -> Self {
        let stacked = |part: fn(&LiveInput) -> &[f32]| inputs.iter().flat_map(part).copied().collect::<Vec<f32>>();
        let n = inputs.len();
        let on = |values: Vec<f32>, shape: &[usize]| TensorData::new(values, shape.to_vec());
        LiveBatch {
            fine: Tensor::from_data(on(stacked(|i| &i.fine), &[n, FINE_CHANNELS, ROWS, FINE]), device),
            coarse: Tensor::from_data(on(stacked(|i| &i.coarse), &[n, COARSE_CHANNELS, ROWS, COARSE]), device),
            rows: Tensor::from_data(on(stacked(|i| &i.rows), &[n, ROW_CHANNELS, ROWS]), device),
            scalars: Tensor::from_data(on(stacked(|i| &i.scalars), &[n, SCALARS]), device),
            constants: Tensor::from_data(on(stacked(|i| &i.constants), &[n, CONSTANTS]), device),
        }
    }
}

impl LiveNetwork {
    /// Whether the tensors of `file` are a live network's, by the name of one that no other network has.
    pub fn is_in(file: &WeightFile) -> bool {
        file.shape("row_kernel").is_some()
    }

    /// A network with random weights.
    pub fn new(config: &LiveConfig, device: &Device) -> Self {
        let [c0, c1, c2, c3] = config.channels;
        let [b0, b1, b2, b3] = config.blocks;
        let halve = |a, b| Conv2dConfig::new([a, b], [2, 2]).with_stride([2, 2]).init(device);
        let mix = |a, b| Conv2dConfig::new([a, b], [1, 1]).init(device);
        LiveNetwork {
            stem: WrapConv::new(INPUT_CHANNELS, c0, device),
            enc0: blocks(b0, c0, false, device),
            down1: halve(c0, c1),
            enc1: blocks(b1.div_ceil(2), c1, false, device),
            down2: halve(c1, c2),
            enc2: blocks(b2.div_ceil(2), c2, true, device),
            down3: halve(c2, c3),
            enc3: blocks(b3, c3, true, device),
            up2: mix(c3, 4 * c2),
            dec2: blocks(b2, c2, true, device),
            up1: mix(c2, 4 * c1),
            dec1: blocks(b1, c1, false, device),
            up0: mix(c1, 4 * c0),
            dec0: blocks(b0, c0, false, device),
            widen: WrapConv::new(c0, DECODER_CHANNELS * FOLD, device),
            fine1: WrapConv::new(DECODER_CHANNELS + FINE_CHANNELS, config.fine, device),
            fine2: small(mix(config.fine, 2 * COLUMNS / FINE)),
            row_sources: small(mix(c0, WIDE_COLUMNS / COARSE)),
            col_kernel: Param::from_tensor(hann_tail(ROWS, -0.5, device)),
            row_kernel: Param::from_tensor(hann_tail(WIDE_COLUMNS, -1.0, device)),
            col_kernels: Param::from_tensor(
                hann_tail(ROWS, -0.5, device).unsqueeze_dim::<2>(0).repeat_dim(0, WINDOWS - 1),
            ),
            row_kernels: Param::from_tensor(
                hann_tail(WIDE_COLUMNS, -1.0, device).unsqueeze_dim::<2>(0).repeat_dim(0, WINDOWS - 1),
            ),
            scalar1: LinearConfig::new(2 * c3 + SCALARS + CONSTANTS, 64).init(device),
            scalar2: zeroed(LinearConfig::new(64, 2).init(device)),
        }
    }

    /// Estimates the maps of a batch.
    pub fn forward(&self, input: LiveBatch) -> LiveOutput {
        let LiveBatch { fine, coarse, rows, scalars, constants } = input;
        let [n, _, _, _] = fine.dims();
        let device = fine.device();
        let fine = decades_in(fine);
        let magnitudes = decades_in(coarse.clone().narrow(1, 0, 4));
        let steps = coarse.narrow(1, 4, COARSE_CHANNELS - 4);
        let powers = decades_in(rows.clone().narrow(1, 4, 2));
        let rows = Tensor::cat(vec![rows.narrow(1, 0, 4), powers], 1);
        let floor = scalars.clone().narrow(1, 0, 1).reshape([n]);
        let scalars = (scalars + 8.0) / 3.0;
        let x = Tensor::cat(
            vec![
                fold_columns(fine.clone(), FOLD),
                magnitudes,
                steps,
                rows.reshape([n, ROW_CHANNELS, ROWS, 1]).expand([n, ROW_CHANNELS, ROWS, COARSE]),
                scalars.clone().reshape([n, SCALARS, 1, 1]).expand([n, SCALARS, ROWS, COARSE]),
                grid(&device, constants.clone().narrow(1, SPACING_AT, 1)),
                constants.clone().reshape([n, CONSTANTS, 1, 1]).expand([n, CONSTANTS, ROWS, COARSE]),
            ],
            1,
        );
        let x0 = through(&self.enc0, self.stem.forward(x));
        let x1 = through(&self.enc1, self.down1.forward(x0.clone()));
        let x2 = through(&self.enc2, self.down2.forward(x1.clone()));
        let x3 = through(&self.enc3, self.down3.forward(x2.clone()));
        let pooled = Tensor::cat(vec![x3.clone().mean_dim(3).mean_dim(2), x3.clone().max_dim(3).max_dim(2)], 1);
        let y2 = through(&self.dec2, x2 + double(self.up2.forward(x3)));
        let y1 = through(&self.dec1, x1 + double(self.up1.forward(y2)));
        let y0 = relu(through(&self.dec0, x0 + double(self.up0.forward(y1))));

        let channels = pooled.dims()[1];
        let hidden = Tensor::cat(vec![pooled.reshape([n, channels]), scalars, constants.clone()], 1);
        let said = self.scalar2.forward(relu(self.scalar1.forward(hidden)));
        let floor = floor + said.clone().narrow(1, 0, 1).reshape([n]);
        let minimum = floor.clone() - 2.5 + said.narrow(1, 1, 1).reshape([n]);

        let f = Tensor::cat(vec![spread_columns(self.widen.forward(y0.clone()), FOLD), fine], 1);
        let heads = spread_columns(self.fine2.forward(relu(self.fine1.forward(f))), COLUMNS / FINE);
        let plane = |k| amplitudes(heads.clone().narrow(1, k, 1).reshape([n, ROWS, COLUMNS]));
        let windows = constants.narrow(1, WINDOWS_AT, WINDOWS - 1);
        let kernel = |hann: &Param<Tensor<1>>, others: &Param<Tensor<2>>, size| {
            circulants(of_windows(&windows, hann.val(), others.val()), size)
        };
        let column = kernel(&self.col_kernel, &self.col_kernels, ROWS).matmul(plane(1));
        let sharp = plane(0) + column;
        let sources =
            spread_columns(self.row_sources.forward(y0), WIDE_COLUMNS / COARSE).reshape([n, ROWS, WIDE_COLUMNS]);
        let each = COLUMNS / WIDE_COLUMNS;
        let pooled = sharp.clone().reshape([n, ROWS, WIDE_COLUMNS, each]).mean_dim(3).reshape([n, ROWS, WIDE_COLUMNS]);
        let row = (amplitudes(sources) + pooled).matmul(kernel(&self.row_kernel, &self.row_kernels, WIDE_COLUMNS));
        let row =
            row.reshape([n, ROWS, WIDE_COLUMNS, 1]).expand([n, ROWS, WIDE_COLUMNS, each]).reshape([n, ROWS, COLUMNS]);
        let total = sharp + row + (floor * LN_10).exp().reshape([n, 1, 1]);
        LiveOutput { decades: total.log() / LN_10, minimum }
    }
}

/// Decades as the network sees them: about -4 to 2.
fn decades_in<const D: usize>(x: Tensor<D>) -> Tensor<D> {
    ((x + 3.0) / 3.0).clamp(-4.0, 2.0)
}

fn amplitudes(x: Tensor<3>) -> Tensor<3> {
    ((x * 3.0 - 3.0).clamp(-18.0, 4.0) * LN_10).exp()
}

/// Range, its logarithm, cos(theta) and sin(theta) of every coarse cell, `[n, 4, 512, 64]`, at spacings `[n, 1]` as the constants tell them.
fn grid(device: &Device, spacing: Tensor<2>) -> Tensor<4> {
    let n = spacing.dims()[0];
    let cell = |f: &dyn Fn(f32, f32) -> f32| -> Vec<f32> {
        let half = (COARSE / 2) as f32;
        (0..ROWS * COARSE).map(|i| f((i / COARSE) as f32, ((i % COARSE) as f32 - half) / half)).collect()
    };
    let values = [cell(&|r, _| r / 256.0 - 1.0), cell(&|r, _| (r + 4.0).log10() - 2.0), cell(&|_, u| u)].concat();
    let grid = Tensor::<4>::from_data(TensorData::new(values, vec![1, 3, ROWS, COARSE]), device);
    let cos = grid.clone().narrow(1, 2, 1).expand([n, 1, ROWS, COARSE]) / (spacing + 1.0).reshape([n, 1, 1, 1]);
    let sin = (-cos.clone() * cos.clone() + 1.0).clamp_min(0.0).sqrt();
    Tensor::cat(vec![grid.narrow(1, 0, 2).expand([n, 2, ROWS, COARSE]), cos, sin], 1)
}

/// `[n, c, h, w * r]` to `[n, c * r, h, w]`: neighbouring columns become channels.
fn fold_columns(x: Tensor<4>, r: usize) -> Tensor<4> {
    let [n, c, h, w] = x.dims();
    x.reshape([n, c, h, w / r, r]).permute([0, 1, 4, 2, 3]).reshape([n, c * r, h, w / r])
}

fn spread_columns(x: Tensor<4>, r: usize) -> Tensor<4> {
    let [n, c, h, w] = x.dims();
    x.reshape([n, c / r, r, h, w]).permute([0, 1, 3, 4, 2]).reshape([n, c / r, h, w * r])
}

/// Pixel shuffle: `[n, 4 c, h, w]` to `[n, c, 2 h, 2 w]`.
fn double(x: Tensor<4>) -> Tensor<4> {
    let [n, c, h, w] = x.dims();
    x.reshape([n, c / 4, 2, 2, h, w]).permute([0, 1, 4, 2, 5, 3]).reshape([n, c / 4, 2 * h, 2 * w])
}

/// log10 of a Hann window's side lobes at distances 0 to n/2: they fall as 1/k^3.
fn hann_tail(n: usize, offset: f32, device: &Device) -> Tensor<1> {
    let values: Vec<f32> = (0..=n / 2).map(|k| offset - 3.0 * (k as f32 + 1.0).log10()).collect();
    Tensor::from_data(TensorData::new(values, vec![n / 2 + 1]), device)
}

/// For each scene the kernel of its window, `[batch, k]`: `hann` `[k]`, or that of `others` `[3, k]` that `windows` `[batch, 3]` names by a 1.
fn of_windows(windows: &Tensor<2>, hann: Tensor<1>, others: Tensor<2>) -> Tensor<2> {
    let is_hann = -windows.clone().sum_dim(1) + 1.0;
    is_hann.matmul(hann.unsqueeze_dim(0)) + windows.clone().matmul(others)
}

/// Matrices `[batch, n, n]` of the even, circular kernels whose log10 at distances 0 to n/2 are `kernels` `[batch, n / 2 + 1]`.
fn circulants(kernels: Tensor<2>, n: usize) -> Tensor<3> {
    let distance = |i: usize, j: usize| i.abs_diff(j).min(n - i.abs_diff(j)) as i64;
    let index: Vec<i64> = (0..n * n).map(|k| distance(k / n, k % n)).collect();
    let index = Tensor::<1, Int>::from_data(TensorData::new(index, vec![n * n]), &kernels.device());
    let batch = kernels.dims()[0];
    (kernels * LN_10).exp().select(1, index).reshape([batch, n, n])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::engine::{LiveEngine, LiveScratch};
    use crate::network::live::features::FeatureExtractor;
    use crate::network::weights::WeightFile;
    use crate::radar::Radar;
    use crate::scene::Reflector;
    use crate::signal::exact;

    /// Written by `training/reference.py`: a tiny network, three reflectors, and what PyTorch makes of them.
    const REFERENCE: &[u8] = include_bytes!("../../../tests/data/live_reference.safetensors");
    const WEIGHTS: &[u8] = include_bytes!("../../../tests/data/live_reference_weights.safetensors");

    fn tiny() -> LiveConfig {
        LiveConfig { channels: [4, 6, 8, 10], blocks: [1, 1, 1, 1], fine: 4 }
    }

    fn input(reference: &WeightFile, loudness: f64) -> LiveInput {
        let radar = Radar::default();
        let points = reference.tensor("points", &[3, 2]).unwrap();
        let reflectors: Vec<Reflector> = points
            .chunks(2)
            .map(|p| Reflector { x_metres: p[0].into(), y_metres: p[1].into(), reflectivity: loudness })
            .collect();
        let ends = exact::beat_signal(&radar, &reflectors).two_ends(&radar);
        FeatureExtractor::new(&radar).unwrap().extract(&ends).unwrap()
    }

    /// Mean and largest distance of every `row`-th row and `column`-th column of `found` planes from a reference.
    fn distance(
        found: &[f32],
        reference: &[f32],
        rows: usize,
        columns: usize,
        row: usize,
        column: usize,
    ) -> (f32, f32) {
        let picked: Vec<f32> = found
            .chunks(rows * columns)
            .flat_map(|plane| {
                plane.chunks(columns).step_by(row).flat_map(move |line| line.iter().step_by(column).copied())
            })
            .collect();
        assert_eq!(picked.len(), reference.len());
        let gaps: Vec<f32> = picked.iter().zip(reference).map(|(a, b)| (a - b).abs()).collect();
        (gaps.iter().sum::<f32>() / gaps.len() as f32, gaps.into_iter().fold(0.0, f32::max))
    }

    #[test]
    fn features_agree_with_the_twin() {
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let found = input(&reference, 1.0);
        let check = |name: &str, values: &[f32], shape: &[usize], rows, columns, row, column| {
            let expected = reference.tensor(name, shape).unwrap();
            let (mean, largest) = distance(values, &expected, rows, columns, row, column);
            assert!(mean < 1e-4 && largest < 5e-2, "{name}: mean {mean}, largest {largest}");
        };
        check("fine", &found.fine, &[4, 16, 32], ROWS, FINE, 32, 8);
        check("coarse", &found.coarse, &[10, 16, 16], ROWS, COARSE, 32, 4);
        check("rows", &found.rows, &[6, 64], 1, ROWS, 1, 8);
        check("scalars", &found.scalars, &[2], 1, 2, 1, 1);
        assert_eq!(found.constants, [0.0; CONSTANTS]);
        check("gain", &[found.gain as f32], &[1], 1, 1, 1, 1);
    }

    /// Weights of version 0.1.0 have no constants of the radar: for the radar that they were trained for, they answer as they did.
    #[test]
    fn weights_of_version_0_1_answer_as_they_did() {
        let weights = include_bytes!("../../../tests/data/program-0.1.0/live_reference_weights.safetensors");
        let reference = include_bytes!("../../../tests/data/program-0.1.0/live_reference.safetensors");
        let reference = WeightFile::parse("reference", reference).unwrap();
        let engine = LiveEngine::new(&WeightFile::parse("weights", weights).unwrap(), &tiny().into()).unwrap();
        let found = engine.forward(&input(&reference, 1.0), &mut LiveScratch::default());
        let (mean, largest) = distance(&found.map, &reference.tensor("log", &[16, 64]).unwrap(), ROWS, COLUMNS, 32, 16);
        assert!(mean < 1e-4 && largest < 1e-2, "mean {mean}, largest {largest}");
    }

    #[test]
    fn the_three_implementations_agree() {
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let weights = WeightFile::parse("weights", WEIGHTS).unwrap();
        let input = input(&reference, 1.0);
        let engine = LiveEngine::new(&weights, &tiny().into()).unwrap();
        let fast = engine.forward(&input, &mut LiveScratch::default());
        let expected = reference.tensor("log", &[16, 64]).unwrap();
        let (mean, largest) = distance(&fast.map, &expected, ROWS, COLUMNS, 32, 16);
        assert!(mean < 1e-4 && largest < 1e-2, "engine against twin: mean {mean}, largest {largest}");
        let minimum = reference.tensor("minimum", &[1]).unwrap()[0];
        assert!((fast.minimum - minimum).abs() < 1e-3, "{} for {minimum}", fast.minimum);

        // The same scene as another radar's, with another window.
        let constants = reference.tensor("constants", &[CONSTANTS]).unwrap().try_into().unwrap();
        let other = LiveInput { constants, ..input.clone() };
        let fast_other = engine.forward(&other, &mut LiveScratch::default());
        let expected = reference.tensor("other_log", &[16, 64]).unwrap();
        let (mean, largest) = distance(&fast_other.map, &expected, ROWS, COLUMNS, 32, 16);
        assert!(mean < 1e-4 && largest < 1e-2, "engine against twin: mean {mean}, largest {largest}");
        assert!(distance(&fast_other.map, &fast.map, ROWS, COLUMNS, 1, 1).0 > 0.05, "the constants say nothing");

        let device = Device::flex();
        let mut module = LiveNetwork::new(&tiny(), &device);
        weights.load_into(&mut module, |_| false).unwrap();
        let slow = module.forward(LiveBatch::new(&[input, other], &device));
        let slow_map = slow.decades.into_data().try_into_vec::<f32>().unwrap();
        let fast_map = [fast.map, fast_other.map].concat();
        let (mean, largest) = distance(&fast_map, &slow_map, ROWS, COLUMNS, 1, 1);
        assert!(mean < 1e-5 && largest < 1e-3, "engine against module: mean {mean}, largest {largest}");
    }

    #[test]
    fn a_louder_receiver_changes_nothing_but_the_gain() {
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let weights = WeightFile::parse("weights", WEIGHTS).unwrap();
        let engine = LiveEngine::new(&weights, &tiny().into()).unwrap();
        let (soft, loud) = (input(&reference, 1.0), input(&reference, 1e6));
        assert!((loud.gain - soft.gain - 6.0).abs() < 1e-9);
        let mut scratch = LiveScratch::default();
        let (a, b) = (engine.forward(&soft, &mut scratch), engine.forward(&loud, &mut scratch));
        let (_, largest) = distance(&a.map, &b.map, ROWS, COLUMNS, 1, 1);
        assert!(largest < 1e-2, "{largest}");
    }

    #[test]
    fn a_second_pass_over_used_buffers_gives_the_same_bits() {
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let weights = WeightFile::parse("weights", WEIGHTS).unwrap();
        let engine = LiveEngine::new(&weights, &tiny().into()).unwrap();
        let input = input(&reference, 1.0);
        let mut scratch = LiveScratch::default();
        assert_eq!(engine.forward(&input, &mut scratch), engine.forward(&input, &mut scratch));
    }
}
