//! The guess and the truth of a lesson's question about a place, drawn together on the map.

use super::frame::Frame;
use crate::app::state::{MapKind, State};
use crate::app::widgets::{MARK, axes, edged};
use crate::lesson::Cell;
use crate::theory;
use eframe::egui::{Align2, Color32, Painter, Pos2, vec2};

/// A guessed place, the true one, and their distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    pub guess: Cell,
    pub truth: Cell,
    pub distance: String,
}

impl Places {
    /// The place that was guessed in a lesson's step, and the true one, where both are of this map.
    pub fn of(state: &State, kind: MapKind) -> Option<Places> {
        let run = state.lesson.as_ref()?;
        let (guess, truth) = run.places(kind, state.radar(), state.editor.scene())?;
        let judged = run.judgement.as_ref()?.as_ref().ok()?;
        Some(Places { guess, truth, distance: judged.distance.clone() })
    }
}

const GUESS_COLOUR: Color32 = Color32::from_rgb(255, 170, 60);

const TRUTH_COLOUR: Color32 = Color32::from_rgb(120, 255, 150);

/// Distances from a place to the nearest and the farthest stroke of its mark, points: the place itself stays free.
const INNER_RADIUS_POINTS: f32 = 9.0;
const OUTER_RADIUS_POINTS: f32 = 16.0;

/// Draws the guess as a cross with an open middle, the truth as a ring, and a line between them, each with its name beside the map's blob.
pub fn draw(painter: &Painter, frame: Frame<'_>, places: &Places) {
    let [guess, truth] =
        [places.guess, places.truth].map(|Cell { bin, column }| frame.cell(theory::MapPlace { bin, column }));
    let apart = guess.distance(truth);
    if apart > 2.0 * OUTER_RADIUS_POINTS {
        let along = OUTER_RADIUS_POINTS * (truth - guess) / apart;
        edged([4.0, 1.4], MARK, |stroke| painter.line_segment([guess + along, truth - along], stroke));
    }
    edged([4.0, 2.0], GUESS_COLOUR, |stroke| {
        for towards in [vec2(1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0)] {
            let towards = towards.normalized();
            painter
                .line_segment([guess + INNER_RADIUS_POINTS * towards, guess + OUTER_RADIUS_POINTS * towards], stroke);
        }
    });
    edged([4.0, 2.0], TRUTH_COLOUR, |stroke| {
        painter.circle_stroke(truth, 0.5 * (INNER_RADIUS_POINTS + OUTER_RADIUS_POINTS), stroke)
    });
    // One name above, one below: both stay readable where the two places are close.
    let guess_is_above = guess.y < truth.y;
    label(painter, guess, guess_is_above, "your guess");
    label(painter, truth, !guess_is_above, "truth");
    let middle = guess + (truth - guess) / 2.0;
    // The text is on the free side of the line; above the marks and their names where the line is level.
    if apart > 5.0 * OUTER_RADIUS_POINTS {
        let along = if truth.x < guess.x { guess - truth } else { truth - guess };
        let (off, align) = match along.y {
            level if level.abs() < 2.0 * OUTER_RADIUS_POINTS => {
                (vec2(0.0, -2.5 * OUTER_RADIUS_POINTS), Align2::CENTER_BOTTOM)
            }
            down if down > 0.0 => (vec2(INNER_RADIUS_POINTS, -INNER_RADIUS_POINTS), Align2::LEFT_BOTTOM),
            _ => (vec2(INNER_RADIUS_POINTS, INNER_RADIUS_POINTS), Align2::LEFT_TOP),
        };
        axes::text_on_patch(painter, middle + off, align, &places.distance);
    }
}

fn label(painter: &Painter, at: Pos2, above: bool, text: &str) {
    let (off, align) = if above { (-1.0, Align2::CENTER_BOTTOM) } else { (1.0, Align2::CENTER_TOP) };
    axes::text_on_patch(painter, at + vec2(0.0, off * (OUTER_RADIUS_POINTS + 3.0)), align, text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{MapView, Projection};
    use crate::app::widgets::seen::{self, Harness};
    use crate::radar::Radar;
    use eframe::egui::{Rect, Shape};

    #[test]
    fn marks_leave_the_blob_free() {
        let radar = Radar::default();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(700.0, 350.0));
        let frame = Frame::of(rect, MapView::default(), &radar, Projection::RangeAngle, 0.0);
        for (column, bin) in [(500.0, 250.0), (512.0, 250.0), (200.0, 250.0), (750.0, 100.0), (650.0, 400.0)] {
            let (guess, truth) = (Cell { bin, column }, Cell { bin: 266.0, column: 512.0 });
            let places = Places { guess, truth, distance: "1.2 m and 12 columns off".to_owned() };
            let drawn = Harness::builder().with_size(rect.size()).build_ui(|ui| draw(ui.painter(), frame, &places));
            let truth = frame.cell(theory::MapPlace { bin: 266.0, column: 512.0 });
            for text in seen::texts(drawn.output()) {
                assert!(text.rect.distance_to_pos(truth) > INNER_RADIUS_POINTS, "{} lies over the blob", text.text);
            }
            let rings = drawn.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
                Shape::Circle(circle) => Some(*circle),
                _ => None,
            });
            for ring in rings {
                let is_open = ring.radius > INNER_RADIUS_POINTS && ring.fill == Color32::TRANSPARENT;
                assert!(ring.center == truth && is_open, "{ring:?}");
            }
        }
    }
}
