//! The scene panel: the canvas, with its keys and its pointer.

mod beyond;
mod bodies;
mod canvas;
mod disturbances;
mod handles;

use super::captions::{self, Hint};
use crate::app::content::{Content, Cx};
use crate::app::state::{Command, Cursor, EditCommand, MapKind, NewObject, SceneView, State, ViewCommand};
use crate::app::widgets::{Inks, empty_text, entry, nudge, pan_keys, zoom_keys};
use crate::interact::{Editor, Grip, Place, SelectionMode, hit};
use crate::scene::{Reflector, Scene};
use canvas::{Canvas, Look};
use eframe::egui::{self, CursorIcon, Painter, PointerButton, Rect, Response, Sense, Ui, Vec2, vec2};

pub const PANEL: Content = Content { marks_age: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let (state, pipeline) = (cx.state, &cx.jobs.pipeline);
    let input = Input {
        found: pipeline.shown_found(state),
        found_stale: pipeline.is_stale(MapKind::Output),
        trails: cx.jobs.failures.search.trails(state.editor.document().id()),
        error: pipeline.maps.scene_error(),
        hint: captions::of_scene(state, pipeline),
        tells_maps: !state.is_predicting(),
    };
    show(ui, input, state)
}

/// Results that the canvas shows beside the scene.
#[derive(Default)]
pub struct Input<'a> {
    /// Reflectors that the method found, where they are drawn.
    pub found: &'a [Reflector],
    /// Whether the found reflectors are those of an earlier scene.
    pub found_stale: bool,
    /// Places through which a search moved each object, (x, y) in metres.
    pub trails: Vec<Vec<[f64; 2]>>,
    /// Reason why the scene can't be computed.
    pub error: Option<&'a str>,
    /// The task at a first start, or the result of the first drag.
    pub hint: Option<Hint>,
    /// Whether effects on the maps are drawn: shadows, glints, and objects that the maps show elsewhere. Not while a lesson asks for them.
    pub tells_maps: bool,
}

/// Opacity of marks that belong to an earlier scene.
const OLD_MARK_OPACITY: f32 = 0.35;

