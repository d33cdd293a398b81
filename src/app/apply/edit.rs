//! Commands that select objects and change the scene on screen.

use super::shared;
use crate::app::state::{EditCommand, NewObject, State};
use crate::interact::Place;
use crate::scene::{Block, GaussianCluster, Line, Object, Point, Polygon, Post, Wall};
use crate::share::is_shared;
use eframe::egui::{Context, ViewportCommand};

pub fn apply(ctx: &Context, state: &mut State, command: EditCommand) -> Result<(), String> {
    let editor = &mut state.editor;
    match command {
        EditCommand::Undo => state.undo(),
        EditCommand::Redo => state.redo(),
        EditCommand::Seal => editor.seal(),
        EditCommand::Cut => {
            copy(ctx, state);
            state.editor.delete_selected();
        }
        EditCommand::Copy => copy(ctx, state),
        EditCommand::Paste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
        EditCommand::PasteText(text) if is_shared(&text) => shared::open(state, &text)?,
        EditCommand::PasteText(text) => {
            editor.paste(&text).map_err(|error| format!("Nothing was pasted: {error}"))?;
        }
        EditCommand::Duplicate => {
            editor.duplicate_selected().map_err(|error| format!("Nothing was duplicated: {error}"))?;
        }
        EditCommand::Delete => editor.delete_selected(),
        EditCommand::SelectAll => editor.select_all(),
        EditCommand::Select(objects, mode) => editor.select(objects, mode),
        EditCommand::SelectNext => editor.select_neighbour(true),
        EditCommand::SelectPrevious => editor.select_neighbour(false),
        EditCommand::SetField(field, change) => {
            editor.set_field(field, change).map_err(|error| format!("Nothing was changed: {error}"))?;
        }
        EditCommand::Name(name) => editor.name_selected(&name),
        // At another time the objects on screen are not where the document has them.
        EditCommand::Grab(_) if state.timeline.moved().is_some() => state.timeline.set(editor.scene(), 0.0),
        EditCommand::Grab(blob) => editor.grab(blob),
        EditCommand::DragTo(place) => _ = editor.drag_to(place, state.settings.snap),
        EditCommand::Drop => editor.end_drag(),
        EditCommand::Add(kind, place) => add(state, kind, place),
        EditCommand::Nudge { dx_metres, dy_metres } => {
            editor.nudge(dx_metres, dy_metres);
            state.note_first_drag();
        }
        EditCommand::SetNoiseSeed(seed) => {
            editor.edit(Some("noise seed"), |scene, _| scene.noise_seed = seed);
        }
        EditCommand::SetSnap(snap) => state.settings.snap = snap,
        EditCommand::SetCoordinates(coordinates) => state.settings.coordinates = coordinates,
    }
    Ok(())
}

/// Copies the selected objects as text; a message where none is selected.
fn copy(ctx: &Context, state: &mut State) {
    match state.editor.copy() {
        Some(text) => ctx.copy_text(text),
        None => state.notices.info("Nothing is selected: click an object, or drag a box around several."),
    }
}

/// Adds an object at `place`, or in the middle of the visible scene, beside the objects already there.
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
            seed: state.editor.scene().objects.len() as u64,
            ..GaussianCluster::new([x_metres, y_metres], [1.0, 1.0], 40)
        }),
        NewObject::Wall => Object::Wall(Wall::new(x_metres, y_metres, 5.0, 0.0)),
        NewObject::Box => Object::Box(Block::new([x_metres, y_metres.max(3.0)], [4.5, 1.8], 90.0)),
        NewObject::Post => Object::Post(Post::new(x_metres, y_metres, 0.2)),
        NewObject::Polygon => {
            // An L whose inner corner faces the array.
            let corners = [[-1.5, 0.0], [-0.5, 0.0], [-0.5, 1.5], [1.5, 1.5], [1.5, 2.5], [-1.5, 2.5]];
            Object::Polygon(Polygon::new(corners.map(|[x, y]| [x + x_metres, y + y_metres]).to_vec()))
        }
    });
}
