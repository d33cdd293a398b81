//! The greedy loop: places that stand out, each refined alone, then with its neighbours, until nothing stands out of the noise.

use super::propose::end_beams::beam_noise_power;
use super::propose::runs::{ABOVE_NOISE, LONG_RUN_BINS, longest_run_bins};
use super::state::{Search, ends_agree, tried};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Refusal, Tried, Verdict};
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Gains, Limits, Profile, Samples, Tie, bin_spans, groups, union_of};
use crate::scene::Reflector;
use num_complex::Complex64;
use rayon::prelude::*;

/// Limits of the refinement of a group while more atoms are to come.
const GROWING_LIMITS: Limits = Limits { max_steps: 12, min_decrease: 3e-2, ridge: 0.0 };

/// Atoms this many bins apart at either end are refined together.
const LINK_BINS: f64 = 6.0;

/// Most rounds of refinement where more is left than noise.
const MAX_SWEEPS: usize = 5;

/// Another round needs that this part of the energy at most is left by the last.
const MAX_SWEEP_RESIDUAL_PART: f64 = 0.3;

/// A point that both ends see has the same gain at both, within this factor while its neighbours are not known.
const MAX_NEW_GAIN_RATIO: f64 = 3.0;

/// Power in a range bin, over that in the bin of which most is left, up to which it may be a side lobe.
const MAX_SIDE_LOBE_POWER_RATIO: f64 = 1e-4;

/// Echoes that a look at the residual takes as long as.
pub const DETECTION_WORK: usize = 200;

/// Work after which growing is checked for its worth.
const PROGRESS_WORK: usize = 3000;

/// Largest part of the energy that this work may leave for growing to continue.
const MAX_PROGRESS_RESIDUAL_PART: f64 = 1.0 / 3.0;

/// Most atoms refined together.
const MAX_GROUP_ATOMS: usize = 48;

/// Candidates taken from one look at the residual.
const MAX_NEW_POINTS: usize = 16;

