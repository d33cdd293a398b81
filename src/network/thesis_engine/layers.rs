//! The layers of a weight file with each batch norm folded into its convolution.

use crate::network::weights::{WeightFile, WeightsError};

/// Term that batch norms add to a variance before its root: the default of burn and PyTorch, and the author's value.
const EPSILON: f32 = 1e-5;

/// Source of layers, under the names of [`Thesis`](super::super::thesis::Thesis). Errors name the tensor that is missing or of another shape.
#[derive(Clone, Copy)]
pub(super) struct ThesisLayers<'a> {
    pub(super) file: &'a WeightFile<'a>,
}

impl ThesisLayers<'_> {
    /// Weights and bias of stage `name`, a convolution `[output, input, size, size]`; with `outputs` 1 transposed, `[input, output, size, size]`.
    pub(super) fn conv(&self, name: &str, shape: [usize; 4], outputs: usize) -> Result<[Vec<f32>; 2], WeightsError> {
        let mut weights = self.file.tensor(&format!("{name}.conv.weight"), &shape)?;
        let [scale, shift] = self.scale_and_shift(name, shape[outputs])?;
        let each = shape[outputs + 1..].iter().product();
        for (of_output, scale) in weights.chunks_exact_mut(each).zip(scale.iter().cycle()) {
            of_output.iter_mut().for_each(|w| *w *= scale);
        }
        Ok([weights, shift])
    }

    fn scale_and_shift(&self, name: &str, channels: usize) -> Result<[Vec<f32>; 2], WeightsError> {
        let tensor = |part: &str| self.file.tensor(&format!("{name}.norm.{part}"), &[channels]);
        let (gamma, beta, mean, variance) =
            (tensor("weight")?, tensor("bias")?, tensor("running_mean")?, tensor("running_var")?);
        let scale: Vec<f32> = gamma.iter().zip(&variance).map(|(g, v)| g / (v + EPSILON).sqrt()).collect();
        let shift = beta.iter().zip(&mean).zip(&scale).map(|((b, m), s)| b - m * s).collect();
        Ok([scale, shift])
    }
}
