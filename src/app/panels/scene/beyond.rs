//! Objects that the maps show elsewhere: a warning for those beyond the maximum range, and mirror images of those behind the array.

use super::canvas::{Canvas, direction_label};
use crate::interact::Place;
use crate::radar::Radar;
use crate::scene::{Object, Scene, Shape as Body};
use eframe::egui::{
    self, Color32, FontId, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// Distance from the edge of the canvas to the middle of a sign there, points.
const SIGN_INSET_POINTS: f32 = 13.0;

/// Most signs; the sentence counts all.
const MAX_SIGNS: usize = 100;

/// Widths of the sentence, points: the first with which it stays in the canvas and covers no label of a direction.
const SENTENCE_WIDTHS_POINTS: [f32; 8] = [330.0, 250.0, 190.0, 150.0, 120.0, 105.0, 95.0, 85.0];

struct Beyond<'a> {
    index: usize,
    object: &'a Object,
    /// The object's farthest reflector.
    farthest: Place,
    /// Whether the whole object is beyond the maximum range.
    is_whole: bool,
}

/// Draws a sign for every object beyond the maximum range. Returns a sentence on these objects.
pub fn warn(ui: &Ui, painter: &Painter, canvas: Canvas<'_>, scene: &Scene) -> Option<String> {
    if canvas.radar.samples == 1 {
        // A snapshot has no ranges.
        return None;
    }
    let beyond = beyond(canvas.radar, scene);
    let said = sentence(canvas.radar, &beyond)?;
    let ink = ui.visuals().warn_fg_color;
    for one in beyond.iter().take(MAX_SIGNS) {
        let at = sign(painter, canvas, one, ink);
        let name = format!("{} beyond the maximum range", one.object.called(one.index));
        let place = Rect::from_center_size(at, Vec2::splat(18.0));
        let response = ui.interact(place, Id::unique(("beyond the maximum range", one.index)), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &name));
        response.on_hover_text(&said);
    }
    Some(said)
}

fn beyond<'a>(radar: &Radar, scene: &'a Scene) -> Vec<Beyond<'a>> {
    let most = radar.max_range_metres();
    let range = |place: &Place| place.x_metres.hypot(place.y_metres);
    let of = |(index, object): (usize, &'a Object)| {
        let places: Vec<Place> = match object {
            Object::Line(l) => vec![[l.x_metres, l.y_start_metres].into(), l.end_metres().into()],
            other => match other.body().map(|body| body.shape) {
                Some(Body::Wall(ends)) => ends.map(Place::from).to_vec(),
                Some(Body::Outline(corners)) => corners.into_iter().map(Place::from).collect(),
                Some(Body::Circle { .. }) | None => vec![other.centre_metres().into()],
            },
        };
        let farthest = places.iter().copied().max_by(|a, b| range(a).total_cmp(&range(b)))?;
        let is_whole = places.iter().all(|place| range(place) > most);
        (range(&farthest) > most).then_some(Beyond { index, object, farthest, is_whole })
    };
    scene.objects.iter().enumerate().filter_map(of).collect()
}

