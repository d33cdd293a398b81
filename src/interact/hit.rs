//! The grip under the pointer, and the objects inside a box.

use super::{Grip, Place, Selection, grips};
use crate::scene::shape::from_stretch;
use crate::scene::{Object, Scene};

/// Smallest radius of a target, in points of the view.
pub const TARGET_RADIUS_POINTS: f64 = 9.0;

/// A grip under the pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    pub object: usize,
    pub grip: Grip,
    /// Place of the grip: a drag keeps the distance between pointer and grip.
    pub place: Place,
}

/// The grip under `at` in a view where one point covers `metres_per_point`.
///
/// Grips other than the body belong to selected objects only (that is when they are drawn). Among several, the nearest wins, and
/// of equally near ones the object drawn last. Anywhere on a line or in a cluster counts as its body.
pub fn test(scene: &Scene, selection: &Selection, at: Place, metres_per_point: f64) -> Option<Hit> {
    let reach = TARGET_RADIUS_POINTS * metres_per_point;
    let mut best: Option<(f64, Hit)> = None;
    for (object, o) in scene.objects.iter().enumerate() {
        for g in grips(o, metres_per_point) {
            let distance = match g.grip {
                Grip::Body => body_distance(o, at),
                _ if !selection.contains(object) => continue,
                // A small grip wins over the body it lies on.
                _ => g.place.distance_metres(at) - 0.5 * reach,
            };
            if distance <= reach && best.is_none_or(|(d, _)| distance <= d) {
                best = Some((distance, Hit { object, grip: g.grip, place: g.place }));
            }
        }
    }
    best.map(|(_, hit)| hit)
}

fn body_distance(object: &Object, at: Place) -> f64 {
    let centre = Place::from(object.centre_metres());
    match object {
        Object::Point(_) => centre.distance_metres(at),
        Object::Line(l) => from_stretch([at.x_metres, at.y_metres], [[l.x_metres, l.y_start_metres], l.end_metres()]),
        Object::Gaussian(g) => {
            let out_x = ((at.x_metres - g.x_metres).abs() - g.x_std_metres).max(0.0);
            let out_y = ((at.y_metres - g.y_metres).abs() - g.y_std_metres).max(0.0);
            // Inside the cluster its centre still counts as nearer than its rim, so that a point within can be grabbed.
            let inside = centre.distance_metres(at) / (g.x_std_metres + g.y_std_metres).max(1e-9);
            out_x.hypot(out_y) + 1e-3 * inside
        }
        Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => {
            let Some(shape) = object.body().map(|body| body.shape) else { return f64::INFINITY };
            let (_, radius) = shape.around();
            // As within a cluster: a small object that lies on a large one can be grabbed.
            shape.distance_metres([at.x_metres, at.y_metres]) + 1e-3 * centre.distance_metres(at) / radius.max(1e-9)
        }
    }
}

/// Objects whose centre lies in the box spanned by two corners.
pub fn in_box(scene: &Scene, a: Place, b: Place) -> Vec<usize> {
    let between = |v: f64, p: f64, q: f64| v >= p.min(q) && v <= p.max(q);
    let inside = |o: &Object| {
        let [x, y] = o.centre_metres();
        between(x, a.x_metres, b.x_metres) && between(y, a.y_metres, b.y_metres)
    };
    (0..scene.objects.len()).filter(|&i| inside(&scene.objects[i])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Line;

    fn scene() -> Scene {
        let mut scene = Scene::of_points([(0.0, 10.0), (3.0, 10.0)]);
        scene.objects.push(Object::Line(Line::vertical(-5.0, 5.0, 0.5, 21)));
        scene
    }

    #[test]
    fn targets_reach_at_least_eight_points() {
        let hit = |x: f64| test(&scene(), &Selection::default(), Place::new(x, 10.0), 0.1).map(|h| h.object);
        assert_eq!(hit(-0.8), Some(0), "8 points away is a hit");
        assert_eq!((hit(1.2), hit(2.9)), (None, Some(1)));
    }

    #[test]
    fn a_selected_line_shows_its_ends() {
        let end = Place::new(-5.0, 15.0);
        let body = test(&scene(), &Selection::default(), end, 0.05).unwrap();
        assert_eq!((body.object, body.grip, body.place), (2, Grip::Body, Place::new(-5.0, 10.0)));
        let grip = test(&scene(), &Selection::of([2]), end, 0.05).unwrap();
        assert_eq!((grip.object, grip.grip), (2, Grip::FarEnd));
    }

    #[test]
    fn a_slanted_line_is_hit_where_it_lies() {
        let mut scene = Scene::default();
        scene.objects.push(Object::Line(Line { direction_degrees: 0.0, ..Line::vertical(-5.0, 8.0, 0.5, 21) }));
        let hit = |x, y| test(&scene, &Selection::default(), Place::new(x, y), 0.05).is_some();
        assert!(hit(4.9, 8.0) && hit(-2.0, 8.1) && !hit(-5.0, 13.0) && !hit(6.0, 8.0));
    }

    #[test]
    fn boxes_take_centres() {
        assert_eq!(in_box(&scene(), Place::new(4.0, 11.0), Place::new(-1.0, 9.0)), [0, 1]);
        assert!(in_box(&scene(), Place::new(20.0, 20.0), Place::new(21.0, 21.0)).is_empty());
    }
}
