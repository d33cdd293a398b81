//! What the menu bar and the status bar are told.

use crate::app::chrome::{menu, status_bar};
use crate::app::jobs::Jobs;
use crate::app::state::{Command, Panel, State};
use crate::platform;

/// What the menu bar shows.
pub fn menu_input<'a>(
    state: &'a State,
    jobs: &Jobs,
    is_open: &'a dyn Fn(Panel) -> bool,
    is_on: &'a dyn Fn(&Command) -> Option<bool>,
) -> menu::Input<'a> {
    let history = state.editor.history();
    menu::Input {
        presents: state.is_presenting(),
        can_undo: state.can_undo(),
        can_redo: history.redo_label().is_some(),
        selected: !state.editor.selection().is_empty(),
        projection: state.settings.projection,
        random: (state.settings.random_seed, state.settings.random_number),
        recent: &state.recent,
        finds_reflectors: state.finds_reflectors(),
        has_recording: state.editor.document().recording().is_some(),
        is_recording: jobs.recorder.is_at_work() || jobs.exports.is_waiting(),
        left: state.editor.left(),
        task: state.arrangement.task(),
        is_open,
        is_on,
    }
}

/// What the status bar says.
pub fn status_input(state: &State, jobs: &Jobs) -> status_bar::Input {
    let scene = state.editor.scene();
    status_bar::Input {
        cursor: state.shown_cursor(),
        objects: scene.objects.len(),
        reflectors: scene.reflector_count(),
        took: jobs.pipeline.took(),
        alone: !platform::has_threads(),
    }
}