/// The sentence on these objects; `None` where there are none.
fn sentence(radar: &Radar, beyond: &[Beyond<'_>]) -> Option<String> {
    let most = radar.max_range_metres();
    Some(match beyond {
        [] => return None,
        [Beyond { index, object: object @ Object::Point(p), .. }] => {
            let (name, shown) = (object.called(*index), p.x_metres.hypot(p.y_metres).rem_euclid(most));
            format!("{name} stands beyond the maximum range of {most:.1} m: the maps show it at {shown:.1} m.")
        }
        [Beyond { index, object, is_whole, .. }] => {
            let (name, part) = (object.called(*index), if *is_whole { "it wraps" } else { "its far part wraps" });
            format!("{name} reaches beyond the maximum range of {most:.1} m: {part} around in the maps.")
        }
        several => {
            let count = several.len();
            format!("{count} objects reach beyond the maximum range of {most:.1} m: they wrap around in the maps.")
        }
    })
}

/// Draws a triangle beside the farthest reflector; where that is out of sight, at the edge of the canvas with an arrow outwards. Returns its place.
fn sign(painter: &Painter, canvas: Canvas<'_>, one: &Beyond<'_>, ink: Color32) -> Pos2 {
    let (target, inner) = (canvas.at(one.farthest), canvas.rect.shrink(SIGN_INSET_POINTS));
    let in_sight = inner.contains(target);
    let at = if in_sight { target + vec2(14.0, -10.0) } else { on_edge(inner, target) };
    let corners = vec![at + vec2(0.0, -7.5), at + vec2(7.5, 6.0), at + vec2(-7.5, 6.0)];
    painter.add(Shape::convex_polygon(corners, canvas.inks.ground, Stroke::new(1.5, ink)));
    painter.line_segment([at + vec2(0.0, -3.0), at + vec2(0.0, 1.5)], Stroke::new(1.6, ink));
    painter.circle_filled(at + vec2(0.0, 4.0), 0.9, ink);
    if !in_sight {
        let out = (target - at).normalized();
        let (tip, side) = (at + out * 12.5, vec2(-out.y, out.x) * 3.5);
        let head = vec![tip, tip - out * 4.0 + side, tip - out * 4.0 - side];
        painter.add(Shape::convex_polygon(head, ink, Stroke::NONE));
    }
    at
}

/// The point where the line from the middle of `inner` to `target` leaves `inner`.
fn on_edge(inner: Rect, target: Pos2) -> Pos2 {
    let (middle, to) = (inner.center(), target - inner.center());
    // Along an axis without a way the part is infinite.
    let part = (inner.width() / 2.0 / to.x.abs()).min(inner.height() / 2.0 / to.y.abs()).min(1.0);
    middle + to * part
}

/// Most objects whose mirror images are drawn.
const MAX_OBJECTS_BEHIND: usize = 100;

const MIRROR_RADIUS_POINTS: f32 = 4.5;

/// Draws the mirror images of objects behind the array. Returns a sentence on them, if there are any.
pub fn mirror(ui: &Ui, painter: &Painter, canvas: Canvas<'_>, scene: &Scene) -> Option<String> {
    let centres = scene.objects.iter().map(|object| object.centre_metres()).enumerate();
    let behind: Vec<(usize, [f64; 2])> = centres.filter(|(_, [_, y])| *y < 0.0).collect();
    let stroke = Stroke::new(1.0, canvas.inks.grid_text);
    let name = |index: usize| scene.objects[index].called(index);
    for (index, [x, y]) in behind.iter().copied().take(MAX_OBJECTS_BEHIND) {
        let (from, to) = (canvas.at(Place::new(x, y)), canvas.at(Place::new(x, -y)));
        painter.extend(Shape::dashed_line(&[from, to + vec2(0.0, MIRROR_RADIUS_POINTS)], stroke, 2.0, 4.0));
        painter.circle_stroke(to, MIRROR_RADIUS_POINTS, stroke);
        let place = Rect::from_center_size(to, Vec2::splat(4.0 * MIRROR_RADIUS_POINTS));
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

/// Writes the sentence in the upper left corner, below the scale and below the hint that ends at `below`, clear of the labels of directions.
pub fn write(ui: &Ui, painter: &Painter, canvas: Canvas<'_>, below: f32, said: &str) {
    let ink = ui.visuals().warn_fg_color;
    let at = pos2(canvas.rect.left() + 12.0, (canvas.rect.top() + 28.0).max(below + 8.0));
    let labels = [-60, -30, 0].map(|degrees| direction_label(painter, canvas, degrees).1);
    let laid = SENTENCE_WIDTHS_POINTS.map(|width| {
        let galley = painter.layout(said.to_owned(), FontId::proportional(12.0), ink, width);
        (Rect::from_min_size(at, galley.size()).expand(4.0), galley)
    });
    let covered = |patch: &Rect| labels.iter().filter(|label| patch.intersects(**label)).count();
    let is_cut = |patch: &Rect| patch.right() > canvas.rect.right();
    let best = laid.into_iter().min_by_key(|(patch, _)| (is_cut(patch), covered(patch)));
    let Some((patch, galley)) = best else { return };
    painter.rect_filled(patch, 3.0, ui.visuals().extreme_bg_color);
    painter.galley(at, galley, ink);
    let response = ui.interact(patch, Id::unique("beyond the maximum range"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, said));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_is_on_the_edge_that_the_object_is_beyond() {
        let inner = Rect::from_min_max(pos2(0.0, 0.0), pos2(200.0, 100.0));
        assert_eq!(on_edge(inner, pos2(100.0, -900.0)), pos2(100.0, 0.0));
        assert_eq!(on_edge(inner, pos2(900.0, 50.0)), pos2(200.0, 50.0));
        assert!((on_edge(inner, pos2(1100.0, -950.0)) - pos2(150.0, 0.0)).length() < 1e-3);
    }
}
