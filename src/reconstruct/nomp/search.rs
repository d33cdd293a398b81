//! The search as a whole: both ends' tones paired, long lines, walls from the pairs, then more points until nothing stands out.

use super::atom::Atom;
use super::begin::Seeds;
use super::echoes::Samples;
use super::finish::{Found, finish};
use super::grow::Grower;
use super::lines::lines_in;
use super::on_wall::is_on;
use super::pairs::{Pairs, paired_points};
use super::peaks::Detector;
use super::refine::{Fit, Gains, Limits, Tie, Workbench};
use super::settings::Settings;
use crate::radar::{Radar, hann};
use crate::reconstruct::hearing::Hearing;
use crate::reconstruct::reconstructor::unit_gain;
use crate::reconstruct::{ReconstructError, Request};
use crate::signal::TwoEnds;

/// Takes the samples apart into atoms.
///
/// # Errors
/// [`ReconstructError::Cancelled`] when the request was cancelled.
pub fn find(radar: &Radar, ends: &TwoEnds, request: &Request, settings: &Settings) -> Result<Found, ReconstructError> {
    find_with(None, radar, ends, request, settings)
}

/// Takes samples apart that differ little from those of `previous`: starts from its atoms, and falls back to [`find`] where they
/// don't do.
///
/// # Errors
/// [`ReconstructError::Cancelled`] when the request was cancelled.
pub fn find_from(
    previous: &Found,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    settings: &Settings,
) -> Result<Found, ReconstructError> {
    find_with(Some(previous).filter(|p| !p.atoms.is_empty()), radar, ends, request, settings)
}

fn find_with(
    previous: Option<&Found>,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    settings: &Settings,
) -> Result<Found, ReconstructError> {
    let Some((ends, scale)) = unit_gain(ends) else { return Ok(Found::nothing()) };
    let flat = ends.flat();
    let window = hann(radar.samples);
    let bench = Workbench::new(radar, &window, &request.task, settings.most_work)
        .hearing(&flat)
        .over(Hearing::beneath(radar, &ends, request.noise));
    let samples = Samples::new(&bench.sensor, &flat);
    let detector = Detector::of(radar);
    let search = Search { radar, bench: &bench, detector: &detector, samples: &samples, request, settings };
    let followed = previous.map(|p| search.followed(p, scale)).transpose()?.flatten();
    let measure = followed.as_ref().filter(|f| !f.is_sure).and(previous).map(|p| p.left_by_search);
    let answer = followed.map_or_else(|| search.run(), Ok)?;
    request.task.check()?;
    request.task.set_progress(1.0);
    let found = finish(radar, &bench, &samples, answer.fit, answer.is_sure, request, scale)?;
    Ok(Found { left_by_search: measure.unwrap_or(found.left_by_search), ..found })
}

/// What a search found, and whether nothing else stands out of the samples.
pub(super) struct Answer {
    pub fit: Fit,
    pub is_sure: bool,
}

/// One search.
pub(super) struct Search<'a> {
    pub radar: &'a Radar,
    pub bench: &'a Workbench<'a>,
    pub detector: &'a Detector,
    pub samples: &'a Samples,
    pub request: &'a Request,
    pub settings: &'a Settings,
}

