//! The removal of atoms that the others don't need.

use super::propose::strides::MAX_RANGES;
use super::state::{Search, tried};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Limits, bin_spans, distance_bins};

/// Energy that an atom must explain over what noise gives to one more gain, as a ratio.
pub const MIN_WORTH_RATIO: f64 = 16.0;

/// Most rounds of taking away.
const MOST_ROUNDS: usize = 12;

/// Atoms nearer than this in range may do for each other: they are not taken, or taken away, in one round.
pub const APART_BINS: f64 = 4.0;

impl Search<'_> {
    /// `fit` without the atoms whose absence noise could hide or the rounding of the others' places, those whose place ran away, and
    /// those that only one end believes in.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn pruned(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for _ in 0..MOST_ROUNDS {
            self.task.check()?;
            if self.fitter.work.is_spent() {
                break;
            }
            let rounding = self.fitter.energy_of_amplitude(self.rounding_amplitude(), self.radar);
            let least = rounding.max(MIN_WORTH_RATIO * self.fitter.noise_energy(self.radar, &fit));
            let worth = self.fitter.marginal_energies(&fit);
            let spans: Vec<BinSpans> = fit.atoms.iter().map(|a| bin_spans(self.radar, a)).collect();
            let is_needless = |i: &usize| worth[*i] < least || self.ran_away(&fit.atoms[*i]);
            let mut order: Vec<usize> = (0..fit.atoms.len()).filter(is_needless).collect();
            order.sort_by(|a, b| worth[*a].total_cmp(&worth[*b]));
            let mut gone: Vec<usize> = Vec::new();
            for i in order {
                let is_apart = |j: &usize| distance_bins(self.radar.samples, &spans[i], &spans[*j]) > APART_BINS;
                if gone.iter().all(is_apart) {
                    gone.push(i);
                }
            }
            if gone.is_empty() {
                break;
            }
            for &i in &gone {
                self.refuse(tried(&fit.atoms[i]), decades(fit.cost() + worth[i], fit.cost()), Refusal::RestDoesWithout);
            }
            fit = self.fitter.remove(fit, &gone);
            let kept = (0..spans.len()).filter(|i| !gone.contains(i));
            let beside = |i: usize| {
                gone.iter().any(|&j| distance_bins(self.radar.samples, &spans[i], &spans[j]) < 2.0 * APART_BINS)
            };
            let marked: Vec<bool> = kept.map(beside).collect();
            fit = self.refined(fit, &marked, APART_BINS, Limits::ROUGH)?;
        }
        Ok(fit)
    }

    fn ran_away(&self, atom: &Atom) -> bool {
        let [x, y] = atom.position_metres(0.0);
        x.hypot(y) > MAX_RANGES * self.radar.max_range_metres()
    }
}
