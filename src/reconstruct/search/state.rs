//! The input of a search, its state, and functions of several rungs.

use super::propose::pairs::{Pairs, paired_points};
use super::propose::peaks::Detector;
use super::settings::Settings;
use super::trace::{ORDERING, Trace, decades};
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{AttemptVerdict, Proposal, Refusal};
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Samples, Tie};

/// Largest residual of a list in which no object is missing but places are inexact, as a part of the samples' energy.
pub const NEARLY_COMPLETE_RESIDUAL_PART: f64 = 1e-5;

/// Largest ratio of the gains of a pair's point at the two ends.
const MAX_PAIR_GAIN_RATIO: f64 = 1.5;

/// The state of a search after a rung, and its answer after the last.
pub struct State {
    pub fit: Fit,
    /// Whether nothing stands out of the residual, so that the search stops.
    pub is_complete: bool,
    /// Points from tones of the residual; `None` where they were not searched, or an end has too many tones.
    pub pairs: Option<Pairs>,
}

impl State {
    pub fn of(fit: Fit) -> Self {
        State { fit, is_complete: false, pairs: None }
    }
}

/// The input of a search.
pub struct Search<'a> {
    pub radar: &'a Radar,
    pub fitter: &'a Fitter<'a>,
    pub detector: &'a Detector,
    pub samples: &'a Samples,
    /// Whether the samples contain white noise beside rounding.
    pub has_white_noise: bool,
    pub settings: &'a Settings,
    pub trace: &'a Trace,
}

impl Search<'_> {
    /// The state of `fit`, complete if nothing stands out of the residual.
    pub fn checked(&self, fit: Fit) -> State {
        State { is_complete: self.is_explained(&fit), ..State::of(fit) }
    }

    /// `answer` with the number of echoes that white noise lets be resolved, where there is white noise.
    pub fn with_model_order(&self, answer: State) -> Result<State, ReconstructError> {
        if !self.has_white_noise || answer.fit.atoms.is_empty() {
            return Ok(answer);
        }
        self.trace.enter(ORDERING);
        self.fitter.work.grant(self.settings.max_work / 2);
        Ok(self.checked(self.pruned(self.relaxed(answer.fit)?)?))
    }

    /// `fit`, refined to the end if no object is missing: a log map shows even a small residual.
    pub fn refined_if_nearly_complete(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        if fit.cost() > NEARLY_COMPLETE_RESIDUAL_PART * self.fitter.energy(self.samples) {
            return Ok(fit);
        }
        self.fitter.work.grant(self.settings.max_work / 4);
        self.pruned(self.refined_by_residual(fit)?)
    }

    /// Records the objects of `fit` that are new, and those of `before` that are gone.
    pub fn record_changes(&self, before: &[Atom], fit: &Fit) {
        let is_in = |atom: &Atom, list: &[Atom]| list.iter().any(|other| self.is_same(atom, other));
        for atom in before.iter().filter(|atom| !is_in(atom, &fit.atoms)) {
            self.record_refusal(tried(atom), 0.0, Refusal::Exchanged);
        }
        for (atom, gains) in fit.atoms.iter().zip(&fit.gains).filter(|(atom, _)| !is_in(atom, before)) {
            let gain_decades = self.own_decades(fit, atom, gains);
            self.trace.add(tried(atom), gain_decades, AttemptVerdict::Kept, self.fitter.work.done());
        }
    }

    /// Whether two objects have the same number of reflectors, and ends less than a range bin apart.
    fn is_same(&self, a: &Atom, b: &Atom) -> bool {
        let distance_metres = |[i, j]: [f64; 2]| {
            let ([x, y], [other_x, other_y]) = (a.position_metres(i), b.position_metres(j));
            (x - other_x).hypot(y - other_y)
        };
        let last = [a, b].map(|atom| atom.reflector_count() as f64 - 1.0);
        a.reflector_count() == b.reflector_count()
            && distance_metres([0.0; 2]).max(distance_metres(last)) < self.radar.range_resolution_metres()
    }

    /// Points from tones of the residual of `fit` that both ends have; `None` where an end has too many tones.
    pub fn tone_pairs(&self, fit: &Fit) -> Option<Pairs> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let noise = self.fitter.noise_model.noise_variance(self.radar, &flat);
        paired_points(self.radar, &flat, noise)
    }

    /// `known` with the points of `pairs` whose gains are equal at both ends; `known` alone if they leave more. With `refines` places are refined.
    pub fn paired(&self, known: Fit, pairs: &Pairs, refines: bool) -> Result<Fit, ReconstructError> {
        let mut atoms = known.atoms.clone();
        atoms.extend(&pairs.points);
        if atoms.len() == known.atoms.len() {
            return Ok(known);
        }
        atoms.truncate(self.settings.max_atoms);
        let mut fit = self.fitter.solve(self.samples, atoms, Tie::PerEnd, 0.0);
        loop {
            let (agreed, unequal): (Vec<_>, Vec<_>) =
                fit.atoms.iter().zip(&fit.gains).partition(|(_, gains)| ends_agree(gains, MAX_PAIR_GAIN_RATIO));
            if unequal.is_empty() {
                break;
            }
            for (atom, gains) in unequal {
                self.record_refusal(tried(atom), self.own_decades(&fit, atom, gains), Refusal::EndsDisagree);
            }
            let agreed = agreed.into_iter().map(|(atom, _)| *atom).collect();
            fit = self.fitter.solve(self.samples, agreed, Tie::PerEnd, 0.0);
        }
        if fit.cost() > known.cost() {
            let tried = Proposal::Together { count: pairs.points.len() };
            self.record_refusal(tried, decades(known.cost(), fit.cost()), Refusal::GainsTooLittle);
            return Ok(known);
        }
        if !refines || self.is_explained(&fit) { self.pruned(fit) } else { self.pruned(self.all_refined(fit)?) }
    }
}

/// Whether the ratio of the gains' magnitudes at both ends is below `max_ratio`.
pub fn ends_agree(gains: &Gains, max_ratio: f64) -> bool {
    let [a, b] = gains.map(|g| g.norm());
    a.max(b) < max_ratio * a.min(b)
}

/// `atom` for the record of attempts.
pub fn tried(atom: &Atom) -> Proposal {
    let [from_metres, to_metres] = [0.0, atom.reflector_count() as f64 - 1.0].map(|i| atom.position_metres(i));
    match *atom {
        Atom::Point { .. } => Proposal::Point { at_metres: from_metres },
        Atom::Row { count, .. } => Proposal::Line { from_metres, to_metres, count },
    }
}
