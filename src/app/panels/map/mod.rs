//! One map: picture, axes, colour bar, cursor, marks.

mod answer;
mod blank;
mod caption;
mod frame;
mod hand;
mod kinds;
mod legend;
mod outline;
mod overlay;
mod plot;
mod scale;
mod swipe;
mod theory;

pub use blank::{Problem, Veil};
pub use caption::{Caption, caption};
pub use frame::{Cells, Marked, Marks};
pub use hand::Memory;
pub use kinds::Kinds;
pub use swipe::Over;
pub use theory::Theory;

use crate::app::state::{
    Command, Cursor, DifferenceView, ExportCommand, LessonCommand, MapKind, MapView, Panel, Projection, Units,
    ViewCommand, WindowCommand,
};
use crate::app::widgets::axes;
use crate::app::widgets::colour_bar::Bar;
use crate::app::widgets::entry::entry;
use crate::app::widgets::nudge::nudge;
use crate::app::widgets::theme::Inks;
use crate::interact::Selection;
use crate::picture::ColourMap;
use crate::radar::{End, Radar};
use crate::scene::Scene;
use eframe::egui;
use eframe::egui::{Align2, Color32, Painter, Rect, Sense, TextureId, Ui, pos2, vec2};
use frame::{Frame, cursor_at};
use legend::Legend;
use plot::{draw_axes, navigate, rect_of};

/// What a map shows.
pub struct Input<'a> {
    /// Which map.
    pub kind: MapKind,
    /// The radar.
    pub radar: &'a Radar,
    /// The scene: what can be grabbed by its blobs.
    pub scene: &'a Scene,
    /// What of it is selected.
    pub selection: &'a Selection,
    /// Over which coordinates.
    pub projection: Projection,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// What the colour bar counts.
    pub units: Units,
    /// How a difference is drawn.
    pub difference: DifferenceView,
    /// Its picture, if there is one.
    pub texture: Option<TextureId>,
    /// Where the scale of that picture ends, Lambda.
    pub end: f32,
    /// Whether the picture is of an earlier scene, and has been for long enough to be told.
    pub stale: bool,
    /// The numbers behind the picture.
    pub cells: Option<Cells<'a>>,
    /// What is drawn over it.
    pub marks: Marks<'a>,
    /// What became of every object, if that is marked.
    pub kinds: Option<Kinds<'a>>,
    /// Whether its cells are hits, misses and false alarms.
    pub told_apart: bool,
    /// Another map right of an edge.
    pub over: Option<Over<'a>>,
    /// What the formulas say of a reflector, if that is drawn over it.
    pub theory: Option<Theory<'a>>,
    /// Where the pointer is, in whichever panel.
    pub cursor: Option<Cursor>,
    /// What is to be known of the method that made it.
    pub note: Option<String>,
    /// Why there is no picture.
    pub error: Option<Problem<'a>>,
    /// Hides the picture: a prediction is asked for.
    pub veil: Option<Veil>,
    /// Whether the axes are told: not while they would answer a lesson's question.
    pub axes: bool,
    /// The place that was guessed in a lesson, and the true one.
    pub places: Option<(crate::lesson::Cell, crate::lesson::Cell)>,
}

#[cfg(test)]
impl<'a> Input<'a> {
    /// A map without a picture.
    pub fn bare(
        kind: MapKind,
        radar: &'a Radar,
        projection: Projection,
        scene: &'a Scene,
        selection: &'a Selection,
    ) -> Input<'a> {
        Input {
            kind,
            radar,
            scene,
            selection,
            projection,
            colours: ColourMap::Grey,
            units: Units::Lambda,
            difference: DifferenceView::default(),
            texture: None,
            end: 1.0,
            stale: false,
            cells: None,
            marks: Marks { objects: &[], found: &[] },
            kinds: None,
            told_apart: false,
            over: None,
            theory: None,
            cursor: None,
            note: None,
            error: None,
            veil: None,
            axes: true,
            places: None,
        }
    }
}

