//! The functions of the ladder's rungs.

use super::on_row::is_on_row;
use super::state::{Search, State};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Proposal, Refusal};
use crate::reconstruct::fit::{Limits, Tie};

/// Largest residual energy of a round, over that of the round before, for which another one follows.
pub const MAX_ROUND_RESIDUAL_PART: f64 = 0.5;

impl Search<'_> {
    /// Points from tones of both ends, if they explain the samples.
    pub fn tone_points(&self, mut state: State) -> Result<State, ReconstructError> {
        state.pairs = self.tone_pairs(&state.fit);
        let Some(pairs) = &state.pairs else {
            self.record_refusal(Proposal::Nothing, 0.0, Refusal::TooManyTones);
            return Ok(state);
        };
        let fit = self.paired(state.fit.clone(), pairs, false)?;
        if self.is_explained(&fit) {
            return Ok(State { is_complete: true, ..State::of(fit) });
        }
        let tried = Proposal::Together { count: fit.atoms.len().saturating_sub(state.fit.atoms.len()) };
        self.record_refusal(tried, decades(state.fit.cost(), fit.cost()), Refusal::LeavesSomething);
        Ok(state)
    }

    /// Points at peaks of the residual, refined and pruned.
    pub fn points_in_residual(&self, state: State) -> Result<State, ReconstructError> {
        let fit = self.converged(self.grown(state.fit)?)?;
        Ok(self.checked(self.pruned(fit)?))
    }

    /// Rows that begin where both ends may have a point. Further rounds follow, since rows hide others.
    pub fn rows_of_any_direction(&self, State { mut fit, pairs, .. }: State) -> Result<State, ReconstructError> {
        let mut pairs = pairs.unwrap_or_default();
        loop {
            let (before, cost) = (fit.atoms.len(), fit.cost());
            fit = self.with_rows(fit, pairs.guesses_metres.clone())?;
            if fit.atoms.len() == before {
                break;
            }
            fit = self.fitter.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH_FIT);
            if self.is_explained(&fit) {
                break;
            }
            let is_progress = fit.cost() <= MAX_ROUND_RESIDUAL_PART * cost;
            if !is_progress {
                // The residual is so similar that its tones are the same, but for those of the rows.
                pairs.points.retain(|point| !fit.atoms.iter().any(|row| is_on_row(row, point)));
                break;
            }
            pairs = self.tone_pairs(&fit).unwrap_or_default();
        }
        Ok(State { pairs: Some(pairs), ..State::of(fit) })
    }

    /// Points from tones that the rows leave, in rounds.
    pub fn paired_in_rounds(&self, State { mut fit, mut pairs, .. }: State) -> Result<State, ReconstructError> {
        while !self.is_explained(&fit) {
            let before = fit.cost();
            let pairs = pairs.take().unwrap_or_else(|| self.tone_pairs(&fit).unwrap_or_default());
            fit = self.refined_if_nearly_complete(self.paired(fit, &pairs, true)?)?;
            tracing::debug!(atoms = fit.atoms.len(), before, cost = fit.cost(), "paired");
            let is_progress = fit.cost() <= MAX_ROUND_RESIDUAL_PART * before;
            if !is_progress {
                break;
            }
        }
        Ok(self.checked(fit))
    }
}
