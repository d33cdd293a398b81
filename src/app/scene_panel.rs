//! The scene's canvas: what the pointer does in it.

use super::application::App;
use super::command::{Command, NewObject};
use super::scene_canvas;
use super::view::Cursor;
use crate::interact::{Grip, Place, SelectionMode, grips, hit};
use eframe::egui;
use eframe::egui::{CursorIcon, Id, PointerButton, Rect, Response, Sense, Ui, vec2};

/// Draws the canvas.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    fit(app, rect);
    // `Sense::drag` alone: a drag starts with the first pixel.
    let response = ui.interact(rect, ui.scope_id().with("scene canvas"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Scene"));
    navigate(app, ui, rect, &response);
    pointer(app, ui, rect, &response);
    let painter = ui.painter().with_clip_rect(rect);
    scene_canvas::ground(app, ui, &painter, rect);
    let hover = response.hover_pos().map(|pos| app.scene_view.to_scene(rect, pos));
    let hovered = hover.and_then(|place| app.editor.hit(place, app.scene_view.metres_per_point));
    let scene = app.editor.scene().clone();
    for (index, object) in scene.objects.iter().enumerate() {
        let under_pointer = hovered.is_some_and(|h| h.object == index);
        scene_canvas::object(app, ui, &painter, rect, index, object, under_pointer);
    }
    scene_canvas::found(app, ui, &painter, rect);
    label_handles(app, ui, rect);
    if let (Some(start), Some(pos)) = (app.box_start, ui.input(|i| i.pointer.interact_pos())) {
        scene_canvas::selection_box(ui, &painter, app.scene_view.to_screen(rect, start), pos);
    }
    match hover {
        Some(place) => app.next_cursor = Some(Cursor::at_place(&app.radar, place)),
        None => scene_canvas::cursor(app, ui, &painter, rect),
    }
    scene_canvas::scale_bar(ui, &painter, rect, app.scene_view);
    if scene.objects.is_empty() {
        let ink = ui.visuals().weak_text_color();
        let text = "Empty scene: double-click to add a point";
        painter.text(rect.center(), egui::Align2::CENTER_CENTER, text, egui::FontId::proportional(14.0), ink);
    }
    if let Some(error) = &app.pipeline.scene_error {
        let text = format!("Not computed: {error}");
        let ink = ui.visuals().error_fg_color;
        let galley = painter.layout(text, egui::FontId::proportional(12.0), ink, rect.width() - 24.0);
        let at = rect.left_bottom() + vec2(12.0, -8.0 - galley.size().y);
        painter.rect_filled(Rect::from_min_size(at, galley.size()).expand(4.0), 3.0, ui.visuals().extreme_bg_color);
        painter.galley(at, galley, ink);
    }
    if let Some(hit) = app.editor.dragged().or(hovered) {
        ui.set_cursor_icon(match (hit.grip, app.editor.dragged()) {
            (Grip::Body, Some(_)) => CursorIcon::Grabbing,
            (Grip::Body, None) => CursorIcon::Grab,
            (Grip::SpreadX, _) => CursorIcon::ResizeHorizontal,
            _ => CursorIcon::ResizeVertical,
        });
    }
    context_menu(app, ui, rect, &response);
}

/// Shows everything the radar can see, and whatever else the scene holds nearby.
fn fit(app: &mut App, rect: Rect) {
    let resized = app.scene_view.fitted.is_some_and(|size| size != rect.size()) && app.editor.dragged().is_none();
    if !(app.scene_view.fit || resized) || rect.width() < 40.0 || rect.height() < 40.0 {
        return;
    }
    let extent = app.radar.max_range_metres();
    let (mut low, mut high) = (Place::new(-extent, -0.08 * extent), Place::new(extent, 1.07 * extent));
    if let Some((a, b)) = app.editor.bounds() {
        // Things at a kilometre would make everything else a dot.
        let limit = 3.0 * extent;
        low.x_metres = low.x_metres.min(a.x_metres.max(-limit));
        low.y_metres = low.y_metres.min(a.y_metres.max(-limit) - 0.03 * extent);
        high.x_metres = high.x_metres.max(b.x_metres.min(limit));
        high.y_metres = high.y_metres.max(b.y_metres.min(limit));
    }
    app.scene_view.show(rect, low, high);
    (app.scene_view.fit, app.scene_view.fitted) = (false, Some(rect.size()));
}

fn navigate(app: &mut App, ui: &Ui, rect: Rect, response: &Response) {
    if let Some(pos) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = f64::from(pinch * (scroll / 200.0).exp());
        if factor != 1.0 {
            app.scene_view.zoom(factor, rect, pos);
            app.scene_view.fitted = None;
        }
    }
    if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary) {
        let delta = response.drag_delta();
        app.scene_view.fitted = None;
        app.scene_view.centre.x_metres -= f64::from(delta.x) * app.scene_view.metres_per_point;
        app.scene_view.centre.y_metres += f64::from(delta.y) * app.scene_view.metres_per_point;
    }
}

