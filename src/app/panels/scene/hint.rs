//! One line over the scene with a task or a result, and an arrow along the path of a drag.

use super::canvas::Canvas;
use crate::app::widgets::{CAPTION, CAPTION_INK};
use crate::interact::Place;
use eframe::egui::{FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use std::sync::Arc;

/// A task, or the result of a drag.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    pub text: String,
    /// Places along which an object is to be dragged; empty without a drag.
    pub way: Vec<Place>,
}

/// Gap between the arrow and the places at its ends, points.
const ARROW_GAP_POINTS: f32 = 12.0;

/// Length of the arrow's head, points.
const HEAD: f32 = 11.0;

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
        let galley = painter.layout(self.text.clone(), FontId::proportional(15.0), CAPTION_INK, room);
        let middle = canvas.rect.center_top() + vec2(0.0, 26.0 + galley.size().y / 2.0);
        let patch = Rect::from_center_size(middle, galley.size() + Vec2::new(20.0, 10.0));
        (galley, patch)
    }
}

/// Draws an arrow along a curve, without the parts near its ends; none where the curve is short.
fn arrow(painter: &Painter, way: &[Pos2], stroke: Stroke) {
    let (Some(first), Some(last)) = (way.first(), way.last()) else { return };
    let is_free = |at: &&Pos2| at.distance(*first) > ARROW_GAP_POINTS && at.distance(*last) > ARROW_GAP_POINTS;
    let curve: Vec<Pos2> = way.iter().filter(is_free).copied().collect();
    let [.., before, tip] = curve[..] else { return };
    let along = HEAD * (tip - before).normalized();
    for side in [0.5, -0.5] {
        painter.line_segment([tip, tip - along + side * along.rot90()], stroke);
    }
    painter.add(Shape::line(curve, stroke));
}
