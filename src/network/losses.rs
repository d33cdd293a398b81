//! The training losses that the thesis names.
//!
//! `output` and `target` are Lambda of a batch, `[batch, range bins, columns]`. Every loss is one number; smaller is better.

use crate::evaluate::TARGET_ETA;
use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

/// A training loss.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TrainingLoss {
    /// Mean square (the thesis' experiment 1).
    MeanSquare,
    /// Sum of squares over the sum of the target's magnitude: sparse targets weigh as much as full ones (experiment 2).
    NormalisedSquare,
    /// Binary cross entropy with Lambda read as a probability.
    CrossEntropy,
    /// Minus the peak signal-to-noise ratio in decibels.
    PeakSignalToNoise,
    /// One minus the Dice coefficient with the target mask (Lambda > 0.9).
    Dice,
    /// Focal loss (gamma 2) on the target mask.
    Focal,
    /// Earth mover's distance along the angles of every range row, both rows scaled to one.
    EarthMover,
}

/// Keeps logarithms and quotients finite.
const EPSILON: f32 = 1e-6;

impl TrainingLoss {
    /// The loss of a batch.
    pub fn of(self, output: Tensor<3>, target: Tensor<3>) -> Tensor<1> {
        let square = |a: Tensor<3>, b: Tensor<3>| (a - b).square();
        match self {
            TrainingLoss::MeanSquare => square(output, target).mean(),
            TrainingLoss::NormalisedSquare => square(output, target.clone()).sum() / (target.abs().sum() + EPSILON),
            TrainingLoss::CrossEntropy => cross_entropy(output, target).mean(),
            TrainingLoss::PeakSignalToNoise => {
                (square(output, target).mean() + 1e-12).log() * (10.0 / std::f32::consts::LN_10)
            }
            TrainingLoss::Dice => {
                let mask = target.greater_elem(TARGET_ETA).float();
                let overlap = (output.clone() * mask.clone()).sum();
                -(overlap * 2.0 + EPSILON) / (output.sum() + mask.sum() + EPSILON) + 1.0
            }
            TrainingLoss::Focal => {
                let mask = target.greater_elem(TARGET_ETA).float();
                let p = output.clamp(EPSILON, 1.0 - EPSILON);
                let right = p.clone() * mask.clone() + (-p.clone() + 1.0) * (-mask.clone() + 1.0);
                ((-right + 1.0).square() * cross_entropy(p, mask)).mean()
            }
            TrainingLoss::EarthMover => {
                let scaled = |x: Tensor<3>| {
                    let x = x.clamp_min(0.0) + EPSILON;
                    x.clone() / x.sum_dim(2)
                };
                (scaled(output) - scaled(target)).cumsum(2).abs().mean()
            }
        }
    }
}

fn cross_entropy(p: Tensor<3>, target: Tensor<3>) -> Tensor<3> {
    let p = p.clamp(EPSILON, 1.0 - EPSILON);
    -(target.clone() * p.clone().log() + (-target + 1.0) * (-p + 1.0).log())
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::tensor::Device;

    fn value(loss: TrainingLoss, output: [[[f32; 2]; 2]; 1], target: [[[f32; 2]; 2]; 1]) -> f32 {
        let device = Device::flex();
        loss.of(Tensor::from_floats(output, &device), Tensor::from_floats(target, &device)).into_scalar::<f32>()
    }

    #[test]
    fn hand_values() {
        let output = [[[0.5, 0.0], [1.0, 0.25]]];
        let target = [[[1.0, 0.0], [0.5, 0.25]]];
        let close = |loss: TrainingLoss, expected: f64| {
            let found = f64::from(value(loss, output, target));
            // The loss of a cell that is certainly wrong is the log of 1e-6, as f32 rounds it beside 1.
            assert!((found - expected).abs() < 2e-3 * expected.abs().max(0.1), "{loss:?}: {found} for {expected}");
        };
        close(TrainingLoss::MeanSquare, 0.5 / 4.0);
        close(TrainingLoss::NormalisedSquare, 0.5 / 1.75);
        close(TrainingLoss::PeakSignalToNoise, 10.0 * 0.125f64.log10());
        // The mask is the first cell alone.
        close(TrainingLoss::Dice, 1.0 - 2.0 * 0.5 / (1.75 + 1.0));
        let ln = |v: f64| -v.ln();
        let entropy = ln(0.5) + 0.0 + 0.5 * (ln(1.0) + ln(1e-6)) + 0.25 * ln(0.25) + 0.75 * ln(0.75);
        close(TrainingLoss::CrossEntropy, entropy / 4.0);
        let focal = 0.25 * ln(0.5) + 0.0 + ln(1e-6) + 0.0625 * ln(0.75);
        close(TrainingLoss::Focal, focal / 4.0);
        // Rows: (1, 0) against (1, 0); (0.8, 0.2) against (2/3, 1/3).
        close(TrainingLoss::EarthMover, (0.8 - 2.0 / 3.0) / 4.0);
    }
}
