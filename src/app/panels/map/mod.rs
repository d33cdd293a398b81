//! One map: picture, axes, colour bar, cursor, marks.

mod answer;
mod blank;
mod caption;
mod clear;
mod frame;
mod hand;
mod hatch;
mod input;
mod kinds;
mod legend;
mod outline;
mod overlay;
mod plot;
mod scale;
mod theory;
mod told;
mod window;

pub use blank::Problem;
pub use frame::Cells;
pub use hand::HandMemory;
pub use hatch::ToldApart;
pub use input::Input;
pub use kinds::Kinds;
pub use theory::Theory;
pub use told::{
    MapMemory, PANEL, caption_of, cells, echoes_found, is_updating, map_input, marks_of, old, scores, verdict,
};

use crate::app::panels::captions;
use crate::app::state::{
    Command, Directions, ExportCommand, LessonCommand, MapKind, MapView, Panel, Projection, State, ViewCommand,
    WindowCommand,
};
use crate::app::widgets::{CAPTION, CAPTION_INK, Inks, axes, entry, entry_called, item, nudge, with_minuses};
use crate::maps::{Aperture, RangeAngleMap, beam_columns};
use crate::radar::{End, MIN_FINE_COLUMNS, Radar};
use crate::reconstruct::untrained_noise;
use crate::scattering::EchoSources;
use crate::scene::Object;
use answer::Places;
use eframe::egui::{self, Color32, Galley, Painter, Pos2, Rect, Sense, Ui, pos2, vec2};
use frame::{Frame, cursor_at};
use legend::Fill;
use plot::{draw_axes, is_wide, navigate, rect_of};
use std::sync::Arc;

/// Text over a map of an earlier scene.
pub const EARLIER_SCENE_TEXT: &str = "Previous scene; updating…";

pub fn show(ui: &mut Ui, input: Input<'_>, view: &mut MapView, memory: &mut HandMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    let (kind, state, radar) = (input.kind, input.state, input.state.radar());
    let projection = state.settings.projection;
    let area = ui.available_rect_before_wrap();
    ui.painter().rect_filled(area, 0.0, ui.visuals().panel_fill);
    let is_bare = !input.is_veiled();
    let bar = (!kind.is_above() && is_bare && is_wide(area)).then(|| scale::bar(&input));
    // Reserved in every map, also where nothing is marked: frames beside each other stay aligned.
    let above = if state.settings.show_kinds { legend::reserved(area.height()) } else { 0.0 };
    let rect = rect_of(area, projection, above);
    let response = ui.interact(rect, ui.scope_id().with(("map", kind)), Sense::click_and_drag());
    let label = format!("{} map", kind.title());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    describe(ui, &input, response.id);
    let frame = Frame::of(rect, *view, radar, projection, centre_x_metres(kind, radar));
    let holds = is_bare && hand::work(ui, kind, state.scene(), frame, &response, memory, &mut asked);
    let is_free = state.editor.selection().is_empty();
    navigate(ui, rect, &response, view, !holds, is_free);
    if response.has_focus() && !is_free {
        asked.extend(nudge(ui.ctx(), radar.range_resolution_metres()));
    }
    let frame = Frame { view: *view, ..frame };
    point(&input, frame, &response, &mut asked);
    let painter = ui.painter().with_clip_rect(area);
    let inner = ui.painter().with_clip_rect(rect.intersect(area));
    let is_drawn = picture(ui, &inner, frame, &input, &mut asked);
    if state.shows_axes() {
        let free = bar.as_ref().map_or(0.0, |bar| bar.overhang(&painter, rect.width()));
        draw_axes(ui, &painter, frame, state.settings.directions, (free, line_of(&input).is_some()));
    }
    if is_bare {
        draw_legend(ui, &painter, &input, area, rect);
    }
    draw_over([&painter, &inner], frame, &input, response.hover_pos(), is_drawn);
    if let Some(bar) = bar {
        bar.draw(ui, &painter, rect);
    }
    response.context_menu(|ui| menu(ui, state, kind, &mut asked));
    if is_bare {
        plot::projection_button(ui, rect, kind, projection, &mut asked);
    }
    asked
}

