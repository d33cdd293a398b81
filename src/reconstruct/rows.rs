//! The methods that work on one end and one range row at a time.
//!
//! Each end's samples become range profiles; each range row is a snapshot of twelve elements from which a method estimates power
//! over angle. Both ends' estimates are laid onto the centre's grid and their geometric mean is taken: what only one end
//! believes in fades.

use super::conditioning::{Conditioned, condition};
use super::registered::register;
use super::rendering::{of_power, silence};
use super::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::maps::{Spectrum, range_transform};
use crate::radar::{End, Radar};
use crate::signal::{BeatSignal, TwoEnds};
use ndarray::{Array2, Axis, Zip};
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rows this far below the strongest, as a ratio of power, hold nothing but side lobes: plain beamforming draws them.
const ACTIVE_ROW: f64 = 1e-12;

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

/// A method that estimates power over angle of one end and one range row at a time.
#[derive(Debug, Clone, Copy)]
pub struct RowMethod {
    pub(super) name: &'static str,
    pub(super) description: &'static str,
    pub(super) eta: f32,
    /// Power over angle, one value a column in the order of the transform, or `None` to leave the row to plain beamforming.
    pub(super) estimate: fn(&Row<'_>) -> Option<Vec<f64>>,
}

impl Reconstructor for RowMethod {
    fn name(&self) -> &'static str {
        self.name
    }

    fn description(&self) -> &'static str {
        self.description
    }

    fn eta(&self) -> f32 {
        self.eta
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        let Some(conditioned) = condition(radar, ends)? else { return Ok(silence(radar)) };
        let [first, last] = End::BOTH.map(|end| {
            let map = self.end_power(radar, &conditioned, end, request)?;
            Ok::<_, ReconstructError>(register(radar, radar.end_centre_metres(end), &map))
        });
        let (mut power, last): (Array2<f64>, Array2<f64>) = (first?, last?);
        Zip::from(&mut power).and(&last).par_for_each(|a, b| *a = (*a * b).sqrt());
        Ok(of_power(radar, power, conditioned.noise_variance, request))
    }
}

impl RowMethod {
    /// Power over range and angle of one end on its own grid, in the scale of the whole array's map.
    fn end_power(
        &self,
        radar: &Radar,
        conditioned: &Conditioned,
        end: End,
        request: &Request,
    ) -> Result<Array2<f64>, ReconstructError> {
        let signal = BeatSignal { samples: conditioned.ends.end(end).clone() };
        // One row a range bin, so that a snapshot is a slice.
        let snapshots = range_transform(radar, &signal).profiles.t().as_standard_layout().into_owned();
        let (bins, columns, elements) = (radar.samples, radar.elements, radar.end_elements);
        let values = snapshots.as_slice().unwrap_or_default();
        let snapshot = |bin: usize| values.get(bin * elements..(bin + 1) * elements).unwrap_or_default();
        let row_power = |bin: usize| snapshot(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
        let strongest = (0..bins).map(row_power).fold(0.0, f64::max);
        let window_power = radar.window.weights(bins).iter().map(|w| w * w).sum::<f64>() / bins as f64;
        let noise_variance = conditioned.noise_variance * window_power;
        let quiet = (strongest * ACTIVE_ROW).max(2.0 * elements as f64 * noise_variance);

        let spectrum = Spectrum::new(columns);
        let angle_gain = (radar.window.weights(columns).iter().sum::<f64>()).powi(2) / columns as f64;
        let done = AtomicUsize::new(0);
        let mut power = Array2::zeros((bins, columns));
        power.axis_iter_mut(Axis(0)).into_par_iter().enumerate().try_for_each(|(bin, mut out)| {
            request.task.check()?;
            let row = Row {
                snapshots: [snapshot((bin + bins - 1) % bins), snapshot(bin), snapshot((bin + 1) % bins)],
                noise_variance,
                spectrum: &spectrum,
            };
            let estimated = if row_power(bin) > quiet { (self.estimate)(&row) } else { None };
            for (k, p) in estimated.unwrap_or_else(|| row.bartlett()).into_iter().enumerate() {
                out[(k + columns / 2) % columns] = p * angle_gain;
            }
            let half = if end == End::First { 0.0 } else { 0.5 };
            let part = done.fetch_add(1, Ordering::Relaxed) as f32 / bins as f32;
            request.task.set_progress(half + part / 2.0);
            Ok::<(), ReconstructError>(())
        })?;
        Ok(power)
    }
}
