//! Tests of the traces of whole searches.

use super::*;
use crate::reconstruct::attempt::{Attempt, AttemptVerdict, Proposal};
use crate::scene::{Line, Object, Scene};
use crate::signal::{Floor, simulate};

fn found_in(scene: &Scene) -> Found {
    let radar = Radar::default();
    let ends = simulate(&radar, scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
    find(&radar, &ends, &Request::default(), &Settings::default()).unwrap()
}

#[test]
fn two_points_are_found_by_their_tones_alone() {
    let found = found_in(&Scene::of_points([(4.0, 9.0), (-12.0, 15.0)]));
    let kept: Vec<&Attempt> = found.trace.iter().filter(|a| a.verdict == AttemptVerdict::Kept).collect();
    assert_eq!(kept.len(), 2, "{:?}", found.trace);
    for [x, y] in [[4.0, 9.0], [-12.0, 15.0]] {
        let near = |a: &&&Attempt| a.tried.place_metres().is_some_and(|p| (p[0] - x).hypot(p[1] - y) < 0.05);
        let attempt = kept.iter().find(near).unwrap_or_else(|| panic!("{x}, {y}: {kept:?}"));
        assert_eq!(attempt.rung, "tones");
        assert!(attempt.gain_decades > 3.0, "{attempt:?}");
    }
    assert!(found.trace.iter().all(|a| a.rung == "tones"), "no step follows one that explains all");
}

#[test]
fn a_line_is_found_by_a_later_step_than_the_tones() {
    let line = Line { direction_degrees: 70.0, ..Line::vertical(-2.0, 6.0, 0.14, 45) };
    let found = found_in(&Scene { objects: vec![Object::Line(line)], ..Scene::default() });
    let steps: Vec<&str> = found.trace.iter().map(|a| a.rung).collect();
    assert_eq!(steps[0], "tones", "{:?}", found.trace);
    let is_line =
        |a: &&Attempt| matches!(a.tried, Proposal::Line { count: 45, .. }) && a.verdict == AttemptVerdict::Kept;
    assert!(found.trace.iter().find(is_line).is_some_and(|a| a.rung != "tones"), "{:?}", found.trace);
}
