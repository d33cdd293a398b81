//! Log-magnitude maps, before normalisation.

use super::lambda::{LambdaScale, Normalisation, RangeAngleMap};
use ndarray::Array2;

/// Added to every magnitude before its logarithm, as in the thesis' program: an exact zero becomes -20. It is smaller for peaks below 1 ([`guard`]):
/// at a peak of 1e-10 it would cover the rounding floor.
pub const LOG_GUARD: f64 = 1e-20;

/// The guard of a map of largest magnitude `peak`: 20 decades below it, so that a common factor has no effect, and at most [`LOG_GUARD`].
pub fn guard(peak: f64) -> f64 {
    (LOG_GUARD * peak.min(1.0)).max(f64::MIN_POSITIVE)
}

/// `L = log10(|Y| + guard)`, `[range bins, columns]`: decades of amplitude, not normalised.
#[derive(Debug, Clone, PartialEq)]
pub struct LogMap {
    decades: Array2<f64>,
    min: f64,
    max: f64,
}

impl LogMap {
    /// A map of decades of amplitude; non-finite cells become -20, as an exact zero.
    pub fn new(mut decades: Array2<f64>) -> Self {
        let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in &mut decades {
            if !v.is_finite() {
                *v = LOG_GUARD.log10();
            }
            min = min.min(*v);
            max = max.max(*v);
        }
        LogMap { decades, min, max }
    }

    /// The cells, `[range bins, columns]`.
    pub fn decades(&self) -> &Array2<f64> {
        &self.decades
    }

    pub fn min(&self) -> f64 {
        self.min
    }

    pub fn max(&self) -> f64 {
        self.max
    }

    pub fn scale(&self, normalisation: Normalisation) -> LambdaScale {
        LambdaScale::new(self.min, self.max, normalisation)
    }

    pub fn normalise(&self, normalisation: Normalisation) -> RangeAngleMap {
        let scale = self.scale(normalisation);
        RangeAngleMap { lambda: self.decades.mapv(|v| scale.lambda(v) as f32) }
    }
}
