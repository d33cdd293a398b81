//! Drawings of the scene's disturbances.

use super::canvas::Canvas;
use crate::app::widgets::axes;
use crate::interact::Place;
use crate::scene::{Interferer, Mirror, Object, Scene};
use eframe::egui::{Align2, Color32, Painter, Stroke, vec2};

/// Most reflectors whose ghosts are drawn.
const MAX_MIRRORED_REFLECTORS: usize = 400;

/// Draws the wall that mirrors, its ghosts, and the other radar.
pub fn draw(painter: &Painter, canvas: Canvas<'_>, scene: &Scene) {
    if let Some(mirror) = &scene.disturbances.mirror {
        wall(painter, canvas, mirror);
        ghosts(painter, canvas, scene, mirror);
    }
    if let Some(interferer) = &scene.disturbances.interferer {
        radar(painter, canvas, interferer);
    }
}

/// Draws the ghosts of the wall: three hollow marks for every reflector before it.
fn ghosts(painter: &Painter, canvas: Canvas<'_>, scene: &Scene, mirror: &Mirror) {
    let drawn = scene.objects.iter().filter(|object| object.reflector_count() <= MAX_MIRRORED_REFLECTORS);
    let reflectors = drawn.flat_map(Object::reflectors).take(MAX_MIRRORED_REFLECTORS);
    for ghost in reflectors.flat_map(|reflector| mirror.ghosts(canvas.radar, &reflector)) {
        let at = canvas.at(Place::new(ghost.x_metres, ghost.y_metres));
        painter.circle_stroke(at, 3.0, Stroke::new(1.0, canvas.inks.grid_text));
    }
}

/// Draws the wall as far as the canvas reaches, hatched on the side away from the radar.
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

/// Draws the other radar, with the waves it sends.
fn radar(painter: &Painter, canvas: Canvas<'_>, interferer: &Interferer) {
    let at = canvas.at(Place::new(interferer.x_metres, interferer.y_metres));
    let ink = Color32::from_rgb(214, 72, 62);
    painter.circle_filled(at, 4.0, ink);
    for radius in [8.0, 12.0] {
        painter.circle_stroke(at, radius, Stroke::new(1.0, ink));
    }
    axes::text(painter, at + vec2(15.0, 0.0), Align2::LEFT_CENTER, "interferer", ink);
}