fn menu(ui: &mut Ui, state: &State, kind: MapKind, asked: &mut Vec<Command>) {
    ui.menu_button("Overlays", |ui| {
        ViewCommand::OVERLAYS.into_iter().for_each(|command| item(ui, state, command, asked));
    });
    let of_all = [ViewCommand::ToggleProjection, ViewCommand::ToggleUnits];
    let of_difference = [ViewCommand::ToggleAbsoluteDifference, ViewCommand::ToggleWholeDifference];
    let of_difference = of_difference.into_iter().filter(|_| kind.is_difference());
    of_all.into_iter().chain(of_difference).for_each(|command| item(ui, state, command, asked));
    ui.separator();
    for command in [
        Command::Window(WindowCommand::Maximise(Panel::Map(kind))),
        Command::View(ViewCommand::ResetMaps),
        Command::Export(ExportCommand::CopyMap(kind)),
    ] {
        entry(ui, command, true, asked);
    }
    let panel = Panel::Map(kind);
    entry_called(ui, &format!("Hide {}", panel.title()), WindowCommand::ClosePanel(panel), true, asked);
}

/// Gives screen readers one sentence: the kind of the map, and its content.
fn describe(ui: &Ui, input: &Input<'_>, id: egui::Id) {
    let seen = input.sentence.filter(|_| !input.is_veiled()).unwrap_or_default();
    let old = if input.stale { " Of the previous scene." } else { "" };
    let description = format!("{}. {seen}{old}", input.kind.describe());
    ui.ctx().accesskit_node_builder(id, |node| node.set_description(description.trim()));
}

/// Draws the legend of fills and marks around `map`, where its panel has room for one.
fn draw_legend(ui: &Ui, painter: &Painter, input: &Input<'_>, area: Rect, map: Rect) {
    if legend::reserved(area.height()) == 0.0 {
        return;
    }
    let dark = ui.visuals().dark_mode;
    let fills = match &input.told_apart {
        _ if !(input.kind.is_above() && is_wide(area)) => Vec::new(),
        Some(_) => Fill::detections(dark),
        None => Fill::mask(dark),
    };
    let width = area.width() - axes::LEFT - axes::RIGHT;
    legend::draw(ui, painter, map, &fills, input.kinds.as_ref(), width);
}

