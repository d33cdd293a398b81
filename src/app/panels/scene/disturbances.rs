//! What disturbs the scene, drawn where it stands.

use super::canvas::Canvas;
use crate::app::widgets::axes;
use crate::interact::Place;
use crate::scene::{Disturbances, Interferer, Mirror};
use eframe::egui::{Align2, Color32, Painter, Stroke, vec2};

/// Draws the wall that mirrors and the other radar.
pub fn draw(painter: &Painter, canvas: Canvas<'_>, disturbances: &Disturbances) {
    if let Some(mirror) = &disturbances.mirror {
        wall(painter, canvas, mirror);
    }
    if let Some(interferer) = &disturbances.interferer {
        radar(painter, canvas, interferer);
    }
}

/// The wall as far as the canvas reaches, hatched on the side that the radar doesn't see.
fn wall(painter: &Painter, canvas: Canvas<'_>, mirror: &Mirror) {
    let ink = canvas.inks.grid_text;
    let (sin, cos) = mirror.direction_degrees.to_radians().sin_cos();
    let foot = canvas.at(Place::new(mirror.x_metres, mirror.y_metres));
    // The y axis of the screen points down.
    let along = vec2(cos as f32, -sin as f32);
    let to_radar = canvas.at(Place::new(0.0, 0.0)) - foot;
    let across = vec2(-along.y, along.x);
    let behind = if across.dot(to_radar) > 0.0 { -across } else { across };
    let reach = canvas.rect.size().length() + (foot - canvas.rect.center()).length();
    painter.line_segment([foot - along * reach, foot + along * reach], Stroke::new(2.0, ink));
    let marks = (reach / 14.0) as i32;
    for i in -marks..=marks {
        let at = foot + along * (14.0 * i as f32);
        if canvas.rect.contains(at) {
            painter.line_segment([at, at + (behind - along) * 5.0], Stroke::new(1.0, ink));
        }
    }
}

/// The other radar, with the waves it sends.
fn radar(painter: &Painter, canvas: Canvas<'_>, interferer: &Interferer) {
    let at = canvas.at(Place::new(interferer.x_metres, interferer.y_metres));
    let ink = Color32::from_rgb(214, 72, 62);
    painter.circle_filled(at, 4.0, ink);
    for radius in [8.0, 12.0] {
        painter.circle_stroke(at, radius, Stroke::new(1.0, ink));
    }
    axes::text(painter, at + vec2(15.0, 0.0), Align2::LEFT_CENTER, "interferer", ink);
}
