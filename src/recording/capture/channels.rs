//! Corrections of channels from a `.cfg`: transmitters that send together are told apart, channels multiplied, ranges corrected by their bias.

use super::plan::Plan;
use crate::radar::SPEED_OF_LIGHT;
use crate::recording::profile::RadarProfile;
use ndarray::{Array3, ArrayView3, Axis};
use num_complex::Complex64;
use std::f64::consts::TAU;

#[derive(Debug, Clone, Default)]
pub(super) struct Channels {
    /// The two chirps of a loop are S1 + S2 and S1 - S2.
    both: bool,
    /// Factor of each chirp's receivers, `[chirps][receivers]`; empty where none is said.
    factors: Vec<Vec<Complex64>>,
    /// Number of chirps of a loop that several transmitters send and that can't be told apart.
    together: usize,
    unfitting: Option<(usize, usize)>,
}

impl Channels {
    pub fn of(profile: Option<&RadarProfile>, plan: &Plan) -> Channels {
        let Some(profile) = profile else { return Channels::default() };
        let masks = &profile.chirp_transmitters;
        let both = profile.both_transmitters;
        let bits = profile.senders();
        let together = if both { 0 } else { masks.iter().filter(|mask| mask.count_ones() > 1).count() };
        let (mut factors, mut unfitting) = (Vec::new(), None);
        if !profile.channel_factors.is_empty() && profile.channel_factors.iter().any(|f| *f != Complex64::ONE) {
            match places(&bits, plan.receivers, profile.channel_factors.len()) {
                Some(places) => {
                    let factor = |t: usize, r: usize| profile.channel_factors[places[t] * plan.receivers + r];
                    factors = (0..bits.len()).map(|t| (0..plan.receivers).map(|r| factor(t, r)).collect()).collect();
                }
                None => unfitting = Some((profile.channel_factors.len(), bits.len() * plan.receivers)),
            }
        }
        Channels { both, factors, together, unfitting }
    }

    /// Notes on the corrections made and on those that could not be made, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let both = "Both transmitters send in both chirps of a loop (bpmCfg): sum and difference tell them apart.";
        let together = (self.together > 0).then(|| {
            format!(
                "{} chirps of a loop are sent by several transmitters at once, and no bpmCfg says how: they are taken for one that stands in \
                 their middle.",
                self.together
            )
        });
        let factors = "Channels are multiplied with the factors of the .cfg's compRangeBiasAndRxChanPhase.";
        let unfitting = self.unfitting.map(|(found, expected)| {
            format!(
                "compRangeBiasAndRxChanPhase has factors of {found} channels, but {expected} are recorded: they are left out."
            )
        });
        let both = self.both.then(|| both.to_owned());
        let factors = (!self.factors.is_empty()).then(|| factors.to_owned());
        [both, together, factors, unfitting].into_iter().flatten().collect()
    }

    /// `[chirps, receivers, samples]` of one loop, transmitters told apart and channels multiplied.
    pub fn of_loop(&self, turn: &ArrayView3<'_, Complex64>) -> Array3<Complex64> {
        let mut rows = turn.to_owned();
        if self.both && rows.dim().0 == 2 {
            let (sum, difference) = (rows.index_axis(Axis(0), 0).to_owned(), rows.index_axis(Axis(0), 1).to_owned());
            rows.index_axis_mut(Axis(0), 0).assign(&((&sum + &difference) / Complex64::from(2.0)));
            rows.index_axis_mut(Axis(0), 1).assign(&((&sum - &difference) / Complex64::from(2.0)));
        }
        for (mut of_chirp, factors) in rows.outer_iter_mut().zip(&self.factors) {
            for (mut row, factor) in of_chirp.outer_iter_mut().zip(factors) {
                row.mapv_inplace(|v| v * factor);
            }
        }
        rows
    }
}

/// Place of each transmitter among those that the factors name: by number where there are factors for all, else by order.
fn places(bits: &[usize], receivers: usize, factors: usize) -> Option<Vec<usize>> {
    let last = bits.iter().max()?;
    if (last + 1) * receivers <= factors {
        return Some(bits.to_vec());
    }
    let mut sorted = bits.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let fits = sorted.len() * receivers <= factors;
    fits.then(|| bits.iter().map(|bit| sorted.iter().position(|b| b == bit).unwrap_or(0)).collect())
}

/// Moves every echo nearer by the range bias: its beat turns back by what the bias added, sample by sample.
pub(super) fn take_off_bias(rows: &mut Array3<Complex64>, profile: &RadarProfile, beat_rises: bool) {
    if profile.range_bias_metres == 0.0 {
        return;
    }
    let samples = rows.dim().2.max(1) as f64;
    let way = if beat_rises { -1.0 } else { 1.0 };
    let per_sample = way * profile.bandwidth_hz() / samples * 2.0 * profile.range_bias_metres / SPEED_OF_LIGHT;
    for mut row in rows.lanes_mut(Axis(2)) {
        row.iter_mut().enumerate().for_each(|(n, v)| *v *= Complex64::from_polar(1.0, TAU * per_sample * n as f64));
    }
}
