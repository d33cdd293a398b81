//! Input of a map.

use super::answer::Places;
use super::blank::{Problem, Veil};
use super::frame::{Cells, Marks};
use super::hatch::ToldApart;
use super::kinds::Kinds;
use super::theory::Theory;
use crate::app::state::{MapKind, Projection, State};
use eframe::egui::TextureId;

/// Picture, values, marks and texts of a map.
pub struct Input<'a> {
    pub kind: MapKind,
    pub state: &'a State,
    /// Texture of the picture, if there is one.
    pub texture: Option<TextureId>,
    /// Projection of the picture; for a moment after a change it is still the former one.
    pub pictured: Projection,
    /// Lambda at the end of the picture's colour scale.
    pub end: f32,
    /// Description of the picture for screen readers.
    pub sentence: Option<&'a str>,
    /// Whether the picture has belonged to an earlier scene for so long that the map says so.
    pub stale: bool,
    /// Text over an outdated picture.
    pub old: String,
    /// Values of the picture's cells.
    pub cells: Option<Cells<'a>>,
    /// Reflectors drawn over the map.
    pub marks: Marks<'a>,
    /// Verdicts on the objects, where they are marked.
    pub kinds: Option<Kinds<'a>>,
    /// Maps and thresholds that separate hits, misses and false alarms, where the cells show these.
    pub told_apart: Option<ToldApart<'a>>,
    /// Prediction of the formulas for a reflector, where it is drawn.
    pub theory: Option<Theory<'a>>,
    /// Note on noise that the map's method was not trained on.
    pub note: Option<String>,
    /// Caption at a first start, one line.
    pub line: Option<String>,
    /// Reason for a missing picture.
    pub error: Option<Problem<'a>>,
    /// Cover of the picture, while a lesson asks for a prediction.
    pub veil: Option<Veil>,
    /// The guessed place of a lesson's question, and the true one.
    pub places: Option<Places>,
}
