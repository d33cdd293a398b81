//! Drawings of bodies: outlines, the shadows behind them for each end of the array, and their glints.

use crate::interact::Place;
use crate::radar::{End, Radar};
use crate::scattering::{AntennaPlaces, EchoKind, ObjectWithOccluders, PathEcho, Scatterer};
use crate::scene::{Scene, Shape};
use eframe::egui::{Color32, Painter, Pos2, Shape as Drawn, Stroke, epaint::PathShape, vec2};
use std::f64::consts::TAU;

/// Most bodies whose shadows and glints are drawn.
const MAX_BODIES: usize = 60;

const CIRCLE_CORNERS: usize = 40;

/// Draws the outline of a body, filled.
pub fn outline(painter: &Painter, at: &dyn Fn(Place) -> Pos2, shape: &Shape, colour: Color32, halo: Color32) {
    if let Shape::Wall([a, b]) = shape {
        let ends = [at((*a).into()), at((*b).into())];
        painter.line_segment(ends, Stroke::new(10.0, halo));
        painter.line_segment(ends, Stroke::new(4.0, colour));
        return;
    }
    let corners: Vec<Pos2> = corners(shape).into_iter().map(|c| at(c.into())).collect();
    if halo != Color32::TRANSPARENT {
        painter.add(Drawn::closed_line(corners.clone(), Stroke::new(8.0, halo)));
    }
    let fill = colour.gamma_multiply(0.45);
    match shape {
        Shape::Outline(outline) => {
            for part in crate::scattering::parts::convex_parts(outline) {
                let part = part.into_iter().map(|c| at(c.into())).collect();
                painter.add(Drawn::convex_polygon(part, fill, Stroke::NONE));
            }
        }
        _ => _ = painter.add(Drawn::convex_polygon(corners.clone(), fill, Stroke::NONE)),
    }
    painter.add(Drawn::Path(PathShape::closed_line(corners, Stroke::new(1.5, colour))));
}

/// Corners of a drawn shape, (x, y) in metres.
fn corners(shape: &Shape) -> Vec<[f64; 2]> {
    match shape {
        Shape::Wall(ends) => ends.to_vec(),
        Shape::Outline(corners) => corners.clone(),
        Shape::Circle { centre_metres: [x, y], radius_metres } => (0..CIRCLE_CORNERS)
            .map(|i| {
                let (sin, cos) = (TAU * i as f64 / CIRCLE_CORNERS as f64).sin_cos();
                [x + radius_metres * cos, y + radius_metres * sin]
            })
            .collect(),
    }
}

/// Draws the shadow of every body for each end of the array, in that end's colour, out to `far_metres` from the end.
pub fn shadows(
    painter: &Painter,
    at: &dyn Fn(Place) -> Pos2,
    radar: &Radar,
    scene: &Scene,
    (far_metres, colours): (f64, [Color32; 2]),
) {
    if !scene.shadows {
        return;
    }
    for (end, colour) in End::BOTH.into_iter().zip(colours) {
        let from = [radar.end_centre_metres(end), 0.0];
        for body in scene.objects.iter().filter_map(|o| o.body()).take(MAX_BODIES) {
            if let Some(shadow) = behind(from, &body.shape, far_metres) {
                let shadow = shadow.map(|c| at(c.into())).to_vec();
                painter.add(Drawn::convex_polygon(shadow, colour.gamma_multiply(0.10), Stroke::NONE));
            }
        }
    }
}

/// The shadow of a shape for a viewer at `from`: its outermost corners on both sides, and the places behind them at `far_metres`. `None` from within.
fn behind(from: [f64; 2], shape: &Shape, far_metres: f64) -> Option<[[f64; 2]; 4]> {
    let (centre, radius) = shape.around();
    let to = [centre[0] - from[0], centre[1] - from[1]];
    let away = to[0].hypot(to[1]);
    if shape.contains(from) || away == 0.0 {
        return None;
    }
    let turned = |c: &[f64; 2]| {
        let v = [c[0] - from[0], c[1] - from[1]];
        (to[0] * v[1] - to[1] * v[0]).atan2(to[0] * v[0] + to[1] * v[1])
    };
    let corners = corners(shape);
    let left = corners.iter().max_by(|a, b| turned(a).total_cmp(&turned(b)))?;
    let right = corners.iter().min_by(|a, b| turned(a).total_cmp(&turned(b)))?;
    let far = far_metres.max(away + 2.0 * radius);
    let beyond = |c: &[f64; 2]| {
        let v = [c[0] - from[0], c[1] - from[1]];
        let scale = far / v[0].hypot(v[1]).max(1e-9);
        [from[0] + v[0] * scale, from[1] + v[1] * scale]
    };
    Some([*left, *right, beyond(right), beyond(left)])
}

