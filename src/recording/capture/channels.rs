//! Corrections of channels by the `.cfg`: separation of transmitters that send at once, factors of channels, and the range bias.

use super::plan::CapturePlan;
use crate::radar::SPEED_OF_LIGHT;
use crate::recording::profile::RadarProfile;
use ndarray::{Array3, ArrayView3, Axis};
use num_complex::Complex64;
use std::f64::consts::TAU;

#[derive(Debug, Clone, Default)]
pub(super) struct Channels {
    /// Whether the two chirps of a loop are S1 + S2 and S1 - S2 of the transmitters' signals (binary phase modulation).
    is_bpm: bool,
    /// Factors of channels, `[chirps][receivers]`; empty where the `.cfg` has none that fit.
    factors: Vec<Vec<Complex64>>,
    /// Number of chirps of a loop from several transmitters at once that can't be separated.
    joint_chirps: usize,
    /// Numbers of channels that the `.cfg` has factors of, and that are recorded, where they don't fit.
    unfit_counts: Option<(usize, usize)>,
}

impl Channels {
    pub fn new(profile: Option<&RadarProfile>, plan: &CapturePlan) -> Channels {
        let Some(profile) = profile else { return Channels::default() };
        let masks = &profile.chirp_transmitters;
        let is_bpm = profile.both_transmitters;
        let transmitters = profile.senders();
        let joint_chirps = if is_bpm { 0 } else { masks.iter().filter(|mask| mask.count_ones() > 1).count() };
        let (mut factors, mut unfit_counts) = (Vec::new(), None);
        if !profile.channel_factors.is_empty() && profile.channel_factors.iter().any(|f| *f != Complex64::ONE) {
            match factor_indices(&transmitters, plan.receivers, profile.channel_factors.len()) {
                Some(factor_indices) => {
                    let factor = |t: usize, r: usize| profile.channel_factors[factor_indices[t] * plan.receivers + r];
                    factors =
                        (0..transmitters.len()).map(|t| (0..plan.receivers).map(|r| factor(t, r)).collect()).collect();
                }
                None => unfit_counts = Some((profile.channel_factors.len(), transmitters.len() * plan.receivers)),
            }
        }
        Channels { is_bpm, factors, joint_chirps, unfit_counts }
    }

    /// Notes on the corrections made and on those that could not be made, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let bpm_note = "Both transmitters send in both chirps of a loop (bpmCfg): sum and difference tell them apart.";
        let joint_chirps = (self.joint_chirps > 0).then(|| {
            format!(
                "{} chirps of a loop are sent by several transmitters at once, and no bpmCfg says how: they are taken for one that stands in \
                 their middle.",
                self.joint_chirps
            )
        });
        let factors = "Channels are multiplied with the factors of the .cfg's compRangeBiasAndRxChanPhase.";
        let unfit_counts = self.unfit_counts.map(|(found, expected)| {
            format!(
                "compRangeBiasAndRxChanPhase has factors of {found} channels, but {expected} are recorded: they are left out."
            )
        });
        let bpm_note = self.is_bpm.then(|| bpm_note.to_owned());
        let factors = (!self.factors.is_empty()).then(|| factors.to_owned());
        [bpm_note, joint_chirps, factors, unfit_counts].into_iter().flatten().collect()
    }

    /// Separates the transmitters of one loop and multiplies its channels, `[chirps, receivers, samples]`.
    pub fn correct_loop(&self, samples: &ArrayView3<'_, Complex64>) -> Array3<Complex64> {
        let mut rows = samples.to_owned();
        if self.is_bpm && rows.dim().0 == 2 {
            let (sum, difference) = (rows.index_axis(Axis(0), 0).to_owned(), rows.index_axis(Axis(0), 1).to_owned());
            rows.index_axis_mut(Axis(0), 0).assign(&((&sum + &difference) / Complex64::from(2.0)));
            rows.index_axis_mut(Axis(0), 1).assign(&((&sum - &difference) / Complex64::from(2.0)));
        }
        for (mut chirp, factors) in rows.outer_iter_mut().zip(&self.factors) {
            for (mut row, factor) in chirp.outer_iter_mut().zip(factors) {
                row.mapv_inplace(|v| v * factor);
            }
        }
        rows
    }
}

/// Index of each transmitter among those with factors: its number where there are factors of all, else its rank.
fn factor_indices(transmitters: &[usize], receivers: usize, factors: usize) -> Option<Vec<usize>> {
    let last = transmitters.iter().max()?;
    if (last + 1) * receivers <= factors {
        return Some(transmitters.to_vec());
    }
    let mut sorted = transmitters.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let fits = sorted.len() * receivers <= factors;
    fits.then(|| transmitters.iter().map(|bit| sorted.iter().position(|b| b == bit).unwrap_or(0)).collect())
}

/// Removes the range bias from `[chirps, receivers, samples]`: subtracts the phase that it adds from sample to sample.
pub(super) fn remove_range_bias(rows: &mut Array3<Complex64>, profile: &RadarProfile, beat_rises: bool) {
    if profile.range_bias_metres == 0.0 {
        return;
    }
    let samples = rows.dim().2.max(1) as f64;
    let sign = if beat_rises { -1.0 } else { 1.0 };
    let turns_per_sample = sign * profile.bandwidth_hz() / samples * 2.0 * profile.range_bias_metres / SPEED_OF_LIGHT;
    for mut row in rows.lanes_mut(Axis(2)) {
        row.iter_mut()
            .enumerate()
            .for_each(|(n, v)| *v *= Complex64::from_polar(1.0, TAU * turns_per_sample * n as f64));
    }
}
