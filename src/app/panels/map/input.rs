//! What a map is drawn from.

use super::answer::Places;
use super::blank::{Problem, Veil};
use super::frame::{Cells, Marks};
use super::hatch::ToldApart;
use super::kinds::Kinds;
use super::theory::Theory;
use crate::app::state::{Cursor, MapKind, MapView, Projection, View};
use crate::interact::Selection;
use crate::radar::Radar;
use crate::scene::Scene;
use eframe::egui::TextureId;

/// What a map shows.
pub struct Input<'a> {
    /// Which map.
    pub kind: MapKind,
    pub radar: &'a Radar,
    /// The scene: what can be grabbed by its blobs.
    pub scene: &'a Scene,
    /// What of it is selected.
    pub selection: &'a Selection,
    /// How maps are looked at.
    pub look: &'a View,
    /// The visible part of maps over the other coordinates.
    pub other_view: MapView,
    /// Its picture, if there is one.
    pub texture: Option<TextureId>,
    /// Over which coordinates that picture is: for a moment after they change, the ones of before.
    pub pictured: Projection,
    /// Where the scale of that picture ends, Lambda.
    pub end: f32,
    /// What it shows, for screen readers.
    pub sentence: Option<&'a str>,
    /// Whether the picture is of an earlier scene, and has been for long enough to be told.
    pub stale: bool,
    /// What is said of it then.
    pub old: String,
    /// The numbers behind the picture.
    pub cells: Option<Cells<'a>>,
    /// What is drawn over it.
    pub marks: Marks<'a>,
    /// What became of every object, if that is marked.
    pub kinds: Option<Kinds<'a>>,
    /// What its cells are, where they are hits, misses and false alarms.
    pub told_apart: Option<ToldApart<'a>>,
    /// What the formulas say of a reflector, if that is drawn over it.
    pub theory: Option<Theory<'a>>,
    /// Where the pointer is, in whichever panel.
    pub cursor: Option<Cursor>,
    /// What is to be known of the method that made it.
    pub note: Option<String>,
    /// What it shows, in a line over it, at a first start.
    pub line: Option<String>,
    /// Why there is no picture.
    pub error: Option<Problem<'a>>,
    /// Hides the picture: a prediction is asked for.
    pub veil: Option<Veil>,
    /// Whether the axes are told: not while they would answer a lesson's question.
    pub axes: bool,
    /// The place that was guessed in a lesson, and the true one.
    pub places: Option<Places>,
}
