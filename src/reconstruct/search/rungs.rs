//! The work of each rung of the search.

use super::on_wall::is_on;
use super::propose::pairs::Pairs;
use super::state::{Answer, Search, State};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Refusal, Tried};
use crate::reconstruct::fit::{Atom, Fit, Gains, Limits, Tie};

/// Most rounds of pairing what is left.
const MOST_ROUNDS: usize = 3;

/// Another round of pairing needs that this part of the energy at most is left by the last.
const WORTH_ANOTHER: f64 = 0.5;

impl Search<'_> {
    /// Points that both ends' tones lead to, kept where they are all there is.
    pub fn climb_tones(&self, state: &mut State) -> Result<(), ReconstructError> {
        state.pairs = self.pairs_of_tones(&state.fit);
        if let Some(pairs) = &state.pairs {
            let fit = self.paired(state.fit.clone(), pairs, false)?;
            if self.is_explained(&fit) {
                state.reach(Answer { fit, is_sure: true });
            } else {
                self.refuse_together(&state.fit, &fit);
            }
        } else {
            self.grower().refuse(Tried::Nothing, 0.0, Refusal::TooManyTones);
        }
        Ok(())
    }

    /// Records that `fit` was refused in favour of `known`, since other energy remains.
    fn refuse_together(&self, known: &Fit, fit: &Fit) {
        let tried = Tried::Together { count: fit.atoms.len().saturating_sub(known.atoms.len()) };
        self.grower().refuse(tried, decades(known.cost(), fit.cost()), Refusal::LeavesSomething);
    }

    /// Lines of any direction that begin where both ends may hear points.
    pub fn climb_lines(&self, state: &mut State) -> Result<(), ReconstructError> {
        let pairs = state.pairs.take().unwrap_or_default();
        let (fit, pairs) = self.walls(state.fit.clone(), pairs)?;
        (state.fit, state.pairs) = (fit, Some(pairs));
        Ok(())
    }

    /// Points that both ends' tones lead to beside the lines.
    pub fn climb_pairs(&self, state: &mut State) -> Result<(), ReconstructError> {
        let pairs = state.pairs.take().unwrap_or_default();
        let answer = self.paired_again(state.fit.clone(), pairs, state.is_long)?;
        state.reach(answer);
        Ok(())
    }

    /// Points wherever the residual stands out, all refined; without those that the rest can do without.
    pub fn climb_points(&self, state: &mut State) -> Result<(), ReconstructError> {
        let grower = self.grower();
        let fit = grower.polished(grower.grown(state.fit.clone())?, self.settings.rounds)?;
        let fit = grower.pruned(fit)?;
        state.reach(Answer { is_sure: self.is_explained(&fit), fit });
        Ok(())
    }

    /// Walls that begin where both ends may hear points, and the points besides that they agree on; and again, as what was found may have
    /// hidden more. `pairs` are those of `fit`; those of the answer come with it.
    fn walls(&self, mut fit: Fit, mut pairs: Pairs) -> Result<(Fit, Pairs), ReconstructError> {
        for _ in 0..MOST_ROUNDS {
            let (before, cost) = (fit.atoms.len(), fit.cost());
            fit = self.grower().more_walls(self.samples, fit, pairs.guesses_metres.clone())?;
            let sure = pairs.points.iter().filter(|point| point.is_sure());
            let more: Vec<Atom> =
                sure.map(|point| point.atom).filter(|point| !fit.atoms.iter().any(|wall| is_on(wall, point))).collect();
            if fit.atoms.len() + more.len() == before {
                if fit.cost() != cost {
                    pairs = self.pairs(&fit);
                }
                break;
            }
            fit.gains.extend(vec![Gains::default(); more.len()]);
            fit.atoms.extend(more);
            fit = self.bench.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH);
            if self.is_explained(&fit) {
                break;
            }
            if fit.cost() > WORTH_ANOTHER * cost {
                // Much the same is left, and much the same would be heard in it: what is not in `fit` yet.
                pairs.points.retain(|point| !point.is_sure() && !fit.atoms.iter().any(|wall| is_on(wall, &point.atom)));
                break;
            }
            pairs = self.pairs(&fit);
        }
        Ok((fit, pairs))
    }

    /// `fit` and the points that the ends' tones lead to in what it leaves, first those of `pairs`, time and again. Where an echo is long
    /// and no wall was found, they are left where they are: lines are better found before.
    fn paired_again(&self, mut fit: Fit, pairs: Pairs, is_long: bool) -> Result<Answer, ReconstructError> {
        let is_polished = !is_long || !fit.atoms.is_empty();
        let mut pairs = Some(pairs);
        for _ in 0..MOST_ROUNDS {
            if self.is_explained(&fit) {
                return Ok(Answer { fit, is_sure: true });
            }
            let before = fit.cost();
            let pairs = pairs.take().unwrap_or_else(|| self.pairs(&fit));
            fit = self.nearly_there(self.paired(fit, &pairs, is_polished)?)?;
            tracing::debug!(atoms = fit.atoms.len(), before, cost = fit.cost(), "paired");
            if fit.cost() > WORTH_ANOTHER * before {
                break;
            }
        }
        Ok(Answer { is_sure: self.is_explained(&fit), fit })
    }
}
