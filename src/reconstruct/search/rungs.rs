//! The work of each rung of the search.

use super::on_row::is_on_row;
use super::state::{MAX_ROUNDS, Search, State};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Refusal, Tried};
use crate::reconstruct::fit::{Limits, Tie};

/// Another round needs that this part of the energy at most is left by the last.
pub const MAX_ROUND_RESIDUAL_PART: f64 = 0.5;

impl Search<'_> {
    /// Points that both ends' tones lead to, kept where they are all there is.
    pub fn tone_points(&self, mut state: State) -> Result<State, ReconstructError> {
        state.pairs = self.pairs_of_tones(&state.fit);
        let Some(pairs) = &state.pairs else {
            self.record_refusal(Tried::Nothing, 0.0, Refusal::TooManyTones);
            return Ok(state);
        };
        let fit = self.paired(state.fit.clone(), pairs, false)?;
        if self.is_explained(&fit) {
            return Ok(State { is_complete: true, ..State::of(fit) });
        }
        let tried = Tried::Together { count: fit.atoms.len().saturating_sub(state.fit.atoms.len()) };
        self.record_refusal(tried, decades(state.fit.cost(), fit.cost()), Refusal::LeavesSomething);
        Ok(state)
    }

    /// Points wherever the residual stands out, all refined; without those that the rest can do without.
    pub fn points_in_residual(&self, state: State) -> Result<State, ReconstructError> {
        let fit = self.converged(self.grown(state.fit)?, self.settings.rounds)?;
        Ok(self.checked(self.pruned(fit)?))
    }

    /// Lines of any direction that begin where both ends may hear points; and again, as what was found may have hidden more.
    pub fn rows_of_any_direction(&self, State { mut fit, pairs, .. }: State) -> Result<State, ReconstructError> {
        let mut pairs = pairs.unwrap_or_default();
        for _ in 0..MAX_ROUNDS {
            let (before, cost) = (fit.atoms.len(), fit.cost());
            fit = self.with_rows(fit, pairs.guesses_metres.clone())?;
            if fit.atoms.len() == before {
                break;
            }
            fit = self.fitter.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH);
            if self.is_explained(&fit) {
                break;
            }
            if fit.cost() > MAX_ROUND_RESIDUAL_PART * cost {
                // Much the same is left, and much the same would be heard in it: what is not in `fit` yet.
                pairs.points.retain(|point| !fit.atoms.iter().any(|row| is_on_row(row, &point.atom)));
                break;
            }
            pairs = self.pairs(&fit);
        }
        Ok(State { pairs: Some(pairs), ..State::of(fit) })
    }

    /// The points that the ends' tones lead to beside the lines, time and again.
    pub fn paired_in_rounds(&self, State { mut fit, mut pairs, .. }: State) -> Result<State, ReconstructError> {
        for _ in 0..MAX_ROUNDS {
            if self.is_explained(&fit) {
                break;
            }
            let before = fit.cost();
            let pairs = pairs.take().unwrap_or_else(|| self.pairs(&fit));
            fit = self.refined_if_nearly_complete(self.paired(fit, &pairs, true)?)?;
            tracing::debug!(atoms = fit.atoms.len(), before, cost = fit.cost(), "paired");
            if fit.cost() > MAX_ROUND_RESIDUAL_PART * before {
                break;
            }
        }
        Ok(self.checked(fit))
    }
}
