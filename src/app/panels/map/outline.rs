//! The outline around a line of places.

use eframe::egui::{Pos2, Vec2, vec2};
use std::f32::consts::PI;

/// Points of a half circle at each end.
const HALF_CIRCLE_CORNERS: usize = 8;

/// Outline at a distance `radius` around a path, round at the ends.
pub fn outline(path: &[Pos2], radius: f32) -> Vec<Pos2> {
    let (Some(first), Some(last)) = (path.first(), path.last()) else { return Vec::new() };
    // The direction at a place is that between its neighbours, or along the screen where all of them coincide.
    let direction = |i: usize| {
        let (before, after) = (path[i.saturating_sub(1)], path[(i + 1).min(path.len() - 1)]);
        let way = (after - before).normalized();
        if way == Vec2::ZERO { vec2(1.0, 0.0) } else { way }
    };
    let aside = |i: usize, sign: f32| path[i] + sign * radius * direction(i).rot90();
    let cap = |at: Pos2, way: Vec2, sign: f32| {
        (1..HALF_CIRCLE_CORNERS).map(move |i| {
            let (sin, cos) = (PI * i as f32 / HALF_CIRCLE_CORNERS as f32).sin_cos();
            at + radius * (sign * cos * way.rot90() + sign * sin * way)
        })
    };
    let there = (0..path.len()).map(|i| aside(i, -1.0));
    let back = (0..path.len()).rev().map(|i| aside(i, 1.0));
    let (start, end) = (direction(0), direction(path.len() - 1));
    let far = cap(*last, end, 1.0).collect::<Vec<_>>().into_iter().rev();
    let near = cap(*first, start, -1.0).collect::<Vec<_>>().into_iter().rev();
    there.chain(far).chain(back).chain(near).collect()
}

/// The convex outline `radius` around places.
pub fn hull(places: &[Pos2], radius: f32) -> Vec<Pos2> {
    let corner = |at: Pos2, i: usize| at + radius * Vec2::angled(PI * i as f32 / HALF_CIRCLE_CORNERS as f32);
    let mut points: Vec<Pos2> =
        places.iter().flat_map(|at| (0..2 * HALF_CIRCLE_CORNERS).map(move |i| corner(*at, i))).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let turns_left = |a: Pos2, b: Pos2, c: Pos2| (b - a).x * (c - a).y - (b - a).y * (c - a).x > 0.0;
    let half = |points: &mut dyn Iterator<Item = Pos2>| {
        let mut chain: Vec<Pos2> = Vec::new();
        for point in points {
            while chain.len() > 1 && !turns_left(chain[chain.len() - 2], chain[chain.len() - 1], point) {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut around = half(&mut points.iter().copied());
    around.extend(half(&mut points.iter().rev().copied()));
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_goes_round_its_path_at_one_radius() {
        let path: Vec<Pos2> = (0..40).map(|i| Pos2::new(i as f32, 20.0 + 0.01 * (i * i) as f32)).collect();
        let around = outline(&path, 6.0);
        for point in &around {
            let nearest = path.iter().map(|p| p.distance(*point)).fold(f32::INFINITY, f32::min);
            assert!((nearest - 6.0).abs() < 0.3, "{nearest} at {point:?}");
        }
        let mut closed = around.iter().zip(around.iter().cycle().skip(1));
        assert!(!around.is_empty() && closed.all(|(a, b)| a.distance(*b) < 4.0), "without a jump");
        assert_eq!(outline(&[Pos2::ZERO], 6.0).len(), 2 + 2 * (HALF_CIRCLE_CORNERS - 1), "a circle");
        assert!(outline(&[], 6.0).is_empty());
    }

    #[test]
    fn a_hull_keeps_its_distance_from_every_place() {
        let places: Vec<Pos2> = (0..30).map(|i| Pos2::new((i * 13 % 37) as f32, (i * 7 % 19) as f32)).collect();
        let around = hull(&places, 8.0);
        for corner in &around {
            let nearest = places.iter().map(|p| p.distance(*corner)).fold(f32::INFINITY, f32::min);
            assert!((nearest - 8.0).abs() < 1e-3, "{nearest}");
        }
        let sides = around.iter().zip(around.iter().cycle().skip(1));
        for (a, b) in sides {
            let inside = |p: &Pos2| (*b - *a).x * (*p - *a).y - (*b - *a).y * (*p - *a).x >= -1e-3;
            assert!(places.iter().all(inside), "{a:?} to {b:?} cuts places off");
        }
        assert!(hull(&[], 8.0).is_empty());
    }
}
