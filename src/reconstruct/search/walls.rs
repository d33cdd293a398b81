//! Walls, one after another: each is looked for in what the others leave, and all are followed to their ends again.

use super::grow::Grower;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Atom, Fit, Limits, Samples, Tie};

/// Most walls of one scene.
const MOST_WALLS: usize = 8;

/// Part of the work granted that the search for walls may take.
const MOST_SPENT: f64 = 0.5;

/// Most times all ends are followed and all walls moved together.
const MOST_TURNS: usize = 4;

/// Another turn needs that the last left this part of the energy at most.
const WORTH_ANOTHER_TURN: f64 = 0.9;

impl Grower<'_> {
    /// `fit` and the walls that begin at `points` (x, y; metres), as long as each explains much of what there is in its range bins.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn more_walls(
        &self,
        samples: &Samples,
        mut fit: Fit,
        mut points: Vec<[f64; 2]>,
    ) -> Result<Fit, ReconstructError> {
        let (known, before) = (fit.atoms.len(), self.bench.work.spent());
        while fit.atoms.len() < known + MOST_WALLS && self.bench.work.spent() < before + MOST_SPENT {
            self.task.check()?;
            let Some(wall) = self.next_wall(&fit, &mut points) else { break };
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
        for _ in 0..MOST_TURNS {
            self.task.check()?;
            let before = fit.cost();
            fit = self.bench.refine(samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH);
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
}
