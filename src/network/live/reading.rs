//! The layers of a weight file, packed for the engine.

use super::grid::CONSTANTS;
use super::planes::{PlaneBlock, PlaneContext};
use super::winograd::Conv3x3;
use crate::network::kernels::convolution::{Packed, padded};
use crate::network::weights::{WeightFile, WeightsError};

/// Number of cells that a spreading layer computes from one cell.
pub(super) const CELLS: usize = 4;

/// Layers of a weight file. All methods return [`WeightsError`] where a tensor is missing or has another shape.
#[derive(Clone, Copy)]
pub(super) struct LiveLayers<'a> {
    pub(super) file: &'a WeightFile<'a>,
}

impl LiveLayers<'_> {
    pub(super) fn tensors(&self, name: &str, shape: &[usize]) -> Result<[Vec<f32>; 2], WeightsError> {
        let tensor = |part: &str, shape: &[usize]| self.file.tensor(&format!("{name}.{part}"), shape);
        Ok([tensor("weight", shape)?, tensor("bias", &shape[..1])?])
    }

    /// As [`LiveLayers::tensors`]; the weights of the last `added` inputs are zeros where an older file lacks them.
    pub(super) fn tensors_or_older(
        &self,
        name: &str,
        shape: &[usize],
        added: usize,
    ) -> Result<[Vec<f32>; 2], WeightsError> {
        let mut old_shape = shape.to_vec();
        old_shape[1] -= added;
        if self.file.shape(&format!("{name}.weight")) != Some(&old_shape) {
            return self.tensors(name, shape);
        }
        let [weights, bias] = self.tensors(name, &old_shape)?;
        let area: usize = shape[2..].iter().product();
        let widened = |of_output: &[f32]| [of_output, &vec![0.0; added * area]].concat();
        Ok([weights.chunks_exact(old_shape[1] * area).flat_map(widened).collect(), bias])
    }

    /// A 3x3 convolution of the first `input` channels of cells with `stride` channels.
    pub(super) fn conv(&self, name: &str, [input, stride]: [usize; 2], output: usize) -> Result<Conv3x3, WeightsError> {
        let [weights, bias] = self.tensors(name, &[output, input, 3, 3])?;
        Ok(Conv3x3::new(&weights, &bias, input, stride))
    }

    /// The first convolution. Older files lack its last inputs, the radar's constants.
    pub(super) fn stem(&self, name: &str, input: usize, output: usize) -> Result<Conv3x3, WeightsError> {
        let [weights, bias] = self.tensors_or_older(name, &[output, input, 3, 3], CONSTANTS)?;
        Ok(Conv3x3::new(&weights, &bias, input, input))
    }

    /// A 3x3 convolution that spreads one cell over [`CELLS`] cells of `channels` channels.
    pub(super) fn widened(&self, name: &str, input: usize, channels: usize) -> Result<Conv3x3, WeightsError> {
        let [weights, bias] = self.tensors(name, &[CELLS * channels, input, 3, 3])?.map(|v| cell_by_cell(&v, channels));
        Ok(Conv3x3::new(&weights, &bias, input, padded(input)))
    }

    /// A convolution with `kernel` rows and columns, and a stride of as many.
    pub(super) fn small(&self, name: &str, input: usize, output: usize, kernel: usize) -> Result<Packed, WeightsError> {
        let [weights, bias] = self.tensors(name, &[output, input, kernel, kernel])?;
        Ok(Packed::new(&weights, &bias, [input, padded(input)], [kernel; 2], kernel))
    }

    /// A 1x1 convolution that spreads one cell over [`CELLS`] cells of `channels` channels.
    pub(super) fn up(&self, name: &str, input: usize, channels: usize) -> Result<Packed, WeightsError> {
        let [weights, bias] = self.tensors(name, &[CELLS * channels, input, 1, 1])?.map(|v| cell_by_cell(&v, channels));
        Ok(Packed::new(&weights, &bias, [input, padded(input)], [1, 1], 1))
    }

    /// A linear layer of contiguous numbers. Older files lack the last `added` of them.
    pub(super) fn linear(&self, name: &str, [input, added]: [usize; 2], output: usize) -> Result<Packed, WeightsError> {
        let [weights, bias] = self.tensors_or_older(name, &[output, input], added)?;
        Ok(Packed::new(&weights, &bias, [input; 2], [1, 1], 1))
    }

    pub(super) fn blocks(
        &self,
        name: &str,
        count: usize,
        c: usize,
        context: bool,
    ) -> Result<Vec<PlaneBlock>, WeightsError> {
        let block = |i: usize| {
            let part = |p: &str| format!("{name}.{i}.{p}");
            let context = match context {
                true => Some(PlaneContext {
                    row: self.mix(&part("context.row"), c)?,
                    col: self.mix(&part("context.col"), c)?,
                }),
                false => None,
            };
            let conv = |p: &str| self.conv(&part(p), [c, padded(c)], c);
            Ok(PlaneBlock { conv1: conv("conv1.conv")?, conv2: conv("conv2.conv")?, context })
        };
        (0..count).map(block).collect()
    }

    /// A 1x1 convolution of `c` means and `c` maxima, each padded to whole vectors.
    fn mix(&self, name: &str, c: usize) -> Result<Packed, WeightsError> {
        let [weights, bias] = self.tensors(name, &[c, 2 * c, 1, 1])?;
        let lanes = padded(c);
        let mut spread = vec![0.0; c * 2 * lanes];
        for (out, row) in spread.chunks_exact_mut(2 * lanes).zip(weights.chunks_exact(2 * c)) {
            out[..c].copy_from_slice(&row[..c]);
            out[lanes..lanes + c].copy_from_slice(&row[c..]);
        }
        Ok(Packed::new(&spread, &bias, [2 * lanes; 2], [1, 1], 1))
    }
}

