//! Drawings of the scene: ground, rings, spokes, array, objects, grips.

use super::bodies;
use crate::app::panels::captions::Hint;
use crate::app::state::{Cursor, SceneView};
use crate::app::widgets::{CAPTION, CAPTION_INK, Inks, axes, cross};
use crate::interact::{Grip, Place, grips};
use crate::radar::{End, Radar};
use crate::scene::{Object, Reflector};
use eframe::egui::{self, Align2, Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};
use std::f64::consts::PI;
use std::sync::Arc;

/// Most reflectors that are drawn of one object.
const MAX_DRAWN_REFLECTORS: usize = 400;

/// Width of the marks of both ends beside the middle of the array, points.
const END_MARK_WIDTH_POINTS: f32 = 22.0;

const LABEL_GAP_POINTS: f32 = 5.0;

/// Rectangle of the canvas, and the part of the scene that it shows.
#[derive(Clone, Copy)]
pub struct Canvas<'a> {
    pub rect: Rect,
    pub view: SceneView,
    pub radar: &'a Radar,
    /// Largest range that is drawn.
    pub extent_metres: f64,
    pub inks: Inks,
}

impl Canvas<'_> {
    pub fn at(&self, place: Place) -> Pos2 {
        self.view.to_screen(self.rect, place)
    }

    /// An arc around a place, between two angles in radians from the right.
    fn arc(&self, centre: Place, radius: f64, [from, to]: [f64; 2]) -> Vec<Pos2> {
        let at = |i: u32| {
            let angle = from + (to - from) * f64::from(i) / 96.0;
            self.at(Place::new(centre.x_metres + radius * angle.cos(), centre.y_metres + radius * angle.sin()))
        };
        (0..=96).map(at).collect()
    }

    /// A half circle ahead of the array.
    fn half_circle(&self, radius: f64) -> Vec<Pos2> {
        self.arc(Place::new(0.0, 0.0), radius, [0.0, PI])
    }
}

/// Draws everything that doesn't move: ground, rings, spokes, fields of view, array.
pub fn ground(painter: &Painter, canvas: Canvas<'_>, fields_of_view: bool, numbers: bool) {
    let Canvas { rect, extent_metres, mut inks, .. } = canvas;
    painter.rect_filled(rect, 0.0, inks.beyond);
    let edge = canvas.half_circle(extent_metres);
    painter.add(Shape::convex_polygon(edge.clone(), inks.ground, Stroke::NONE));
    if fields_of_view {
        for (end, colour) in End::BOTH.into_iter().zip(inks.ends) {
            field_of_view(painter, canvas, end, colour);
        }
    }
    let ink = inks.grid_text;
    if !numbers {
        inks.grid_text = Color32::TRANSPARENT;
    }
    rings(painter, Canvas { inks, ..canvas });
    painter.add(Shape::line(edge, Stroke::new(1.5, ink)));
    array(painter, Canvas { inks, ..canvas });
}

/// The label of a direction, degrees from straight ahead, and its place beyond the arc, on the side of the label that faces it.
pub fn direction_label(painter: &Painter, canvas: Canvas<'_>, degrees: i32) -> (String, Rect) {
    let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
    let end = canvas.at(Place::new(canvas.extent_metres * sin, canvas.extent_metres * cos));
    let label = format!("{degrees}°").replace('-', "−");
    let half = vec2(axes::width(painter, &label) / 2.0, 7.0);
    let out = vec2(sin as f32, -cos as f32);
    (label, Rect::from_center_size(end + out * (half + Vec2::splat(4.0)), 2.0 * half))
}

