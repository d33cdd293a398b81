//! Commands of lessons: begin, predict, go on, leave.

use crate::app::jobs::Jobs;
use crate::app::state::lesson_focus::{control_of, map_of};
use crate::app::state::{Arrangement, Before, LessonCommand, LessonRun, MapKind, MapViews, Panel, State, Task};
use crate::interact::{Document, SelectionMode};
use crate::lesson::{Guess, Lesson, shipped};
use crate::scene::Scene;
use crate::scene::file::SceneFile;
use std::sync::Arc;

pub fn apply(state: &mut State, jobs: &mut Jobs, command: LessonCommand) -> Result<(), String> {
    match command {
        LessonCommand::Begin(index) => begin_shipped(state, index)?,
        LessonCommand::OpenFile(path) => {
            jobs.lessons.open(path).map_err(|error| format!("The lesson can't be read: {error}"))?;
        }
        LessonCommand::Take { id, lesson } => begin(state, id, lesson),
        LessonCommand::Step(step) => go_to(state, step),
        LessonCommand::Predict(guess) => {
            if let Some(run) = state.lesson.as_mut().filter(|run| run.is_predicting()) {
                run.guess = Some(guess);
                // Maps of cells above the threshold use the predicted threshold.
                if let Guess::Eta(eta) = guess {
                    state.settings.target_eta = eta;
                }
                show_challenge(state);
            }
        }
        LessonCommand::ShowSolution => show_solution(state),
        LessonCommand::Leave => leave(state),
        LessonCommand::Present => state.present_lesson(),
        LessonCommand::SetLearner(name) => state.progress.set_learner(&name),
        LessonCommand::ForgetProgress => state.progress.reset(),
    }
    Ok(())
}

/// Begins a lesson that comes with the program.
///
/// # Errors
/// The reason why its file can't be read.
pub fn begin_shipped(state: &mut State, index: usize) -> Result<(), String> {
    let Some(file) = shipped::ALL.get(index) else { return Ok(()) };
    let lesson = file.load().map_err(|error| format!("Lesson {}: {error}", file.id))?;
    begin(state, file.id.to_owned(), Arc::new(lesson));
    Ok(())
}

/// Goes to a step of the lesson, from 0.
pub fn go_to(state: &mut State, step: usize) {
    state.lesson.iter_mut().for_each(|run| run.go_to(step));
    set_up(state);
}

fn begin(state: &mut State, id: String, lesson: Arc<Lesson>) {
    leave(state);
    let (setup, scene_view, map_views) = (state.setup(), state.scene_view, state.map_views);
    let task = state.kept_arrangement().task;
    if !state.is_presenting() {
        state.arrangement.switch(Task::Teach);
    }
    state.lesson = Some(LessonRun::new(id, lesson, Before { setup, scene_view, map_views, task }));
    state.arrangement.set_open(Panel::Lesson, true);
    state.close_unused();
    set_up(state);
}

/// Puts the step's scene, radar and conditions on screen.
fn set_up(state: &mut State) {
    let Some(step) = state.lesson.as_ref().and_then(|run| run.current()).cloned() else { return };
    state.settings.floor = step.view.floor;
    state.settings.normalisation = step.view.normalisation;
    state.settings.one_scale = step.view.one_scale;
    state.settings.method.clone_from(&step.view.method);
    state.settings.layout = None;
    state.settings.detect_by(step.view.cfar);
    let name = state.lesson.as_ref().map_or_else(String::new, |run| run.lesson.title.clone());
    // Name and notes would tell the answer that the learner predicts.
    let scene = Scene { name, notes: String::new(), noise_seed: step.view.seed, ..step.scene() };
    state.set_document(Document::shipped(SceneFile { scene, radar: step.radar.clone() }));
    let (scene, depth) = (state.editor.scene().clone(), state.editor.history().depth());
    state.map_views = MapViews::default();
    let (map, control) = (map_of(&step), control_of(&step).map(|(panel, _)| panel));
    close_opened(state, &[Some(map), control]);
    state.arrangement.set_open(Panel::Scene, true);
    if map == Panel::RangeDoppler {
        open_for_step(state, map);
    }
    state.arrangement.put_large(map);
    show_challenge(state);
    let Some(run) = &mut state.lesson else { return };
    (run.set_up, run.depth) = (Some(scene), depth);
    if let Some(Guess::Eta(eta)) = run.guess {
        state.settings.target_eta = eta;
    }
}

