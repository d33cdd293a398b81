//! Mirror images of objects behind the array, which the maps show in front of it.

use super::canvas::Canvas;
use crate::interact::Place;
use crate::scene::Scene;
use eframe::egui::{self, Id, Painter, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};

/// Most objects whose mirror images are drawn.
const MAX_OBJECTS_BEHIND: usize = 100;

/// Radius of a mirror image, points.
const RADIUS: f32 = 4.5;

/// Draws the mirror images of objects behind the array. Returns a sentence on them, if there are any.
pub fn mirror(ui: &Ui, painter: &Painter, canvas: Canvas<'_>, scene: &Scene) -> Option<String> {
    let centres = scene.objects.iter().map(|object| object.centre_metres()).enumerate();
    let behind: Vec<(usize, [f64; 2])> = centres.filter(|(_, [_, y])| *y < 0.0).collect();
    let stroke = Stroke::new(1.0, canvas.inks.grid_text);
    let name = |index: usize| scene.objects[index].called(index);
    for (index, [x, y]) in behind.iter().copied().take(MAX_OBJECTS_BEHIND) {
        let (from, to) = (canvas.at(Place::new(x, y)), canvas.at(Place::new(x, -y)));
        painter.extend(Shape::dashed_line(&[from, to + vec2(0.0, RADIUS)], stroke, 2.0, 4.0));
        painter.circle_stroke(to, RADIUS, stroke);
        let place = Rect::from_center_size(to, Vec2::splat(4.0 * RADIUS));
        let response = ui.interact(place, Id::unique(("mirror image", index)), Sense::hover());
        let said = format!("{} is behind the array: the maps show it here", name(index));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &said));
        response.on_hover_text(said);
    }
    match behind.as_slice() {
        [] => None,
        [(index, _)] => Some(format!("{} is behind the array, seen mirrored at the hollow circle.", name(*index))),
        several => {
            Some(format!("{} objects are behind the array, seen mirrored at the hollow circles.", several.len()))
        }
    }
}
