//! Inputs of the menu bar and the status bar.

use crate::app::chrome::{menu, status_bar};
use crate::app::jobs::Jobs;
use crate::app::state::{Command, Cursor, Panel, State};
use crate::platform;
use crate::scattering::{PathEcho, heard_in_the_middle};

/// Content of the menu bar.
pub fn menu_input<'a>(
    state: &'a State,
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
        left: state.editor.left(),
        task: state.arrangement.task(),
        is_open,
        is_on,
    }
}

/// Content of the status bar.
pub fn status_input(state: &State, jobs: &Jobs) -> status_bar::Input {
    let scene = state.editor.scene();
    let bodies = || scene.objects.iter().filter_map(|o| o.body());
    status_bar::Input {
        cursor: state.shown_cursor(),
        echo: state.shown_cursor().and_then(|cursor| echo_at(state, &cursor)),
        objects: scene.objects.len(),
        reflectors: scene.reflector_count(),
        bodies: bodies().count(),
        echoes: (!state.is_predicting()).then(|| bodies().map(|body| body.echo_count()).sum()),
        took: jobs.pipeline.maps.took(),
        alone: !platform::has_threads(),
    }
}

/// Most bodies among which the echo under the pointer is searched.
const MOST_BODIES: usize = 60;
/// Largest distance of the pointer from an echo, in range bins and columns.
const NEAR_CELLS: [f64; 2] = [1.5, 8.0];

/// Kind and body of the strongest echo under the pointer, in words.
fn echo_at(state: &State, cursor: &Cursor) -> Option<String> {
    let (radar, scene) = (state.radar(), state.editor.scene());
    let bodies = scene.objects.iter().filter(|o| o.body().is_some()).count();
    if !(1..=MOST_BODIES).contains(&bodies) {
        return None;
    }
    let [bins, columns] = NEAR_CELLS;
    let near = |(_, echo): &(usize, PathEcho)| {
        let [x, y] = echo.place_metres;
        let bin = radar.bin_of_range(echo.range_metres - cursor.range_metres).abs();
        let column = (x / x.hypot(y) - cursor.cos_theta).abs() * radar.elements as f64 / radar.fold_period_cos();
        bin < bins && column < columns
    };
    let strength = |(_, echo): &(usize, PathEcho)| echo.amplitude.norm_sqr();
    let all = heard_in_the_middle(radar, scene).into_iter().filter(near);
    let (index, echo) = all.max_by(|a, b| strength(a).total_cmp(&strength(b)))?;
    Some(format!("{} of {}", echo.kind.name(), scene.objects[index].called(index)))
}
