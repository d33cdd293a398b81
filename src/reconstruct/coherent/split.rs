//! Tests of one echo against two close ones, and of two against one.
//!
//! Two reflectors closer than a beam of an end and a range bin look like one. Where one is put in their middle, its residual has maxima beside
//! it, at which further echoes are taken: none of them is at a true place, and none moves to one. Where that may have happened, the whole search
//! runs once more, and each echo with a residual at its own range is tried as two before others are added beside it. The answer is the run that
//! needs fewer echoes for the same residual, or leaves less.

use super::sectors::end_beam_cos;
use super::settle::{MOST_FAILURES, MOST_TWOS, Settled};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::fit::{Atom, Fit, Limits, Profile, Tie, distance_bins, rows_of};
use crate::reconstruct::search::APART_BINS;
use num_complex::Complex64;
use rayon::prelude::*;

/// Starts of the two echoes: offsets to either side of the one, in parts of an end's beam and in range bins.
const STARTS: [(f64, f64); 5] = [(0.1, 0.0), (0.1, 0.25), (0.1, -0.25), (0.02, 0.25), (0.3, 0.0)];

/// Largest residual of two echoes at their range, as a part of that of the one, for which two replace one.
const WORTH_TWO: f64 = 0.2;

/// Largest distance of echoes that may be one: parts of an end's beam, and range bins.
const MAY_BE_ONE: (f64, f64) = (0.1, 0.5);

/// Largest growth of the residual where one echo replaces two, as a part.
const AS_GOOD: f64 = 0.05;

/// Largest power of an echo relative to a stronger one nearby, and largest distance from it in parts of an end's beam and in range bins, at
/// which the weak echo may be the residual of the strong one.
const WEAKER: f64 = 0.1;
const BESIDE: (f64, f64) = (2.0, 2.0);

/// Largest ratio of the residuals of a run with fewer echoes and of the present one.
const FEWER: f64 = 1.5;

/// Largest ratio of the residuals for another run to replace the present one without fewer echoes.
const BETTER: f64 = 0.5;

/// Place and energy of an echo.
struct Spot {
    /// Direction, in an end's beams.
    beam: f64,
    /// Range, in bins.
    bin: f64,
    /// Energy of the echo's samples, with an arbitrary scale.
    energy: f64,
}

