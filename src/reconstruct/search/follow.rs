//! The answer to samples that differ little from the last ones, starting from the last answer.

use super::finish::Found;
use super::ladder::{POINTS, after_rungs};
use super::state::{Search, State};
use super::trace::FOLLOWING;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Atom, Fit};

/// Part of the samples' energy that a last answer may leave and still be a start.
const MAX_START_RESIDUAL_PART: f64 = 0.7;

/// An answer that follows a search which left something leaves this many times as much at most.
const MAX_RESIDUAL_GROWTH: f64 = 1.3;

/// Most atoms that appear from one answer to the next.
const MAX_NEW_ATOMS: usize = 2;

impl Search<'_> {
    /// The answer to samples a little different from those of `previous`: what stands elsewhere now found anew, or else its atoms refined
    /// where the residual asks for it, and more or fewer of them where that is not enough. `None` where they don't explain the samples
    /// as well as they did.
    pub fn followed(&self, previous: &Found, scale: f64) -> Result<Option<State>, ReconstructError> {
        self.trace.enter(FOLLOWING);
        let ratio = scale / previous.scale;
        let gains = previous.gains.iter().map(|g| g.map(|g| g * ratio)).collect();
        let mut fit = Fit { atoms: previous.atoms.clone(), gains, residual: self.samples.clone(), energy: [0.0; 2] };
        let left = self.fitter.subtract(self.samples, &fit.atoms, &fit.gains);
        (fit.residual, fit.energy) = (left.residual, left.energy);
        let all = self.fitter.energy(self.samples);
        if fit.cost() > MAX_START_RESIDUAL_PART * all {
            return Ok(None);
        }
        if let Some(fit) = self.found_by_tones(&fit)? {
            self.record_changes(&previous.atoms, &fit);
            return Ok(Some(State { is_complete: true, ..State::of(fit) }));
        }
        // A vanished object leaves an atom that the others don't need.
        fit = self.pruned(self.refined_by_residual(fit)?)?;
        let most_left = MAX_RESIDUAL_GROWTH * previous.search_residual_part * all;
        let is_as_good = |fit: &Fit| !previous.complete && fit.cost() < most_left;
        let mut answer = self.checked(fit);
        if !answer.is_complete && !is_as_good(&answer.fit) {
            self.record_changes(&previous.atoms, &answer.fit);
            answer = after_rungs(self, &[POINTS], answer)?;
        }
        // Many new atoms make up for old ones that went astray.
        let is_like_it = answer.fit.atoms.len() <= previous.atoms.len() + MAX_NEW_ATOMS;
        Ok((is_like_it && (answer.is_complete || is_as_good(&answer.fit))).then_some(answer))
    }

    /// The points of `fit` in whose range bins more is left than noise looked for once more, by their tones: few echoes are told apart at
    /// once, however far they have moved. `None` where that doesn't explain all.
    fn found_by_tones(&self, fit: &Fit) -> Result<Option<Fit>, ReconstructError> {
        let needed = self.have_residual(fit);
        let is_moved = |i: &usize| needed[*i] && matches!(fit.atoms[*i], Atom::Point { .. });
        let moved: Vec<usize> = (0..needed.len()).filter(is_moved).collect();
        let stayed = if moved.is_empty() { fit.clone() } else { self.fitter.remove(fit.clone(), &moved) };
        let pairs = self.pairs(&stayed);
        if pairs.points.len() > moved.len() + MAX_NEW_ATOMS {
            return Ok(None);
        }
        let anew = self.refined_if_nearly_complete(self.paired(stayed, &pairs, false)?)?;
        Ok(self.is_explained(&anew).then_some(anew))
    }
}