fn rings(painter: &Painter, canvas: Canvas<'_>) {
    let Canvas { rect, view, extent_metres: extent, inks, .. } = canvas;
    let thin = Stroke::new(1.0, inks.grid);
    let origin = canvas.at(Place::new(0.0, 0.0));
    let visible = f64::from(rect.width().min(2.0 * rect.height())) * view.metres_per_point;
    // From straight ahead, positive to the right.
    for degrees in [-75, -60, -45, -30, -15, 0, 15, 30, 45, 60, 75] {
        let angle = f64::from(90 - degrees) * PI / 180.0;
        let end = canvas.at(Place::new(extent * angle.cos(), extent * angle.sin()));
        let stroke = if degrees % 30 == 0 { thin } else { Stroke::new(1.0, inks.grid.gamma_multiply(0.5)) };
        painter.line_segment([origin, end], stroke);
        if degrees % 30 == 0 {
            let (label, place) = direction_label(painter, canvas, degrees);
            axes::text(painter, place.center(), Align2::CENTER_CENTER, &label, inks.grid_text);
        }
    }
    let ranges = axes::ticks(0.0, extent, (0.5 * extent * 8.0 / visible.max(1e-3)).clamp(4.0, 60.0) as f32);
    let step = ranges.windows(2).map(|w| w[1] - w[0]).next().unwrap_or(1.0);
    let last = ranges.last().copied();
    // Distance from the middle that the next label may reach: the outermost first, and none into the ends' marks.
    let mut free = f32::INFINITY;
    for range in ranges.into_iter().rev().filter(|r| *r > 0.0) {
        painter.add(Shape::line(canvas.half_circle(range), thin));
        let unit = if Some(range) == last { " m" } else { "" };
        let label = format!("{}{unit}", axes::tick_text(range, step));
        let half = axes::width(painter, &label) / 2.0;
        let off = (canvas.at(Place::new(range, 0.0)) - origin).x;
        if off + half <= free && off - half >= END_MARK_WIDTH_POINTS {
            free = off - half - LABEL_GAP_POINTS;
            for at in [origin - vec2(off, -3.0), origin + vec2(off, 3.0)] {
                axes::text(painter, at, Align2::CENTER_TOP, &label, inks.grid_text);
            }
        }
    }
}

/// Draws the field of view of one end: its unambiguous angles out to the maximum range (thesis figure 5-6).
fn field_of_view(painter: &Painter, canvas: Canvas<'_>, end: End, colour: Color32) {
    let radar = canvas.radar;
    let centre = Place::new(radar.end_centre_metres(end), 0.0);
    let half = radar.end_field_of_view_radians();
    let mut outline = canvas.arc(centre, canvas.extent_metres, [PI / 2.0 - half, PI / 2.0 + half]);
    outline.push(canvas.at(centre));
    painter.add(Shape::convex_polygon(outline.clone(), colour.gamma_multiply(0.07), Stroke::NONE));
    painter.add(Shape::closed_line(outline, Stroke::new(1.2, colour.gamma_multiply(0.7))));
}

/// Draws the array to scale on the x axis, its ends in their colours with markers that stay visible when the array is small.
fn array(painter: &Painter, canvas: Canvas<'_>) {
    let Canvas { radar, inks, .. } = canvas;
    let at = |x: f64| canvas.at(Place::new(x, 0.0));
    let half = radar.aperture_metres() / 2.0;
    painter.line_segment([at(-half), at(half)], Stroke::new(3.0, inks.array));
    for ((end, colour), name) in End::BOTH.into_iter().zip(inks.ends).zip(["0", "1"]) {
        let range = radar.end_range(end);
        let (a, b) = (radar.element_x_metres(range.start), radar.element_x_metres(range.end - 1));
        painter.line_segment([at(a), at(b)], Stroke::new(5.0, colour));
        let tip = at((a + b) / 2.0) + vec2(0.0, 3.0);
        let triangle = vec![tip, tip + vec2(-5.0, 9.0), tip + vec2(5.0, 9.0)];
        painter.add(Shape::convex_polygon(triangle, colour, Stroke::NONE));
        let (side, shift) = if end == End::First { (Align2::RIGHT_TOP, -6.0) } else { (Align2::LEFT_TOP, 6.0) };
        axes::text(painter, tip + vec2(shift, 1.0), side, name, colour);
    }
}

/// Highlighting of an object.
#[derive(Clone, Copy)]
pub struct Look {
    pub selected: bool,
    pub hovered: bool,
}

