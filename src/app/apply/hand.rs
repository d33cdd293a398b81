//! Commands of the hand: select, drag in a map, arrange, enter numbers.

use crate::app::state::{Command, State};

/// Does a command of the hand; hands any other on.
pub fn apply(state: &mut State, command: Command) -> Option<Command> {
    let editor = &mut state.editor;
    match command {
        Command::Select(objects, mode) => editor.select(objects, mode),
        Command::SelectNext => editor.select_neighbour(true),
        Command::SelectPrevious => editor.select_neighbour(false),
        Command::Align(alignment) => editor.align(alignment),
        Command::Distribute(along) => editor.distribute(along),
        Command::Grab(blob) => editor.grab(blob),
        Command::DragTo(place) => _ = editor.drag_to(place, state.settings.snap),
        Command::Drop => editor.end_drag(),
        Command::SetField(field, change) => {
            if let Err(error) = editor.set_field(field, change) {
                state.notices.error(format!("Nothing was changed: {error}"));
            }
        }
        other => return Some(other),
    }
    None
}
