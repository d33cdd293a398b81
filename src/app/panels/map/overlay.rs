//! What is drawn over a map: true and found reflectors, the pointer's place and the value there.

use super::frame::{Cells, Frame, Marks};
use crate::app::state::{Cursor, Projection};
use crate::app::widgets::axes;
use crate::app::widgets::theme::{MARK, MARK_EDGE};
use crate::scene::Reflector;
use eframe::egui::{Align2, Color32, Painter, Pos2, Stroke, vec2};

/// Most reflectors that are marked.
const MARKS: usize = 4000;

/// How near the pointer must be to a ring to be told the true direction.
const NEAR: f32 = 9.0;

/// True reflectors as rings, those the method found as crosses: where the map shows what stands there. A ring under the `pointer` tells
/// the direction in which its reflector really stands.
pub fn marks(painter: &Painter, frame: Frame<'_>, marks: &Marks<'_>, pointer: Option<Pos2>) {
    let radius = if marks.reflectors.len() > 60 { 2.5 } else { 6.0 };
    let mut nearest: Option<(&Reflector, f32)> = None;
    for r in marks.reflectors.iter().take(MARKS) {
        let at = frame.blob(r);
        painter.circle_stroke(at, radius, Stroke::new(2.5, MARK_EDGE));
        painter.circle_stroke(at, radius, Stroke::new(1.2, MARK));
        let distance = pointer.map_or(f32::INFINITY, |p| p.distance(at));
        if distance < nearest.map_or(NEAR, |(_, d)| d) {
            nearest = Some((r, distance));
        }
    }
    for r in marks.found.iter().take(MARKS) {
        cross(painter, frame.blob(r), 4.0, Stroke::new(2.6, MARK_EDGE));
        cross(painter, frame.blob(r), 4.0, Stroke::new(1.3, Color32::from_rgb(120, 255, 150)));
    }
    if let Some((reflector, _)) = nearest {
        true_direction(painter, frame, reflector);
    }
}

/// From a ring to where it would be without the beam's squint.
fn true_direction(painter: &Painter, frame: Frame<'_>, reflector: &Reflector) {
    let (from, to) = (frame.blob(reflector), frame.true_direction(reflector));
    for (width, colour) in [(3.0, MARK_EDGE), (1.4, MARK)] {
        painter.line_segment([from, to], Stroke::new(width, colour));
        painter.circle_filled(to, 1.0 + width, colour);
    }
    let text = direction_text(frame, reflector);
    axes::text_on_patch(painter, frame.rect.left_top() + vec2(10.0, 8.0), Align2::LEFT_TOP, &text);
}

fn direction_text(frame: Frame<'_>, reflector: &Reflector) -> String {
    let seen = frame.radar.polar_of(reflector.x_metres - frame.centre_x_metres, reflector.y_metres);
    let blob = frame.radar.blob_of(frame.centre_x_metres, reflector.x_metres, reflector.y_metres);
    format!("stands at cos θ {:+.3}, seen at {:+.3}", seen.cos_theta, blob.cos_theta)
}

fn cross(painter: &Painter, at: Pos2, r: f32, stroke: Stroke) {
    painter.line_segment([at + vec2(-r, -r), at + vec2(r, r)], stroke);
    painter.line_segment([at + vec2(-r, r), at + vec2(r, -r)], stroke);
}

/// The cell under the pointer of whichever panel has it, and its value here.
pub fn cursor(painter: &Painter, frame: Frame<'_>, cursor: &Cursor, cells: Option<&Cells<'_>>) {
    let Some((bin, column)) = cursor.cell(frame.radar) else { return };
    let (rect, at, gap) = (frame.rect, frame.cursor(cursor), 7.0);
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
