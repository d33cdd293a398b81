//! A row method is one closure; everything around it is written here once.

use super::registered::joined;
use super::row::Row;
use crate::maps::{Spectrum, range_transform};
use crate::radar::{End, Radar};
use crate::reconstruct::answer::{Reconstruction, Request};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::hearing::ends_noise_variance;
use crate::reconstruct::power::of_power;
use crate::reconstruct::reconstructor::{About, Reconstructor};
use crate::reconstruct::seen::{no_plane_waves, too_many_folds};
use crate::signal::{BeatSignal, TwoEnds};
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rows this far below the strongest, as a ratio of power, hold nothing but side lobes: plain beamforming draws them.
const ACTIVE_ROW: f64 = 1e-12;

/// What every row method is told.
pub(super) const TOLD: &str =
    "that what an end hears is plane waves; nothing about the scene or the floor, it measures the noise itself";

/// A method that estimates power over angle of one end and one range row at a time.
#[derive(Debug, Clone, Copy)]
pub struct RowMethod {
    pub(super) about: About,
    /// Power over angle, one value a column in the order of the transform, or `None` to leave the row to plain beamforming.
    pub(super) estimate: fn(&Row<'_>) -> Option<Vec<f64>>,
}

impl Reconstructor for RowMethod {
    fn about(&self) -> About {
        self.about
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        let why = no_plane_waves(radar).or_else(|| too_many_folds(radar));
        why.map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let noise_variance = ends_noise_variance(radar, ends, request.floor);
        let [first, last] = End::BOTH.map(|end| self.end_power(radar, ends, end, noise_variance, request));
        let power = joined(radar, &[first?, last?]);
        Ok(of_power(radar, power, noise_variance, request))
    }
}

impl RowMethod {
    /// Power over range and angle of one end on its own grid, in the scale of the whole array's map.
    fn end_power(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        end: End,
        sample_noise_variance: f64,
        request: &Request,
    ) -> Result<Array2<f64>, ReconstructError> {
        let signal = BeatSignal { samples: ends.end(end).clone() };
        // One row a range bin, so that a snapshot is a slice.
        let snapshots = range_transform(radar, &signal).profiles.t().as_standard_layout().into_owned();
        let (bins, columns, elements) = (radar.samples, radar.elements, radar.end_elements);
        let values = snapshots.as_slice().unwrap_or_default();
        let snapshot = |bin: usize| values.get(bin * elements..(bin + 1) * elements).unwrap_or_default();
        let row_power = |bin: usize| snapshot(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
        let strongest = (0..bins).map(row_power).fold(0.0, f64::max);
        let window_power = radar.window.weights(bins).iter().map(|w| w * w).sum::<f64>() / bins as f64;
        let noise_variance = sample_noise_variance * window_power;
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
