//! Row methods: each is one closure, and the steps around it are shared.

use super::covariance::subarray_len;
use super::registered::joined;
use super::row::RowSnapshot;
use crate::maps::peaks::{Peak as MapPeak, peaks as map_peaks};
use crate::maps::{Spectrum, range_transform};
use crate::radar::{End, Radar};
use crate::reconstruct::coherent::{Peak, found_in_residuals, gains};
use crate::reconstruct::echoes::of_echoes;
use crate::reconstruct::error::Result;
use crate::reconstruct::noise_model::{NoiseModel, ends_noise_variance};
use crate::reconstruct::polar::{Direction, directions, no_plane_waves, row_ranges_metres, too_many_folds};
use crate::reconstruct::power::of_power;
use crate::reconstruct::{MethodInfo, ReconstructError, Reconstruction, Reconstructor, Request};
use crate::signal::{BeatSignal, TwoEnds};
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Power of a row relative to the strongest below which the row has only side lobes: plain beamforming draws it.
const MIN_ACTIVE_ROW_PART: f64 = 1e-12;

/// [`MethodInfo::prior_knowledge`] of the methods that draw a spectrum.
const ASSUMPTIONS: &str = "that what an end hears is plane waves; nothing about the scene or the floor, it measures the noise itself. \
    It does not use the phase between the ends";

const PEAK_ASSUMPTIONS: &str = "that what an end hears is plane waves, and that a scene is single reflectors; nothing else about the \
    scene or the floor, it measures the noise itself. Its peaks do not use the phase between the ends; their places and amplitudes \
    are then fitted to both ends together, as those of iaa and sbl are";

/// The step from a row method's estimate to a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Render {
    /// Power over angle, row by row, both ends combined.
    Spectrum,
    /// Peaks of that power, moved to where their echoes fit best; amplitudes by least squares; and the exact map of these echoes.
    Peaks,
}

/// Decades of power below the strongest to which peaks are used; weaker ones show in another look.
const SPAN_DECADES: f64 = 4.0;

/// Most peaks of one look.
const MAX_PEAKS: usize = 256;

/// Least part of an echo that counts as not plane: the rounding of a covariance.
const MIN_CURVED_PART: f64 = 1e-12;

/// Power by which a peak must stand above the noise of one beam.
const MIN_PEAK_OVER_NOISE: f64 = 10.0;

/// A method that estimates power over angle of one end and one range row at a time.
#[derive(Debug, Clone, Copy)]
pub struct RowMethod {
    pub(super) name: &'static str,
    pub(super) description: &'static str,
    /// [`MethodInfo::eta`].
    pub(super) eta: f32,
    /// Power over angle, one value a column in the order of the transform, or `None` to leave the row to plain beamforming.
    pub(super) estimate: fn(&RowSnapshot<'_>) -> Option<Vec<f64>>,
    pub(super) render: Render,
}

impl Reconstructor for RowMethod {
    fn info(&self) -> MethodInfo {
        let RowMethod { name, description, eta, render, .. } = *self;
        MethodInfo {
            name,
            description,
            prior_knowledge: if render == Render::Peaks { PEAK_ASSUMPTIONS } else { ASSUMPTIONS },
            eta,
        }
    }

    fn check_radar(&self, radar: &Radar) -> Result<()> {
        let why = no_plane_waves(radar).or_else(|| too_many_folds(radar));
        why.map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        let noise_variance = ends_noise_variance(radar, ends, request.noise);
        if self.render == Render::Spectrum {
            return Ok(of_power(radar, self.power(radar, ends, noise_variance, request)?, noise_variance, request));
        }
        // The task reports the progress of all looks, not of one.
        let quiet = Request { task: request.task.quiet(), ..request.clone() };
        let noise_model = NoiseModel::beneath(radar, ends, request.noise);
        let look = |left: &TwoEnds| -> Result<Vec<Peak>> {
            let noise_variance = noise_model.ends_noise_variance(radar, left);
            Ok(self.peaks(radar, &self.power(radar, left, noise_variance, &quiet)?, noise_variance))
        };
        let found = if radar.samples == 1 {
            gains(radar, &look(ends)?, ends, &request.task)?
        } else {
            found_in_residuals(radar, ends, &request.task, look)?
        };
        Ok(of_echoes(radar, ends, &found, noise_variance, request))
    }
}

/// Each end's beams without an angle window, combined on the centre's grid.
///
/// M. S. Bartlett, "Smoothing periodograms from time-series with continuous spectra", Nature 161, 1948, applied to arrays.
pub const BARTLETT: RowMethod = RowMethod {
    name: "bartlett",
    description: "both ends' plain beams, laid over each other where they see the same place",
    eta: 0.952, // by examples/choose_eta.rs
    estimate: |row| Some(row.bartlett()),
    render: Render::Spectrum,
};

/// [`RowSnapshot::not_plane`] of the sub-arrays of `radar`'s ends. Over half a sub-array the range changes by up to `b` bins, and the amplitude
/// in a row in proportion; a second signal in the same direction takes up the linear part, and its square is left.
fn not_plane(radar: &Radar) -> f64 {
    let half_metres = 0.5 * (subarray_len(radar.end_elements) - 1) as f64 * radar.element_spacing_metres;
    let bins = if radar.samples == 1 { 0.0 } else { half_metres / radar.range_resolution_metres() };
    bins.min(1.0).powi(4).max(MIN_CURVED_PART)
}

impl RowMethod {
    fn power(&self, radar: &Radar, ends: &TwoEnds, noise_variance: f64, request: &Request) -> Result<Array2<f64>> {
        let [first, last] = End::BOTH.map(|end| self.end_power(radar, ends, end, noise_variance, request));
        Ok(joined(radar, &[first?, last?]))
    }