/// Draws the canvas. Drags and selections go straight to the editor, since commands would take effect a frame later.
pub fn show(ui: &mut Ui, mut input: Input<'_>, state: &mut State) -> Vec<Command> {
    let mut asked = Vec::new();
    let rect = ui.available_rect_before_wrap();
    input.hint.take_if(|_| rect.height() < MIN_HINT_PANEL_HEIGHT_POINTS);
    let (radar, moved) = (state.editor.radar().clone(), state.timeline.moved());
    let (cursor, has_numbers) = (state.shown_cursor(), state.shows_axes());
    let extent_metres = extent_metres(state);
    fit(extent_metres, &state.editor, &mut state.scene_view, rect, input.hint.is_some());
    // `Sense::drag` alone: a drag starts with the first pixel.
    let response = ui.interact(rect, ui.scope_id().with("scene canvas"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Scene"));
    navigate(&mut state.scene_view, ui, rect, &response);
    match moved {
        None => edit(ui, state, rect, &response, &mut asked),
        // A scene at another time than 0 can't be edited.
        Some(_) if response.drag_started_by(PointerButton::Primary) => asked.push(ViewCommand::SetTime(0.0).into()),
        Some(_) => {}
    }
    let (editor, view) = (&mut state.editor, &state.scene_view);
    let hover = response.hover_pos().map(|pos| view.to_scene(rect, pos));
    let hovered = hover.filter(|_| moved.is_none()).and_then(|place| editor.hit(place, view.metres_per_point));
    let painter = ui.painter().with_clip_rect(rect);
    let canvas = Canvas { rect, view: *view, radar: &radar, extent_metres, inks: Inks::of(ui.visuals()) };
    canvas::ground(&painter, canvas, state.settings.show_fields_of_view, has_numbers);
    let scene = moved.clone().unwrap_or_else(|| editor.scene().clone());
    objects(&painter, canvas, &scene, editor, hovered.map(|h| h.object), input.tells_maps);
    let mut of_found = painter.clone();
    of_found.set_opacity(if input.found_stale { OLD_MARK_OPACITY } else { 1.0 });
    canvas::found(&of_found, canvas, input.found);
    canvas::trails(&painter, canvas, &input.trails);
    if moved.is_none() {
        handles::show(radar.range_resolution_metres(), editor, *view, ui, rect);
    }
    if let (Some(start), Some(pos)) = (view.box_start, ui.input(|i| i.pointer.interact_pos())) {
        canvas::selection_box(&painter, canvas, start, pos);
    }
    match (hover, cursor) {
        (Some(place), _) => asked.push(ViewCommand::Hover(Cursor::at_place(&radar, place)).into()),
        (None, Some(cursor)) => canvas::cursor(&painter, canvas, &cursor),
        (None, None) => {}
    }
    if has_numbers {
        canvas::scale_bar(&painter, canvas);
    }
    if has_numbers && input.tells_maps {
        let seconds = moved.is_some().then_some(state.timeline.seconds);
        elsewhere(ui, &painter, canvas, &scene, seconds, input.hint.as_ref());
    }
    input.hint.iter().for_each(|hint| hint.draw(&painter, canvas));
    let is_empty = editor.scene().objects.is_empty() && input.found.is_empty() && input.hint.is_none();
    say(ui, &painter, rect, is_empty, input.error);
    if let Some(hit) = editor.dragged().or(hovered) {
        ui.set_cursor_icon(icon(hit.grip, editor.dragged().is_some()));
    }
    if moved.is_none() {
        context_menu(state, ui, rect, &response, &mut asked);
    }
    asked
}

/// The pointer's icon over a grip, and while it is dragged.
fn icon(grip: Grip, is_dragged: bool) -> CursorIcon {
    match grip {
        Grip::Body | Grip::Turn | Grip::Rotate if is_dragged => CursorIcon::Grabbing,
        Grip::Body | Grip::Turn | Grip::Rotate => CursorIcon::Grab,
        Grip::SpreadX | Grip::Radius => CursorIcon::ResizeHorizontal,
        Grip::NearEnd | Grip::FarEnd | Grip::Corner(_) => CursorIcon::Move,
        _ => CursorIcon::ResizeVertical,
    }
}

/// Handles keys and pointer, which edit the scene.
fn edit(ui: &Ui, state: &mut State, rect: Rect, response: &Response, asked: &mut Vec<Command>) {
    keys(state, rect, response, asked);
    let was_dragged = state.editor.dragged().is_some();
    pointer(ui, state, rect, response, asked);
    if was_dragged && state.editor.dragged().is_none() {
        state.scene_view.dropped = response.ctx.pointer_latest_pos();
    }
}

fn objects(
    painter: &Painter,
    canvas: Canvas<'_>,
    scene: &Scene,
    editor: &Editor,
    hovered: Option<usize>,
    tells_maps: bool,
) {
    disturbances::draw(painter, canvas, scene);
    let at = |place| canvas.at(place);
    if tells_maps {
        bodies::shadows(painter, &at, canvas.radar, scene, (canvas.extent_metres, canvas.inks.ends));
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let look = Look { selected: editor.selection().contains(index), hovered: hovered == Some(index) };
        canvas::object(painter, canvas, object, look);
        canvas::velocity(painter, canvas, object, look);
    }
    if tells_maps {
        bodies::glints(painter, &at, canvas.radar, scene, canvas.inks.ends);
    }
}

/// Draws the warnings for objects that the maps show elsewhere, and the note on a scene at another time than 0, which is `seconds`.
fn elsewhere(ui: &Ui, painter: &Painter, canvas: Canvas<'_>, scene: &Scene, seconds: Option<f64>, hint: Option<&Hint>) {
    let later = seconds.map(|seconds| format!("At {seconds:.2} s. Press here to go back to 0 s and edit."));
    let behind = beyond::mirror(ui, painter, canvas, scene);
    let beyond = beyond::warn(ui, painter, canvas, scene);
    let said: Vec<String> = later.into_iter().chain(behind).chain(beyond).collect();
    if !said.is_empty() {
        let below = hint.map_or(0.0, |hint| hint.patch(painter, canvas).1.bottom());
        beyond::write(ui, painter, canvas, below, &said.join("\n"));
    }
}

/// Writes the text of an empty scene, and the error of a scene that can't be computed.
fn say(ui: &Ui, painter: &Painter, rect: Rect, empty: bool, error: Option<&str>) {
    if empty {
        empty_text(ui, rect, "Empty scene: double-click to add a point");
    }
    if let Some(error) = error {
        let text = format!("Not computed: {error}");
        let ink = ui.visuals().error_fg_color;
        let galley = painter.layout(text, egui::FontId::proportional(12.0), ink, rect.width() - 24.0);
        let at = rect.left_bottom() + vec2(12.0, -8.0 - galley.size().y);
        painter.rect_filled(Rect::from_min_size(at, galley.size()).expand(4.0), 3.0, ui.visuals().extreme_bg_color);
        painter.galley(at, galley, ink);
    }
}

/// Room for the labels on each side of the half disc, points.
const LABEL_ROOM_POINTS: Vec2 = vec2(30.0, 24.0);

/// Least height of a panel with a hint, points: in a lower one the hint would cover the scene.
const MIN_HINT_PANEL_HEIGHT_POINTS: f32 = 160.0;

/// Farthest that a scene stands below the middle of its panel, so that its hint covers less of it, points.
const MAX_SHIFT_POINTS: f32 = 40.0;

/// Largest range that is drawn, metres: the radar's maximum, or for a snapshot somewhat more than the range of its echoes.
fn extent_metres(state: &State) -> f64 {
    let of_snapshot = state.editor.document().recording().and_then(|recording| recording.range_metres);
    of_snapshot.map_or(state.radar().max_range_metres(), |range| 1.25 * range)
}

/// Fits the view to the radar's ranges and to the objects nearby.
fn fit(extent: f64, editor: &Editor, view: &mut SceneView, rect: Rect, has_hint: bool) {
    let resized = view.fitted.is_some_and(|size| size != rect.size()) && editor.dragged().is_none();
    if !(view.fit || resized) || rect.width() < 40.0 || rect.height() < 40.0 {
        return;
    }
    let (mut low, mut high) = (Place::new(-extent, 0.0), Place::new(extent, extent));
    if let Some((a, b)) = editor.bounds() {
        // An object at a kilometre would make all else a dot.
        let limit = 3.0 * extent;
        low.x_metres = low.x_metres.min(a.x_metres.max(-limit));
        low.y_metres = low.y_metres.min(a.y_metres.max(-limit) - 0.03 * extent);
        high.x_metres = high.x_metres.max(b.x_metres.min(limit));
        high.y_metres = high.y_metres.max(b.y_metres.min(limit));
    }
    // Around the half disc there is room for the labels of its rings and spokes.
    let inner = rect.shrink2(LABEL_ROOM_POINTS.min(rect.size() / 4.0));
    view.show(inner, low, high);
    if has_hint {
        // What is free is above the scene.
        let free = inner.height() - ((high.y_metres - low.y_metres) / view.metres_per_point) as f32;
        view.centre.y_metres += f64::from((free / 2.0).min(MAX_SHIFT_POINTS)) * view.metres_per_point;
    }
    (view.fit, view.fitted) = (false, Some(rect.size()));
}

fn navigate(view: &mut SceneView, ui: &Ui, rect: Rect, response: &Response) {
    if let Some(pos) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = f64::from(pinch * (scroll / 200.0).exp());
        if factor != 1.0 {
            view.zoom(factor, rect, pos);
            view.fitted = None;
        }
    }
    if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary) {
        let delta = response.drag_delta();
        view.fitted = None;
        view.centre.x_metres -= f64::from(delta.x) * view.metres_per_point;
        view.centre.y_metres += f64::from(delta.y) * view.metres_per_point;
    }
}

