//! The removal of atoms that the others don't need.

use super::propose::strides::MAX_RANGE_RATIO;
use super::state::{Search, tried};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{BinSpans, Fit, Limits, bin_spans, distance_bins};

/// Least energy that an atom explains, over the mean energy that one gain explains of noise.
pub const MIN_ENERGY_RATIO: f64 = 16.0;

/// Range bins below which one atom may explain the echo of another, so that both are not added or removed in one round.
pub const MIN_DISTANCE_BINS: f64 = 4.0;

impl Search<'_> {
    /// `fit` without the atoms that explain no more than noise or the rounding of places, and those far beyond the maximum range.
    pub fn pruned(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        loop {
            self.fitter.task.check()?;
            if self.fitter.work.is_spent() {
                return Ok(fit);
            }
            let rounding = self.fitter.energy_of_amplitude(self.rounding_amplitude());
            let least = rounding.max(MIN_ENERGY_RATIO * self.fitter.noise_energy(self.radar, &fit));
            let energies = self.fitter.marginal_energies(&fit);
            let spans: Vec<BinSpans> = fit.atoms.iter().map(|a| bin_spans(self.radar, a)).collect();
            let distance = |i: usize, j: usize| distance_bins(self.radar.samples, &spans[i], &spans[j]);
            let max_range = MAX_RANGE_RATIO * self.radar.max_range_metres();
            let is_needless = |i: &usize| energies[*i] < least || fit.atoms[*i].range_metres() > max_range;
            let mut order: Vec<usize> = (0..fit.atoms.len()).filter(is_needless).collect();
            order.sort_by(|a, b| energies[*a].total_cmp(&energies[*b]));
            let mut removed: Vec<usize> = Vec::new();
            for i in order {
                if removed.iter().all(|&j| distance(i, j) > MIN_DISTANCE_BINS) {
                    removed.push(i);
                }
            }
            if removed.is_empty() {
                return Ok(fit);
            }
            for &i in &removed {
                let gain_decades = decades(fit.cost() + energies[i], fit.cost());
                self.record_refusal(tried(&fit.atoms[i]), gain_decades, Refusal::RestDoesWithout);
            }
            fit = self.fitter.remove(&fit, &removed);
            let kept = (0..spans.len()).filter(|i| !removed.contains(i));
            let beside = |i: usize| removed.iter().any(|&j| distance(i, j) < 2.0 * MIN_DISTANCE_BINS);
            let marked: Vec<bool> = kept.map(beside).collect();
            fit = self.refined(fit, &marked, MIN_DISTANCE_BINS, Limits::ROUGH_FIT)?;
        }
    }
}