/// Draws a map.
pub fn show(ui: &mut Ui, input: Input<'_>, view: &mut MapView, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    let area = ui.available_rect_before_wrap();
    ui.painter().rect_filled(area, 0.0, ui.visuals().panel_fill);
    let is_told = !input.kind.is_above() && input.veil.is_none() && area.width() > 200.0;
    let bar = is_told.then(|| bar_of(&input));
    let legend = legend_of(ui.painter(), &input, area);
    let rect = rect_of(ui.painter(), area, bar.as_ref(), input.projection, legend.height());
    let response = ui.interact(rect, ui.scope_id().with(("map", input.kind)), Sense::click_and_drag());
    let label = format!("{} map", input.kind.title());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    let frame = Frame {
        rect,
        view: *view,
        radar: input.radar,
        projection: input.projection,
        centre_x_metres: centre_x_metres(input.kind, input.radar),
    };
    let is_bare = input.veil.is_none();
    let holds = is_bare && hand::work(ui, input.kind, input.scene, frame, &response, memory, &mut asked);
    navigate(ui, rect, &response, view, !holds);
    if response.has_focus() && !input.selection.is_empty() {
        asked.extend(nudge(ui.ctx(), input.radar.range_resolution_metres()));
    }
    let frame = Frame { view: *view, ..frame };
    let painter = ui.painter().with_clip_rect(area);
    let inner = ui.painter().with_clip_rect(rect.intersect(area));
    let is_drawn = picture(ui, &inner, frame, &input, &mut asked);
    if input.axes {
        draw_axes(ui, &painter, frame);
    }
    legend.draw(ui, &painter, rect.left_top() - vec2(0.0, legend.height() + 4.0));
    point(&input, frame, &response, &mut asked);
    draw_over(&inner, frame, &input, &response, is_drawn);
    if let Some(bar) = bar {
        bar.draw(ui, &painter, rect);
    }
    if let Some(over) = input.over.as_ref().filter(|_| is_bare) {
        over.handle(ui, &inner, rect, &mut asked);
    }
    response.context_menu(|ui| menu(ui, input.kind, &mut asked));
    asked
}

/// What hatches and marks stand for, where there is room to say so.
fn legend_of(painter: &Painter, input: &Input<'_>, area: Rect) -> Legend {
    let has_room = input.veil.is_none() && area.height() > 150.0;
    let told_apart = input.told_apart && has_room;
    Legend::new(painter, told_apart, input.kinds.as_ref().filter(|_| has_room), area.width() - axes::LEFT - 12.0)
}

/// Marks, the cursor and what is said of an old picture.
fn draw_over(inner: &Painter, frame: Frame<'_>, input: &Input<'_>, response: &egui::Response, is_drawn: bool) {
    let rect = frame.rect;
    let is_old = input.stale && is_drawn;
    if !is_drawn && input.veil.is_none() {
        // What is said in the place of the map stays readable.
        return;
    }
    // Beneath all that is to be read.
    if let Some(cursor) = &input.cursor {
        let told = input.veil.is_none();
        let beneath = input.cells.as_ref();
        let cells = match &input.over {
            Some(over) => over.cells_at(rect, frame.cursor(cursor).x, beneath),
            None => beneath,
        };
        overlay::cursor(inner, frame, cursor, cells.filter(|_| told), input.units);
    }
    if input.veil.is_none() {
        let pointer = response.hover_pos();
        overlay::marks(inner, frame, input.marks.objects, pointer);
        overlay::found(inner, frame, input.marks.found, input.stale);
        overlay::selected(inner, frame, input.scene, input.selection);
        input.theory.iter().for_each(|theory| theory.draw(inner, frame, pointer));
        if let Some((guess, truth)) = input.places {
            answer::draw(inner, frame, guess, truth);
        }
        if let Some(kinds) = input.kinds.as_ref().filter(|_| is_drawn) {
            kinds.draw(inner, frame, pointer, if is_old { 24.0 } else { 0.0 });
        }
    }
    let said = if is_old { Some("Previous scene; updating…") } else { input.note.as_deref() };
    if let Some(said) = said.filter(|_| input.veil.is_none() || is_old) {
        let corner = rect.left_bottom() + vec2(8.0, -8.0);
        axes::text_on_patch(inner, corner, Align2::LEFT_BOTTOM, said);
    }
}

