//! The scene while a lesson's question is open: nothing that is drawn gives the answer away.

use super::super::*;
use super::Held;
use crate::app::widgets::seen::{Harness, Queryable};
use crate::lesson::question::Answer;
use crate::lesson::{Stage, Step, Truth, shipped};
use crate::scattering::{EchoKind, array_centre_echoes};

/// A step's scene, drawn with or without its effects on the maps.
fn step_drawn(step: &Step, tells_maps: bool) -> (Harness<'static, Held>, Vec<egui::Shape>) {
    let draw = move |ui: &mut Ui, held: &mut Held| {
        _ = show(ui, Input { tells_maps, ..Input::default() }, &mut held.state);
    };
    let held = Held { state: State::of(step.radar.clone(), step.scene()), asked: Vec::new() };
    let panel = Harness::builder().with_size([600.0, 400.0]).build_ui_state(draw, held);
    let shapes = panel.output().shapes.iter().map(|clipped| clipped.shape.clone()).collect();
    (panel, shapes)
}

/// Places in the scene that answer a step's question: the place that is asked for, and the glints of bodies.
fn answers(step: &Step) -> Vec<Place> {
    let heard = array_centre_echoes(&step.radar, &step.scene());
    let mut places: Vec<Place> = heard
        .iter()
        .filter(|(_, e)| e.kind == EchoKind::Glint && e.is_heard())
        .map(|(_, e)| e.place_metres.into())
        .collect();
    let asked = step.predict.as_ref().filter(|question| matches!(question.answer, Answer::Click { .. }));
    if let Some(question) = asked.filter(|question| !question.needs_output()) {
        let stage = Stage::new(&step.radar, &step.scene(), &step.view, false).unwrap();
        if let Ok(Truth::Place(cell)) = question.truth(&stage) {
            places.push(Cursor::at_cell(&step.radar, cell.bin, cell.column).place);
        }
    }
    places
}

#[test]
fn no_drawn_mark_lies_at_the_answer_of_an_open_question() {
    let mut hidden = 0;
    for file in shipped::ALL {
        for (number, step) in file.load().unwrap().steps.iter().enumerate().filter(|(_, step)| step.predict.is_some()) {
            let (panel, open) = step_drawn(step, false);
            let rect = panel.get_by_label("Scene").rect();
            let (view, radar) = (panel.state().state.scene_view, step.radar.clone());
            let (extent_metres, inks) = (radar.max_range_metres(), Inks::of(&panel.ctx.global_style().visuals));
            let canvas = Canvas { rect, view, radar: &radar, extent_metres, inks };
            // Ground and objects alone.
            let scene = step.scene();
            let bare = Harness::builder().with_size([600.0, 400.0]).build_ui(|ui| {
                let painter = ui.painter();
                canvas::ground(painter, canvas, false, true);
                let look = Look { selected: false, hovered: false };
                scene.objects.iter().for_each(|object| {
                    canvas::object(painter, canvas, object, look);
                    canvas::velocity(painter, canvas, object, look);
                });
            });
            let near = |shape: &egui::Shape, place: &Place| {
                let bounds = shape.visual_bounding_rect();
                bounds.size().max_elem() < 40.0 && bounds.distance_to_pos(view.to_screen(rect, *place)) < 6.0
            };
            let count = |shapes: &[egui::Shape], place: &Place| shapes.iter().filter(|s| near(s, place)).count();
            let bare: Vec<egui::Shape> = bare.output().shapes.iter().map(|clipped| clipped.shape.clone()).collect();
            let (_, told) = step_drawn(step, true);
            for place in answers(step) {
                assert_eq!(count(&open, &place), count(&bare, &place), "{}, step {}: {place:?}", file.id, number + 1);
                hidden += usize::from(count(&told, &place) > count(&open, &place));
            }
        }
    }
    assert!(hidden > 5, "only {hidden} answers would be marked once they are given");
}
