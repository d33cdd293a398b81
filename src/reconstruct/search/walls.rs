//! Walls: rows of points that were found one by one, followed to where they end.

use super::begin::Seeds;
use super::grow::{Grower, tried};
use super::on_wall::stands_on;
use super::propose::chains::Chains;
use super::trace::decades;
use super::without::Part;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{Atom, Fit, Gains, Limits, Samples, Tie};

/// A wall must leave less than this part of what was left without it.
const LEAST_GAINED: f64 = 0.98;

/// Of all walls together.
const TOGETHER: Limits = Limits { iterations: 10, least_gain: 1e-2, ridge: 0.0 };

/// Most walls of one scene.
const MOST_WALLS: usize = 8;

/// Part of the work granted that the search for walls may take.
const MOST_SPENT: f64 = 0.5;

/// Most times all ends are followed and all walls moved together.
const MOST_TURNS: usize = 4;

/// Another turn needs that the last left this part of the energy at most.
const WORTH_ANOTHER_TURN: f64 = 0.9;

impl Grower<'_> {
    /// `fit` and the walls that begin at `seeds`, as long as each explains much of what there is in its range bins.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn more_walls(&self, samples: &Samples, mut fit: Fit, mut seeds: Seeds) -> Result<Fit, ReconstructError> {
        let (known, before) = (fit.atoms.len(), self.bench.work.spent());
        while fit.atoms.len() < known + MOST_WALLS && self.bench.work.spent() < before + MOST_SPENT {
            self.task.check()?;
            let Some(wall) = self.next_wall(&fit, &mut seeds) else { break };
            fit.atoms.push(wall.atoms[0]);
            fit.gains.push(wall.gains[0]);
            (fit.residual, fit.energy) = (wall.residual, wall.energy);
        }
        if fit.atoms.len() == known {
            return Ok(fit);
        }
        self.with_settled_ends(samples, fit)
    }

    /// Every wall followed to its ends once more, now that the others are known, and all moved together; by turns, as long as it helps.
    fn with_settled_ends(&self, samples: &Samples, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for _ in 0..if self.settings.lacks(Part::SettledEnds) { 0 } else { MOST_TURNS } {
            self.task.check()?;
            let before = fit.cost();
            fit = self.bench.refine(samples, fit.atoms, fit.gains, Tie::PerEnd, TOGETHER);
            let joined = fit.cost();
            for i in 0..fit.atoms.len() {
                if self.bench.work.is_spent() || !matches!(fit.atoms[i], Atom::Segment { .. }) {
                    continue;
                }
                let back = fit.gains[i].map(|g| -g);
                let base = self.bench.without(&fit.residual, &fit.atoms[i..=i], &[back]).residual;
                let wall = self.followed_to_its_ends(&base, fit.atoms[i]);
                if wall.cost() < fit.cost() {
                    (fit.atoms[i], fit.gains[i]) = (wall.atoms[0], wall.gains[0]);
                    (fit.residual, fit.energy) = (wall.residual, wall.energy);
                }
            }
            tracing::debug!(before, joined, cost = fit.cost(), "settled ends");
            if fit.cost() > WORTH_ANOTHER_TURN * before {
                break;
            }
        }
        Ok(fit)
    }

    /// `fit` with walls in place of the points that stand in rows, each as long as the samples say.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn with_walls(&self, samples: &Samples, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let seeds = self.proposed(Part::Chains, &Chains, &self.unexplained(&[], &fit));
        for seed in seeds {
            self.task.check()?;
            if self.bench.work.is_spent() {
                break;
            }
            let others: Vec<usize> = (0..fit.atoms.len()).filter(|&i| !stands_on(&seed, &fit.atoms[i])).collect();
            let mut atoms: Vec<Atom> = others.iter().map(|&i| fit.atoms[i]).collect();
            let mut gains: Vec<Gains> = others.iter().map(|&i| fit.gains[i]).collect();
            let base = self.bench.without(samples, &atoms, &gains).residual;
            let wall = self.followed_to_its_ends(&base, seed);
            tracing::debug!(?seed, wall = ?wall.atoms[0], before = fit.cost(), after = wall.cost(), "wall");
            if wall.cost() < LEAST_GAINED * fit.cost() {
                atoms.push(wall.atoms[0]);
                gains.push(wall.gains[0]);
                fit = Fit { atoms, gains, residual: wall.residual, energy: wall.energy };
            } else {
                self.refuse(tried(&wall.atoms[0]), decades(fit.cost(), wall.cost()), Refusal::GainsTooLittle);
            }
        }
        Ok(fit)
    }
}
