//! Points at peaks of the residual, in rounds: each is refined alone, then with its neighbours, until no peak stands out of the noise.

use super::propose::end_beams::beam_noise_power;
use super::propose::runs::{MIN_ECHO_OVER_NOISE, MIN_LONG_RUN_BINS, longest_run_bins};
use super::state::{Search, ends_agree, tried};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{AttemptVerdict, Proposal, Refusal};
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Gains, Limits, Profile, Samples, Tie, bin_spans, groups, union_of};
use crate::scene::Reflector;
use num_complex::Complex64;
use rayon::prelude::*;

/// Limits of a group's refinement before further points are added.
const GROWING_LIMITS: Limits = Limits { max_steps: 12, min_decrease: 3e-2, ridge: 0.0 };

/// Distance in range at either end up to which atoms are refined together.
const LINK_BINS: f64 = 6.0;

/// Largest number of refinements of all groups, one after another.
const MAX_SWEEPS: usize = 5;

/// Largest residual energy after such a sweep, over that before, for which another one follows.
const MAX_SWEEP_RESIDUAL_PART: f64 = 0.3;

/// Largest ratio of a new point's gains at the two ends. Its neighbours may still be missing, so that they are not equal.
const MAX_NEW_GAIN_RATIO: f64 = 3.0;

/// Largest energy in a range bin that may be a side lobe, over that in the bin with the largest residual.
const MAX_SIDE_LOBE_POWER_RATIO: f64 = 1e-4;

/// Work of a search for peaks of the residual, in units of the budget.
pub const DETECTION_WORK: usize = 200;

/// Work between two checks of the progress.
const PROGRESS_WORK: usize = 3000;

/// Largest residual energy after this work, over that before, for which more points are added.
const MAX_PROGRESS_RESIDUAL_PART: f64 = 1.0 / 3.0;

/// Largest number of atoms that are refined together.
const MAX_GROUP_ATOMS: usize = 48;

/// Largest number of points from one search for peaks.
const MAX_NEW_POINTS: usize = 16;

