//! What the panel shows.

use crate::app::jobs::{Album, RowTable};
use crate::app::widgets::method_menu::Offered;
use crate::evaluate::Metrics;
use crate::evaluate::campaign::Unfit;
use crate::evaluate::rows::Row;
use crate::picture::ColourMap;
use std::path::Path;

/// What is shown.
pub struct Input<'a> {
    /// The methods to choose from.
    pub methods: Offered<'a>,
    /// The method in use.
    pub method: Option<&'static str>,
    /// The rows.
    pub table: &'a RowTable,
    /// Their small maps.
    pub album: &'a Album,
    /// Rows that others took the place of, and that can be brought back.
    pub before: Option<usize>,
    /// The part that is done, while methods are tried.
    pub progress: Option<f32>,
    /// How the last run ended, if not well.
    pub note: Option<&'a str>,
    /// Methods that the last run went on without.
    pub unfit: &'a [Unfit],
    /// The folder of one's own scenes.
    pub own: Option<&'a Path>,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// Index of the row that was opened last, as long as it stands in this table.
    pub opened: Option<usize>,
    /// That row, while its scene is on screen.
    pub on_screen: Option<Live<'a>>,
    /// The search near the scene on screen.
    pub search: Searched<'a>,
}

/// A row whose scene is on screen.
pub struct Live<'a> {
    pub row: &'a Row,
    /// How it is now, if that is of the method's latest output.
    pub now: Option<Now>,
}

/// What a method makes of the scene on screen as it is now.
pub struct Now {
    /// Its name.
    pub method: &'static str,
    /// Its figures.
    pub metrics: Metrics,
    /// What became of the objects, in words, once that is known.
    pub fates: Option<String>,
}

/// A search, as far as it has come.
#[derive(Default)]
pub struct Searched<'a> {
    /// The part that is done, while it runs.
    pub progress: Option<f32>,
    /// What it has found.
    pub summary: Option<String>,
    /// How it ended, if not well.
    pub note: Option<&'a str>,
    /// Whether there is something to put on screen.
    pub has_found: bool,
}
