//! Input of the scene panel, taken from the state of the app.

use super::{Input, show};
use crate::app::content::{Content, Cx, Nothing};
use crate::app::panels::captions;
use crate::app::state::{Command, MapKind};
use eframe::egui::Ui;

pub struct ScenePanel;

impl Content for ScenePanel {
    type Asks = Nothing;
    type Remembers = ();
    const MARKS_AGE: bool = true;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (state, pipeline) = (cx.state, &cx.jobs.pipeline);
        let found = pipeline.shown_found(state);
        let radar = state.editor.radar().clone();
        let moved = state.timeline.moved();
        let input = Input {
            radar: &radar,
            snapshot_range_metres: state.editor.document().recording().and_then(|r| r.range_metres),
            snap: state.settings.snap,
            fields_of_view: state.settings.show_fields_of_view,
            found,
            found_stale: pipeline.is_stale(MapKind::Output),
            trails: cx.jobs.failures.search.trails(state.editor.document().id()),
            cursor: state.shown_cursor(),
            error: pipeline.maps.scene_error(),
            numbers: state.shows_axes(),
            hint: captions::of_scene(state, pipeline),
            tells_maps: !state.is_predicting(),
            moved: moved.as_deref().map(|scene| (scene, state.timeline.seconds())),
        };
        show(ui, input, &mut state.editor, &mut state.scene_view)
    }
}