/// Brings the control for the step's challenge to the front, once the challenge is on screen.
fn show_challenge(state: &mut State) {
    let run = state.lesson.as_ref().filter(|run| !run.is_predicting());
    let Some((panel, object)) = run.and_then(|run| run.current()).and_then(control_of) else { return };
    open_for_step(state, panel);
    state.editor.select(object, SelectionMode::Replace);
}

/// Opens a panel until a step that does not need it.
fn open_for_step(state: &mut State, panel: Panel) {
    let was_open = state.arrangement.has_tile(panel);
    state.arrangement.set_open(panel, true);
    state.lesson.iter_mut().filter(|_| !was_open).for_each(|run| run.opened.push(panel));
}

/// Closes the panels that earlier steps opened, but for `needed`.
fn close_opened(state: &mut State, needed: &[Option<Panel>]) {
    let is_of_lessons = state.is_presenting() || state.arrangement.task == Task::Teach;
    let Some(run) = state.lesson.as_mut().filter(|_| is_of_lessons) else { return };
    for panel in run.opened.extract_if(.., |panel| !needed.contains(&Some(*panel))) {
        if panel == Panel::RangeDoppler {
            state.arrangement.put_large(Panel::Map(MapKind::Target));
        }
        state.arrangement.set_open(panel, false);
    }
}

/// Keeps the cells of a challenge in sight as scene and radar change, until the learner zooms.
pub fn follow_challenge(state: &mut State) {
    let Some(run) = state.lesson.as_mut().filter(|_| state.editor.dragged().is_none()) else { return };
    let Some(part) = run.challenged_part(state.editor.radar(), state.editor.scene()) else { return };
    let shown = &mut state.map_views.range_angle;
    if run.part.is_none_or(|last| last == *shown) {
        (*shown, run.part) = (part, Some(part));
    }
}

fn show_solution(state: &mut State) {
    let step = state.lesson.as_ref().and_then(|run| run.current());
    let Some(challenge) = step.and_then(|s| s.challenge.clone()) else { return };
    let mut file = state.editor.document().to_file();
    if !challenge.solution.objects.is_empty() {
        file.scene.objects = challenge.solution.objects;
    }
    if let Some(radar) = challenge.solution.radar {
        file.radar = radar;
    }
    state.set_document(Document::shipped(file));
    state.lesson.iter_mut().for_each(|run| run.gave_up = true);
}

/// Ends the lesson and restores scene, radar, settings, panels and visible parts from before it.
fn leave(state: &mut State) {
    close_opened(state, &[]);
    let Some(run) = state.lesson.take() else { return };
    let after = state.settings.view.clone();
    let Before { setup, scene_view, map_views, .. } = run.before;
    while state.editor.history().depth() > setup.depth && state.editor.undo() {}
    state.settings.take_back(&setup.view, &after);
    (state.scene_view, state.map_views) = (scene_view, map_views);
    state.kept_arrangement().open_again(&run.closed);
    state.kept_arrangement().switch(run.before.task);
    if state.presents_lesson() {
        state.arrangement = Arrangement::of_a_lesson();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_step_opened_is_closed_by_a_step_without_it() {
        let mut state = State::new(Vec::new());
        let index = |id: &str| shipped::ALL.iter().position(|file| file.id == id).unwrap();
        let place = |state: &State, panel: Panel| state.arrangement.tree.tiles.find_pane(&panel.tile());
        begin_shipped(&mut state, index("range-and-velocity")).unwrap();
        let largest = place(&state, Panel::RangeDoppler);
        go_to(&mut state, 3);
        assert!(state.arrangement.is_open(Panel::RangeDoppler) && place(&state, Panel::RangeDoppler) == largest);
        begin_shipped(&mut state, index("range-and-bandwidth")).unwrap();
        assert!(!state.arrangement.is_open(Panel::RangeDoppler));
        assert_eq!(place(&state, Panel::Map(MapKind::Target)), largest);
        for (step, is_open) in [(3, false), (4, true), (4, true), (3, false)] {
            go_to(&mut state, step);
            assert_eq!(state.arrangement.is_open(Panel::Radar), is_open, "step {}", step + 1);
        }
        state.arrangement.set_open(Panel::Radar, true);
        go_to(&mut state, 4);
        go_to(&mut state, 3);
        assert!(state.arrangement.is_open(Panel::Radar), "the learner's own stays");
    }
}
