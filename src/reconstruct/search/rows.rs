//! Walls, one after another: each is looked for in what the others leave, and all are moved together.

use super::state::Search;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Fit, Limits, Tie};

/// Most rows of one scene.
const MAX_ROWS: usize = 8;

impl Search<'_> {
    /// `fit` and the rows that begin at `points` (x, y; metres), as long as each explains much of what there is in its range bins.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn with_rows(&self, mut fit: Fit, mut points: Vec<[f64; 2]>) -> Result<Fit, ReconstructError> {
        let (known, before) = (fit.atoms.len(), self.fitter.work.done());
        // Half of the work is for what is no row.
        let most = before + self.settings.max_work / 2;
        while fit.atoms.len() < known + MAX_ROWS && self.fitter.work.done() < most {
            self.task.check()?;
            let Some(row) = self.next_row(&fit, &mut points) else { break };
            fit.atoms.push(row.atoms[0]);
            fit.gains.push(row.gains[0]);
            (fit.residual, fit.energy) = (row.residual, row.energy);
        }
        if fit.atoms.len() == known {
            return Ok(fit);
        }
        Ok(self.fitter.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH))
    }
}
