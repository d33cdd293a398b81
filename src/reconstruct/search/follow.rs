//! The answer to samples that differ little from those before, from the last answer.

use super::finish::Found;
use super::ladder::{POINTS, after_rungs};
use super::state::{Search, State};
use super::trace::FOLLOWING;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Atom, Fit};

/// Largest residual of the last answer, as a part of the samples' energy, for which it is used.
const MAX_START_RESIDUAL_PART: f64 = 0.7;

/// Largest residual of an answer over that of the search that it follows, where that search was not complete.
const MAX_RESIDUAL_GROWTH: f64 = 1.3;

/// Largest number of additional atoms from one answer to the next.
const MAX_NEW_ATOMS: usize = 2;

impl Search<'_> {
    /// The answer from that of `previous`: points with a residual are searched again; or the atoms with a residual are refined, removed or added to.
    /// `None` where the residual is larger than it was. `scale` is as in [`Found::scale`].
    pub fn followed(&self, previous: &Found, scale: f64) -> Result<Option<State>, ReconstructError> {
        self.trace.enter(FOLLOWING);
        let ratio = scale / previous.scale;
        let gains = previous.gains.iter().map(|g| g.map(|g| g * ratio)).collect();
        let mut fit = self.fitter.fit_of(self.samples, previous.atoms.clone(), gains);
        let all = self.fitter.energy(self.samples);
        if fit.cost() > MAX_START_RESIDUAL_PART * all {
            return Ok(None);
        }
        if let Some(fit) = self.found_by_tones(&fit)? {
            self.record_changes(&previous.atoms, &fit);
            return Ok(Some(State { is_complete: true, ..State::of(fit) }));
        }
        fit = self.pruned(self.refined_by_residual(fit)?)?;
        let max_residual = MAX_RESIDUAL_GROWTH * previous.search_residual_part * all;
        let is_as_good = |fit: &Fit| !previous.is_complete && fit.cost() < max_residual;
        let mut answer = self.checked(fit);
        if !answer.is_complete && !is_as_good(&answer.fit) {
            self.record_changes(&previous.atoms, &answer.fit);
            answer = after_rungs(self, &[POINTS], answer)?;
        }
        // Many new atoms would only correct old ones in wrong places.
        let has_few_more = answer.fit.atoms.len() <= previous.atoms.len() + MAX_NEW_ATOMS;
        Ok((has_few_more && (answer.is_complete || is_as_good(&answer.fit))).then_some(answer))
    }

    /// `fit` with the points that have a residual in their range bins searched again by tones, however far they moved; `None` where a residual is left.
    fn found_by_tones(&self, fit: &Fit) -> Result<Option<Fit>, ReconstructError> {
        let have_residual = self.have_residual(fit);
        let is_moved = |i: &usize| have_residual[*i] && matches!(fit.atoms[*i], Atom::Point { .. });
        let moved: Vec<usize> = (0..have_residual.len()).filter(is_moved).collect();
        let stayed = if moved.is_empty() { fit.clone() } else { self.fitter.remove(fit, &moved) };
        let pairs = self.tone_pairs(&stayed).unwrap_or_default();
        if pairs.points.len() > moved.len() + MAX_NEW_ATOMS {
            return Ok(None);
        }
        let found = self.refined_if_nearly_complete(self.paired(stayed, &pairs, false)?)?;
        Ok(self.is_explained(&found).then_some(found))
    }
}
