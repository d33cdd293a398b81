//! The map, the control and the part of the map that a lesson's step is about.

use super::panel::{MapKind, Panel};
use super::view::MapView;
use crate::lesson::challenge::Measure;
use crate::lesson::question::Answer;
use crate::lesson::{Challenge, MapName, Step, StepView};
use crate::radar::Radar;
use crate::scene::{Object, Scene};
use eframe::egui::{pos2, vec2};

/// Least part shown to either side of two blobs: a ratio of all columns, and metres of range.
const MIN_SIDE_PART: f32 = 0.15;
const MIN_SIDE_RANGE_METRES: f64 = 4.0;

/// Part shown to either side of the middle of two blobs, as a multiple of their distance.
const SIDE_DISTANCE_RATIO: f32 = 2.0;

/// The map that a lesson's file names.
pub fn kind_of(map: MapName) -> MapKind {
    match map {
        MapName::Input0 => MapKind::Input0,
        MapName::Input1 => MapKind::Input1,
        MapName::Target => MapKind::Target,
        MapName::Output => MapKind::Output,
    }
}

/// The panel of the map that a step is about: the map that a question asks about or a challenge measures, else the range-Doppler map where the
/// radar sends several chirps, the output where a question's step names a method, or the target.
pub fn map_of(step: &Step) -> Panel {
    let asked = step.predict.as_ref().and_then(|question| match &question.answer {
        Answer::Click { map, .. } | Answer::Threshold { map, .. } => Some(*map),
        _ => None,
    });
    let measured = || {
        step.challenge.as_ref()?.requirements.iter().find_map(|requirement| match &requirement.measure {
            Measure::Lambda { map, .. } | Measure::Dip { map, .. } | Measure::BrightPart { map, .. } => Some(*map),
            _ => None,
        })
    };
    let named_method = step.predict.is_some() && step.view.method != StepView::default().method;
    match asked.or_else(measured) {
        Some(map) => Panel::Map(kind_of(map)),
        None if step.radar.chirps > 1 => Panel::RangeDoppler,
        None if named_method => Panel::Map(MapKind::Output),
        None => Panel::Map(MapKind::Target),
    }
}

/// The panel with the control for a step's challenge, and the index of the object to change there.
pub fn control_of(step: &Step) -> Option<(Panel, Option<usize>)> {
    let solution = &step.challenge.as_ref()?.solution;
    if let Some(radar) = solution.radar.as_ref().filter(|radar| **radar != step.radar) {
        let Radar { chirps, chirp_interval_seconds, .. } = *radar;
        let is_of_chirps = *radar == Radar { chirps, chirp_interval_seconds, ..step.radar.clone() };
        return Some((if is_of_chirps { Panel::RangeDoppler } else { Panel::Radar }, None));
    }
    let objects = step.scene().objects;
    let is_same_but_for_its_place = |(before, after): (&Object, &Object)| {
        let mut moved = before.clone();
        moved.set_anchor(after.anchor_metres());
        moved == *after
    };
    let changed = objects.iter().zip(&solution.objects).position(|pair| !is_same_but_for_its_place(pair));
    Some(changed.map_or((Panel::Scene, None), |object| (Panel::Inspector, Some(object))))
}

/// The part of the maps in which a challenge tells two objects apart, for this scene and radar; `None` where the whole map counts.
pub fn part_of(challenge: &Challenge, radar: &Radar, scene: &Scene) -> Option<MapView> {
    let (map, pair) = challenge.requirements.iter().find_map(|requirement| match &requirement.measure {
        Measure::Dip { map, objects } => Some((*map, *objects)),
        _ => None,
    })?;
    let object = |index: usize| pair[index].index(scene.objects.len()).ok().map(|index| &scene.objects[index]);
    let at = |object: &Object| {
        let [x_metres, y_metres] = object.centre_metres();
        let blob = radar.blob_of(0.0, x_metres, y_metres);
        let bin = radar.bin_of_range(blob.range_metres).rem_euclid(radar.samples as f64);
        let across = radar.across_of_column(radar.column_of_cos(blob.cos_theta));
        pos2(across as f32, ((bin + 0.5) / radar.samples as f64) as f32)
    };
    let (a, b) = (at(object(0)?), at(object(1)?));
    let apart = SIDE_DISTANCE_RATIO * (a - b).abs();
    let least_range = (MIN_SIDE_RANGE_METRES / radar.max_range_metres()) as f32;
    // An end's beam is as wide as part of the map, so all directions stay in sight.
    let across = if matches!(map, MapName::Target | MapName::Output) { apart.x.max(MIN_SIDE_PART) } else { 1.0 };
    Some(MapView::around((a + b.to_vec2()) / 2.0, vec2(across, apart.y.max(least_range))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::shipped;

    fn last_step(id: &str) -> Step {
        let lesson = shipped::ALL.iter().find(|file| file.id == id).unwrap().load().unwrap();
        lesson.steps.last().unwrap().clone()
    }

    #[test]
    fn a_challenge_brings_the_control_that_its_solution_changes() {
        for (id, panel) in [
            ("range-and-bandwidth", (Panel::Radar, None)),
            ("range-and-velocity", (Panel::RangeDoppler, None)),
            ("folding-and-wrapping", (Panel::Scene, None)),
            ("smooth-and-rough", (Panel::Inspector, Some(0))),
            ("the-floor", (Panel::Inspector, Some(1))),
        ] {
            assert_eq!(control_of(&last_step(id)), Some(panel), "{id}");
        }
    }

    #[test]
    fn the_large_map_is_the_one_that_a_step_is_about() {
        let target = Panel::Map(MapKind::Target);
        for (id, step, panel) in [
            ("range-and-bandwidth", 5, target),
            ("angle-and-aperture", 5, Panel::Map(MapKind::Input0)),
            ("range-and-velocity", 3, Panel::RangeDoppler),
            ("range-and-velocity", 4, Panel::RangeDoppler),
            ("points-taken-for-a-line", 1, target),
            ("points-taken-for-a-line", 2, Panel::Map(MapKind::Output)),
        ] {
            let lesson = shipped::ALL.iter().find(|file| file.id == id).unwrap().load().unwrap();
            assert_eq!(map_of(&lesson.steps[step - 1]), panel, "{id}, step {step}");
        }
    }

    #[test]
    fn a_challenge_about_two_blobs_shows_their_part_of_the_map() {
        let step = last_step("range-and-bandwidth");
        let challenge = step.challenge.as_ref().unwrap();
        for bandwidth_hz in [0.2e9, 0.95e9] {
            let radar = Radar { bandwidth_hz, ..step.radar.clone() };
            let part = part_of(challenge, &radar, &step.scene()).unwrap();
            let metres = |fraction: f32| f64::from(fraction) * radar.max_range_metres();
            let (low, high) = (metres(part.low.y), metres(part.high.y));
            assert!(low < 19.0 && high > 21.6 && high - low < 12.0, "{bandwidth_hz}: {low} to {high} m");
            assert!(part.low.x < 0.5 && part.high.x > 0.5);
        }
        let whole = last_step("near-field");
        assert_eq!(part_of(whole.challenge.as_ref().unwrap(), &whole.radar, &whole.scene()), None);
    }
}