/// Draws what lies over the picture: in the panel, and within the map alone.
fn draw_over(
    [panel, inner]: [&Painter; 2],
    frame: Frame<'_>,
    input: &Input<'_>,
    pointer: Option<Pos2>,
    is_drawn: bool,
) {
    let (kind, state, is_bare) = (input.kind, input.state, !input.is_veiled());
    let is_old = input.stale && is_drawn;
    if !is_drawn && is_bare {
        // The text in the place of the map stays readable.
        return;
    }
    if let Some(told_apart) = input.told_apart.as_ref().filter(|_| is_bare) {
        told_apart.draw(inner, frame, inner.ctx().theme() == egui::Theme::Dark);
    }
    // Beneath all texts.
    if let Some(cursor) = &state.shown_cursor() {
        let cells = input.cells.as_ref();
        overlay::cursor(inner, frame, cursor, cells.filter(|_| is_bare), state.settings.units);
        if let Some(cfar) = state.settings.cfar.as_ref().filter(|_| is_bare && kind.is_above()) {
            window::draw(inner, frame, cursor, cells, cfar);
        }
    }
    if let Some(aperture) = aperture(input).filter(|_| is_bare) {
        overlay::beam(inner, frame, beam_columns(state.radar(), aperture));
    }
    let line = captions::of_map(state, kind).filter(|_| is_bare);
    let note = if is_old { Some(input.old.clone()) } else { note(state, kind).filter(|_| is_bare) };
    let said = line.map(|line| (line, CAPTION_STYLE)).or(note.map(|note| (note, NOTE_STYLE)));
    if is_bare {
        overlay::marks(inner, frame, input.objects, pointer);
        overlay::found(inner, frame, input.found, input.stale);
        overlay::selected(inner, frame, state.scene(), state.editor.selection());
        if let Some(theory) = &input.theory {
            theory.draw(inner, frame);
        }
        if let Some(places) = Places::of(state, kind) {
            answer::draw(inner, frame, &places);
        }
        if let Some(kinds) = input.kinds.as_ref().filter(|_| is_drawn) {
            kinds.draw(inner, frame, pointer, if is_old { 24.0 } else { 0.0 });
        }
        // Maps above a threshold leave the numbers out: the map under the threshold shows the same ones.
        if let Some(theory) = input.theory.as_ref().filter(|_| !kind.is_above()) {
            theory.tell(inner, frame, pointer, &taken(state, frame, said.is_some()));
        }
    }
    let above = if state.settings.show_kinds { legend::reserved(panel.clip_rect().height()) } else { 0.0 };
    said.into_iter().for_each(|(line, look)| say([panel, inner], frame, above, &line, look));
}

/// Note on the noise that the map's method was trained on, where the scene has another noise. None for a recording, whose noise is unknown.
fn note(state: &State, kind: MapKind) -> Option<String> {
    let method = state.method_in(kind.slot()?).filter(|_| !state.is_recorded())?;
    method.trained_noise()?;
    let echoing = EchoSources::of(state.radar(), state.scene());
    untrained_noise(method.as_ref(), state.radar(), &echoing, state.settings.floor).map(|told| with_minuses(&told))
}

/// Places that text must not cover: blobs of the scene's reflectors, and the text at the foot of the map.
fn taken(state: &State, frame: Frame<'_>, has_foot: bool) -> Vec<Pos2> {
    let reflectors = state.scene().objects.iter().flat_map(Object::marks).take(overlay::MAX_MARKED_REFLECTORS);
    let foot = has_foot.then(|| frame.rect.left_bottom() + vec2(12.0, -12.0));
    reflectors.map(|reflector| frame.blob(&reflector)).chain(foot).collect()
}

/// Background and size of the text of a caption, points.
const CAPTION_STYLE: (Color32, f32) = (CAPTION, 14.0);

/// The same of a note on the map.
const NOTE_STYLE: (Color32, f32) = (Color32::from_black_alpha(170), 12.0);

/// Largest part of a map's height that a text at its foot may cover.
const MAX_TEXT_PART: f32 = 0.3;

/// Writes a caption or a note. It stands above a Cartesian map and its legend, whose rows are `above` points high, where the panel has room there. Else it stands
/// at the foot of the map, left of the button in the corner; it is left out where it would cover much of the map.
fn say([panel, inner]: [&Painter; 2], frame: Frame<'_>, above: f32, line: &str, look: (Color32, f32)) {
    let (rect, area) = (frame.rect, panel.clip_rect());
    let font = egui::FontId::proportional(look.1);
    let layout = |room: f32| inner.layout(line.to_owned(), font.clone(), CAPTION_INK, room.max(60.0));
    let wide = layout(area.width() - 28.0);
    let top = rect.top() - above - 6.0 - wide.size().y;
    if frame.projection == Projection::Cartesian && top >= area.top() + 3.0 {
        let left = rect.left().min(area.right() - 14.0 - wide.size().x);
        return patch(panel, pos2(left, top), wide, look.0);
    }
    let galley = layout(rect.width() - 56.0);
    if galley.size().y <= MAX_TEXT_PART * rect.height() {
        patch(inner, rect.left_bottom() + vec2(8.0, -8.0 - galley.size().y), galley, look.0);
    }
}