impl Settled<'_> {
    /// Whether there is a residual at the range of an echo, or a weak echo beside a strong one: either may be two reflectors found as one.
    pub fn is_doubtful(&self) -> bool {
        let count = self.fit.atoms.len();
        (1..=MOST_TWOS).contains(&count)
            && !self.is_done()
            && (self.has_companions() || self.search().in_need(&self.fit).contains(&true))
    }

    /// Whether a weak echo stands beside a strong one.
    fn has_companions(&self) -> bool {
        let places = self.places();
        let beside = |a: &Spot, b: &Spot| {
            a.energy < WEAKER * b.energy && (a.beam - b.beam).abs() < BESIDE.0 && (a.bin - b.bin).abs() < BESIDE.1
        };
        places.iter().any(|a| places.iter().any(|b| beside(a, b)))
    }

    /// The run itself, or `other` where that needs fewer echoes for the same residual or leaves much less.
    pub fn or(self, other: Self) -> Self {
        let (own, others) = (self.fit.cost(), other.fit.cost());
        let noise = self.bench.gain_noise(self.radar, &other.fit);
        let [few, fewer] = [&self, &other].map(|s| s.fit.atoms.len());
        let is_as_good = others <= FEWER * own + 4.0 * noise + self.enough;
        if (fewer < few && is_as_good) || (fewer <= few && others < own) || others < BETTER * own {
            other
        } else {
            self
        }
    }

    /// Tries echoes with a residual at their own range as two, the strongest first.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn split(&mut self) -> Result<(), ReconstructError> {
        let in_need = self.search().in_need(&self.fit);
        let energy = |i: usize| self.fit.gains[i].iter().map(|g| g.norm_sqr()).sum::<f64>();
        let mut order: Vec<usize> = (0..in_need.len()).filter(|i| in_need[*i]).collect();
        order.sort_by(|a, b| energy(*b).total_cmp(&energy(*a)));
        for i in order {
            self.task.check()?;
            if self.failures >= MOST_FAILURES || self.bench.work.is_spent() {
                break;
            }
            match self.as_two(i) {
                // The indices of the echoes have changed; remaining doubtful ones show in the next round.
                Some(fit) => {
                    (self.fit, self.failures) = (fit, 0);
                    break;
                }
                None => self.failures += 1,
            }
        }
        Ok(())
    }

    /// The fit with two echoes for the one of index `i`, where their residual at its range is much smaller.
    fn as_two(&self, i: usize) -> Option<Fit> {
        let own = rows_of(self.radar, &self.fit.atoms[i]);
        let left = |fit: &Fit| Profile::new(self.radar, &fit.residual.flat(&self.bench.sensor)).at(&own);
        let without = self.bench.less(self.fit.clone(), &[i]);
        let [x, y] = self.fit.atoms[i].position_metres(0.0);
        let place = self.radar.polar_of(x, y);
        let (beam_cos, bin_metres) = (end_beam_cos(self.radar), self.radar.range_resolution_metres());
        let refined =
            |atoms: Vec<Atom>, gains, limits| self.bench.refine(&without.residual, atoms, gains, Tie::PerEnd, limits);
        let start = |(beams, bins): &(f64, f64)| {
            let side = |sign: f64| {
                let cos = (place.cos_theta + sign * beams * beam_cos).clamp(-1.0, 1.0);
                let range = (place.range_metres + sign * bins * bin_metres).max(bin_metres);
                Atom::Point { x_metres: range * cos, y_metres: range * (1.0 - cos * cos).max(0.0).sqrt() }
            };
            refined(vec![side(1.0), side(-1.0)], vec![Default::default(); 2], Limits::ROUGH)
        };
        let tried: Vec<Fit> = STARTS.par_iter().map(start).collect();
        let best = tried.into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost()))?;
        let two = refined(best.atoms, best.gains, Limits::FINAL_FIT);
        let mut fit = without;
        fit.atoms.extend(two.atoms);
        fit.gains.extend(two.gains);
        (fit.residual, fit.energy) = (two.residual, two.energy);
        // A place beyond the maximum range has the same echo as others.
        let is_in_reach = |atom: &Atom| {
            let [x, y] = atom.position_metres(0.0);
            distance_bins(self.radar.samples, &own, &rows_of(self.radar, atom)) < 2.0
                && x.hypot(y) < place.range_metres + 4.0 * bin_metres
        };
        let is_better = left(&fit) < WORTH_TWO * left(&self.fit) && fit.cost() < self.fit.cost();
        (is_better && fit.atoms.iter().rev().take(2).all(is_in_reach)).then_some(fit)
    }

    /// Removes echoes close to another one that, moved, explains both as well.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn merge(&mut self) -> Result<(), ReconstructError> {
        for _ in 0..MOST_TWOS {
            self.task.check()?;
            if self.bench.work.is_spent() {
                break;
            }
            let Some((gone, beside)) = self.closest() else { break };
            let noise = self.bench.gain_noise(self.radar, &self.fit);
            let less = self.bench.less(self.fit.clone(), &[gone]);
            let beside = if beside > gone { beside - 1 } else { beside };
            let marked: Vec<bool> = (0..less.atoms.len()).map(|i| i == beside).collect();
            let fewer = self.search().refined(less, &marked, APART_BINS, Limits::FINAL_FIT)?;
            if fewer.cost() > (1.0 + AS_GOOD) * self.fit.cost() + 4.0 * noise + self.enough {
                break;
            }
            self.fit = fewer;
        }
        Ok(())
    }

    /// Places of all echoes.
    fn places(&self) -> Vec<Spot> {
        let spot = |(atom, gains): (&Atom, &[Complex64; 2])| {
            let [x, y] = atom.position_metres(0.0);
            let place = self.radar.polar_of(x, y);
            Spot {
                beam: place.cos_theta / end_beam_cos(self.radar),
                bin: self.radar.bin_of_range(place.range_metres),
                energy: gains.iter().map(Complex64::norm_sqr).sum::<f64>() / place.range_metres.max(1e-3).powi(4),
            }
        };
        self.fit.atoms.iter().zip(&self.fit.gains).map(spot).collect()
    }

    /// The weaker and the stronger of the two closest echoes, where they may be one.
    fn closest(&self) -> Option<(usize, usize)> {
        let places = self.places();
        let pairs = (0..places.len()).flat_map(|i| (0..places.len()).map(move |j| (i, j)));
        let apart = |(i, j): (usize, usize)| {
            let (a, b) = (&places[i], &places[j]);
            let apart = ((a.beam - b.beam).abs() / MAY_BE_ONE.0).max((a.bin - b.bin).abs() / MAY_BE_ONE.1);
            (i != j && a.energy <= b.energy && apart < 1.0).then_some((apart, (i, j)))
        };
        pairs.filter_map(apart).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, pair)| pair)
    }
}
