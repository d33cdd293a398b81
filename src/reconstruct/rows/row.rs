//! What a row method sees.

use crate::maps::Spectrum;
use num_complex::Complex64;

/// One end's snapshot at one range row, and its surroundings.
pub struct Row<'a> {
    /// Range profiles of the elements at the rows before, at and after this one; the middle is the row itself.
    pub snapshots: [&'a [Complex64]; 3],
    /// Variance of the noise of each value.
    pub noise_variance: f64,
    /// The transform from elements to columns.
    pub spectrum: &'a Spectrum,
}

impl Row<'_> {
    /// The row's own snapshot, one value an element.
    pub fn own(&self) -> &[Complex64] {
        self.snapshots[1]
    }

    /// Power over angle of plain beamforming, in the order of the transform: amplitude is the mean over the elements.
    pub fn bartlett(&self) -> Vec<f64> {
        let elements = self.own().len() as f64;
        self.spectrum.of(self.own().iter().copied()).into_iter().map(|v| v.norm_sqr() / (elements * elements)).collect()
    }

    /// Turns a null spectrum, small where there is a reflector, into power: its reciprocal, scaled to plain beamforming's
    /// largest. A pseudo-spectrum tells where reflectors are, not how strong.
    pub fn power_of_nulls(&self, nulls: &[f64]) -> Vec<f64> {
        let strongest = self.bartlett().into_iter().fold(0.0, f64::max);
        let guard = nulls.iter().fold(0.0, |m: f64, v| m.max(*v)) * 1e-15 + f64::MIN_POSITIVE;
        let deepest = nulls.iter().fold(f64::INFINITY, |m, v| m.min(*v)).max(guard);
        nulls.iter().map(|v| strongest * deepest / v.max(deepest)).collect()
    }
}