impl Search<'_> {
    pub(super) fn grower(&self) -> Grower<'_> {
        Grower {
            radar: self.radar,
            bench: self.bench,
            detector: self.detector,
            settings: self.settings,
            task: &self.request.task,
        }
    }

    /// Points that both ends' tones lead to; where those are not all, long lines along y, walls from the points, and what stands beside;
    /// then whatever still stands out.
    fn run(&self) -> Result<Answer, ReconstructError> {
        let nothing = self.bench.solve(self.samples, Vec::new(), Tie::PerEnd, 0.0);
        let is_long = self.grower().echoes_in(&nothing.residual.flat(&self.bench.sensor)).are_long();
        // Many tones take long to tell apart, and are mostly those of lines.
        let few = self.pairs_of_tones(&nothing, if is_long { FEW_TONES } else { usize::MAX });
        if let Some(pairs) = &few {
            let fit = self.paired(nothing.clone(), pairs, false)?;
            if self.is_explained(&fit) {
                return Ok(Answer { fit, is_sure: true });
            }
        }
        let lines = self.long_lines(nothing)?;
        let looked_at = lines.cost();
        let pairs = match few {
            Some(pairs) if lines.atoms.is_empty() => pairs,
            // There are too many, and the same as before.
            None if !is_long => Pairs::default(),
            _ => self.pairs(&lines),
        };
        if !lines.atoms.is_empty() {
            // Lines and points are often all there is.
            let fit = self.nearly_there(self.paired(lines.clone(), &pairs, true)?)?;
            if self.is_nearly_all(&fit) {
                let left = self.pairs(&fit);
                let answer = self.paired_again(fit, left, is_long)?;
                if answer.is_sure {
                    return Ok(answer);
                }
            }
        }
        let (walls, pairs) = self.walls(lines, pairs)?;
        let mut answer = self.paired_again(walls, pairs, is_long)?;
        if !answer.is_sure && answer.fit.cost() < WORTH_ANOTHER_LOOK * looked_at {
            // What was found may have hidden a weaker line.
            let before = answer.fit.atoms.len();
            let lines = self.long_lines(answer.fit.clone())?;
            if lines.atoms.len() > before {
                let pairs = self.pairs(&lines);
                answer = self.paired_again(lines, pairs, is_long)?;
            }
        }
        if answer.is_sure {
            return Ok(answer);
        }
        let fit = self.completed(answer.fit)?;
        Ok(Answer { is_sure: self.is_explained(&fit), fit })
    }

    /// `fit` brought to its end where all is there and not yet quite in its place: a map shows even what little is left.
    pub(super) fn nearly_there(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        if !self.is_nearly_all(&fit) {
            return Ok(fit);
        }
        self.bench.work.grant(self.settings.most_work / 4);
        let grower = self.grower();
        grower.pruned(grower.refined_where_needed(fit)?)
    }

    /// Whether `fit` holds all objects, though perhaps not quite where they are.
    fn is_nearly_all(&self, fit: &Fit) -> bool {
        fit.cost() <= NEARLY_NOTHING * self.energy()
    }

    /// Energy of the windowed samples.
    pub(super) fn energy(&self) -> f64 {
        self.bench.without(self.samples, &[], &[]).energy.iter().sum()
    }

    /// `fit` and long lines along y, looked for as a whole as long as something long is left.
    fn long_lines(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for _ in 0..MOST_ROUNDS {
            let flat = fit.residual.flat(&self.bench.sensor);
            let echoes = self.grower().echoes_in(&flat);
            if !echoes.are_long() {
                break;
            }
            let before = fit.atoms.len();
            self.bench.work.spend(LOOK_FOR_LINES);
            let lines = lines_in(self.radar, &flat, &echoes, &self.request.task);
            fit = self.grower().more_walls(self.samples, fit, Seeds::LongLines(lines))?;
            if fit.atoms.len() == before {
                break;
            }
        }
        Ok(fit)
    }

    /// Walls that begin where both ends may hear points, and the points besides that they agree on; and again, as what was found may have
    /// hidden more. `pairs` are those of `fit`; those of the answer come with it.
    fn walls(&self, mut fit: Fit, mut pairs: Pairs) -> Result<(Fit, Pairs), ReconstructError> {
        for _ in 0..MOST_ROUNDS {
            let (before, cost) = (fit.atoms.len(), fit.cost());
            fit = self.grower().more_walls(self.samples, fit, Seeds::Points(pairs.guesses_metres.clone()))?;
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
            fit = self.bench.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, WITH_POINTS);
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
            fit = self.grower().with_walls(self.samples, self.paired(fit, &pairs, is_polished)?)?;
            fit = self.nearly_there(fit)?;
            tracing::debug!(atoms = fit.atoms.len(), before, cost = fit.cost(), "paired");
            if fit.cost() > WORTH_ANOTHER * before {
                break;
            }
        }
        Ok(Answer { is_sure: self.is_explained(&fit), fit })
    }

    /// Points whose tones both ends hear in what `fit` leaves; none where there are too many to tell apart.
    pub(super) fn pairs(&self, fit: &Fit) -> Pairs {
        self.pairs_of_tones(fit, usize::MAX).unwrap_or_default()
    }

    /// The same; `None` where an end hears more tones than `most`.
    fn pairs_of_tones(&self, fit: &Fit, most: usize) -> Option<Pairs> {
        let flat = fit.residual.flat(&self.bench.sensor);
        let noise = self.bench.hearing.noise_variance(self.radar, &flat);
        paired_points(self.radar, &flat, noise, most)
    }

    /// `known` and the points that `pairs` of what it leaves lead to, less those whose gains the ends don't agree on.
    /// They are moved to their best places only if that is asked for.
    pub(super) fn paired(&self, known: Fit, pairs: &Pairs, polished: bool) -> Result<Fit, ReconstructError> {
        let mut atoms = known.atoms.clone();
        atoms.extend(pairs.points.iter().map(|point| point.atom));
        if atoms.len() == known.atoms.len() {
            return Ok(known);
        }
        atoms.truncate(self.settings.most_atoms);
        let mut fit = self.bench.solve(self.samples, atoms, Tie::PerEnd, 0.0);
        for _ in 0..MOST_DOUBTS {
            let alike = |gains: &Gains| {
                let [a, b] = gains.map(|g| g.norm());
                a.max(b) < MOST_UNLIKE * a.min(b)
            };
            let kept: Vec<Atom> = fit.atoms.iter().zip(&fit.gains).filter(|(_, g)| alike(g)).map(|(a, _)| *a).collect();
            if kept.len() == fit.atoms.len() {
                break;
            }
            fit = self.bench.solve(self.samples, kept, Tie::PerEnd, 0.0);
        }
        if fit.cost() > known.cost() {
            return Ok(known);
        }
        let grower = self.grower();
        if !polished || self.is_explained(&fit) { grower.pruned(fit) } else { grower.pruned(grower.polished(fit, 1)?) }
    }

    /// `fit` with the points it lacks and without those it doesn't need.
    pub(super) fn completed(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        let grower = self.grower();
        let mut fit = grower.polished(grower.grown(fit)?, self.settings.rounds)?;
        fit = grower.pruned(fit)?;
        // What was pruned may uncover what it hid.
        if !self.is_explained(&fit) && fit.atoms.len() < MOST_AGAIN {
            fit = grower.pruned(grower.polished(grower.grown(fit)?, self.settings.rounds)?)?;
        }
        Ok(fit)
    }

    /// Whether nothing stands out of what `fit` leaves.
    pub(super) fn is_explained(&self, fit: &Fit) -> bool {
        self.grower().is_explained(fit)
    }
}

/// Part of the samples' energy that is left where all is found but for its exact place.
const NEARLY_NOTHING: f64 = 1e-5;

/// Tones that are told apart in no time.
const FEW_TONES: usize = 92;

/// Work that a look for long lines amounts to.
const LOOK_FOR_LINES: usize = 2000;

/// Of walls and points together.
const WITH_POINTS: Limits = Limits { iterations: 12, least_gain: 1e-2, ridge: 0.0 };

/// Most rounds of pairing what is left.
const MOST_ROUNDS: usize = 3;

/// Another round of pairing needs that this part of the energy at most is left by the last.
const WORTH_ANOTHER: f64 = 0.5;

/// Another look for long lines needs that this part of the energy at most is left of what the last one saw.
const WORTH_ANOTHER_LOOK: f64 = 0.3;

/// Rounds in which pairs that the ends don't agree on are dropped.
const MOST_DOUBTS: usize = 3;

/// Gains of one pair at both ends agree within this factor.
const MOST_UNLIKE: f64 = 1.5;

/// Most atoms of a fit that is worth a second search for what it lacks.
const MOST_AGAIN: usize = 60;
