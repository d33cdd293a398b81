//! The handles of objects: names, tooltips, and keys that drag them.

use crate::app::state::SceneView;
use crate::app::widgets::focused_steps;
use crate::interact::{Editor, Grip, Place, Snap, grips, hit};
use crate::scene::Object;
use eframe::egui::{self, Id, Rect, RectAlign, Response, Sense, Ui, vec2};

/// Gives every handle a name and a place that screen readers and tests can find. The grips of selected objects take the focus: arrow keys
/// then drag them by a range bin of `bin_metres`, with Shift by ten, with Alt by a tenth.
pub fn show(bin_metres: f64, editor: &mut Editor, view: SceneView, ui: &Ui, rect: Rect) {
    let mut moved = None;
    for (index, object) in editor.scene().objects.iter().enumerate() {
        let selected = editor.selection().contains(index);
        for g in grips(object, view.metres_per_point) {
            if g.grip != Grip::Body && !selected {
                continue;
            }
            let at = view.to_screen(rect, g.place);
            if !rect.contains(at) {
                continue;
            }
            // The body moves with the arrow keys wherever the focus is.
            let sense = if g.grip == Grip::Body { Sense::hover() } else { Sense::focusable_noninteractive() };
            let place = Rect::from_center_size(at, vec2(18.0, 18.0));
            let response = ui.interact(place, Id::unique(("handle", index, g.grip)), sense);
            response.widget_info(|| {
                let name = format!("{}: {}", object.called(index), g.grip.describe());
                egui::WidgetInfo::selected(egui::Role::Button, true, selected, name)
            });
            if let Some((dx, dy)) = focused_steps(&response).filter(|_| g.grip != Grip::Body) {
                let to = Place::new(g.place.x_metres + dx * bin_metres, g.place.y_metres + dy * bin_metres);
                moved = Some((hit::Hit { object: index, grip: g.grip, place: g.place }, to));
            }
            if editor.dragged().is_none() && response.hovered() && !view.was_just_dropped(ui.ctx()) {
                let [x, y] = object.centre_metres();
                let name = object.called(index);
                let text = format!("{name} at x {x:.2} m, y {y:.2} m\ndrag to {}", g.grip.describe());
                beside(&response, on_screen(object, view, rect), &text);
            }
        }
    }
    if let Some((hit, to)) = moved.filter(|_| editor.dragged().is_none()) {
        editor.begin_drag(hit, hit.place);
        editor.drag_to(to, Snap::Off);
        editor.end_drag();
    }
}

/// Rectangle of an object on the canvas.
fn on_screen(object: &Object, view: SceneView, rect: Rect) -> Rect {
    let places = match object.body() {
        Some(body) => {
            let (low, high) = body.shape.extent();
            vec![low.into(), high.into()]
        }
        None => object.reflectors().iter().map(|r| Place::new(r.x_metres, r.y_metres)).collect(),
    };
    let places = places.into_iter().map(|place: Place| view.to_screen(rect, place));
    Rect::from_points(&places.collect::<Vec<_>>()).expand(8.0).intersect(rect)
}

/// A tooltip beside an object, never over it.
fn beside(response: &Response, object: Rect, text: &str) {
    let mut tooltip = egui::Tooltip::for_enabled(response);
    tooltip.popup = tooltip.popup.anchor(object).align(RectAlign::RIGHT).align_alternatives(&[
        RectAlign::LEFT,
        RectAlign::TOP,
        RectAlign::BOTTOM,
    ]);
    tooltip.gap(6.0).show(|ui| ui.label(text));
}
