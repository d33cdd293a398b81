//! Walls, one after another: each is looked for in what the others leave, and all are moved together.

use super::state::Search;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Fit, Limits, Tie};

/// Most walls of one scene.
const MOST_WALLS: usize = 8;

impl Search<'_> {
    /// `fit` and the walls that begin at `points` (x, y; metres), as long as each explains much of what there is in its range bins.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn more_walls(&self, mut fit: Fit, mut points: Vec<[f64; 2]>) -> Result<Fit, ReconstructError> {
        let (known, before) = (fit.atoms.len(), self.fitter.work.done());
        // Half of the work is for what is no wall.
        let most = before + self.settings.max_work / 2;
        while fit.atoms.len() < known + MOST_WALLS && self.fitter.work.done() < most {
            self.task.check()?;
            let Some(wall) = self.next_wall(&fit, &mut points) else { break };
            fit.atoms.push(wall.atoms[0]);
            fit.gains.push(wall.gains[0]);
            (fit.residual, fit.energy) = (wall.residual, wall.energy);
        }
        if fit.atoms.len() == known {
            return Ok(fit);
        }
        Ok(self.fitter.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH))
    }
}