pub fn object(painter: &Painter, canvas: Canvas<'_>, object: &Object, look: Look) {
    let (Canvas { view, inks, .. }, Look { selected, hovered }) = (canvas, look);
    let colour = if selected { inks.selected } else { inks.reflector };
    let at = |p: Place| canvas.at(p);
    let centre = at(object.centre_metres().into());
    let halo = if hovered || selected { colour.gamma_multiply(0.25) } else { Color32::TRANSPARENT };
    match object {
        Object::Point(_) => {
            painter.circle_filled(centre, 9.0, halo);
            painter.circle(centre, 4.5, colour, Stroke::new(1.0, inks.ground));
        }
        Object::Line(l) => {
            let (a, b) = (at(Place::new(l.x_metres, l.y_start_metres)), at(l.end_metres().into()));
            painter.line_segment([a, b], Stroke::new(9.0, halo));
            painter.line_segment([a, b], Stroke::new(1.0, colour.gamma_multiply(0.6)));
            dots(painter, object, 1.8, colour, at);
        }
        Object::Gaussian(g) => {
            let radius =
                vec2((g.x_std_metres / view.metres_per_point) as f32, (g.y_std_metres / view.metres_per_point) as f32);
            painter.add(egui::epaint::EllipseShape {
                center: centre,
                radius: 2.0 * radius,
                fill: halo.gamma_multiply(0.4),
                stroke: Stroke::new(1.0, colour.gamma_multiply(0.6)),
                angle: 0.0,
            });
            dots(painter, object, 1.8, colour, at);
        }
        Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => {
            if let Some(body) = object.body() {
                bodies::outline(painter, &at, &body.shape, colour, halo);
            }
        }
    }
    if selected {
        let handles = grips(object, view.metres_per_point);
        let place = |grip| handles.iter().find(|g| g.grip == grip).map(|g| at(g.place));
        if let Some((end, turn)) = place(Grip::FarEnd).zip(place(Grip::Turn)) {
            painter.line_segment([end, turn], Stroke::new(1.0, colour));
        }
        if let Some(turn) = place(Grip::Rotate) {
            painter.line_segment([centre, turn], Stroke::new(1.0, colour.gamma_multiply(0.6)));
        }
        for g in handles.into_iter().filter(|g| g.grip != Grip::Body) {
            grip(painter, at(g.place), g.grip, colour, inks);
        }
    }
}

/// Draws an arrow to the place of an object a second later.
pub fn velocity(painter: &Painter, canvas: Canvas<'_>, object: &Object, look: Look) {
    if !object.is_moving() {
        return;
    }
    let ([x, y], [vx, vy]) = (object.centre_metres(), object.velocity_metres_per_second());
    let (from, to) = (canvas.at(Place::new(x, y)), canvas.at(Place::new(x + vx, y + vy)));
    let colour = if look.selected { canvas.inks.selected } else { canvas.inks.reflector };
    // A long arrow is cut, so that its head is in sight.
    let inner = canvas.rect.shrink(ARROW_INSET_POINTS);
    let part = |from: f32, way: f32, [low, high]: [f32; 2]| ((if way < 0.0 { low } else { high }) - from) / way;
    let way = to - from;
    let parts =
        [part(from.x, way.x, [inner.left(), inner.right()]), part(from.y, way.y, [inner.top(), inner.bottom()])];
    let part = parts.into_iter().filter(|part| part.is_finite()).fold(1.0, f32::min).max(0.0);
    let (stroke, tip) = (Stroke::new(1.2, colour), from + part * way);
    painter.line_segment([from, tip], stroke);
    head(painter, tip, way.normalized() * ARROW_HEAD_POINTS.min(0.5 * part * way.length()), stroke);
}

/// Draws an arrow's head as long as `along`, which leads to `tip`.
fn head(painter: &Painter, tip: Pos2, along: Vec2, stroke: Stroke) {
    for side in [0.5, -0.5] {
        painter.line_segment([tip, tip - along + side * along.rot90()], stroke);
    }
}

fn dots(painter: &Painter, object: &Object, radius: f32, colour: Color32, at: impl Fn(Place) -> Pos2) {
    let reflectors = object.reflectors();
    let step = reflectors.len().div_ceil(MAX_DRAWN_REFLECTORS).max(1);
    for r in reflectors.iter().step_by(step) {
        painter.circle_filled(at(Place::new(r.x_metres, r.y_metres)), radius, colour);
    }
}

