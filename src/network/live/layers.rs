//! Layers of the live network's burn module.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Linear, PaddingConfig2d};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

/// 3x3 convolution, circular in angle, zero-padded in range.
#[derive(Module, Debug)]
pub struct WrapConv {
    conv: Conv2d,
}

impl WrapConv {
    pub(super) fn new(input: usize, output: usize, device: &Device) -> Self {
        let conv = Conv2dConfig::new([input, output], [3, 3]).with_padding(PaddingConfig2d::Explicit(1, 0, 1, 0));
        WrapConv { conv: conv.init(device) }
    }

    pub(super) fn zeroed(mut self) -> Self {
        self.conv.weight = self.conv.weight.map(|w| w.zeros_like());
        self.conv.bias = self.conv.bias.map(|b| b.map(|b| b.zeros_like()));
        self
    }

    pub(super) fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let columns = x.dims()[3];
        let wrapped = Tensor::cat(vec![x.clone().narrow(3, columns - 1, 1), x.clone(), x.narrow(3, 0, 1)], 3);
        self.conv.forward(wrapped)
    }
}

/// Means and maxima of rows and of columns, mixed and added to every cell.
#[derive(Module, Debug)]
pub struct Context {
    row: Conv2d,
    col: Conv2d,
}

impl Context {
    pub(super) fn new(channels: usize, device: &Device) -> Self {
        let mix = || Conv2dConfig::new([2 * channels, channels], [1, 1]).init(device);
        Context { row: mix(), col: mix() }
    }

    pub(super) fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let pooled = |dim: usize| Tensor::cat(vec![x.clone().mean_dim(dim), x.clone().max_dim(dim)], 1);
        let row = relu(self.row.forward(pooled(3)));
        let col = relu(self.col.forward(pooled(2)));
        x + row + col
    }
}

/// Residual block of two convolutions, with row and column context where it has any.
#[derive(Module, Debug)]
pub struct ResidualBlock {
    conv1: WrapConv,
    conv2: WrapConv,
    context: Option<Context>,
}

impl ResidualBlock {
    pub(super) fn new(channels: usize, context: bool, device: &Device) -> Self {
        ResidualBlock {
            conv1: WrapConv::new(channels, channels, device),
            conv2: WrapConv::new(channels, channels, device).zeroed(),
            context: context.then(|| Context::new(channels, device)),
        }
    }

    pub(super) fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let mut h = self.conv1.forward(relu(x.clone()));
        if let Some(context) = &self.context {
            h = context.forward(h);
        }
        x + self.conv2.forward(relu(h))
    }
}

pub(super) fn blocks(count: usize, channels: usize, context: bool, device: &Device) -> Vec<ResidualBlock> {
    (0..count).map(|_| ResidualBlock::new(channels, context, device)).collect()
}

pub(super) fn through(blocks: &[ResidualBlock], x: Tensor<4>) -> Tensor<4> {
    blocks.iter().fold(x, |x, block| block.forward(x))
}

/// The network's head starts quiet: small weights, three decades below its middle.
pub(super) fn small(mut conv: Conv2d) -> Conv2d {
    conv.weight = conv.weight.map(|w| w * 0.3);
    conv.bias = conv.bias.map(|b| b.map(|b| b.full_like(-1.0)));
    conv
}

/// A linear layer that starts by saying nothing.
pub(super) fn zeroed(mut linear: Linear) -> Linear {
    linear.weight = linear.weight.map(|w| w.zeros_like());
    linear.bias = linear.bias.map(|b| b.map(|b| b.zeros_like()));
    linear
}
