//! Walls: rows of points that were found one by one, followed to where they end.

use super::atom::Atom;
use super::chains::rows_of_points;
use super::echoes::Samples;
use super::grow::Grower;
use super::refine::{Fit, Gains, Limits, Tie};
use crate::reconstruct::ReconstructError;

/// Of a wall by itself.
const ALONE: Limits = Limits { iterations: 8, least_gain: 1e-2, ridge: 0.0 };

/// Reflectors beyond the best end of a wall that are tried.
const BEYOND: usize = 8;

/// Most reflectors of a wall.
const MOST_REFLECTORS: usize = 250;

/// Most times a wall is followed further and moved to its best place.
const MOST_WALKS: usize = 8;

/// Points this near to a wall's axis belong to it or stand for what belongs to it, metres.
const BESIDE_METRES: f64 = 0.06;

/// A wall must leave less than this part of what was left without it.
const LEAST_GAINED: f64 = 0.98;

impl Grower<'_> {
    /// `fit` with walls in place of the points that stand in rows, each as long as the samples say.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn with_walls(&self, samples: &Samples, mut fit: Fit) -> Result<Fit, ReconstructError> {
        for seed in rows_of_points(&fit.atoms, &fit.gains) {
            self.task.check()?;
            if self.bench.is_spent() {
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
            }
        }
        Ok(fit)
    }

    /// The wall moved to its best place in `samples` and made longer, by turns, until neither helps.
    fn followed_to_its_ends(&self, samples: &Samples, seed: Atom) -> Fit {
        let mut wall = self.bench.refine(samples, vec![seed], vec![Gains::default()], Tie::PerEnd, ALONE);
        for _ in 0..MOST_WALKS {
            let [before, after] = [self.more_reflectors(&wall, false), self.more_reflectors(&wall, true)];
            let Some(longer) = extended(wall.atoms[0], before, after).filter(|_| before + after > 0) else { break };
            let trial = self.bench.refine(samples, vec![longer], wall.gains.clone(), Tie::PerEnd, ALONE);
            if trial.cost() >= wall.cost() || self.bench.is_spent() {
                break;
            }
            wall = trial;
        }
        wall
    }

    /// By how many reflectors the wall is too short at its last end, or at its first: as many more as leave least. No more than it
    /// already has, as far as its direction can be trusted.
    fn more_reflectors(&self, wall: &Fit, at_last: bool) -> usize {
        let Some(atom) = wall.atoms.first() else { return 0 };
        let count = atom.reflector_count();
        let (mut best, mut least) = (0, wall.cost());
        let mut residual = wall.residual.clone();
        for more in 1..=count {
            let at = if at_last { (count - 1 + more) as f64 } else { -(more as f64) };
            let [x_metres, y_metres] = atom.position_metres(at);
            if y_metres < 0.0 {
                break;
            }
            let left = self.bench.without(&residual, &[Atom::Point { x_metres, y_metres }], &wall.gains);
            residual = left.residual;
            let cost = left.energy[0] + left.energy[1];
            if cost < least {
                (best, least) = (more, cost);
            } else if more >= best + BEYOND {
                break;
            }
        }
        best
    }
}

/// `wall` with this many reflectors more before its first and after its last.
fn extended(wall: Atom, before: usize, after: usize) -> Option<Atom> {
    let Atom::Segment { dx_metres, dy_metres, count, .. } = wall else { return None };
    let [x_metres, y_metres] = wall.position_metres(-(before as f64));
    let count = count + before + after;
    (count <= MOST_REFLECTORS).then_some(Atom::Segment { x_metres, y_metres, dx_metres, dy_metres, count })
}

/// Whether `atom` is a point on the axis of `wall`, not far beyond its ends.
fn stands_on(wall: &Atom, atom: &Atom) -> bool {
    let (Atom::Segment { dx_metres: dx, dy_metres: dy, .. }, Atom::Point { .. }) = (*wall, *atom) else {
        return false;
    };
    let ([x, y], [point_x, point_y]) = (wall.position_metres(0.0), atom.position_metres(0.0));
    let (to_x, to_y, step) = (point_x - x, point_y - y, dx.hypot(dy));
    let along_steps = (to_x * dx + to_y * dy) / (step * step);
    let beside_metres = (to_x * dy - to_y * dx).abs() / step;
    beside_metres < BESIDE_METRES && along_steps.abs() < MOST_REFLECTORS as f64
}
