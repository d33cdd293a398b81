//! The grips of bodies: ends of walls, corners, radius, and a handle that turns.

use super::{Grip, GripPlace, Place};
use crate::scene::body::{MAX_SIZE_METRES, MIN_RADIUS_METRES, MIN_SIZE_METRES};
use crate::scene::shape::direction;
use crate::scene::{Block, Object, Wall};

/// The grips of a body but for the body itself. The turning grip stands `beyond_metres` away from it.
pub(super) fn grips(object: &Object, beyond_metres: f64) -> Vec<GripPlace> {
    let at = |grip, [x, y]: [f64; 2]| GripPlace { grip, place: Place::new(x, y) };
    let corners = |corners: &[[f64; 2]]| -> Vec<GripPlace> {
        corners.iter().enumerate().map(|(i, c)| at(Grip::Corner(i), *c)).collect()
    };
    let (mut all, turning) = match object {
        Object::Wall(w) => (corners(&w.ends_metres()), Some((w.angle_degrees, w.length_metres / 2.0))),
        Object::Box(b) => (corners(&b.corners_metres()), Some((b.angle_degrees, b.length_metres / 2.0))),
        Object::Post(p) => (vec![at(Grip::Radius, [p.x_metres + p.radius_metres, p.y_metres])], None),
        Object::Polygon(p) => {
            let (_, reach) = object.body().map_or(([0.0; 2], 0.0), |body| body.shape.around());
            (corners(&p.corners_metres), Some((90.0, reach)))
        }
        Object::Point(_) | Object::Line(_) | Object::Gaussian(_) => (Vec::new(), None),
    };
    if let Some((angle, reach)) = turning {
        let ([x, y], [dx, dy]) = (object.centre_metres(), direction(angle));
        let out = reach + beyond_metres;
        all.push(at(Grip::Rotate, [x + out * dx, y + out * dy]));
    }
    all
}

pub(super) fn move_grip(object: &mut Object, grip: Grip, to: Place) {
    match (object, grip) {
        (Object::Wall(w), Grip::Corner(end)) => move_end(w, end, to),
        (Object::Box(b), Grip::Corner(corner)) => move_corner(b, corner, to),
        (Object::Polygon(p), Grip::Corner(corner)) => {
            if let Some(corner) = p.corners_metres.get_mut(corner) {
                *corner = [to.x_metres, to.y_metres];
            }
        }
        (Object::Post(p), Grip::Radius) => {
            let radius = (to.x_metres - p.x_metres).hypot(to.y_metres - p.y_metres);
            p.radius_metres = radius.clamp(MIN_RADIUS_METRES, MAX_SIZE_METRES);
        }
        (Object::Wall(Wall { x_metres, y_metres, angle_degrees, .. }), Grip::Rotate)
        | (Object::Box(Block { x_metres, y_metres, angle_degrees, .. }), Grip::Rotate) => {
            if let Some(angle) = angle_to([*x_metres, *y_metres], to) {
                *angle_degrees = angle;
            }
        }
        // The side that faced ahead faces `to`.
        (polygon @ Object::Polygon(_), Grip::Rotate) => {
            if let Some(angle) = angle_to(polygon.centre_metres(), to) {
                polygon.turn(angle - 90.0);
            }
        }
        _ => {}
    }
}

/// The direction from one place to another, degrees counter-clockwise from +x; `None` where they are one.
fn angle_to(from: [f64; 2], to: Place) -> Option<f64> {
    let (dx, dy) = (to.x_metres - from[0], to.y_metres - from[1]);
    (dx != 0.0 || dy != 0.0).then(|| dy.atan2(dx).to_degrees())
}

fn move_end(wall: &mut Wall, end: usize, to: Place) {
    let ends = wall.ends_metres();
    let Some(stays) = ends.get(1 - end.min(1)) else { return };
    let Some(angle) = angle_to(*stays, to) else { return };
    let length = (to.x_metres - stays[0]).hypot(to.y_metres - stays[1]).clamp(MIN_SIZE_METRES, MAX_SIZE_METRES);
    wall.length_metres = length;
    wall.angle_degrees = if end == 0 { angle - 180.0 } else { angle };
    let [dx, dy] = direction(angle);
    (wall.x_metres, wall.y_metres) = (stays[0] + dx * length / 2.0, stays[1] + dy * length / 2.0);
}