fn grip(painter: &Painter, at: Pos2, grip: Grip, colour: Color32, inks: Inks) {
    let stroke = Stroke::new(1.5, colour);
    match grip {
        Grip::Spacing | Grip::SpreadX | Grip::SpreadY | Grip::Radius => {
            let r = 5.5;
            let diamond = vec![at + vec2(0.0, -r), at + vec2(r, 0.0), at + vec2(0.0, r), at + vec2(-r, 0.0)];
            painter.add(Shape::convex_polygon(diamond, inks.ground, stroke));
        }
        Grip::Turn | Grip::Rotate => {
            painter.circle(at, 7.0, inks.ground, stroke);
            turning_arrow(painter, at, stroke);
        }
        _ => {
            let square = Rect::from_center_size(at, vec2(8.0, 8.0));
            painter.rect(square, 1.0, inks.ground, stroke, egui::StrokeKind::Middle);
        }
    }
}

/// Most of a circle with an arrow's head at its end.
fn turning_arrow(painter: &Painter, at: Pos2, stroke: Stroke) {
    let on = |degrees: f32| at + 3.5 * vec2(degrees.to_radians().cos(), -degrees.to_radians().sin());
    painter.add(Shape::line((0..=12).map(|i| on(60.0 + 25.0 * i as f32)).collect(), stroke));
    let tip = on(60.0);
    for side in [vec2(-2.8, -1.2), vec2(-0.6, 2.8)] {
        painter.line_segment([tip, tip + side], stroke);
    }
}

pub fn found(painter: &Painter, canvas: Canvas<'_>, found: &[Reflector]) {
    let stroke = Stroke::new(1.5, canvas.inks.found);
    for r in found.iter().take(2000) {
        cross(painter, canvas.at(Place::new(r.x_metres, r.y_metres)), Vec2::splat(5.0), stroke);
    }
}

/// Draws the paths along which a search moved the objects, with a ring at each beginning and a dot at each stop.
pub fn trails(painter: &Painter, canvas: Canvas<'_>, trails: &[Vec<[f64; 2]>]) {
    let ink = canvas.inks.selected;
    for trail in trails.iter().filter(|trail| trail.len() > 1) {
        let stops: Vec<Pos2> = trail.iter().map(|place| canvas.at((*place).into())).collect();
        painter.line(stops.clone(), Stroke::new(1.2, ink.gamma_multiply(0.7)));
        painter.circle_stroke(stops[0], 5.0, Stroke::new(1.2, ink));
        stops[1..].iter().for_each(|stop| _ = painter.circle_filled(*stop, 2.2, ink));
    }
}

/// Draws the place that the pointer has in another panel.
pub fn cursor(painter: &Painter, canvas: Canvas<'_>, cursor: &Cursor) {
    let at = canvas.at(cursor.place);
    let stroke = Stroke::new(1.0, canvas.inks.selected.gamma_multiply(0.8));
    if cursor.range_metres <= canvas.extent_metres {
        painter.add(Shape::line(canvas.half_circle(cursor.range_metres), stroke));
        painter.line_segment([canvas.at(Place::new(0.0, 0.0)), at], stroke);
    }
    painter.circle_stroke(at, 6.0, stroke);
}

pub fn selection_box(painter: &Painter, canvas: Canvas<'_>, corner: Place, pointer: Pos2) {
    let colour = canvas.inks.selected;
    let rect = Rect::from_two_pos(canvas.at(corner), pointer);
    painter.rect(rect, 0.0, colour.gamma_multiply(0.12), Stroke::new(1.0, colour), egui::StrokeKind::Middle);
}

/// Draws a bar of the scale in the corner, with its length.
pub fn scale_bar(painter: &Painter, canvas: Canvas<'_>) {
    let Canvas { rect, view, inks, .. } = canvas;
    let length = round_length(100.0 * view.metres_per_point);
    let width = (length / view.metres_per_point) as f32;
    let left = pos2(rect.left() + 10.0, rect.top() + 14.0);
    painter.line_segment([left, left + vec2(width, 0.0)], Stroke::new(2.0, inks.grid_text));
    axes::text(painter, left + vec2(width + 5.0, 0.0), Align2::LEFT_CENTER, &length_text(length), inks.grid_text);
}

