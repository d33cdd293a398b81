//! Searches that start from the last answer.

use super::*;
use crate::reconstruct::{Baseline, Hybrid, Reconstructor};
use crate::scene::Scene;
use crate::signal::{Floor, simulate};
use rayon::prelude::*;
use std::sync::Arc;

/// A few points, the first of which moves by (0.01, 0.004) m a step.
fn scene(step: u32) -> Scene {
    let first = (3.0 + 0.01 * f64::from(step), 9.0 + 0.004 * f64::from(step));
    Scene::of_points([first, (-6.0, 13.0), (1.0, 16.0), (8.0, 5.0), (-2.0, 25.0), (12.0, 12.5)])
}

fn ends_of(scene: &Scene, seed: u64) -> TwoEnds {
    let radar = Radar::default();
    simulate(&radar, scene, Floor::Thesis, seed).unwrap().two_ends(&radar)
}

fn assert_found(found: &Found, scene: &Scene) {
    assert_eq!(found.atoms.len(), scene.reflector_count(), "{:?}", found.atoms);
    assert!(found.is_complete);
    for r in scene.reflectors() {
        let distance = |a: &Atom| {
            let [x, y] = a.position_metres(0.0);
            (x - r.x_metres).hypot(y - r.y_metres)
        };
        let nearest = found.atoms.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{r:?}: {nearest:e}");
    }
}

#[test]
fn following_a_drag_gives_what_a_search_from_scratch_gives() {
    let (radar, request, settings) = (Radar::default(), Request::default(), Settings::default());
    let mut last = find(&radar, &ends_of(&scene(0), 0), &request, &settings).unwrap();
    for step in 1..5 {
        let ends = ends_of(&scene(step), u64::from(step));
        last = find_from(&last, &radar, &ends, &request, &settings).unwrap();
        assert_found(&last, &scene(step));
        let scratch = find(&radar, &ends, &request, &settings).unwrap();
        let [a, b] = [&last, &scratch].map(|f| f.reconstruction(&radar, &request).lambda);
        let worst = a.lambda.iter().zip(&b.lambda).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3, "step {step}: {worst}");
    }
}

#[test]
fn what_appears_vanishes_or_jumps_is_followed_too() {
    let (radar, request, settings) = (Radar::default(), Request::default(), Settings::default());
    let before = scene(0);
    let mut more = before.clone();
    more.objects.extend(Scene::of_points([(-10.0, 18.0)]).objects);
    let mut fewer = before.clone();
    fewer.objects.remove(2);
    let mut elsewhere = before.clone();
    elsewhere.objects[0] = Scene::of_points([(-9.0, 7.0)]).objects.remove(0);
    let other = Scene::of_points([(5.0, 20.0), (-3.0, 8.0)]);
    let last = find(&radar, &ends_of(&before, 0), &request, &settings).unwrap();
    for scene in [more, fewer, elsewhere, other] {
        let found = find_from(&last, &radar, &ends_of(&scene, 1), &request, &settings).unwrap();
        assert_found(&found, &scene);
    }
}

#[test]
fn many_threads_may_ask_one_follower() {
    let (radar, request) = (Radar::default(), Request { may_follow: true, ..Request::default() });
    let following = Hybrid::new(Arc::new(Baseline)).following().unwrap();
    let counts: Vec<usize> = (0..8u32)
        .into_par_iter()
        .map(|step| following.reconstruct(&radar, &ends_of(&scene(step), 0), &request).unwrap().reflectors.len())
        .collect();
    assert_eq!(counts, [6; 8]);
}