fn pointer(app: &mut App, ui: &Ui, rect: Rect, response: &Response) {
    let (origin, now, modifiers) = ui.input(|i| (i.pointer.press_origin(), i.pointer.interact_pos(), i.modifiers));
    let view = app.scene_view;
    // A tap can come and go within one frame: then there is no drag, but still something to select.
    let tapped = ui.input(|i| i.pointer.primary_pressed() && i.pointer.primary_released() && !i.pointer.primary_down());
    let began = response.drag_started_by(PointerButton::Primary) || (tapped && response.contains_pointer());
    if began && let Some(origin) = origin.or(now) {
        ui.memory_mut(|m| m.stop_text_input());
        let place = view.to_scene(rect, origin);
        let mode = if modifiers.shift || modifiers.command { SelectionMode::Toggle } else { SelectionMode::Replace };
        match app.editor.hit(place, view.metres_per_point) {
            Some(hit) if tapped || mode == SelectionMode::Toggle => app.editor.select([hit.object], mode),
            Some(hit) => app.editor.begin_drag(hit, place),
            None => {
                if mode == SelectionMode::Replace {
                    app.editor.select([], mode);
                }
                app.box_start = (!tapped).then_some(place);
            }
        }
    }
    if let (Some(_), Some(now)) = (app.editor.dragged(), now) {
        app.editor.drag_to(view.to_scene(rect, now), app.settings.snap);
    }
    if response.drag_stopped_by(PointerButton::Primary) {
        app.editor.end_drag();
        if let (Some(start), Some(now)) = (app.box_start.take(), now) {
            let inside = hit::in_box(app.editor.scene(), start, view.to_scene(rect, now));
            app.editor.select(inside, SelectionMode::Add);
        }
    }
    let double = ui.input(|i| i.pointer.button_double_clicked(PointerButton::Primary));
    if double
        && response.contains_pointer()
        && let Some(pos) = now
    {
        let place = view.to_scene(rect, pos);
        if app.editor.hit(place, view.metres_per_point).is_none() {
            let place = app.settings.snap.apply(&app.radar, place);
            app.commands.push(Command::Add(NewObject::Point, Some(place)));
        }
    }
}

/// Gives every handle a name and a place that screen readers and tests can find.
fn label_handles(app: &App, ui: &Ui, rect: Rect) {
    let view = app.scene_view;
    for (index, object) in app.editor.scene().objects.iter().enumerate() {
        let selected = app.editor.selection().contains(index);
        for g in grips(object, view.metres_per_point) {
            if g.grip != Grip::Body && !selected {
                continue;
            }
            let at = view.to_screen(rect, g.place);
            if !rect.contains(at) {
                continue;
            }
            let response = ui.interact(
                Rect::from_center_size(at, vec2(18.0, 18.0)),
                Id::unique(("handle", index, g.grip)),
                Sense::hover(),
            );
            response.widget_info(|| {
                let name = format!("{} {}: {}", object.kind(), index + 1, g.grip.describe());
                egui::WidgetInfo::selected(egui::Role::Button, true, selected, name)
            });
            if app.editor.dragged().is_none() {
                let [x, y] = object.centre_metres();
                response.on_hover_text(format!(
                    "{} {} at x {x:.2} m, y {y:.2} m\ndrag to {}",
                    object.kind(),
                    index + 1,
                    g.grip.describe()
                ));
            }
        }
    }
}

fn context_menu(app: &mut App, ui: &Ui, rect: Rect, response: &Response) {
    let id = ui.scope_id().with("context place");
    let clicked = ui.input(|i| i.pointer.button_clicked(PointerButton::Secondary));
    if clicked && let Some(pos) = response.hover_pos() {
        let place = app.scene_view.to_scene(rect, pos);
        ui.data_mut(|d| d.insert_temp(id, [place.x_metres, place.y_metres]));
        if let Some(hit) = app.editor.hit(place, app.scene_view.metres_per_point)
            && !app.editor.selection().contains(hit.object)
        {
            app.editor.select([hit.object], SelectionMode::Replace);
        }
    }
    let popup = egui::Popup::menu(response).id(ui.scope_id().with("scene menu")).at_pointer_fixed();
    let popup = popup.open_memory(clicked.then_some(egui::SetOpenCommand::Bool(response.hovered())));
    popup.show(|ui| {
        let place = ui.data(|d| d.get_temp::<[f64; 2]>(id)).map(Place::from);
        for kind in [NewObject::Point, NewObject::Line, NewObject::Cluster] {
            super::menu::entry(app, ui, Command::Add(kind, place), true);
        }
        ui.separator();
        let selected = !app.editor.selection().is_empty();
        for command in [Command::Cut, Command::Copy, Command::Duplicate, Command::Delete] {
            super::menu::entry(app, ui, command, selected);
        }
        super::menu::entry(app, ui, Command::Paste, true);
        ui.separator();
        super::menu::entry(app, ui, Command::FitScene, true);
    });
}
