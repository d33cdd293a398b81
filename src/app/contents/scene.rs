//! What the panels are told that show the scene, or the radar before it.

use super::{Contents, captions, shown_found};
use crate::app::panels::{disturbances, elements, inspector, objects, radar, scene};
use crate::app::state::{Command, MapKind};
use eframe::egui::Ui;

impl Contents<'_> {
    pub(super) fn scene(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, pipeline) = (&mut *self.state, &self.jobs.pipeline);
        let found = shown_found(state, pipeline);
        let radar = state.editor.radar().clone();
        let moved = state.timeline.moved();
        let input = scene::Input {
            radar: &radar,
            snapshot_range_metres: state.editor.document().recording().and_then(|r| r.range_metres),
            snap: state.settings.snap,
            fields_of_view: state.settings.show_fields_of_view,
            found,
            found_stale: pipeline.is_stale(MapKind::Output),
            trails: self.jobs.failures.search.trails(state.editor.document().id()),
            cursor: state.shown_cursor(),
            error: pipeline.scene_error(),
            numbers: state.shows_axes(),
            hint: captions::of_scene(state, pipeline),
            tells_maps: !state.is_predicting(),
            moved: moved.as_deref().map(|scene| (scene, state.timeline.seconds())),
        };
        scene::show(ui, input, &mut state.editor, &mut state.scene_view)
    }

    pub(super) fn radar(&mut self, ui: &mut Ui) -> Vec<Command> {
        let recording = self.state.editor.document().recording();
        let measured = recording.map(|r| radar::Measured { by_all_elements: r.signal().is_some() });
        let selection = self.state.editor.selection().single();
        let selected = selection.and_then(|index| {
            let object = self.state.editor.scene().objects.get(index).filter(|o| o.body().is_none())?;
            let name = format!("{} {}", object.noun(), index + 1);
            let of_many = if object.reflector_count() == 1 { name } else { format!("a reflector of {name}") };
            let (place_metres, reflectivity) = (object.centre_metres(), object.reflectivity());
            Some(radar::Selected { name: of_many, place_metres, reflectivity })
        });
        radar::show(ui, radar::Input { radar: self.state.radar(), measured, selected })
    }

    pub(super) fn elements(&mut self, ui: &mut Ui) -> Vec<Command> {
        let input = elements::Input {
            radar: self.state.radar(),
            elements: &self.state.editor.scene().disturbances.elements,
            calibration: self.jobs.calibration.value(),
        };
        elements::show(ui, input, &mut self.memory.elements)
    }

    pub(super) fn disturbances(&mut self, ui: &mut Ui) -> Vec<Command> {
        let document = self.state.editor.document();
        let is_recorded = document.recording().is_some();
        let (disturbances, radar) = (&document.scene().disturbances, self.state.radar());
        disturbances::show(ui, disturbances::Input { disturbances, radar, is_recorded })
    }

    pub(super) fn inspector(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (editor, coordinates) = (&self.state.editor, self.state.settings.coordinates);
        inspector::show(
            ui,
            inspector::Input {
                editor,
                radar: editor.radar(),
                coordinates,
                metres_per_point: self.state.scene_view.metres_per_point,
            },
        )
    }

    pub(super) fn objects(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (editor, coordinates) = (&self.state.editor, self.state.settings.coordinates);
        let input = objects::Input { scene: editor.scene(), selection: editor.selection(), coordinates };
        objects::show(ui, input, &mut self.memory.objects)
    }
}