impl Search<'_> {
    /// Records an attempt that was refused.
    pub fn record_refusal(&self, tried: Tried, gain_decades: f64, why: Refusal) {
        self.trace.add(tried, gain_decades, Verdict::Refused(why), self.fitter.work.done());
    }

    /// Decades by which the energy that `fit` leaves would grow without this object of it, the others staying as they are.
    pub fn own_decades(&self, fit: &Fit, atom: &Atom, gains: &Gains) -> f64 {
        let own = |r: Reflector| {
            self.fitter.energy_of_amplitude(r.reflectivity / (r.x_metres.powi(2) + r.y_metres.powi(2)), self.radar)
        };
        let energy: f64 = atom.reflectors((gains[0].norm() + gains[1].norm()) / 2.0).map(own).sum();
        decades(fit.cost() + energy, fit.cost())
    }

    /// Whether nothing stands out of the noise of what `fit` leaves.
    pub fn is_explained(&self, fit: &Fit) -> bool {
        let flat = fit.residual.flat(&self.fitter.sensor);
        self.detector.peaks(self.radar, &flat, self.least_power(&flat), 1).is_empty()
    }

    /// The power in a beam that stands out of the noise of `flat`.
    fn least_power(&self, flat: &[Complex64]) -> f64 {
        let noise = beam_noise_power(self.radar, self.fitter.noise_model.noise_variance(self.radar, flat));
        (noise * self.settings.min_prominence).max(self.rounding_power())
    }

    /// Whether the residual `flat` has something longer than a few reflectors.
    pub fn has_long_run(&self, flat: &[Complex64]) -> bool {
        let variance = self.fitter.noise_model.noise_variance(self.radar, flat);
        longest_run_bins(self.radar, flat, variance) >= LONG_RUN_BINS
    }

    /// Amplitude of the error by rounding a reflector's place to f64, if its samples are 1: many reflectors of one wall are each off
    /// by that.
    pub fn rounding_amplitude(&self) -> f64 {
        let [radians_per_metre, _] = self.fitter.sensor.radians_per_metre_over_chirp();
        radians_per_metre * f64::EPSILON * self.radar.max_range_metres()
    }

    /// The power of this error in a beam.
    fn rounding_power(&self) -> f64 {
        let radar = self.radar;
        let window: f64 = radar.window.weights(radar.samples).iter().sum();
        (self.rounding_amplitude() * radar.end_elements as f64 * window).powi(2) / radar.samples as f64
    }

    /// Adds points to `fit` until nothing stands out, nothing helps, it goes too slowly or there are too many.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn grown(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let mut look_back = (self.fitter.work.done(), fit.cost());
        while fit.atoms.len() < self.settings.max_atoms && !self.fitter.work.is_spent() {
            self.task.check()?;
            self.fitter.work.spend(DETECTION_WORK);
            let flat = fit.residual.flat(&self.fitter.sensor);
            let room = self.settings.max_atoms - fit.atoms.len();
            let points = self.detector.peaks(self.radar, &flat, self.least_power(&flat), MAX_NEW_POINTS.min(room));
            if points.is_empty() {
                break;
            }
            fit = self.with_points(fit, &points)?;
            tracing::debug!(atoms = fit.atoms.len(), cost = fit.cost(), new = points.len(), "grown");
            let (done, cost) = look_back;
            if self.fitter.work.done() > done + PROGRESS_WORK {
                if fit.cost() > MAX_PROGRESS_RESIDUAL_PART * cost {
                    // Too dense to be told apart: what more there is to gain is small and dear.
                    self.fitter.work.exhaust();
                }
                look_back = (self.fitter.work.done(), fit.cost());
            }
        }
        Ok(fit)
    }

    /// All atoms refined with their neighbours, as long as the energy falls fast: what one group leaves blinds the others.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
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

    /// `fit` with one more atom for every one of `points` (x and y, metres; the strongest first), each refined alone, then with its
    /// neighbours.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn with_points(&self, mut fit: Fit, points: &[[f64; 2]]) -> Result<Fit, ReconstructError> {
        let mut refined_point: Vec<(Atom, Gains)> = points.par_iter().map(|p| self.refined_point(&fit, *p)).collect();
        // The strongest is taken as it is; of the others those that both ends believe in.
        let mut strongest = true;
        refined_point.retain(|(atom, gains)| {
            let is_kept = std::mem::take(&mut strongest) || ends_agree(gains, MAX_NEW_GAIN_RATIO);
            if !is_kept {
                self.record_refusal(tried(atom), self.own_decades(&fit, atom, gains), Refusal::EndsDisagree);
            }
            is_kept
        });
        let known = fit.atoms.len();
        for (atom, gains) in refined_point {
            fit.atoms.push(atom);
            fit.gains.push(gains);
        }
        let new = &fit.atoms[known..];
        let left = self.fitter.subtract(&fit.residual, new, &fit.gains[known..]);
        (fit.residual, fit.energy) = (left.residual, left.energy);
        let marked: Vec<bool> = (0..fit.atoms.len()).map(|i| i >= known).collect();
        self.refined(fit, &marked, LINK_BINS, GROWING_LIMITS)
    }

    /// A point moved to its best place, at its own range or one wrap nearer or further out: ranges repeat, curvature does not.
    pub fn refined_point(&self, fit: &Fit, [x_metres, y_metres]: [f64; 2]) -> (Atom, Gains) {
        let own = Atom::Point { x_metres, y_metres };
        let wrap = self.radar.max_range_metres();
        let is_near = x_metres.hypot(y_metres) <= wrap;
        let alone = |atom: Atom| {
            self.fitter.refine(&fit.residual, vec![atom], vec![Gains::default()], Tie::PerEnd, Limits::ROUGH)
        };
        let (own, other) = rayon::join(|| alone(own), || alone(at_other_wrap([x_metres, y_metres], wrap)));
        // The nearer one unless the other is clearly better.
        let (near, far) = if is_near { (own, other) } else { (other, own) };
        if far.cost() >= 0.5 * near.cost() {
            return (near.atoms[0], near.gains[0]);
        }
        // The nearer one may only not have got there: where the array is small, both places sound alike.
        let [x, y] = far.atoms[0].position_metres(0.0);
        let back = if x.hypot(y) > wrap { alone(at_other_wrap([x, y], wrap)) } else { near };
        let better = if far.cost() < 0.5 * back.cost() { far } else { back };
        (better.atoms[0], better.gains[0])
    }

    /// Every group of neighbours that holds a marked atom refined together, one group after another.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn refined(
        &self,
        mut fit: Fit,
        marked: &[bool],
        link_bins: f64,
        limits: Limits,
    ) -> Result<Fit, ReconstructError> {
        let spans: Vec<BinSpans> = fit.atoms.iter().map(|a| bin_spans(self.radar, a)).collect();
        for group in groups(self.radar.samples, &spans, marked, link_bins, MAX_GROUP_ATOMS) {
            self.task.check()?;
            if self.fitter.work.is_spent() {
                break;
            }
            self.fitter.work.spend(DETECTION_WORK / 2);
            let atoms: Vec<Atom> = group.iter().map(|&i| fit.atoms[i]).collect();
            let gains: Vec<Gains> = group.iter().map(|&i| fit.gains[i]).collect();
            let back: Vec<Gains> = gains.iter().map(|g| [-g[0], -g[1]]).collect();
            let base = self.fitter.subtract(&fit.residual, &atoms, &back).residual;
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

    /// Part of the energy of `base` in these spans that is left unexplained: what the gains of atoms there may cost.
    fn ridge(&self, fit: &Fit, base: &Samples, spans: &BinSpans) -> f64 {
        let of = |samples: &Samples| Profile::new(self.radar, &samples.flat(&self.fitter.sensor)).energy(spans);
        let (left, all) = rayon::join(|| of(&fit.residual), || of(base));
        if all > 0.0 { self.settings.gain_price * (left / all).min(1.0) } else { 0.0 }
    }

    /// For every atom whether more is left in its spans than noise, and than the side lobes of what is left in others.
    pub fn have_residual(&self, fit: &Fit) -> Vec<bool> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let profile = Profile::new(self.radar, &flat);
        let noise = beam_noise_power(self.radar, self.fitter.noise_model.noise_variance(self.radar, &flat));
        let left: Vec<f64> = fit.atoms.iter().map(|atom| profile.peak_energy(&bin_spans(self.radar, atom))).collect();
        let strongest = left.iter().copied().fold(0.0, f64::max);
        let least = (ABOVE_NOISE * noise.max(self.rounding_power())).max(MAX_SIDE_LOBE_POWER_RATIO * strongest);
        left.into_iter().map(|left| left > least).collect()
    }

    /// The atoms refined in whose spans more is left than noise, with their neighbours.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn refined_by_residual(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for sweep in 0..MAX_SWEEPS {
            let before = fit.cost();
            let marked = self.have_residual(&fit);
            if !marked.contains(&true) {
                break;
            }
            // Groups that are far apart still hear a little of each other: all together they come to the end at once.
            let link_bins = if sweep == 0 { LINK_BINS } else { self.radar.samples as f64 };
            fit = self.refined(fit, &marked, link_bins, Limits::FINAL_FIT)?;
            tracing::debug!(
                before,
                cost = fit.cost(),
                marked = marked.iter().filter(|m| **m).count(),
                "refined where needed"
            );
            if fit.cost() > MAX_SWEEP_RESIDUAL_PART * before {
                break;
            }
        }
        Ok(fit)
    }

    /// All atoms refined with their neighbours, time and again, until a round gains little.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn converged(&self, mut fit: Fit, rounds: usize) -> Result<Fit, ReconstructError> {
        for _ in 0..rounds {
            let before = fit.cost();
            let all = vec![true; fit.atoms.len()];
            fit = self.refined(fit, &all, 2.0 * LINK_BINS, Limits::FINAL_FIT)?;
            if fit.cost() > 0.9 * before {
                break;
            }
        }
        Ok(fit)
    }
}

/// The place one wrap of the range further out, or nearer if it lies beyond the maximum range.
fn at_other_wrap([x_metres, y_metres]: [f64; 2], max_range_metres: f64) -> Atom {
    let range = x_metres.hypot(y_metres).max(1e-3);
    let other = if range > max_range_metres { -1.0 } else { 1.0 };
    let far = 1.0 + other * max_range_metres / range;
    Atom::Point { x_metres: x_metres * far, y_metres: y_metres * far }
}
