//! What a lesson's question about a place was answered with, and the truth: drawn together on the map.

use super::frame::Frame;
use crate::app::widgets::axes;
use crate::app::widgets::theme::{MARK, MARK_EDGE};
use crate::lesson::Cell;
use crate::theory;
use eframe::egui::{Align2, Color32, Painter, Pos2, Stroke, vec2};

/// A place that was guessed, the true one, and how far they are apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// What was clicked.
    pub guess: Cell,
    /// Where it is.
    pub truth: Cell,
    /// In metres and columns.
    pub distance: String,
}

/// The guess.
const GUESS: Color32 = Color32::from_rgb(255, 170, 60);

/// The truth.
const TRUTH: Color32 = Color32::from_rgb(120, 255, 150);

/// Arms of the guess's cross and radius of the truth's ring, points.
const SIZE: f32 = 8.0;

/// Draws the guess as a cross, the truth as a ring, and a line between them; each says what it is.
pub fn draw(painter: &Painter, frame: Frame<'_>, places: &Places) {
    let Places { guess, truth, distance } = places;
    let (guess, truth) = (*guess, *truth);
    let [guess, truth] = [guess, truth].map(|cell| frame.cell(theory::Cell { bin: cell.bin, column: cell.column }));
    for (width, colour) in [(4.0, MARK_EDGE), (1.8, MARK)] {
        painter.line_segment([guess, truth], Stroke::new(width, colour));
    }
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
    let middle = guess + (truth - guess) / 2.0;
    // Beside the line, where it is long enough not to stand over its ends.
    if guess.distance(truth) > 5.0 * SIZE {
        axes::text_on_patch(painter, middle + vec2(SIZE, 0.0), Align2::LEFT_CENTER, distance);
    }
}

fn label(painter: &Painter, at: Pos2, above: bool, text: &str) {
    let (off, align) = match above {
        true => (-SIZE - 4.0, Align2::CENTER_BOTTOM),
        false => (SIZE + 4.0, Align2::CENTER_TOP),
    };
    axes::text_on_patch(painter, at + vec2(0.0, off), align, text);
}
