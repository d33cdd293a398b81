//! The paths along which a search moved the objects.

use super::canvas::Canvas;
use eframe::egui::{Painter, Pos2, Stroke};

/// Draws a line from place to place of every object, with a ring at its beginning and a dot at each stop.
pub fn draw(painter: &Painter, canvas: Canvas<'_>, trails: &[Vec<[f64; 2]>]) {
    let ink = canvas.inks.selected;
    for trail in trails.iter().filter(|trail| trail.len() > 1) {
        let stops: Vec<Pos2> = trail.iter().map(|place| canvas.at((*place).into())).collect();
        for pair in stops.windows(2) {
            painter.line_segment([pair[0], pair[1]], Stroke::new(1.2, ink.gamma_multiply(0.7)));
        }
        painter.circle_stroke(stops[0], 5.0, Stroke::new(1.2, ink));
        for stop in &stops[1..] {
            painter.circle_filled(*stop, 2.2, ink);
        }
    }
}