/// The longest of 1, 2, 5, 10, .. metres (and their parts) that is not above `at_most`.
fn round_length(at_most: f64) -> f64 {
    let decade = 10f64.powf(at_most.log10().floor());
    [10.0, 5.0, 2.0].into_iter().map(|m| m * decade).find(|v| *v <= at_most * 1.000_001).unwrap_or(decade)
}

/// Text of a round length, in the unit in which it has the fewest digits.
fn length_text(metres: f64) -> String {
    let (length, unit) = match metres {
        m if m >= 999.0 => (m / 1e3, "km"),
        m if m >= 0.99 => (m, "m"),
        m if m >= 0.0099 => (m * 1e2, "cm"),
        m => (m * 1e3, "mm"),
    };
    format!("{} {unit}", axes::tick_text(length, length))
}

/// Gap between the arrow and the places at its ends, points.
const ARROW_GAP_POINTS: f32 = 12.0;

const ARROW_HEAD_POINTS: f32 = 11.0;

/// Distance from the edge of the canvas that the head of an object's arrow keeps, points.
const ARROW_INSET_POINTS: f32 = 6.0;

impl Hint {
    /// Draws the hint at the top of the scene, beneath the scale.
    pub fn draw(&self, painter: &Painter, canvas: Canvas<'_>) {
        let way: Vec<Pos2> = self.way.iter().map(|place| canvas.at(*place)).collect();
        arrow(painter, &way, Stroke::new(2.5, canvas.inks.selected));
        let (galley, patch) = self.patch(painter, canvas);
        painter.rect_filled(patch, 6.0, CAPTION);
        painter.galley(patch.min + vec2(10.0, 5.0), galley, CAPTION_INK);
    }

    /// The laid-out text, and the rectangle beneath it.
    pub fn patch(&self, painter: &Painter, canvas: Canvas<'_>) -> (Arc<Galley>, Rect) {
        let room = (canvas.rect.width() - 32.0).max(60.0);
        let laid = |points: f32| painter.layout(self.text.clone(), FontId::proportional(points), CAPTION_INK, room);
        // A second line would cover the label of 0°.
        let one_line = [15.0, 14.0, 13.0].map(laid).into_iter().find(|galley| galley.rows.len() == 1);
        let galley = one_line.unwrap_or_else(|| laid(13.0));
        let middle = canvas.rect.center_top() + vec2(0.0, 26.0 + galley.size().y / 2.0);
        let patch = Rect::from_center_size(middle, galley.size() + vec2(20.0, 10.0));
        (galley, patch)
    }
}

/// Draws an arrow along a curve, without the parts near its ends; none where the curve is short.
fn arrow(painter: &Painter, way: &[Pos2], stroke: Stroke) {
    let (Some(first), Some(last)) = (way.first(), way.last()) else { return };
    let is_free = |at: &&Pos2| at.distance(*first) > ARROW_GAP_POINTS && at.distance(*last) > ARROW_GAP_POINTS;
    let curve: Vec<Pos2> = way.iter().filter(is_free).copied().collect();
    let [.., before, tip] = curve[..] else { return };
    head(painter, tip, ARROW_HEAD_POINTS * (tip - before).normalized(), stroke);
    painter.add(Shape::line(curve, stroke));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_has_a_round_length_at_every_zoom() {
        // As far in and out as the view goes, in steps of 1 %.
        for step in 0..1620 {
            let metres_per_point = 1e-4 * 1.01f64.powi(step);
            let length = round_length(100.0 * metres_per_point);
            let points = length / metres_per_point;
            assert!((40.0 - 1e-6..=100.001).contains(&points), "{points} points at {metres_per_point} m a point");
            let text = length_text(length);
            let digits = text.chars().find(|c| ('1'..='9').contains(c));
            assert!(matches!(digits, Some('1' | '2' | '5')), "{text}");
            assert!(text.chars().filter(|c| ('1'..='9').contains(c)).count() == 1 && text.len() < 9, "{text}");
        }
        assert_eq!([10.0, 0.5, 0.002, 2000.0].map(length_text), ["10 m", "50 cm", "2 mm", "2 km"]);
    }
}