    /// The peaks of `power` above the noise, the strongest first. Where several directions share a column, each has a peak.
    fn peaks(&self, radar: &Radar, power: &Array2<f64>, noise_variance: f64) -> Vec<Peak> {
        let square_mean = |n: usize| radar.window.weights(n).iter().map(|w| w * w).sum::<f64>() / n as f64;
        let angle_gain = (radar.window.weights(radar.elements).iter().sum::<f64>()).powi(2) / radar.elements as f64;
        let of_beam = noise_variance * square_mean(radar.samples) * angle_gain / radar.end_elements as f64;
        let least = MIN_PEAK_OVER_NOISE * of_beam;
        let decades = power.mapv(|p| p.max(f64::MIN_POSITIVE).log10());
        let found =
            map_peaks(decades.view(), SPAN_DECADES, MAX_PEAKS).into_iter().filter(|p| 10f64.powf(p.value) > least);
        let (directions, ranges) = (directions(radar), row_ranges_metres(radar));
        let place = |p: MapPeak| {
            let column = (p.column.round() as usize) % radar.elements;
            let off_cos = radar.cos_of_column(p.column) - radar.cos_of_column(p.column.round());
            let range_metres = if radar.samples == 1 {
                ranges[0]
            } else {
                radar.range_of_bin_metres(p.range_bin.rem_euclid(radar.samples as f64))
            };
            let at = move |d: &Direction| Peak {
                range_metres,
                cos_theta: (d.cos_theta + off_cos).clamp(-1.0, 1.0),
                power: 10f64.powf(p.value),
            };
            directions.iter().filter(move |d| d.column == column).map(at).collect::<Vec<_>>()
        };
        found.flat_map(place).collect()
    }

    fn end_power(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        end: End,
        sample_noise_variance: f64,
        request: &Request,
    ) -> Result<Array2<f64>> {
        let signal = BeatSignal { samples: ends.end(end).clone() };
        let snapshots = range_transform(radar, &signal).profiles.t().as_standard_layout().into_owned();
        let (bins, columns, elements) = (radar.samples, radar.elements, radar.end_elements);
        let values = snapshots.as_slice().unwrap_or_default();
        let snapshot = |bin: usize| values.get(bin * elements..(bin + 1) * elements).unwrap_or_default();
        let row_power = |bin: usize| snapshot(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
        let strongest = (0..bins).map(row_power).fold(0.0, f64::max);
        let window_power = radar.window.weights(bins).iter().map(|w| w * w).sum::<f64>() / bins as f64;
        let noise_variance = sample_noise_variance * window_power;
        let quiet = (strongest * MIN_ACTIVE_ROW_PART).max(2.0 * elements as f64 * noise_variance);

        let (spectrum, not_plane) = (Spectrum::new(columns), not_plane(radar));
        let angle_gain = (radar.window.weights(columns).iter().sum::<f64>()).powi(2) / columns as f64;
        let done = AtomicUsize::new(0);
        let mut power = Array2::zeros((bins, columns));
        power.axis_iter_mut(Axis(0)).into_par_iter().enumerate().try_for_each(|(bin, mut out)| {
            request.task.check()?;
            let row = RowSnapshot {
                snapshots: [snapshot((bin + bins - 1) % bins), snapshot(bin), snapshot((bin + 1) % bins)],
                noise_variance,
                not_plane,
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
