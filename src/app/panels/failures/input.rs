//! Input of the failures panel.

use crate::app::jobs::{Album, RowTable};
use crate::app::widgets::Offered;
use crate::evaluate::Metrics;
use crate::evaluate::campaign::Unfit;
use crate::evaluate::rows::Row;
use crate::picture::ColourMap;
use std::path::Path;

/// The rows, the state of the current run, and the row on screen.
pub struct Input<'a> {
    /// The methods to choose from.
    pub methods: Offered<'a>,
    /// The method in use.
    pub method: Option<&'static str>,
    /// The rows.
    pub table: &'a RowTable,
    /// Small maps of the rows.
    pub album: &'a Album,
    /// Number of replaced rows that can be brought back.
    pub before: Option<usize>,
    /// Completed part of the run, 0 to 1, while methods are tried.
    pub progress: Option<f32>,
    /// Message of the last run, where it did not succeed.
    pub note: Option<&'a str>,
    /// Methods that the last run left out.
    pub unfit: &'a [Unfit],
    /// Folder of the user's own scenes.
    pub own: Option<&'a Path>,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// Index of the row that was opened last, as long as it is in the table.
    pub opened: Option<usize>,
    /// The opened row, while its scene is on screen.
    pub on_screen: Option<Live<'a>>,
    /// The search near the scene on screen.
    pub search: Searched<'a>,
}

/// A row whose scene is on screen.
pub struct Live<'a> {
    pub row: &'a Row,
    /// Figures of the method's latest output; `None` where they are outdated.
    pub now: Option<Now>,
}

/// Figures of a method's output for the scene on screen.
pub struct Now {
    /// Name of the method.
    pub method: &'static str,
    /// Figures of the output against the target.
    pub metrics: Metrics,
    /// Text with the numbers of objects found, missed and so on, once they are known.
    pub fates: Option<String>,
}

/// State of the search for a worse or a repaired scene.
#[derive(Default)]
pub struct Searched<'a> {
    /// Completed part of the search, 0 to 1, while it runs.
    pub progress: Option<f32>,
    /// Summary of the search's result.
    pub summary: Option<String>,
    /// Message of the search, where it did not succeed.
    pub note: Option<&'a str>,
    /// Whether the search has a scene to put on screen.
    pub has_found: bool,
}
