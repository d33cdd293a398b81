//! The search as a whole: long lines, both ends' tones paired, walls through them, few points sample by sample, then more until nothing
//! stands out.

use super::atom::Atom;
use super::echoes::Samples;
use super::few;
use super::finish::{Found, finish};
use super::grow::Grower;
use super::pairs::paired_points;
use super::peaks::Detector;
use super::refine::{Fit, Gains, Tie, Workbench};
use super::settings::Settings;
use crate::maps::channels_range_transform;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::noise::noise_variance;
use crate::reconstruct::reconstructor::unit_gain;
use crate::reconstruct::{ReconstructError, Request};
use crate::signal::TwoEnds;
use ndarray::ArrayView1;
use num_complex::Complex64;

/// Range bins in a row that only something longer than a few reflectors fills.
const LONG_RUN_BINS: usize = 48;

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
    let bench = Workbench::new(radar, &window, &request.task, settings.most_work);
    let samples = Samples::new(&bench.sensor, &flat);
    let detector = Detector::of(radar);
    let search =
        Search { radar, bench: &bench, detector: &detector, flat: &flat, samples: &samples, request, settings };
    let followed = previous.map(|p| search.followed(p, scale)).transpose()?.flatten();
    let answer = followed.map_or_else(|| search.run(), Ok)?;
    request.task.check()?;
    request.task.set_progress(1.0);
    finish(radar, &bench, &samples, answer.fit, answer.is_sure, request, scale)
}

/// What a search found, and whether nothing else stands out of the samples.
struct Answer {
    fit: Fit,
    is_sure: bool,
}

struct Search<'a> {
    radar: &'a Radar,
    bench: &'a Workbench<'a>,
    detector: &'a Detector,
    flat: &'a [Complex64],
    samples: &'a Samples,
    request: &'a Request,
    settings: &'a Settings,
}