/// Handles the keys while the canvas has the focus.
fn keys(state: &mut State, rect: Rect, response: &Response, asked: &mut Vec<Command>) {
    let (editor, view) = (&state.editor, &mut state.scene_view);
    if let Some(factor) = zoom_keys(response) {
        view.zoom(f64::from(factor), rect, rect.center());
        view.fitted = None;
    }
    if let Some(by) = pan_keys(response, editor.selection().is_empty()) {
        view.centre.x_metres += f64::from(by.x * rect.width()) * view.metres_per_point;
        view.centre.y_metres += f64::from(by.y * rect.height()) * view.metres_per_point;
        view.fitted = None;
    }
    if response.has_focus() && !editor.selection().is_empty() {
        asked.extend(nudge(&response.ctx, editor.radar().range_resolution_metres()));
    }
}

/// Handles the pointer: selects, drags, draws boxes and adds points.
fn pointer(ui: &Ui, state: &mut State, rect: Rect, response: &Response, asked: &mut Vec<Command>) {
    let (editor, view, snap) = (&mut state.editor, &mut state.scene_view, state.settings.snap);
    let (origin, now, modifiers) = ui.input(|i| (i.pointer.press_origin(), i.pointer.interact_pos(), i.modifiers));
    // A tap can come and go within one frame: then there is no drag, but still something to select.
    let tapped = ui.input(|i| i.pointer.primary_pressed() && i.pointer.primary_released() && !i.pointer.primary_down());
    let began = response.drag_started_by(PointerButton::Primary) || (tapped && response.contains_pointer());
    if began && let Some(origin) = origin.or(now) {
        ui.memory_mut(|m| m.stop_text_input());
        let place = view.to_scene(rect, origin);
        let mode = if modifiers.shift || modifiers.command { SelectionMode::Toggle } else { SelectionMode::Replace };
        match editor.hit(place, view.metres_per_point) {
            Some(hit) if tapped || mode == SelectionMode::Toggle => editor.select([hit.object], mode),
            Some(hit) => editor.begin_drag(hit, place),
            None => {
                if mode == SelectionMode::Replace {
                    editor.select([], mode);
                }
                view.box_start = (!tapped).then_some(place);
            }
        }
    }
    // Drags in a map are handled by the map's panel.
    let dragging = response.dragged_by(PointerButton::Primary) || response.drag_stopped_by(PointerButton::Primary);
    if let (Some(_), Some(now), true) = (editor.dragged(), now, dragging) {
        editor.drag_to(view.to_scene(rect, now), snap);
    }
    if response.drag_stopped_by(PointerButton::Primary) {
        editor.end_drag();
        if let (Some(start), Some(now)) = (view.box_start.take(), now) {
            let inside = hit::in_box(editor.scene(), start, view.to_scene(rect, now));
            editor.select(inside, SelectionMode::Add);
        }
    }
    let double = ui.input(|i| i.pointer.button_double_clicked(PointerButton::Primary));
    if let Some(pos) = now.filter(|_| double && response.contains_pointer()) {
        let place = view.to_scene(rect, pos);
        if editor.hit(place, view.metres_per_point).is_none() {
            let place = snap.apply(editor.radar(), place);
            asked.push(EditCommand::Add(NewObject::Point, Some(place)).into());
        }
    }
}

