//! How far found points lie from where they stand.

use super::failure::{Failures, Fate};
use crate::scene::{Object, Reflector, Scene};

/// The median distance, in metres, of points that are found to the nearest of the `found` reflectors; `None` where no point is found, or
/// the method names no reflectors.
pub fn median_offset_metres(scene: &Scene, failures: &Failures, found: &[Reflector]) -> Option<f64> {
    let points = scene.objects.iter().zip(&failures.objects).filter_map(|(object, fate)| match object {
        Object::Point(point) if *fate == Fate::Found => Some([point.x_metres, point.y_metres]),
        _ => None,
    });
    let nearest =
        |[x, y]: [f64; 2]| found.iter().map(|r| (r.x_metres - x).hypot(r.y_metres - y)).min_by(|a, b| a.total_cmp(b));
    let mut offsets: Vec<f64> = points.filter_map(nearest).collect();
    offsets.sort_by(f64::total_cmp);
    offsets.get(offsets.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_that_are_found_count() {
        let scene = Scene::of_points([(0.0, 10.0), (4.0, 10.0), (8.0, 10.0)]);
        let fates = vec![Fate::Found, Fate::Found, Fate::Missed];
        let failures = Failures { objects: fates, covered: vec![1.0, 1.0, 0.0], ghosts: Vec::new() };
        let reflector = |x_metres: f64| Reflector { x_metres, y_metres: 10.0, reflectivity: 1.0 };
        let offset = median_offset_metres(&scene, &failures, &[reflector(0.01), reflector(4.05)]);
        assert!(offset.is_some_and(|offset| (offset - 0.05).abs() < 1e-9), "{offset:?}");
        assert_eq!(median_offset_metres(&scene, &failures, &[]), None);
    }
}
