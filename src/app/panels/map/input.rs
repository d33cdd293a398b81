//! Input of a map.

use super::blank::Problem;
use super::frame::{Cells, Marked};
use super::hatch::ToldApart;
use super::kinds::Kinds;
use super::theory::Theory;
use crate::app::state::{MapKind, Projection, State};
use crate::scene::Reflector;
use eframe::egui::TextureId;

/// Picture, values, marks and texts of a map.
pub struct Input<'a> {
    pub kind: MapKind,
    pub state: &'a State,
    pub texture: Option<TextureId>,
    /// Projection of the picture; for a moment after a change it is still the former one, and no picture is drawn.
    pub pictured: Projection,
    /// Lambda at the end of the picture's colour scale.
    pub end: f32,
    /// Description of the picture for screen readers.
    pub sentence: Option<&'a str>,
    /// Whether the picture has belonged to an earlier scene for so long that the map says so.
    pub stale: bool,
    /// Text over an outdated picture.
    pub old: String,
    pub cells: Option<Cells<'a>>,
    /// True reflectors, object by object: as rings, or as the outline of a line.
    pub objects: &'a [Marked],
    /// Reflectors that the method found, as crosses.
    pub found: &'a [Reflector],
    /// Verdicts on the objects, where they are marked.
    pub kinds: Option<Kinds<'a>>,
    /// Maps and thresholds that separate hits, misses and false alarms, where the cells show these.
    pub told_apart: Option<ToldApart<'a>>,
    pub theory: Option<Theory<'a>>,
    pub error: Option<Problem<'a>>,
}

impl Input<'_> {
    /// Whether the picture is hidden, since a lesson asks for a prediction.
    pub fn is_veiled(&self) -> bool {
        self.state.is_predicting()
    }

    /// Whether that prediction is a click in this map.
    pub fn awaits_click(&self) -> bool {
        let run = self.state.lesson.as_ref().filter(|run| run.is_predicting());
        run.is_some_and(|run| run.clicked_map() == Some(self.kind))
    }
}
