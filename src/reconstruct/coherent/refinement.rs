//! Refinement of peaks by their exact echoes, and removal of needless ones.
//!
//! The cyclic least squares by which Yardibi et al. refine their own peaks (RELAX: J. Li and P. Stoica, "Efficient mixed-spectrum estimation
//! with applications to target feature extraction", IEEE Trans. Signal Process. 44, 1996), with the tools of the search.

use super::peaks::{Peak, distinct, gains};
use super::sectors::end_beam_cos;
use crate::radar::{Radar, hann};
use crate::reconstruct::echoes::Gained;
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Fitter, Samples, Tie, bin_spans, distance_bins};
use crate::reconstruct::search::{
    Detector, MAX_ROUNDING_RESIDUAL_PART, MIN_DISTANCE_BINS, MIN_ENERGY_RATIO, Search, Settings, Trace,
};
use crate::scene::Reflector;
use crate::signal::{ArrayEcho, TwoEnds};
use crate::task::Task;
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::Arc;

/// Least distance of a reflector from the array over its distance from the nearer end.
const MIN_DISTANCE_RATIO: f64 = 0.25;

/// Largest number of rounds in which peaks of one search are added.
const MAX_ROUNDS: usize = 8;

/// Least energy of a peak over that of the strongest of the same round: the residual of a strong peak in an inexact place resembles many weak ones.
const MIN_STRONGEST_PART: f64 = 0.03;

/// Energy of a peak, over its first energy, up to which others have explained it.
const MAX_EXPLAINED_REMAINDER_PART: f64 = 0.05;

/// Largest residual energy after a search, over that before, for which another one follows.
const MAX_SEARCH_RESIDUAL_PART: f64 = 0.9;

/// Residual energy at which the search ends, as a part of the samples': 130 dB down, above rounding, which is not white.
const COMPLETE_PART: f64 = 1e-13;

/// Distance within which echoes are one: range bins, and parts of an end's beam width.
const MAX_SAME_PLACE_DISTANCE: [f64; 2] = [1e-2, 1e-3];

/// Budget of work, in units of about ten microseconds.
const MAX_WORK: usize = 30_000;

/// A peak without a reflector so far.
struct PendingPeak {
    echo: ArrayEcho,
    spans: BinSpans,
    /// Energy that it explained when it was found.
    energy: f64,
}

/// Reflectors found so far, with their residual.
pub(super) struct Refinement<'a> {
    radar: &'a Radar,
    fitter: Fitter<'a>,
    detector: Arc<Detector>,
    settings: Settings,
    samples: Samples,
    trace: Trace,
    fit: Fit,
    /// Energy of the windowed samples.
    samples_energy: f64,
}

impl<'a> Refinement<'a> {
    /// The start for `ends`, without reflectors.
    pub fn new(radar: &'a Radar, ends: &TwoEnds, task: &'a Task) -> Self {
        let flat = ends.flat();
        let fitter = Fitter::new(radar, &hann(radar.samples), task, MAX_WORK).with_channels_of(&flat);
        let samples = Samples::new(&fitter.sensor, &flat);
        let fit = fitter.solve(&samples, Vec::new(), Tie::PerEnd, 0.0);
        let (detector, settings) = (Detector::of(radar), Settings::default());
        let samples_energy = fit.cost();
        Refinement { radar, fitter, detector, settings, samples, trace: Trace::default(), fit, samples_energy }
    }

