//! Marks that are readable over any picture.

use super::theme::MARK_EDGE;
use eframe::egui::{Color32, Painter, Pos2, Stroke, Vec2, vec2};

/// Draws twice: in a wide dark stroke, and over it in `colour`. `widths` are those of both strokes, points.
pub fn edged<T>(widths: [f32; 2], colour: Color32, mut draw: impl FnMut(Stroke) -> T) {
    for (width, colour) in widths.into_iter().zip([MARK_EDGE, colour]) {
        draw(Stroke::new(width, colour));
    }
}

/// Draws both diagonals of a box around a place; `half` is half its size, points.
pub fn cross(painter: &Painter, at: Pos2, half: Vec2, stroke: Stroke) {
    for half in [half, vec2(half.x, -half.y)] {
        painter.line_segment([at - half, at + half], stroke);
    }
}
