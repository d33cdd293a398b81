//! Input of the failures panel.

use crate::app::jobs::Failures;
use crate::app::state::State;
use crate::evaluate::Metrics;
use crate::evaluate::rows::Row;
use std::path::Path;

/// The rows, the state of the current run, and the row on screen.
pub struct Input<'a> {
    pub state: &'a State,
    /// The rows, their run and the search near the scene on screen.
    pub job: &'a Failures,
    /// Folder of the user's own scenes.
    pub own: Option<&'a Path>,
    /// Figures of now for the row on screen; `None` where they are outdated.
    pub now: Option<Now>,
}

impl Input<'_> {
    /// Index of the row that was opened last, as long as it is in the table.
    pub fn opened(&self) -> Option<usize> {
        let opened = self.state.failures.opened.as_ref()?;
        (opened.generation == self.job.table.generation()).then_some(opened.index)
    }

    /// The opened row, while its scene is on screen.
    pub fn row_on_screen(&self) -> Option<&Row> {
        self.state.row_on_screen().map(|opened| &opened.row)
    }
}

/// Figures of a method's output for the scene on screen.
pub struct Now {
    pub method: &'static str,
    pub metrics: Metrics,
    /// Text with the numbers of objects found, missed and so on, once they are known.
    pub verdicts: Option<String>,
}
