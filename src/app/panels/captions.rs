//! Captions of the maps and of the scene at a first start.

use crate::app::jobs::Pipeline;
use crate::app::state::{MapKind, MethodSlot, State};
use crate::evaluate::dip_between;
use crate::interact::Place;
use crate::radar::{End, LayoutKind, Radar};
use crate::scene::{Object, Scene, presets};
use std::sync::LazyLock;

/// A task, or the result of a drag.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    pub text: String,
    /// Places along which an object is to be dragged; empty without a drag.
    pub way: Vec<Place>,
}

/// The scene of a first start, as it opens.
static STREET_SCENE: LazyLock<Scene> = LazyLock::new(|| presets::default_scene().scene);

/// Index of the post that is to be dragged, in that scene.
const STREET_POST: usize = 3;

/// The caption of a map in one line; `None` where captions are off or the numbers of the theory are drawn.
pub fn of_map(state: &State, kind: MapKind) -> Option<String> {
    (state.shows_captions() && !state.settings.show_theory).then(|| {
        let method = state.method_in(kind.slot().unwrap_or(MethodSlot::First)).map_or("the method", |m| m.name());
        text(kind, state.radar(), state.settings.layout.as_ref(), method)
    })
}

fn text(kind: MapKind, radar: &Radar, layout: Option<&LayoutKind>, method: &str) -> String {
    let [first, last] = End::BOTH.map(|end| radar.end_range(end).len());
    // The middle one of three elements belongs to both ends.
    let (all, ends) = (radar.elements, radar.elements.min(first + last));
    match kind {
        MapKind::Input0 if let Some(layout) = layout => format!("Input 0: the elements of {layout}"),
        MapKind::Output | MapKind::Second if layout.is_some() => format!("Output: {method}, from these elements"),
        MapKind::Input0 => format!("Input 0: the first {first} elements"),
        MapKind::Input1 => format!("Input 1: the last {last} elements"),
        MapKind::Target => format!("Target: all {all} elements"),
        MapKind::Output | MapKind::Second => format!("Output: {method}, from {ends} elements"),
        MapKind::TargetAbove => "Target > η': cells detected in the target".to_owned(),
        MapKind::OutputAbove | MapKind::SecondAbove => "Output > η: cells detected in the output".to_owned(),
        MapKind::Difference | MapKind::SecondDifference => "Difference: output minus target".to_owned(),
        MapKind::Doubt => format!("Doubt: the error that {method} expects"),
        MapKind::Unexplained => "The part of the recording that reflectors leave unexplained".to_owned(),
    }
}

/// The hint over the scene: at a first start what to drag, the post of the street or any reflector; after the first drag its result in the maps.
pub fn of_scene(state: &State, pipeline: &Pipeline) -> Option<Hint> {
    let scene = state.editor.scene();
    if state.shows_captions() {
        return Some(hint(scene, state.radar(), state.is_recorded()));
    }
    let is_told = state.tells_first_drag && state.lesson.is_none() && state.editor.dragged().is_none();
    let places_metres = (is_told && *state.radar() == Radar::default()).then(|| post_and_wall(scene)).flatten()?;
    if scene.objects == STREET_SCENE.objects {
        return Some(hint(scene, state.radar(), false));
    }
    let is_old = [MapKind::Input0, MapKind::Input1, MapKind::Target].iter().any(|kind| pipeline.is_stale(*kind));
    let frame = &pipeline.maps.result().filter(|_| !is_old)?.frame;
    let maps = [frame.first.as_ref()?, frame.last.as_ref()?, frame.full.as_ref()?];
    let text = match places_metres {
        None => OFF_RING_HINT,
        Some(places) => told(maps.map(|map| dip_between(state.radar(), &map.lambda, places) >= MIN_DIP)),
    };
    Some(Hint { text: text.to_owned(), way: Vec::new() })
}

/// Least dip of Lambda between two blobs that separates them.
const MIN_DIP: f32 = 0.05;

/// Largest difference in range between post and wall while the post is on its ring, metres.
const SAME_RANGE_METRES: f64 = 0.5;

/// The hint after the post was dragged off its ring.
const OFF_RING_HINT: &str = "Post and wall now differ in range: drag the post along its ring, to the wall's range";

/// The hint after a drag, from whether input 0, input 1 and the target show post and wall apart.
fn told([first, last, target]: [bool; 3]) -> &'static str {
    match (first, last, target) {
        (true, true, true) => "Every map still shows post and wall apart: drag on, towards the wall",
        (false, false, true) => "Both inputs now show post and wall as one blob; the target shows two",
        (_, _, true) => "One input now shows post and wall as one blob; the target shows two",
        (_, _, false) => "Now even the target shows post and wall as one blob: drag back a little",
    }
}