/// Reorders the weights of a layer that spreads one cell over several of `channels` channels, from PyTorch's channel by channel to cell by cell.
fn cell_by_cell(of_channels: &[f32], channels: usize) -> Vec<f32> {
    let each = of_channels.len() / (CELLS * channels);
    let part = |cell: usize, channel: usize| &of_channels[(channel * CELLS + cell) * each..][..each];
    (0..CELLS).flat_map(|cell| (0..channels).flat_map(move |channel| part(cell, channel))).copied().collect()
}

/// The circulant matrix `[n, n]` of amplitudes by `kernel`, decades for each circular distance between row and column.
pub(super) fn circulant(kernel: &[f32], n: usize) -> Vec<f32> {
    let distance = |k: usize| (k / n).abs_diff(k % n).min(n - (k / n).abs_diff(k % n));
    let amplitudes: Vec<f32> = kernel.iter().map(|decades| 10f32.powf(*decades)).collect();
    (0..n * n).map(|k| amplitudes[distance(k)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_missing_in_an_older_file_have_zero_weights() {
        let header = r#"{"a.weight":{"dtype":"F32","shape":[2,1,1,2],"data_offsets":[0,16]},
            "a.bias":{"dtype":"F32","shape":[2],"data_offsets":[16,24]}}"#;
        let numbers = [1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0].map(f32::to_le_bytes).concat();
        let bytes = [&(header.len() as u64).to_le_bytes(), header.as_bytes(), &numbers].concat();
        let file = WeightFile::parse("older", &bytes).unwrap();
        let read =
            |input: usize, added: usize| LiveLayers { file: &file }.tensors_or_older("a", &[2, input, 1, 2], added);
        assert_eq!(read(1, 0).unwrap(), [vec![1.0, 2.0, 3.0, 4.0], vec![5.0, 6.0]]);
        let widened = vec![1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(read(3, 2).unwrap(), [widened, vec![5.0, 6.0]]);
        assert!(read(3, 1).unwrap_err().to_string().contains("expected [2, 3, 1, 2]"));
    }
}