impl Search<'_> {
    pub fn record_refusal(&self, tried: Proposal, gain_decades: f64, why: Refusal) {
        self.trace.add(tried, gain_decades, AttemptVerdict::Refused(why), self.fitter.work.done());
    }

    /// Increase of the residual energy of `fit` without this object, the others unchanged, in decades.
    pub fn own_decades(&self, fit: &Fit, atom: &Atom, gains: &Gains) -> f64 {
        let own =
            |r: Reflector| self.fitter.energy_of_amplitude(r.reflectivity / (r.x_metres.powi(2) + r.y_metres.powi(2)));
        let energy: f64 = atom.reflectors((gains[0].norm() + gains[1].norm()) / 2.0).map(own).sum();
        decades(fit.cost() + energy, fit.cost())
    }

    /// Whether no peak of the residual stands out of the noise.
    pub fn is_explained(&self, fit: &Fit) -> bool {
        let flat = fit.residual.flat(&self.fitter.sensor);
        self.detector.peaks(&flat, self.min_peak_power(&flat), 1).is_empty()
    }

    /// Mean power of the noise of `flat` in a beam ([`beam_noise_power`]).
    pub fn noise_power(&self, flat: &[Complex64]) -> f64 {
        beam_noise_power(self.radar, self.fitter.noise_model.noise_variance(self.radar, flat))
    }

    /// The power in a beam from which a peak stands out of the noise of `flat`.
    fn min_peak_power(&self, flat: &[Complex64]) -> f64 {
        (self.noise_power(flat) * self.settings.min_prominence).max(self.rounding_power())
    }

    /// Whether the residual `flat` has echoes in more successive range bins than a few reflectors have.
    pub fn has_long_run(&self, flat: &[Complex64]) -> bool {
        let variance = self.fitter.noise_model.noise_variance(self.radar, flat);
        longest_run_bins(self.radar, flat, variance) >= MIN_LONG_RUN_BINS
    }

    /// Relative error of a reflector's samples by the rounding of its place to f64: each reflector of a row has it.
    pub fn rounding_amplitude(&self) -> f64 {
        let [radians_per_metre, _] = self.fitter.sensor.radians_per_metre_over_chirp();
        radians_per_metre * f64::EPSILON * self.radar.max_range_metres()
    }

    /// Power of this error in a beam.
    fn rounding_power(&self) -> f64 {
        let radar = self.radar;
        let window: f64 = radar.window.weights(radar.samples).iter().sum();
        (self.rounding_amplitude() * radar.end_elements as f64 * window).powi(2) / radar.samples as f64
    }

    /// Adds points to `fit` until no peak stands out, progress is slow, or the largest number of atoms or the budget is reached.
    pub fn grown(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let mut last_check = (self.fitter.work.done(), fit.cost());
        while fit.atoms.len() < self.settings.max_atoms && !self.fitter.work.is_spent() {
            self.fitter.task.check()?;
            self.fitter.work.spend(DETECTION_WORK);
            let flat = fit.residual.flat(&self.fitter.sensor);
            let remaining = self.settings.max_atoms - fit.atoms.len();
            let points = self.detector.peaks(&flat, self.min_peak_power(&flat), MAX_NEW_POINTS.min(remaining));
            if points.is_empty() {
                break;
            }
            fit = self.with_points(fit, &points)?;
            tracing::debug!(atoms = fit.atoms.len(), cost = fit.cost(), new = points.len(), "grown");
            let (done, cost) = last_check;
            if self.fitter.work.done() > done + PROGRESS_WORK {
                if fit.cost() > MAX_PROGRESS_RESIDUAL_PART * cost {
                    // Reflectors too dense to be resolved: further points lower the residual little for much work.
                    self.fitter.work.exhaust();
                }
                last_check = (self.fitter.work.done(), fit.cost());
            }
        }
        Ok(fit)
    }

    /// All groups refined one after another, and again while this lowers the residual much: a group's residual disturbs the others.
    pub fn refined_in_sweeps(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for _ in 0..MAX_SWEEPS {
            let before = fit.cost();
            let all = vec![true; fit.atoms.len()];
            fit = self.refined(fit, &all, LINK_BINS, GROWING_LIMITS)?;
            if fit.cost() > MAX_SWEEP_RESIDUAL_PART * before {
                break;
            }
        }
        Ok(fit)
    }

    /// `fit` with one more atom for each of `points` (x and y, metres; the strongest first), refined alone, then with its neighbours.
    pub fn with_points(&self, mut fit: Fit, points: &[[f64; 2]]) -> Result<Fit, ReconstructError> {
        let refined: Vec<(Atom, Gains)> = points.par_iter().map(|p| self.refined_point(&fit, *p)).collect();
        let is_kept = |(number, (atom, gains)): &(usize, (Atom, Gains))| {
            // The strongest is added even if its gains differ between the ends.
            let is_kept = *number == 0 || ends_agree(gains, MAX_NEW_GAIN_RATIO);
            if !is_kept {
                self.record_refusal(tried(atom), self.own_decades(&fit, atom, gains), Refusal::EndsDisagree);
            }
            is_kept
        };
        let (atoms, gains): (Vec<Atom>, Vec<Gains>) =
            refined.into_iter().enumerate().filter(is_kept).map(|(_, new)| new).unzip();
        let known = fit.atoms.len();
        let remainder = self.fitter.subtract(&fit.residual, &atoms, &gains);
        (fit.residual, fit.energy) = (remainder.residual, remainder.energy);
        fit.atoms.extend(atoms);
        fit.gains.extend(gains);
        let marked: Vec<bool> = (0..fit.atoms.len()).map(|i| i >= known).collect();
        self.refined(fit, &marked, LINK_BINS, GROWING_LIMITS)
    }

    /// The point at (x, y), metres, refined at its own range or the wrapped one, the better: beat frequencies wrap, the curvature of waves doesn't.
    pub fn refined_point(&self, fit: &Fit, [x_metres, y_metres]: [f64; 2]) -> (Atom, Gains) {
        let own = Atom::Point { x_metres, y_metres };
        let max_range = self.radar.max_range_metres();
        let is_near = x_metres.hypot(y_metres) <= max_range;
        let alone = |atom: Atom| {
            self.fitter.refine(&fit.residual, vec![atom], vec![Gains::default()], Tie::PerEnd, Limits::ROUGH_FIT)
        };
        let (own, other) = rayon::join(|| alone(own), || alone(at_other_wrap([x_metres, y_metres], max_range)));
        let (near, far) = if is_near { (own, other) } else { (other, own) };
        if far.cost() >= 0.5 * near.cost() {
            return (near.atoms[0], near.gains[0]);
        }
        // The nearer one may have missed its best place: at a small array both have nearly the same echo.
        let place = far.atoms[0].position_metres(0.0);
        let back = if far.atoms[0].range_metres() > max_range { alone(at_other_wrap(place, max_range)) } else { near };
        let better = if far.cost() < 0.5 * back.cost() { far } else { back };
        (better.atoms[0], better.gains[0])
    }

    /// `fit` with each group that contains a marked atom refined, one after another ([`groups`]).
    pub fn refined(
        &self,
        mut fit: Fit,
        marked: &[bool],
        link_bins: f64,
        limits: Limits,
    ) -> Result<Fit, ReconstructError> {
        let spans: Vec<BinSpans> = fit.atoms.iter().map(|a| bin_spans(self.radar, a)).collect();
        for group in groups(self.radar.samples, &spans, marked, link_bins, MAX_GROUP_ATOMS) {
            self.fitter.task.check()?;
            if self.fitter.work.is_spent() {
                break;
            }
            self.fitter.work.spend(DETECTION_WORK / 2);
            let base = self.fitter.residual_without(&fit, &group).residual;
            let (atoms, gains) = group.iter().map(|&i| (fit.atoms[i], fit.gains[i])).unzip();
            let own = union_of(group.iter().map(|&i| spans[i]));
            let ridge = own.map_or(0.0, |own| self.ridge(&fit, &base, &own) / group.len() as f64);
            let refined = self.fitter.refine(&base, atoms, gains, Tie::PerEnd, Limits { ridge, ..limits });
            for (k, &i) in group.iter().enumerate() {
                (fit.atoms[i], fit.gains[i]) = (refined.atoms[k], refined.gains[k]);
            }
            (fit.residual, fit.energy) = (refined.residual, refined.energy);
        }
        Ok(fit)
    }

    /// The ridge for atoms in `spans`: the settings' price times the part of the energy of `base` there that is in the residual.
    fn ridge(&self, fit: &Fit, base: &Samples, spans: &BinSpans) -> f64 {
        let of = |samples: &Samples| Profile::new(self.radar, &samples.flat(&self.fitter.sensor)).energy(spans);
        let (residual, all) = rayon::join(|| of(&fit.residual), || of(base));
        if all > 0.0 { self.settings.gain_price * (residual / all).min(1.0) } else { 0.0 }
    }

    /// For each atom whether its range bins have more residual than noise and than side lobes of the residual elsewhere.
    pub fn have_residual(&self, fit: &Fit) -> Vec<bool> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let profile = Profile::new(self.radar, &flat);
        let noise = self.noise_power(&flat);
        let peaks: Vec<f64> = fit.atoms.iter().map(|atom| profile.peak_energy(&bin_spans(self.radar, atom))).collect();
        let strongest = peaks.iter().copied().fold(0.0, f64::max);
        let least = (MIN_ECHO_OVER_NOISE * noise.max(self.rounding_power())).max(MAX_SIDE_LOBE_POWER_RATIO * strongest);
        peaks.into_iter().map(|peak| peak > least).collect()
    }

    /// The atoms with residual in their range bins refined with their neighbours, in sweeps.
    pub fn refined_by_residual(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for sweep in 0..MAX_SWEEPS {
            let before = fit.cost();
            let marked = self.have_residual(&fit);
            if !marked.contains(&true) {
                break;
            }
            // Side lobes couple distant groups too, so that later sweeps refine all atoms together.
            let link_bins = if sweep == 0 { LINK_BINS } else { self.radar.samples as f64 };
            fit = self.refined(fit, &marked, link_bins, Limits::FINAL_FIT)?;
            tracing::debug!(before, cost = fit.cost(), "refined where needed");
            if fit.cost() > MAX_SWEEP_RESIDUAL_PART * before {
                break;
            }
        }
        Ok(fit)
    }

    /// All atoms refined with their neighbours, and again while the residual decreases.
    pub fn converged(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        loop {
            let before = fit.cost();
            fit = self.all_refined(fit)?;
            // False where the residual is no number.
            let is_progress = fit.cost() < 0.9 * before;
            if !is_progress {
                return Ok(fit);
            }
        }
    }

    /// All atoms refined with their neighbours.
    pub fn all_refined(&self, fit: Fit) -> Result<Fit, ReconstructError> {
        let all = vec![true; fit.atoms.len()];
        self.refined(fit, &all, 2.0 * LINK_BINS, Limits::FINAL_FIT)
    }
}

/// The place farther by the maximum range, or nearer by it if it is beyond.
fn at_other_wrap([x_metres, y_metres]: [f64; 2], max_range_metres: f64) -> Atom {
    let range = x_metres.hypot(y_metres).max(1e-3);
    let other = if range > max_range_metres { -1.0 } else { 1.0 };
    let far = 1.0 + other * max_range_metres / range;
    Atom::Point { x_metres: x_metres * far, y_metres: y_metres * far }
}
