//! What a lesson's question about a place was answered with, and the truth: drawn together on the map.

use super::frame::Frame;
use crate::app::widgets::axes;
use crate::app::widgets::theme::MARK_EDGE;
use crate::lesson::Cell;
use crate::theory;
use eframe::egui::{Align2, Color32, Painter, Pos2, Stroke, vec2};

/// The guess.
const GUESS: Color32 = Color32::from_rgb(255, 170, 60);

/// The truth.
const TRUTH: Color32 = Color32::from_rgb(120, 255, 150);

/// Arms of the guess's cross and radius of the truth's ring, points.
const SIZE: f32 = 8.0;

/// Draws the guess as a cross, the truth as a ring, and a line between them; each says what it is.
pub fn draw(painter: &Painter, frame: Frame<'_>, guess: Cell, truth: Cell) {
    let [guess, truth] = [guess, truth].map(|cell| frame.cell(theory::Cell { bin: cell.bin, column: cell.column }));
    painter.line_segment([guess, truth], Stroke::new(1.0, MARK_EDGE));
    for (width, edge) in [(4.0, true), (2.0, false)] {
        let colour = |own: Color32| if edge { MARK_EDGE } else { own };
        for arm in [vec2(SIZE, SIZE), vec2(SIZE, -SIZE)] {
            painter.line_segment([guess - arm, guess + arm], Stroke::new(width, colour(GUESS)));
        }
        painter.circle_stroke(truth, SIZE, Stroke::new(width, colour(TRUTH)));
    }
    // One above, one below: they stay readable where the two places are close.
    let guess_is_above = guess.y < truth.y;
    label(painter, guess, guess_is_above, "your guess");
    label(painter, truth, !guess_is_above, "truth");
}

fn label(painter: &Painter, at: Pos2, above: bool, text: &str) {
    let (off, align) = match above {
        true => (-SIZE - 4.0, Align2::CENTER_BOTTOM),
        false => (SIZE + 4.0, Align2::CENTER_TOP),
    };
    axes::text_on_patch(painter, at + vec2(0.0, off), align, text);
}