fn hint(scene: &Scene, radar: &Radar, is_recorded: bool) -> Hint {
    let plain = |text: &str| Hint { text: text.to_owned(), way: Vec::new() };
    if is_recorded {
        return plain("Double-click to lay a reflector over the recording");
    }
    if scene.objects.is_empty() {
        return plain("Double-click to add a reflector");
    }
    let is_street = scene.objects == STREET_SCENE.objects && *radar == Radar::default();
    match post_and_wall(scene).flatten().filter(|_| is_street) {
        Some(ends) => Hint { text: "Drag the post along its ring, to the wall".to_owned(), way: along_the_ring(ends) },
        None => plain("Drag a reflector: every map follows"),
    }
}

/// Places of the street's post and of the wall's reflector nearest in range, (x, y) in metres. `None` in another scene; `Some(None)` at unlike ranges.
fn post_and_wall(scene: &Scene) -> Option<Option<[[f64; 2]; 2]>> {
    let is_post = |index: usize| index == STREET_POST;
    let same = |(index, (now, then)): (usize, (&Object, &Object))| is_post(index) || now == then;
    let is_street = scene.objects.len() == STREET_SCENE.objects.len()
        && scene.objects.iter().zip(&STREET_SCENE.objects).enumerate().all(same);
    let post = scene.objects.get(STREET_POST).filter(|_| is_street)?.centre_metres();
    let wall = scene.objects.iter().find(|o| matches!(o, Object::Line(_)))?;
    let range = post[0].hypot(post[1]);
    let off = |at: &[f64; 2]| (at[0].hypot(at[1]) - range).abs();
    let nearest =
        wall.reflectors().into_iter().map(|r| [r.x_metres, r.y_metres]).min_by(|a, b| off(a).total_cmp(&off(b)))?;
    Some(Some([post, nearest]).filter(|_| off(&nearest) <= SAME_RANGE_METRES))
}

/// Places on a ring around the array, from the direction of `from` to that of `to`.
fn along_the_ring([from, to]: [[f64; 2]; 2]) -> Vec<Place> {
    const DIP_STEPS: usize = 48;
    let range = from[0].hypot(from[1]);
    let angle = |at: [f64; 2]| at[1].atan2(at[0]);
    let at = |step: usize| {
        let angle = angle(from) + (angle(to) - angle(from)) * step as f64 / DIP_STEPS as f64;
        Place::new(range * angle.cos(), range * angle.sin())
    };
    (0..=DIP_STEPS).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_of_the_first_window_says_what_it_shows() {
        let of = |kind| text(kind, &Radar::default(), None, "live");
        assert_eq!(of(MapKind::Input0), "Input 0: the first 12 elements");
        assert_eq!(of(MapKind::Target), "Target: all 1024 elements");
        assert_eq!(of(MapKind::Output), "Output: live, from 24 elements");
    }

    #[test]
    fn the_first_scene_asks_to_drag_the_post_along_its_ring() {
        let street = presets::default_scene().scene;
        let Hint { text, way } = hint(&street, &Radar::default(), false);
        assert_eq!(text, "Drag the post along its ring, to the wall");
        let ranges: Vec<f64> = way.iter().map(|at| at.x_metres.hypot(at.y_metres)).collect();
        assert!(ranges.iter().all(|range| (range - ranges[0]).abs() < 1e-9), "{ranges:?}");
        let [.., end] = way[..] else { panic!("an arrow") };
        assert!((end.x_metres - 9.0).abs() < 0.1, "the arrow ends at {end:?}, not at the wall");
        assert_eq!(hint(&Scene::default(), &Radar::default(), false).text, "Double-click to add a reflector");
    }

    #[test]
    fn another_scene_of_point_and_line_asks_to_drag_any_reflector() {
        let mut other = presets::default_scene().scene;
        other.objects.retain(|object| matches!(object, Object::Line(_) | Object::Point(_)));
        let plain = Hint { text: "Drag a reflector: every map follows".to_owned(), way: Vec::new() };
        assert_eq!(hint(&other, &Radar::default(), false), plain);
        let (street, few) = (presets::default_scene().scene, Radar { elements: 64, ..Radar::default() });
        assert_eq!(hint(&street, &few, false), plain, "the wall is not where the array of 1024 has it");
    }

    #[test]
    fn a_post_off_the_ranges_of_the_wall_has_no_counterpart() {
        let mut street = presets::default_scene().scene;
        assert!(post_and_wall(&street).flatten().is_some());
        street.objects[STREET_POST].translate(0.0, -8.0);
        assert_eq!(post_and_wall(&street), Some(None));
        street.objects.swap_remove(0);
        assert_eq!(post_and_wall(&street), None, "another scene");
    }
}