/// Draws the map itself, or says why there is none; whether there is one.
fn picture(ui: &mut Ui, inner: &Painter, frame: Frame<'_>, input: &Input<'_>, asked: &mut Vec<Command>) -> bool {
    let (rect, view) = (frame.rect, frame.view);
    let texture = input.texture.filter(|_| input.veil.is_none());
    match texture {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(view.low.x, view.high.y), pos2(view.high.x, view.low.y));
            let tint = if input.stale { Color32::from_gray(120) } else { Color32::WHITE };
            inner.rect_filled(rect, 0.0, Inks::of(ui.visuals()).beyond);
            inner.image(texture, rect, uv, tint);
        }
        None if input.veil.is_some() => {
            blank::veil(inner, rect, input.veil.is_some_and(|v| v.is_clicked), ui.visuals());
        }
        None => blank::empty(ui, inner, rect, input.error.as_ref(), asked),
    }
    if let Some(over) = input.over.as_ref().filter(|_| input.veil.is_none()) {
        over.draw(ui, inner, frame);
    }
    texture.is_some()
}

/// Tells where the pointer is; a click predicts where that is asked for.
fn point(input: &Input<'_>, frame: Frame<'_>, response: &egui::Response, asked: &mut Vec<Command>) {
    let Some(pos) = response.hover_pos() else { return };
    let Some(cursor) = cursor_at(input.radar, input.projection, frame.view.at(frame.rect, pos)) else { return };
    if input.veil.is_some_and(|v| v.is_clicked) && response.clicked() {
        let cell = crate::lesson::Cell { bin: cursor.bin, column: cursor.column };
        asked.push(LessonCommand::Predict(crate::lesson::Guess::Place(cell)).into());
    }
    asked.push(ViewCommand::Hover(cursor).into());
}

/// Middle of the elements that a map is of.
fn centre_x_metres(kind: MapKind, radar: &Radar) -> f64 {
    match kind {
        MapKind::Input0 => radar.end_centre_metres(End::First),
        MapKind::Input1 => radar.end_centre_metres(End::Last),
        _ => 0.0,
    }
}

fn bar_of(input: &Input<'_>) -> Bar {
    let Input { kind, colours, units, difference, end, .. } = *input;
    let lambda = input.cells.as_ref().and_then(|cells| cells.scale);
    scale::Scale { kind, colours, units, lambda, difference, end }.bar()
}

fn menu(ui: &mut Ui, kind: MapKind, asked: &mut Vec<Command>) {
    for command in [
        Command::Window(WindowCommand::Maximise(Panel::Map(kind))),
        Command::View(ViewCommand::ToggleProjection),
        Command::View(ViewCommand::ToggleUnits),
        Command::View(ViewCommand::ResetMaps),
        Command::View(ViewCommand::ToggleReflectors),
        Command::View(ViewCommand::ToggleTheory),
        Command::View(ViewCommand::ToggleKinds),
        Command::Export(ExportCommand::CopyMap(kind)),
        Command::Window(WindowCommand::ClosePanel(Panel::Map(kind))),
    ] {
        entry(ui, command, true, asked);
    }
    if kind.is_difference() {
        entry(ui, ViewCommand::ToggleAbsoluteDifference, true, asked);
        entry(ui, ViewCommand::ToggleWholeDifference, true, asked);
    }
}

#[cfg(test)]
mod tests;
