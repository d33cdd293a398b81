//! Rows, one after another, each in the residual of the others; then all are refined together.

use super::state::Search;
use crate::reconstruct::ReconstructError;
use crate::reconstruct::fit::{Fit, Limits, Tie};

impl Search<'_> {
    /// `fit` with rows that begin at `points` (x, y; metres).
    pub fn with_rows(&self, mut fit: Fit, mut points: Vec<[f64; 2]>) -> Result<Fit, ReconstructError> {
        let (known, before) = (fit.atoms.len(), self.fitter.work.done());
        // The other half of the work is for points.
        let max_work = before + self.settings.max_work / 2;
        while self.fitter.work.done() < max_work {
            self.fitter.task.check()?;
            let Some(row) = self.next_row(&fit, &mut points) else { break };
            fit.atoms.push(row.atoms[0]);
            fit.gains.push(row.gains[0]);
            (fit.residual, fit.energy) = (row.residual, row.energy);
        }
        if fit.atoms.len() == known {
            return Ok(fit);
        }
        Ok(self.fitter.refine(self.samples, fit.atoms, fit.gains, Tie::PerEnd, Limits::ROUGH_FIT))
    }
}
