//! Commands that change the scene on screen or its selection.

use crate::app::state::{Command, NewObject, State};
use crate::interact::Place;
use crate::scene::{GaussianCluster, Line, Object, Point};

/// Does those commands, and hands others on.
pub fn apply(state: &mut State, command: Command) -> Option<Command> {
    let editor = &mut state.editor;
    match command {
        Command::Undo => state.undo(),
        Command::Redo => state.redo(),
        Command::Seal => editor.seal(),
        Command::PasteText(text) => {
            if let Err(error) = editor.paste(&text) {
                state.notices.error(format!("Nothing was pasted: {error}"));
            }
        }
        Command::Duplicate => {
            if let Err(error) = editor.duplicate_selected() {
                state.notices.error(format!("Nothing was duplicated: {error}"));
            }
        }
        Command::Delete => editor.delete_selected(),
        Command::SelectAll => editor.select_all(),
        Command::Nudge { dx_metres, dy_metres } => editor.nudge(dx_metres, dy_metres),
        Command::Add(kind, place) => add(state, kind, place),
        Command::SetNoiseSeed(seed) => {
            editor.edit("noise seed", Some("noise seed"), |scene, _| scene.noise_seed = seed);
        }
        other => return Some(other),
    }
    None
}

/// Adds an object at `place`, or in the middle of the visible scene, beside whatever is there already.
fn add(state: &mut State, kind: NewObject, place: Option<Place>) {
    let (bin, view) = (state.radar().range_resolution_metres(), state.scene_view);
    let mut at = place.unwrap_or(Place::new(view.centre.x_metres, view.centre.y_metres.max(2.0)));
    if place.is_none() {
        while state.editor.hit(at, view.metres_per_point).is_some() {
            at.x_metres += 20.0 * view.metres_per_point;
        }
    }
    let Place { x_metres, y_metres } = at;
    state.editor.add(match kind {
        NewObject::Point => Object::Point(Point::new(x_metres, y_metres)),
        NewObject::Line => {
            let (count, spacing_metres) = (75, 1.5 * bin);
            let y_start_metres = (y_metres - spacing_metres * (count - 1) as f64 / 2.0).max(bin);
            Object::Line(Line::vertical(x_metres, y_start_metres, spacing_metres, count))
        }
        NewObject::Cluster => Object::Gaussian(GaussianCluster {
            x_metres,
            y_metres,
            x_std_metres: 1.0,
            y_std_metres: 1.0,
            count: 40,
            seed: state.editor.scene().objects.len() as u64,
            reflectivity: 1.0,
        }),
    });
}
