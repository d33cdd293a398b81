//! Model order over white noise: the number of echoes of a group of neighbours, and their places.
//!
//! Echoes in one range bin that noise hides from each other are found too many times, in wrong places, with gains that cancel. Each such group is
//! searched again by RELAX (J. Li and P. Stoica, "Efficient mixed-spectrum estimation with applications to target feature extraction", IEEE Trans.
//! Signal Process. 44, 1996): one echo more, then each removed and searched again in turn, until one more explains less than the price of its four
//! numbers, a place and a complex gain (P. Stoica and Y. Selén, "Model-order selection: a review of information criterion rules", IEEE Signal Process.
//! Mag. 21, 2004).

use super::grow::DETECTION_WORK;
use super::settings::min_echo_energy_ratio;
use super::state::{Search, tried};
use super::trace::decades;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Gains, Limits, Samples, Tie, bin_spans, groups, union_of};

/// Range bins at either end within which echoes hide each other: the half of a Hann window's main lobe.
const HIDING_BINS: f64 = 1.5;

/// Largest number of points of a group that is searched again, and of echoes that are searched in it: the time grows with the cube of their number.
const MAX_GROUP_POINTS: usize = 20;
const MAX_GROUP_ECHOES: usize = 8;

/// Largest number of times that each echo of a group is removed and searched again.
const MAX_CYCLES: usize = 2;

impl Search<'_> {
    /// `fit` with each small group of points that may hide each other searched again, where the price of echoes and the residual become less.
    pub fn relaxed(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let spans: Vec<BinSpans> = fit.atoms.iter().map(|atom| bin_spans(self.radar, atom)).collect();
        let are_points: Vec<bool> = fit.atoms.iter().map(|atom| matches!(atom, Atom::Point { .. })).collect();
        let found = groups(self.radar.samples, &spans, &are_points, HIDING_BINS, usize::MAX);
        let rounding = self.fitter.energy_of_amplitude(self.rounding_amplitude());
        let price = rounding.max(min_echo_energy_ratio(self.radar) * self.fitter.noise_energy(self.radar, &fit));
        let is_sought = |group: &Vec<usize>| {
            let is_crowd = group.len() > 1 || group.iter().any(|&i| self.is_beyond(&fit.atoms[i]));
            is_crowd && group.len() <= MAX_GROUP_POINTS && group.iter().all(|i| are_points[*i])
        };
        let found: Vec<Vec<usize>> = found.into_iter().filter(is_sought).collect();
        let (mut removed, mut new): (Vec<usize>, Vec<(Atom, Gains)>) = (Vec::new(), Vec::new());
        for group in found {
            self.fitter.task.check()?;
            if self.fitter.work.is_spent() {
                break;
            }
            let Some(own) = union_of(group.iter().map(|&i| spans[i])) else { continue };
            let base = self.fitter.residual_without(&fit, &group).residual;
            let best = self.relaxed_group(&base, &own, price, MAX_GROUP_ECHOES.min(group.len() + 1))?;
            let before = price * self.echo_count(group.iter().map(|&i| &fit.atoms[i]));
            if best.cost() + price * self.echo_count(best.atoms.iter()) >= fit.cost() + before {
                continue;
            }
            for &i in &group {
                self.record_refusal(tried(&fit.atoms[i]), decades(fit.cost(), best.cost()), Refusal::RestDoesWithout);
            }
            // Atoms are removed after the last group, so that their numbers stay; until then their gains are 0.
            (fit.residual, fit.energy) = (best.residual, best.energy);
            group.iter().for_each(|&i| fit.gains[i] = Gains::default());
            removed.extend(group);
            new.extend(best.atoms.into_iter().zip(best.gains));
        }
        let kept = (0..fit.atoms.len()).filter(|i| !removed.contains(i));
        let all: Vec<(Atom, Gains)> = kept.map(|i| (fit.atoms[i], fit.gains[i])).chain(new).collect();
        (fit.atoms, fit.gains) = all.into_iter().unzip();
        Ok(fit)
    }

    /// Number of `atoms`, those beyond the maximum range counted twice: their echo is like that of a nearer point.
    fn echo_count<'b>(&self, atoms: impl Iterator<Item = &'b Atom>) -> f64 {
        atoms.map(|atom| if self.is_beyond(atom) { 2.0 } else { 1.0 }).sum()
    }

    /// Whether `atom` is beyond the maximum range.
    fn is_beyond(&self, atom: &Atom) -> bool {
        atom.range_metres() > self.radar.max_range_metres()
    }

    /// At most `limit` echoes in the range bins `own` of `base`, as many as each explain the energy `price`.
    fn relaxed_group(&self, base: &Samples, own: &BinSpans, price: f64, limit: usize) -> Result<Fit, ReconstructError> {
        let mut fit = self.fitter.solve(base, Vec::new(), Tie::PerEnd, 0.0);
        let mut best = fit.clone();
        for count in 1..=limit {
            self.fitter.task.check()?;
            let Some(more) = self.with_one_more(&fit, base, own) else { break };
            fit = more;
            for _ in 0..MAX_CYCLES {
                let before = fit.cost();
                for i in 0..count {
                    let others = self.fitter.remove(&fit, &[i]);
                    if let Some(trial) =
                        self.with_one_more(&others, base, own).filter(|trial| trial.cost() < fit.cost())
                    {
                        fit = trial;
                    }
                }
                if count == 1 || before - fit.cost() < price {
                    break;
                }
            }
            if best.cost() - fit.cost() > price * (count - best.atoms.len()) as f64 {
                best = fit.clone();
            } else if count > best.atoms.len() + 1 {
                break;
            }
        }
        Ok(best)
    }

    /// `fit` with a point at the strongest peak of its residual in the range bins `own`, all refined together.
    fn with_one_more(&self, fit: &Fit, base: &Samples, own: &BinSpans) -> Option<Fit> {
        self.fitter.work.spend(DETECTION_WORK);
        let flat = fit.residual.flat(&self.fitter.sensor);
        let place = self.detector.strongest_within(&flat, own)?;
        let (atom, gains) = self.refined_point(fit, place);
        let (mut atoms, mut all) = (fit.atoms.clone(), fit.gains.clone());
        atoms.push(atom);
        all.push(gains);
        Some(self.fitter.refine(base, atoms, all, Tie::PerEnd, Limits::ROUGH_FIT))
    }
}
