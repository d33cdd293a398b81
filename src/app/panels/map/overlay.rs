//! What is drawn over a map: true and found reflectors, the pointer's place and the value there.

use super::frame::{Cells, Frame, Marks};
use crate::app::state::{Cursor, Projection};
use crate::app::widgets::axes;
use crate::app::widgets::theme::{MARK, MARK_EDGE};
use crate::interact::Place;
use crate::scene::Reflector;
use eframe::egui::{Align2, Color32, Painter, Pos2, Stroke, vec2};

/// Most reflectors that are marked.
const MARKS: usize = 4000;

/// True reflectors as rings, those the method found as crosses.
pub fn marks(painter: &Painter, frame: Frame<'_>, marks: &Marks<'_>) {
    let place = |r: &Reflector| frame.at(&Cursor::at_place(frame.radar, Place::new(r.x_metres, r.y_metres)));
    let radius = if marks.reflectors.len() > 60 { 2.5 } else { 6.0 };
    for r in marks.reflectors.iter().take(MARKS) {
        let at = place(r);
        painter.circle_stroke(at, radius, Stroke::new(2.5, MARK_EDGE));
        painter.circle_stroke(at, radius, Stroke::new(1.2, MARK));
    }
    for r in marks.found.iter().take(MARKS) {
        cross(painter, place(r), 4.0, Stroke::new(2.6, MARK_EDGE));
        cross(painter, place(r), 4.0, Stroke::new(1.3, Color32::from_rgb(120, 255, 150)));
    }
}

fn cross(painter: &Painter, at: Pos2, r: f32, stroke: Stroke) {
    painter.line_segment([at + vec2(-r, -r), at + vec2(r, r)], stroke);
    painter.line_segment([at + vec2(-r, r), at + vec2(r, -r)], stroke);
}

/// The cell under the pointer of whichever panel has it, and its value here.
pub fn cursor(painter: &Painter, frame: Frame<'_>, cursor: &Cursor, cells: Option<&Cells<'_>>) {
    let Some((bin, column)) = cursor.cell(frame.radar) else { return };
    let (rect, at, gap) = (frame.rect, frame.at(cursor), 7.0);
    for stroke in [Stroke::new(2.6, Color32::from_black_alpha(110)), Stroke::new(1.0, MARK)] {
        if frame.projection == Projection::RangeAngle {
            painter.hline(rect.left()..=at.x - gap, at.y, stroke);
            painter.hline(at.x + gap..=rect.right(), at.y, stroke);
            painter.vline(at.x, rect.top()..=at.y - gap, stroke);
            painter.vline(at.x, at.y + gap..=rect.bottom(), stroke);
        }
        painter.circle_stroke(at, gap, stroke);
    }
    if let Some(text) = cells.and_then(|cells| value_text(cells, bin, column)) {
        // Away from the pointer: in the corner where it isn't.
        let (corner, align) = if at.y < rect.top() + 40.0 && at.x > rect.center().x {
            (rect.left_top() + vec2(10.0, 8.0), Align2::LEFT_TOP)
        } else {
            (rect.right_top() + vec2(-10.0, 8.0), Align2::RIGHT_TOP)
        };
        axes::text_on_patch(painter, corner, align, &text);
    }
}

/// Value of a cell in Lambda and decibels below the peak.
fn value_text(cells: &Cells<'_>, bin: usize, column: usize) -> Option<String> {
    let lambda = *cells.map.lambda.get((bin, column))?;
    if let Some(minus) = cells.minus {
        return Some(format!("ΔΛ {:+.3}", lambda - minus.lambda.get((bin, column))?));
    }
    let decibels = cells.scale.map(|s| 20.0 * (s.peak - s.floor) * (f64::from(lambda) - 1.0));
    Some(match decibels {
        // The peak itself, and silence, are 0 dB below the peak, not -0.
        Some(db) => format!("Λ {lambda:.3}  {:6.1} dB", if db > -0.05 { 0.0 } else { db }),
        None => format!("Λ {lambda:.3}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{LambdaScale, RangeAngleMap};
    use ndarray::array;

    #[test]
    fn values_are_told_in_lambda_and_decibels_and_nothing_is_minus_zero() {
        let map = RangeAngleMap { lambda: array![[1.0f32, 0.5], [0.0, 0.25]] };
        let cells = |peak, floor| Cells { map: &map, minus: None, scale: Some(LambdaScale { peak, floor }) };
        assert_eq!(value_text(&cells(5.0, 0.0), 0, 1).unwrap(), "Λ 0.500   -50.0 dB");
        assert_eq!(value_text(&cells(5.0, 0.0), 0, 0).unwrap(), "Λ 1.000     0.0 dB");
        assert_eq!(value_text(&cells(0.0, 0.0), 1, 0).unwrap(), "Λ 0.000     0.0 dB", "silence");
        let difference = Cells { map: &map, minus: Some(&map), scale: None };
        assert_eq!(value_text(&difference, 1, 1).unwrap(), "ΔΛ +0.000");
    }
}
