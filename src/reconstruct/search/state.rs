//! The input of a search, its state, and the functions that several rungs share.

use super::propose::pairs::{Pairs, paired_points};
use super::propose::peaks::Detector;
use super::settings::Settings;
use super::trace::{ORDERING, Trace, decades};
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Refusal, Tried, Verdict};
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Samples, Tie};
use crate::task::Task;

/// Part of the samples' energy that is left where all is found but for its exact place.
pub const NEARLY_COMPLETE_RESIDUAL_PART: f64 = 1e-5;

/// Most rounds of pairing what is left, and of dropping pairs that the ends don't agree on.
pub const MAX_ROUNDS: usize = 3;

/// Gains of one pair at both ends agree within this factor.
const MAX_PAIR_GAIN_RATIO: f64 = 1.5;

/// The state of a search, which one rung leaves to the next, and its answer.
pub struct State {
    /// The objects found.
    pub fit: Fit,
    /// Whether nothing stands out of what `fit` leaves: then the search stops.
    pub is_complete: bool,
    /// Points whose tones both ends hear in what `fit` leaves; `None` where an end hears too many tones.
    pub pairs: Option<Pairs>,
}

impl State {
    pub fn of(fit: Fit) -> Self {
        State { fit, is_complete: false, pairs: None }
    }
}

pub struct Search<'a> {
    pub radar: &'a Radar,
    /// Fits under the search's window, and the work that is left.
    pub fitter: &'a Fitter<'a>,
    /// Looks for places.
    pub detector: &'a Detector,
    pub samples: &'a Samples,
    /// Whether white noise lies beneath the samples.
    pub has_white_noise: bool,
    pub settings: &'a Settings,
    /// The task, which may be cancelled.
    pub task: &'a Task,
    /// The record of attempts.
    pub trace: &'a Trace,
}

impl Search<'_> {
    /// The state with the objects of `fit`, which is sure where nothing stands out of what they leave.
    pub fn checked(&self, fit: Fit) -> State {
        State { is_complete: self.is_explained(&fit), ..State::of(fit) }
    }

    /// `answer` with as many echoes as noise lets be told apart, where there is noise.
    pub fn with_model_order(&self, answer: State) -> Result<State, ReconstructError> {
        if !self.has_white_noise || answer.fit.atoms.is_empty() {
            return Ok(answer);
        }
        self.trace.enter(ORDERING);
        self.fitter.work.grant(self.settings.max_work / 2);
        Ok(self.checked(self.pruned(self.relaxed(answer.fit)?)?))
    }

    /// `fit` brought to its end where all is there and not yet quite in its place: a map shows even what little is left.
    pub fn refined_if_nearly_complete(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        if !self.is_nearly_complete(&fit) {
            return Ok(fit);
        }
        self.fitter.work.grant(self.settings.max_work / 4);
        self.pruned(self.refined_by_residual(fit)?)
    }

    /// Records which objects of `fit` are new, and which of those `before` were exchanged.
    pub fn record_changes(&self, before: &[Atom], fit: &Fit) {
        let is_in = |atom: &Atom, list: &[Atom]| list.iter().any(|other| self.is_same(atom, other));
        for atom in before.iter().filter(|atom| !is_in(atom, &fit.atoms)) {
            self.record_refusal(tried(atom), 0.0, Refusal::Exchanged);
        }
        for (atom, gains) in fit.atoms.iter().zip(&fit.gains).filter(|(atom, _)| !is_in(atom, before)) {
            let gain_decades = self.own_decades(fit, atom, gains);
            self.trace.add(tried(atom), gain_decades, Verdict::Kept, self.fitter.work.done());
        }
    }

    /// Whether two objects are one that was moved a little.
    fn is_same(&self, a: &Atom, b: &Atom) -> bool {
        let apart = |[i, j]: [f64; 2]| {
            let ([x, y], [other_x, other_y]) = (a.position_metres(i), b.position_metres(j));
            (x - other_x).hypot(y - other_y)
        };
        let last = [a, b].map(|atom| atom.reflector_count() as f64 - 1.0);
        a.reflector_count() == b.reflector_count()
            && apart([0.0; 2]).max(apart(last)) < self.radar.range_resolution_metres()
    }

    /// Whether `fit` holds all objects, though perhaps not quite where they are.
    pub fn is_nearly_complete(&self, fit: &Fit) -> bool {
        fit.cost() <= NEARLY_COMPLETE_RESIDUAL_PART * self.fitter.energy(self.samples)
    }

    /// Points whose tones both ends hear in what `fit` leaves; none where there are too many to tell apart.
    pub fn pairs(&self, fit: &Fit) -> Pairs {
        self.pairs_of_tones(fit).unwrap_or_default()
    }

    /// [`Search::pairs`]; `None` where an end has too many tones.
    pub fn pairs_of_tones(&self, fit: &Fit) -> Option<Pairs> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let noise = self.fitter.noise_model.noise_variance(self.radar, &flat);
        paired_points(self.radar, &flat, noise)
    }

    /// `known` and the points that `pairs` of what it leaves lead to, less those whose gains the ends don't agree on.
    /// They are moved to their best places only if that is asked for.
    pub fn paired(&self, known: Fit, pairs: &Pairs, converged: bool) -> Result<Fit, ReconstructError> {
        let mut atoms = known.atoms.clone();
        atoms.extend(pairs.points.iter().map(|point| point.atom));
        if atoms.len() == known.atoms.len() {
            return Ok(known);
        }
        atoms.truncate(self.settings.max_atoms);
        let mut fit = self.fitter.solve(self.samples, atoms, Tie::PerEnd, 0.0);
        for _ in 0..MAX_ROUNDS {
            let (kept, unlike): (Vec<_>, Vec<_>) =
                fit.atoms.iter().zip(&fit.gains).partition(|(_, gains)| ends_agree(gains, MAX_PAIR_GAIN_RATIO));
            if unlike.is_empty() {
                break;
            }
            for (atom, gains) in unlike {
                self.record_refusal(tried(atom), self.own_decades(&fit, atom, gains), Refusal::EndsDisagree);
            }
            let kept = kept.into_iter().map(|(atom, _)| *atom).collect();
            fit = self.fitter.solve(self.samples, kept, Tie::PerEnd, 0.0);
        }
        if fit.cost() > known.cost() {
            let tried = Tried::Together { count: pairs.points.len() };
            self.record_refusal(tried, decades(known.cost(), fit.cost()), Refusal::GainsTooLittle);
            return Ok(known);
        }
        if !converged || self.is_explained(&fit) { self.pruned(fit) } else { self.pruned(self.converged(fit, 1)?) }
    }
}

/// Whether the amplitudes of both ends' gains differ by less than the factor `within`.
pub fn ends_agree(gains: &Gains, within: f64) -> bool {
    let [a, b] = gains.map(|g| g.norm());
    a.max(b) < within * a.min(b)
}

/// `atom` as an attempt names it.
pub fn tried(atom: &Atom) -> Tried {
    let [from_metres, to_metres] = [0.0, atom.reflector_count() as f64 - 1.0].map(|i| atom.position_metres(i));
    match *atom {
        Atom::Point { .. } => Tried::Point { at_metres: from_metres },
        Atom::Segment { count, .. } => Tried::Line { from_metres, to_metres, count },
    }
}