impl Search<'_> {
    fn grower(&self) -> Grower<'_> {
        Grower {
            radar: self.radar,
            bench: self.bench,
            detector: self.detector,
            settings: self.settings,
            task: &self.request.task,
        }
    }

    /// Lines where the echo is long. Elsewhere, and beside them, points that both ends' tones lead to and walls through them, told apart
    /// sample by sample where they are few; then whatever still stands out.
    fn run(&self) -> Result<Answer, ReconstructError> {
        let nothing = self.bench.solve(self.samples, Vec::new(), Tie::PerEnd, 0.0);
        let is_long = self.longest_run() >= LONG_RUN_BINS;
        let mut few = if is_long { Some(self.with_few()?) } else { None };
        if let Some(sure) = few.take_if(|few| few.is_sure) {
            return Ok(sure);
        }
        let mut answer = Answer { fit: nothing, is_sure: false };
        for _ in 0..MOST_ROUNDS {
            let before = answer.fit.cost();
            answer.fit = self.grower().with_walls(self.samples, self.paired(answer.fit, !is_long)?)?;
            tracing::debug!(atoms = answer.fit.atoms.len(), before, cost = answer.fit.cost(), "paired");
            answer.is_sure = self.is_explained(&answer.fit);
            if answer.is_sure || answer.fit.cost() > WORTH_ANOTHER * before {
                break;
            }
        }
        if few.is_none() && answer.fit.atoms.len() <= FEW {
            few = Some(self.with_few()?);
        }
        match few {
            Some(few) if few.is_sure || !answer.is_sure && few.fit.cost() < answer.fit.cost() => answer = few,
            _ => {}
        }
        if answer.is_sure {
            return Ok(answer);
        }
        let fit = self.completed(answer.fit)?;
        Ok(Answer { is_sure: self.is_explained(&fit), fit })
    }

    /// What a search for a few points and long vertical lines finds, every sample of each written out.
    fn with_few(&self) -> Result<Answer, ReconstructError> {
        let found = few::find(self.radar, self.flat, self.request, self.settings.most_line_work)?;
        let atoms: Vec<Atom> = found.atoms.iter().map(few::atom::Atom::outside).collect();
        let left = self.bench.without(self.samples, &atoms, &found.gains);
        let fit = Fit { atoms, gains: found.gains, residual: left.residual, energy: left.energy };
        Ok(Answer { fit, is_sure: found.complete })
    }

    /// `known` and the points whose tones both ends hear in what it leaves, less those whose gains the ends don't agree on.
    /// They are moved to their best places only if that is asked for: long lines are better found before.
    fn paired(&self, known: Fit, polished: bool) -> Result<Fit, ReconstructError> {
        let flat = known.residual.flat(&self.bench.sensor);
        let noise = noise_variance(self.radar, flat.chunks_exact(self.radar.samples).map(ArrayView1::from));
        let mut atoms = known.atoms.clone();
        atoms.extend(paired_points(self.radar, &flat, noise));
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
    fn completed(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        let grower = self.grower();
        let mut fit = grower.polished(grower.grown(fit)?, self.settings.rounds)?;
        fit = grower.pruned(fit)?;
        // What was pruned may uncover what it hid.
        if !self.is_explained(&fit) && fit.atoms.len() < MOST_AGAIN {
            fit = grower.pruned(grower.polished(grower.grown(fit)?, self.settings.rounds)?)?;
        }
        Ok(fit)
    }

    /// The answer to samples a little different from those of `previous`: its atoms refined where the residual asks for it, and more
    /// or fewer of them where that is not enough. `None` where they don't explain the samples as well as they did.
    fn followed(&self, previous: &Found, scale: f64) -> Result<Option<Answer>, ReconstructError> {
        let grower = self.grower();
        let ratio = scale / previous.scale;
        let gains = previous.gains.iter().map(|g| g.map(|g| g * ratio)).collect();
        let mut fit = Fit { atoms: previous.atoms.clone(), gains, residual: self.samples.clone(), energy: [0.0; 2] };
        let left = self.bench.without(self.samples, &fit.atoms, &fit.gains);
        (fit.residual, fit.energy) = (left.residual, left.energy);
        let all = self.bench.without(self.samples, &[], &[]).energy;
        if fit.cost() > MOST_CHANGED * (all[0] + all[1]) {
            return Ok(None);
        }
        // What vanished leaves an atom that the rest can do without.
        fit = grower.pruned(grower.refined_where_needed(fit)?)?;
        if !self.is_explained(&fit) {
            fit = self.completed(fit)?;
        }
        // Many new atoms make up for old ones that went astray.
        if fit.atoms.len() > previous.atoms.len() + MOST_APPEARING {
            return Ok(None);
        }
        let unexplained = fit.cost() / (all[0] + all[1]);
        let is_sure = self.is_explained(&fit);
        let is_as_good = is_sure || !previous.complete && unexplained < 2.0 * previous.unexplained;
        Ok(is_as_good.then_some(Answer { fit, is_sure }))
    }

    /// Whether nothing stands out of what `fit` leaves.
    fn is_explained(&self, fit: &Fit) -> bool {
        self.grower().candidates(&fit.residual.flat(&self.bench.sensor), 1, |_| false).is_empty()
    }

    /// Most neighbouring range bins with an echo at either end: above the noise, and no more than 60 dB below the strongest when
    /// ranges are evened out by the 1/R^2 law.
    fn longest_run(&self) -> usize {
        let ends = TwoEnds::of_flat(self.radar, self.flat);
        let weights = self.radar.window.weights(self.radar.samples);
        let window = weights.iter().map(|w| w * w).sum::<f64>() / self.radar.samples as f64;
        let channels = End::BOTH.into_iter().flat_map(|end| ends.end(end).outer_iter());
        let noise = window * self.radar.end_elements as f64 * noise_variance(self.radar, channels);
        let run_of = |end| {
            let profiles = channels_range_transform(self.radar, ends.end(end).view()).profiles;
            let even = |bin: usize| (bin as f64 + 10.0).powi(4);
            let power = |bin: usize| profiles.column(bin).iter().map(Complex64::norm_sqr).sum::<f64>();
            let powers: Vec<f64> = (0..self.radar.samples).map(power).collect();
            let strongest = powers.iter().enumerate().map(|(bin, p)| p * even(bin)).fold(0.0, f64::max);
            let is_echo = |bin: usize| powers[bin] > 4.0 * noise && powers[bin] * even(bin) >= 1e-6 * strongest;
            let echoes: Vec<bool> = (0..powers.len()).map(is_echo).collect();
            echoes.split(|echo| !*echo).map(<[bool]>::len).max().unwrap_or(0)
        };
        End::BOTH.map(run_of).into_iter().max().unwrap_or(0)
    }
}

/// Most atoms that are told apart sample by sample.
const FEW: usize = 12;

/// Most atoms that appear from one answer to the next.
const MOST_APPEARING: usize = 2;

/// Most rounds of pairing what is left.
const MOST_ROUNDS: usize = 3;

/// Another round of pairing needs that this part of the energy at most is left by the last.
const WORTH_ANOTHER: f64 = 0.5;

/// Rounds in which pairs that the ends don't agree on are dropped.
const MOST_DOUBTS: usize = 3;

/// Gains of one pair at both ends agree within this factor.
const MOST_UNLIKE: f64 = 1.5;

/// Most atoms of a fit that is worth a second search for what it lacks.
const MOST_AGAIN: usize = 60;

/// Part of the samples' energy that a last answer may leave and still be a start.
const MOST_CHANGED: f64 = 0.7;
