//! Turning bodies about their middles.

use super::shape::direction;
use super::{Object, Polygon};

impl Object {
    /// Whether [`Object::turn`] changes anything: a wall, a box or a polygon.
    pub fn can_turn(&self) -> bool {
        matches!(self, Object::Wall(_) | Object::Box(_) | Object::Polygon(_))
    }

    /// Turns a body about its middle, counter-clockwise; round bodies and objects made of points stay as they are.
    pub fn turn(&mut self, degrees: f64) {
        match self {
            Object::Wall(w) => w.angle_degrees += degrees,
            Object::Box(b) => b.angle_degrees += degrees,
            Object::Polygon(p) => {
                let ([cos, sin], [x, y]) = (direction(degrees), p.centre_metres());
                for corner in &mut p.corners_metres {
                    let [u, v] = [corner[0] - x, corner[1] - y];
                    *corner = [x + u * cos - v * sin, y + u * sin + v * cos];
                }
            }
            Object::Point(_) | Object::Line(_) | Object::Gaussian(_) | Object::Post(_) => {}
        }
    }

    /// Rotation since `before`, -180 to 180 degrees, counter-clockwise; 0 where [`Object::turn`] changes nothing.
    pub fn turned_degrees(&self, before: &Object) -> f64 {
        let turned = match (before, self) {
            (Object::Wall(a), Object::Wall(b)) => b.angle_degrees - a.angle_degrees,
            (Object::Box(a), Object::Box(b)) => b.angle_degrees - a.angle_degrees,
            (Object::Polygon(a), Object::Polygon(b)) => first_corner_degrees(b) - first_corner_degrees(a),
            _ => 0.0,
        };
        (turned + 180.0).rem_euclid(360.0) - 180.0
    }
}

fn first_corner_degrees(polygon: &Polygon) -> f64 {
    let [x, y] = polygon.centre_metres();
    polygon.corners_metres.first().map_or(0.0, |corner| (corner[1] - y).atan2(corner[0] - x).to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Block, Point, Post, Wall};

    #[test]
    fn a_body_that_is_turned_tells_by_how_much() {
        let corners = vec![[1.0, 8.0], [3.0, 8.0], [2.0, 9.5], [1.5, 9.0]];
        let bodies = [
            Object::Wall(Wall::new(1.0, 9.0, 4.0, 170.0)),
            Object::Box(Block::new([0.0, 9.0], [4.0, 2.0], -30.0)),
            Object::Polygon(Polygon::new(corners)),
        ];
        for before in bodies {
            for degrees in [25.0, -170.0] {
                let mut after = before.clone();
                after.turn(degrees);
                assert!((after.turned_degrees(&before) - degrees).abs() < 1e-9, "{after:?}");
                let ([x, y], [u, v]) = (before.centre_metres(), after.centre_metres());
                assert!((x - u).hypot(y - v) < 1e-12, "the middle stays");
                after.turn(-degrees);
                let off = before.body().unwrap().shape.faces().into_iter().flatten().flatten();
                let back = after.body().unwrap().shape.faces().into_iter().flatten().flatten();
                assert!(off.zip(back).all(|(a, b): (f64, f64)| (a - b).abs() < 1e-12), "{after:?}");
            }
        }
    }

    #[test]
    fn what_is_round_does_not_turn() {
        for before in [Object::Point(Point::new(1.0, 5.0)), Object::Post(Post::new(1.0, 5.0, 0.2))] {
            let mut after = before.clone();
            after.turn(40.0);
            assert!(!before.can_turn() && after == before && after.turned_degrees(&before) == 0.0);
        }
    }
}
