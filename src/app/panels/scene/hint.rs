//! One line over the scene that says what to do, and an arrow that shows it.

use super::canvas::Canvas;
use crate::app::widgets::theme::{CAPTION, CAPTION_INK};
use crate::interact::Place;
use eframe::egui::{FontId, Painter, Rect, Stroke, Vec2, vec2};

/// What to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    /// In words.
    pub text: String,
    /// From where to where something is to be dragged.
    pub way: Option<[Place; 2]>,
}

/// Where the arrow begins and ends beside what it leads from and to, points.
const APART: f32 = 12.0;

impl Hint {
    /// Draws it at the top of the scene, beneath its scale.
    pub fn draw(&self, painter: &Painter, canvas: Canvas<'_>) {
        if let Some([from, to]) = self.way {
            let (from, to) = (canvas.at(from), canvas.at(to));
            let way = to - from;
            if way.length() > 3.0 * APART {
                let along = APART * way.normalized();
                painter.arrow(from + along, way - 2.0 * along, Stroke::new(2.5, canvas.inks.selected));
            }
        }
        let room = (canvas.rect.width() - 32.0).max(60.0);
        let galley = painter.layout(self.text.clone(), FontId::proportional(15.0), CAPTION_INK, room);
        let middle = canvas.rect.center_top() + vec2(0.0, 26.0 + galley.size().y / 2.0);
        let patch = Rect::from_center_size(middle, galley.size() + Vec2::new(20.0, 10.0));
        painter.rect_filled(patch, 6.0, CAPTION);
        painter.galley(patch.min + vec2(10.0, 5.0), galley, CAPTION_INK);
    }
}