/// Draws the glints of bodies for each end of the array, in that end's colour; paler where something stands before them.
pub fn glints(painter: &Painter, at: &dyn Fn(Place) -> Pos2, radar: &Radar, scene: &Scene, colours: [Color32; 2]) {
    let bodies = scene.objects.iter().filter(|o| o.body().is_some()).count();
    if bodies == 0 || bodies > MAX_BODIES {
        return;
    }
    let seen = ObjectWithOccluders::all(radar, scene);
    for (end, colour) in End::BOTH.into_iter().zip(colours) {
        for (place, part) in shining(radar, &seen, end) {
            let at = at(place);
            let stroke = Stroke::new(1.6, colour.gamma_multiply((part as f32).clamp(0.15, 1.0)));
            for way in [vec2(6.0, 0.0), vec2(0.0, 6.0), vec2(3.5, 3.5), vec2(3.5, -3.5)] {
                painter.line_segment([at - way, at + way], stroke);
            }
        }
    }
}

/// Places of the glints, posts and double bounces for the middle of `end`, each with the part of the amplitude that nothing hides.
pub fn shining(radar: &Radar, seen: &[ObjectWithOccluders], end: End) -> Vec<(Place, f64)> {
    let antennas = AntennaPlaces::at([radar.end_centre_metres(end), 0.0]);
    let shines = |echo: &PathEcho| matches!(echo.kind, EchoKind::Glint | EchoKind::Post | EchoKind::DoubleBounce);
    let mut places = Vec::new();
    for one in seen.iter().filter(|one| one.object.body().is_some()) {
        let [mut free, mut heard] = [Vec::new(), Vec::new()];
        Scatterer::new(radar, &one.object, &[]).echoes(&antennas, &mut free);
        one.scatterer(radar).echoes(&antennas, &mut heard);
        for (free, heard) in free.iter().zip(&heard).filter(|(free, _)| shines(free) && free.is_heard()) {
            places.push((free.place_metres.into(), heard.amplitude.norm() / free.amplitude.norm()));
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Block, Object, Post, Wall};

    fn scene(objects: Vec<Object>) -> Scene {
        Scene { objects, ..Scene::default() }
    }

    #[test]
    fn each_end_sees_a_walls_glint_at_another_place() {
        let radar = Radar::default();
        let wall = scene(vec![Object::Wall(Wall::new(0.0, 10.0, 6.0, 0.0))]);
        let [first, last] = End::BOTH.map(|end| shining(&radar, &ObjectWithOccluders::all(&radar, &wall), end));
        let ([(left, _)], [(right, _)]) = (first.as_slice(), last.as_slice()) else { panic!("{first:?}, {last:?}") };
        assert!(left.x_metres < -0.9 && right.x_metres > 0.9 && (left.y_metres - 10.0).abs() < 1e-9);
    }

    #[test]
    fn a_box_hides_a_post_from_one_end_only() {
        let radar = Radar::default();
        let objects =
            vec![Object::Post(Post::new(-3.0, 20.0, 0.3)), Object::Box(Block::new([-2.0, 8.0], [1.8, 1.8], 0.0))];
        let seen = ObjectWithOccluders::all(&radar, &scene(objects));
        let part = |end| shining(&radar, &seen, end)[0].1;
        let [first, last] = End::BOTH.map(part);
        assert!(first < 0.1 && (last - 1.0).abs() < 0.1, "{first} {last}");
    }

    #[test]
    fn a_shadow_reaches_from_the_outermost_corners() {
        let shape = Shape::Outline(Block::new([0.0, 5.0], [2.0, 2.0], 0.0).corners_metres().to_vec());
        let [left, right, beyond, _] = behind([0.0, 0.0], &shape, 40.0).unwrap();
        assert_eq!((left, right), ([-1.0, 4.0], [1.0, 4.0]));
        assert!((beyond[0] / beyond[1] - 0.25).abs() < 1e-12 && (beyond[0].hypot(beyond[1]) - 40.0).abs() < 1e-9);
        assert_eq!(behind([0.0, 5.0], &shape, 40.0), None);
    }
}