fn patch(painter: &Painter, at: Pos2, galley: Arc<Galley>, ground: Color32) {
    painter.rect_filled(Rect::from_min_size(at, galley.size()).expand2(vec2(6.0, 3.0)), 4.0, ground);
    painter.galley(at, galley, CAPTION_INK);
}

/// Draws the picture, or the reason why there is none. Returns whether there is one.
fn picture(ui: &mut Ui, inner: &Painter, frame: Frame<'_>, input: &Input<'_>, asked: &mut Vec<Command>) -> bool {
    let (rect, view) = (frame.rect, frame.view);
    let texture = input.texture.filter(|_| !input.is_veiled());
    match texture {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(view.low.x, view.high.y), pos2(view.high.x, view.low.y));
            let tint = if input.stale { Color32::from_gray(120) } else { Color32::WHITE };
            inner.rect_filled(rect, 0.0, Inks::of(ui.visuals()).beyond);
            if let Some(map) = line_of(input) {
                overlay::line(inner, frame, map, ui.visuals().strong_text_color());
                return true;
            }
            if input.pictured == frame.projection {
                _ = inner.image(texture, rect, uv, tint);
            }
        }
        None if input.is_veiled() => blank::veil(inner, rect, input.awaits_click(), ui.visuals()),
        None => blank::empty(ui, inner, rect, input.error.as_ref(), asked),
    }
    texture.is_some()
}

/// Draws axes around a whole map in `rect` whose elements' middle is the array's.
pub fn draw_axes_around(ui: &Ui, rect: Rect, radar: &Radar, projection: Projection, directions: Directions) {
    let frame = Frame::of(rect, MapView::default(), radar, projection, 0.0);
    draw_axes(ui, ui.painter(), frame, directions, (0.0, false));
}

/// Reports the pointer's place. A click answers a question that asks for a place.
fn point(input: &Input<'_>, frame: Frame<'_>, response: &egui::Response, asked: &mut Vec<Command>) {
    let Some(pos) = response.hover_pos() else { return };
    let Some(cursor) = cursor_at(frame.radar, frame.projection, frame.view.at(frame.rect, pos)) else { return };
    if input.awaits_click() && response.clicked() {
        let cell = crate::lesson::Cell { bin: cursor.bin, column: cursor.column };
        asked.push(LessonCommand::Predict(crate::lesson::Guess::Place(cell)).into());
    }
    asked.push(ViewCommand::Hover(cursor).into());
}

/// The map of one range bin, where it is drawn as a line over directions.
fn line_of<'a>(input: &'a Input<'_>) -> Option<&'a RangeAngleMap> {
    let is_flat = [input.state.settings.projection, input.pictured] == [Projection::RangeAngle; 2];
    let is_lambda = !input.kind.is_above() && input.kind != MapKind::Doubt;
    let cells = input.cells.as_ref().filter(|cells| cells.minus.is_none());
    cells.filter(|_| input.state.radar().samples == 1 && is_flat && is_lambda).map(|cells| cells.map)
}

/// The elements whose beam is drawn over a map of few of them.
fn aperture(input: &Input<'_>) -> Option<Aperture> {
    if input.state.radar().elements >= MIN_FINE_COLUMNS || input.state.settings.projection != Projection::RangeAngle {
        return None;
    }
    match input.kind {
        MapKind::Input0 => Some(Aperture::End(End::First)),
        MapKind::Input1 => Some(Aperture::End(End::Last)),
        MapKind::Target => Some(Aperture::Full),
        _ => None,
    }
}

/// Middle of a map's elements, metres along the array.
fn centre_x_metres(kind: MapKind, radar: &Radar) -> f64 {
    match kind {
        MapKind::Input0 => radar.end_centre_metres(End::First),
        MapKind::Input1 => radar.end_centre_metres(End::Last),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests;
