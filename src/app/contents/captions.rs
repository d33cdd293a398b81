//! What maps and scene say of themselves at a first start.

use crate::app::panels::scene::Hint;
use crate::app::state::{MapKind, MethodSlot, State};
use crate::interact::Place;
use crate::radar::{End, Radar};
use crate::scene::{Object, Scene, presets};
use std::sync::LazyLock;

/// The scene of a first start, as it opens.
static STREET: LazyLock<Scene> = LazyLock::new(|| presets::default_scene().scene);

/// What a map shows, in a line; nothing where the box of the theory stands.
pub fn of_map(state: &State, kind: MapKind) -> Option<String> {
    (state.shows_captions() && !state.settings.show_theory).then(|| {
        let method = state.method_in(kind.slot().unwrap_or(MethodSlot::First)).map_or("the method", |m| m.name());
        text(kind, state.radar(), method)
    })
}

fn text(kind: MapKind, radar: &Radar, method: &str) -> String {
    let [first, last] = End::BOTH.map(|end| radar.end_range(end).len());
    let (all, ends) = (radar.elements, first + last);
    match kind {
        MapKind::Input0 => format!("Input 0: the first {first} elements"),
        MapKind::Input1 => format!("Input 1: the last {last} elements"),
        MapKind::Target => format!("Target: all {all} elements"),
        MapKind::Output | MapKind::Second => format!("Output: what {method} makes of the {ends}"),
        MapKind::TargetAbove => "Target > η': what a detector finds in the target".to_owned(),
        MapKind::OutputAbove | MapKind::SecondAbove => "Output > η: what it finds in the output".to_owned(),
        MapKind::Difference | MapKind::SecondDifference => "Difference: output minus target".to_owned(),
        MapKind::Doubt => format!("Doubt: how far off {method} expects to be"),
        MapKind::Unexplained => "What reflectors leave unexplained of the recording".to_owned(),
    }
}

/// What to do in the scene: in the street as it opens a post is to be dragged towards the wall, elsewhere whatever there is.
pub fn of_scene(state: &State) -> Option<Hint> {
    let scene = state.editor.scene();
    state.shows_captions().then(|| hint(scene, state.editor.document().recording().is_some()))
}

fn hint(scene: &Scene, is_recorded: bool) -> Hint {
    if is_recorded {
        return Hint { text: "Double-click to lay a reflector over the recording".to_owned(), way: None };
    }
    if scene.objects.is_empty() {
        return Hint { text: "Double-click to add a reflector".to_owned(), way: None };
    }
    let way = (scene.objects == STREET.objects).then(|| from_post_to_wall(scene)).flatten();
    let text = if way.is_some() { "Drag the post towards the wall" } else { "Drag a reflector: every map follows" };
    Hint { text: text.to_owned(), way }
}

fn from_post_to_wall(scene: &Scene) -> Option<[Place; 2]> {
    let place = |object: &Object| Place::from(object.centre_metres());
    let wall = scene.objects.iter().find(|o| matches!(o, Object::Line(_)));
    let post = scene.objects.iter().filter(|o| matches!(o, Object::Point(_)));
    let nearest = post.min_by(|a, b| a.centre_metres()[1].total_cmp(&b.centre_metres()[1]));
    Some([place(nearest?), place(wall?)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_of_the_first_window_says_what_it_shows() {
        let of = |kind| text(kind, &Radar::default(), "live");
        assert_eq!(of(MapKind::Input0), "Input 0: the first 12 elements");
        assert_eq!(of(MapKind::Target), "Target: all 1024 elements");
        assert_eq!(of(MapKind::Output), "Output: what live makes of the 24");
    }

    #[test]
    fn the_first_scene_asks_to_drag_the_post_towards_the_wall() {
        let street = presets::default_scene().scene;
        let Hint { text, way } = hint(&street, false);
        let [from, to] = way.expect("from the post to the wall");
        assert_eq!(text, "Drag the post towards the wall");
        assert!(from.y_metres < to.y_metres && from.x_metres < to.x_metres, "{from:?} to {to:?}");
        assert_eq!(hint(&Scene::default(), false).text, "Double-click to add a reflector");
    }

    #[test]
    fn another_scene_of_a_point_with_a_line_asks_to_drag_any_reflector() {
        let mut other = presets::default_scene().scene;
        other.objects.retain(|object| matches!(object, Object::Line(_) | Object::Point(_)));
        assert_eq!(hint(&other, false), Hint { text: "Drag a reflector: every map follows".to_owned(), way: None });
    }
}