fn move_corner(block: &mut Block, corner: usize, to: Place) {
    let corners = block.corners_metres();
    let Some(stays) = corners.get((corner + 2) % 4) else { return };
    let along = direction(block.angle_degrees);
    let (dx, dy) = (to.x_metres - stays[0], to.y_metres - stays[1]);
    let (length, width) = (dx * along[0] + dy * along[1], dy * along[0] - dx * along[1]);
    // A corner that is dragged past the opposite one doesn't turn the box inside out.
    let (ahead, left) = (matches!(corner, 1 | 2), matches!(corner, 2 | 3));
    let size = |v: f64, positive: bool| (if positive { v } else { -v }).clamp(MIN_SIZE_METRES, MAX_SIZE_METRES);
    (block.length_metres, block.width_metres) = (size(length, ahead), size(width, left));
    let half = |v: f64, positive: bool| if positive { v / 2.0 } else { -v / 2.0 };
    let (l, w) = (half(block.length_metres, ahead), half(block.width_metres, left));
    block.x_metres = stays[0] + l * along[0] - w * along[1];
    block.y_metres = stays[1] + l * along[1] + w * along[0];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Polygon, Post};

    fn is_at(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12
    }

    #[test]
    fn dragging_an_end_of_a_wall_keeps_the_other() {
        for end in [0, 1] {
            let mut wall = Object::Wall(Wall::new(1.0, 10.0, 4.0, 30.0));
            let Object::Wall(before) = wall.clone() else { panic!() };
            move_grip(&mut wall, Grip::Corner(end), Place::new(2.0, 14.0));
            let Object::Wall(after) = wall else { panic!() };
            assert!(is_at(after.ends_metres()[1 - end], before.ends_metres()[1 - end]), "{after:?}");
            assert!(is_at(after.ends_metres()[end], [2.0, 14.0]), "{after:?}");
        }
    }

    #[test]
    fn dragging_a_corner_of_a_box_keeps_the_opposite_one() {
        for corner in 0..4 {
            let mut car = Object::Box(Block::new([1.0, 10.0], [4.0, 2.0], 25.0));
            let Object::Box(before) = car.clone() else { panic!() };
            let [x, y] = before.corners_metres()[corner];
            let out = [x + 0.3 * (x - 1.0), y + 0.3 * (y - 10.0)];
            move_grip(&mut car, Grip::Corner(corner), out.into());
            let Object::Box(after) = &car else { panic!() };
            assert!(is_at(after.corners_metres()[(corner + 2) % 4], before.corners_metres()[(corner + 2) % 4]));
            assert!(is_at(after.corners_metres()[corner], out) && after.angle_degrees == 25.0, "{after:?}");
            let beyond = before.corners_metres()[(corner + 2) % 4].map(|v| v * 1.5);
            move_grip(&mut car, Grip::Corner(corner), Place::new(1.0 - beyond[0], -50.0));
            assert!(matches!(&car, Object::Box(b) if b.length_metres > 0.0 && b.width_metres > 0.0), "{car:?}");
        }
    }

    #[test]
    fn the_turning_grip_of_a_body_stays_where_it_was_taken() {
        let corners = vec![[0.0, 9.0], [2.0, 9.0], [1.0, 12.0]];
        for object in [
            Object::Wall(Wall::new(1.0, 10.0, 4.0, 0.0)),
            Object::Box(Block::new([1.0, 10.0], [4.0, 2.0], 0.0)),
            Object::Polygon(Polygon::new(corners)),
        ] {
            let mut turned = object.clone();
            let [x, y] = object.centre_metres();
            move_grip(&mut turned, Grip::Rotate, Place::new(x - 5.0, y));
            assert!(is_at(turned.centre_metres(), [x, y]), "{turned:?}");
            if let Object::Polygon(p) = &turned {
                assert!(is_at(p.corners_metres[2], [x - 2.0, y]), "what pointed ahead points left: {p:?}");
            } else {
                let grip = grips(&turned, 0.5).pop().unwrap();
                assert!(grip.grip == Grip::Rotate && is_at([grip.place.x_metres, grip.place.y_metres], [x - 2.5, y]));
            }
        }
    }

    #[test]
    fn the_radius_follows_its_grip() {
        let mut post = Object::Post(Post::new(1.0, 10.0, 0.5));
        assert_eq!(grips(&post, 0.1)[0].place, Place::new(1.5, 10.0));
        move_grip(&mut post, Grip::Radius, Place::new(3.0, 10.0));
        assert!(matches!(&post, Object::Post(p) if p.radius_metres == 2.0));
        move_grip(&mut post, Grip::Radius, Place::new(1.0, 10.0));
        assert!(matches!(&post, Object::Post(p) if p.radius_metres == MIN_RADIUS_METRES));
    }
}