    fn search(&self) -> Search<'_> {
        let Refinement { radar, fitter, detector, settings, samples, trace, .. } = self;
        Search { radar, fitter, detector, samples, has_white_noise: false, settings, trace }
    }

    pub fn residual(&self) -> TwoEnds {
        TwoEnds::of_flat(self.radar, &self.fit.residual.flat(&self.fitter.sensor))
    }

    /// Adds reflectors at `peaks`, in rounds from the strongest on. Returns whether another search is useful.
    pub fn add(&mut self, peaks: &[Peak]) -> Result<bool, ReconstructError> {
        let before = self.fit.clone();
        let mut pending: Vec<PendingPeak> = peaks.iter().filter_map(|p| PendingPeak::new(self.radar, p)).collect();
        let first = self.explained_energies(&pending);
        pending.iter_mut().zip(first).for_each(|(peak, energy)| peak.energy = energy);
        for _ in 0..MAX_ROUNDS {
            self.fitter.task.check()?;
            let noise = MIN_ENERGY_RATIO * self.fitter.noise_energy(self.radar, &self.fit);
            let now = self.explained_energies(&pending);
            let mut remaining: Vec<(f64, PendingPeak)> = now.into_iter().zip(pending).collect();
            remaining.retain(|(now, peak)| *now > noise.max(MAX_EXPLAINED_REMAINDER_PART * peak.energy));
            remaining.sort_by(|a, b| b.0.total_cmp(&a.0));
            let least = remaining.first().map_or(0.0, |(strongest, _)| MIN_STRONGEST_PART * strongest);
            let mut later = remaining.split_off(remaining.partition_point(|(now, _)| *now >= least));
            let taken = taken_places(self.radar, &mut remaining);
            remaining.append(&mut later);
            if taken.is_empty() || self.is_done() {
                break;
            }
            let search = self.search();
            self.fit = search.refined_in_sweeps(search.with_points(self.fit.clone(), &taken)?)?;
            pending = remaining.into_iter().map(|(_, peak)| peak).collect();
        }
        self.fit = self.search().pruned(self.fit.clone())?;
        let is_better = self.fit.cost() < MAX_SEARCH_RESIDUAL_PART * before.cost();
        if self.fit.cost() > before.cost() {
            self.fit = before;
        }
        Ok(is_better && !self.is_done())
    }

    /// The reflectors after a new search for those that hide each other ([`Search::relaxed`]), where there is a residual.
    pub fn with_model_order(mut self) -> Result<Self, ReconstructError> {
        if !self.is_done() {
            let search = self.search();
            self.fit = search.pruned(search.relaxed(self.fit.clone())?)?;
        }
        Ok(self)
    }

    /// Whether the residual is small enough, or the work is spent.
    fn is_done(&self) -> bool {
        self.fit.cost() <= COMPLETE_PART * self.samples_energy || self.fitter.work.is_spent()
    }

    /// Energy of the residual that each of `pending` explains alone.
    fn explained_energies(&self, pending: &[PendingPeak]) -> Vec<f64> {
        let mut weighted = self.fit.residual.flat(&self.fitter.sensor);
        let weights = self.fitter.squared.iter().cycle();
        weighted.iter_mut().zip(weights).for_each(|(v, w)| *v *= w);
        let mean = self.fitter.squared.iter().sum::<f64>() / self.fitter.squared.len() as f64;
        pending.par_iter().map(|peak| peak.echo.correlate(&weighted).norm_sqr() / mean).collect()
    }

    /// The reflectors, with gains common to both ends; `ends` are the samples in which they were found.
    pub fn found(self, ends: &TwoEnds) -> Result<Vec<Gained>, ReconstructError> {
        let (radar, task) = (self.radar, self.fitter.task);
        let fit = self.search().with_tied_gains(self.fit.clone());
        // A residual without an echo proves reflectors at any place.
        let is_certain = fit.cost() <= MAX_ROUNDING_RESIDUAL_PART * self.samples_energy;
        let peak = |(atom, gains): (&Atom, &[Complex64; 2])| {
            let [x, y] = atom.position_metres(0.0);
            let place = radar.polar_of(x, y);
            let power = gains[0].norm_sqr();
            let peak = Peak { range_metres: place.range_metres, cos_theta: place.cos_theta, power };
            (is_certain || is_heard_at_the_ends(radar, x, y)).then_some(peak)
        };
        let peaks = fit.atoms.iter().zip(&fit.gains).filter_map(peak).collect();
        let [bins, beam_widths] = MAX_SAME_PLACE_DISTANCE;
        gains(radar, &distinct(radar, peaks, [bins, beam_widths * end_beam_cos(radar)]), ends, task)
    }
}

/// Whether a reflector's echo is not much stronger between the ends than at them: it would fill the map, though the ends hardly measure it.
fn is_heard_at_the_ends(radar: &Radar, x_metres: f64, y_metres: f64) -> bool {
    let nearest = |from: f64, to: f64| (x_metres - x_metres.clamp(from, to)).hypot(y_metres);
    let outermost = radar.element_x_metres(radar.elements - 1);
    let inner = radar.element_x_metres(radar.elements - radar.end_elements);
    let at_an_end = nearest(-outermost, -inner).min(nearest(inner, outermost));
    nearest(-outermost, outermost) > MIN_DISTANCE_RATIO * at_an_end
}

impl PendingPeak {
    fn new(radar: &Radar, peak: &Peak) -> Option<Self> {
        let echo = ArrayEcho::at(radar, peak.range_metres, peak.cos_theta);
        let Reflector { x_metres, y_metres, .. } = echo.reflector;
        let is_heard = echo.norm().is_finite() && echo.norm() > 0.0;
        let spans = bin_spans(radar, &Atom::Point { x_metres, y_metres });
        is_heard.then_some(PendingPeak { spans, echo, energy: 0.0 })
    }
}

/// Removes the peaks without a stronger one nearby from `remaining`, and returns their places (x, y), metres.
fn taken_places(radar: &Radar, remaining: &mut Vec<(f64, PendingPeak)>) -> Vec<[f64; 2]> {
    let mut taken: Vec<(BinSpans, [f64; 2])> = Vec::new();
    remaining.retain(|(_, peak)| {
        let is_apart =
            taken.iter().all(|(spans, _)| distance_bins(radar.samples, spans, &peak.spans) > MIN_DISTANCE_BINS);
        if is_apart {
            taken.push((peak.spans, [peak.echo.reflector.x_metres, peak.echo.reflector.y_metres]));
        }
        !is_apart
    });
    taken.into_iter().map(|(_, place)| place).collect()
}