fn context_menu(state: &mut State, ui: &Ui, rect: Rect, response: &Response, asked: &mut Vec<Command>) {
    let (editor, view) = (&mut state.editor, state.scene_view);
    let id = ui.scope_id().with("context place");
    let clicked = ui.input(|i| i.pointer.button_clicked(PointerButton::Secondary));
    if clicked && let Some(pos) = response.hover_pos() {
        let place = view.to_scene(rect, pos);
        let hit = editor.hit(place, view.metres_per_point);
        ui.data_mut(|d| d.insert_temp(id, ([place.x_metres, place.y_metres], hit.is_some())));
        if let Some(hit) = hit.filter(|hit| !editor.selection().contains(hit.object)) {
            editor.select([hit.object], SelectionMode::Replace);
        }
    }
    let popup = egui::Popup::menu(response).id(ui.scope_id().with("scene menu")).at_pointer_fixed();
    let popup = popup.open_memory(clicked.then_some(egui::SetOpenCommand::Bool(response.hovered())));
    popup.show(|ui| {
        let clicked = ui.data(|d| d.get_temp::<([f64; 2], bool)>(id));
        let (place, on_object) = (clicked.map(|(place, _)| Place::from(place)), clicked.is_some_and(|(_, hit)| hit));
        for kind in NewObject::ALL {
            entry(ui, EditCommand::Add(kind, place), true, asked);
        }
        ui.separator();
        // On empty ground there is nothing to delete; objects selected elsewhere have their entries in the menu Edit.
        if on_object {
            for command in [EditCommand::Cut, EditCommand::Copy, EditCommand::Duplicate, EditCommand::Delete] {
                entry(ui, command, true, asked);
            }
        }
        entry(ui, EditCommand::Paste, true, asked);
        ui.separator();
        entry(ui, ViewCommand::FitScene, true, asked);
    });
}

#[cfg(test)]
mod tests;
