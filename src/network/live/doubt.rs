//! The live network's estimate of its error: a small head, trained on it, gives the decimal exponent of each cell's expected error in Lambda.

use super::columns::ColumnTaps;
use super::grid::{COARSE_COLUMNS, COLUMNS, FINE_COLUMNS};
use super::planes::{Plane, rectified};
use super::reading::LiveLayers;
use super::winograd::{Conv3x3, ConvResults};
use crate::maps::RangeAngleMap;
use crate::network::kernels::convolution::{Packed, padded};
use crate::network::weights::{WeightFile, WeightsError};
use crate::signal::simd::Simd;
use crate::signal::simd::powers::{each, power_of_ten};
use ndarray::Array2;
use rayon::prelude::*;

const TENSOR_PREFIX: &str = "doubt.";
/// Exponents of the head for each cell of the coarse grid.
const EXPONENTS_PER_CELL: usize = FINE_COLUMNS / COARSE_COLUMNS;
const COLUMNS_PER_EXPONENT: usize = COLUMNS / FINE_COLUMNS;

/// Limits of a cell's exponent.
const CELL_EXPONENT_LIMITS: [f32; 2] = [-4.0, 0.0];
/// Largest magnitude of the scene's exponent, which is added to those of all cells.
const MAX_SCENE_EXPONENT: f64 = 0.5;

/// The head's weights.
#[derive(Debug)]
pub struct DoubtHead {
    conv1: Conv3x3,
    /// Outputs: the exponents of a coarse cell, and last its contribution to the scene's exponent.
    conv2: Packed,
}

impl DoubtHead {
    /// The head of `file` on the decoder's finest level of `channels` channels; `None` where the file has none.
    /// # Errors
    /// [`WeightsError`] names the tensor that is missing or of another shape.
    pub fn new(file: &WeightFile, channels: usize) -> Result<Option<Self>, WeightsError> {
        let name = format!("{TENSOR_PREFIX}conv1.conv");
        let Some([hidden, ..]) = file.shape(&format!("{name}.weight")) else { return Ok(None) };
        let (hidden, layers) = (*hidden, LiveLayers { file });
        let [mut weights, mut bias] =
            layers.tensors(&format!("{TENSOR_PREFIX}conv2"), &[EXPONENTS_PER_CELL, hidden, 1, 1])?;
        // The scene's exponent is linear in the mean over the cells. So it is the mean of one more output of each cell.
        let [scene_weights, constant] = layers.tensors(&format!("{TENSOR_PREFIX}scene"), &[1, hidden])?;
        weights.extend(scene_weights);
        bias.extend(constant);
        Ok(Some(DoubtHead {
            conv1: layers.conv(&name, [channels, padded(channels)], hidden)?,
            conv2: Packed::new(&weights, &bias, [hidden, padded(hidden)], [1, 1], 1),
        }))
    }

    /// The expected error of each cell of a map of `columns` columns, by `taps` where not the network's, from the decoder's finest level `picture`.
    pub(super) fn read(&self, picture: &Plane, taps: Option<&ColumnTaps>, columns: usize) -> RangeAngleMap {
        let (rows, lanes) = (picture.h, self.conv2.output());
        let mut exponents = vec![0.0; rows * COARSE_COLUMNS * lanes];
        let read = |row: usize, line: &mut [f32]| line.copy_from_slice(&picture.data[row * line.len()..][..line.len()]);
        let simd = Simd::chosen();
        let heads = |results: ConvResults, out: &mut [f32]| {
            let sums = results.sums();
            sums.iter_mut().for_each(|v| *v = rectified(*v));
            self.conv2.line(simd, sums, COARSE_COLUMNS, COARSE_COLUMNS, out);
        };
        self.conv1.run([rows, COARSE_COLUMNS], read, &mut exponents, heads);
        let scene_exponent = mean(exponents.chunks_exact(lanes).map(|cell| cell[EXPONENTS_PER_CELL]))
            .clamp(-MAX_SCENE_EXPONENT, MAX_SCENE_EXPONENT) as f32;
        let [min, max] = CELL_EXPONENT_LIMITS;
        let mut error = Array2::zeros((rows, columns));
        let lines = error.as_slice_mut().unwrap_or_default().par_chunks_mut(columns);
        lines.zip(exponents.par_chunks(COARSE_COLUMNS * lanes)).for_each(|(line, exponents)| {
            let mut fine = [0.0; FINE_COLUMNS];
            for (to, cell) in fine.chunks_exact_mut(EXPONENTS_PER_CELL).zip(exponents.chunks_exact(lanes)) {
                to.copy_from_slice(&cell[..EXPONENTS_PER_CELL]);
            }
            each(&mut fine, |v| power_of_ten(v.clamp(min, max) + scene_exponent).min(1.0));
            let spread = |line: &mut [f32]| {
                line.chunks_exact_mut(COLUMNS_PER_EXPONENT).zip(fine).for_each(|(to, v)| to.fill(v));
            };
            let Some(taps) = taps else { return spread(line) };
            let mut wide = [0.0; COLUMNS];
            spread(&mut wide);
            taps.fill(&wide, line);
        });
        RangeAngleMap { lambda: error }
    }
}

fn mean(numbers: impl ExactSizeIterator<Item = f32>) -> f64 {
    let count = numbers.len() as f64;
    numbers.map(f64::from).sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::engine::LiveScratch;
    use crate::network::live::grid::ROWS;
    use crate::network::live::twin_tests::{heard, reference, tiny};
    use crate::radar::Radar;

    // `training/reference.py` writes these files.
    /// Weights of a tiny network that has the head.
    const WEIGHTS: &[u8] = include_bytes!("../../../tests/data/doubt_reference_weights.safetensors");
    const WITHOUT: &[u8] = include_bytes!("../../../tests/data/live_reference_weights.safetensors");

    fn doubt_of(weights: &[u8]) -> Option<RangeAngleMap> {
        let (engine, mut scratch) = (tiny(weights), LiveScratch::default());
        engine.forward(&heard(&Radar::default(), &reference()).1, &mut scratch);
        engine.doubt(&scratch)
    }

    #[test]
    fn the_head_agrees_with_its_twin() {
        let found = doubt_of(WEIGHTS).unwrap().lambda;
        let expected = reference().tensor("doubt", &[ROWS / 16, FINE_COLUMNS / 4]).unwrap();
        for (i, expected) in expected.iter().enumerate() {
            let [row, column] = [i / (FINE_COLUMNS / 4) * 16, i % (FINE_COLUMNS / 4) * 4 * COLUMNS_PER_EXPONENT];
            let gap = (found[[row, column]] - expected).abs();
            let holds = gap < 1e-4 && found[[row, column]] == found[[row, column + COLUMNS_PER_EXPONENT - 1]];
            assert!(holds, "{row}, {column}: {gap}");
        }
        let spread = expected.iter().fold(0.0f32, |a, v| a.max(*v)) - expected.iter().fold(1.0f32, |a, v| a.min(*v));
        assert!(spread > 0.01, "the reference says the same everywhere");
    }

    #[test]
    fn weights_without_the_head_have_no_doubt() {
        assert_eq!(doubt_of(WITHOUT), None);
    }
}
