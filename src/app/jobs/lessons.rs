//! Judgement of predictions and measurement of challenges, off the UI thread.

use super::background::Background;
use super::derived::{Derived, Failure, Query};
use crate::app::shared::Shared;
use crate::app::state::{LessonCommand, LessonRun, State};
use crate::app::widgets::picture;
use crate::lesson::{Guess, Judgement, Lesson, MapName, Measured, Stage, Step};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;
use crate::platform;
use crate::radar::Radar;
use crate::scene::Scene;
use crate::task::Task;
use eframe::egui::{ColorImage, Context};
use std::path::PathBuf;
use std::sync::Arc;

/// A query of the judged prediction and the measured challenge.
#[derive(Clone, PartialEq)]
struct Answered {
    lesson: Shared<Lesson>,
    step: usize,
    guess: Option<Guess>,
    radar: Radar,
    scene: Shared<Scene>,
}

/// The judged prediction, the measured challenge, and a picture of the hidden scene.
#[derive(Default)]
struct Outcome {
    judgement: Option<Result<Judgement, String>>,
    measured: Option<Result<Vec<Measured>, String>>,
    hidden: Option<Arc<ColorImage>>,
}

impl Answered {
    /// The query of the lesson on screen.
    fn of(state: &State) -> Option<Answered> {
        let LessonRun { lesson, step, guess, .. } = state.lesson.as_ref()?;
        let (radar, scene) = (state.radar().clone(), state.editor.scene().into());
        Some(Answered { lesson: lesson.into(), step: *step, guess: *guess, radar, scene })
    }

    fn is_of(&self, run: &LessonRun) -> bool {
        Arc::ptr_eq(&run.lesson, &self.lesson) && run.step == self.step && run.guess == self.guess
    }
}

impl Query for Answered {
    type Value = Outcome;
    type State = ();
    const WHAT: &'static str = "Judging the answer";
    const ADVICE: &'static str = "Change it to try again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<Outcome, Failure> {
        let Some(step) = self.lesson.steps.get(self.step) else { return Ok(Outcome::default()) };
        let judgement = self.guess.zip(step.predict.as_ref()).map(|(guess, question)| {
            let stage = Stage::new(&step.radar, &step.scene(), &step.view, question.needs_output());
            stage.map_err(|e| e.to_string()).and_then(|stage| question.judge(&stage, guess))
        });
        let (measured, hidden) = challenge(step, self).unzip();
        Ok(Outcome { judgement, measured, hidden: hidden.flatten() })
    }
}

type Challenged = (Result<Vec<Measured>, String>, Option<Arc<ColorImage>>);

/// The challenge measured on the learner's scene, and a picture of the hidden scene.
fn challenge(step: &Step, request: &Answered) -> Option<Challenged> {
    let challenge = step.challenge.as_ref()?;
    let hidden = challenge
        .hidden_scene()
        .and_then(|scene| Stage::new(&step.radar, &scene, &step.view, challenge.needs_hidden_output()).ok());
    let picture = hidden.as_ref().and_then(|stage| Some(shrunk(&stage.radar, stage.map(MapName::Target).ok()?)));
    let stage = Stage::new(&request.radar, &request.scene, &step.view, challenge.needs_output());
    let measured = stage.map_err(|e| e.to_string()).and_then(|stage| challenge.measure(&stage, hidden.as_ref()));
    Some((measured, picture))
}

/// Every second cell, the farthest row on top.
fn shrunk(radar: &Radar, map: &RangeAngleMap) -> Arc<ColorImage> {
    picture(radar.left_to_right(&map.lambda).slice(ndarray::s![..;-2, ..;2]), ColourMap::default())
}

/// Judgements, and lesson files being read.
pub struct Lessons {
    judged: Derived<Answered>,
    /// Lesson files being tried out: each ends in a command that begins the lesson, or in the reason why it can't begin.
    pub opened: Background<Result<LessonCommand, String>>,
}

impl Lessons {
    /// Starts the worker, idle at first; `wake` draws another frame.
    pub fn start(wake: &Context) -> Lessons {
        Lessons { judged: Derived::start(platform::waker(wake)), opened: Background::new(wake.clone()) }
    }

    /// Reads a lesson file and tries its steps out; [`Lessons::opened`] has the result.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn open(&self, path: PathBuf) -> std::io::Result<()> {
        let work = move || match Lesson::load(&path) {
            Ok(lesson) => Ok(LessonCommand::Take { id: path.display().to_string(), lesson: Arc::new(lesson) }),
            Err(error) => Err(format!("{error}\nNo lesson was opened.")),
        };
        self.opened.begin("lesson files", work, |why| Err(format!("The lesson can't be tried out ({why}).")))
    }

    /// Asks for judgement and measurement of the lesson on screen, if that changed.
    pub fn ask(&mut self, state: &State) {
        self.judged.ask(Answered::of(state));
    }

    /// Picture of the hidden scene, where the step has one.
    pub fn hidden(&self) -> Option<&Arc<ColorImage>> {
        self.judged.value()?.ok()?.hidden.as_ref()
    }

    /// Takes in judgements. Returns a message for the user.
    pub fn poll(&mut self, state: &mut State) -> Option<String> {
        let message = self.judged.poll();
        if let (Some(run), Some((of, Ok(outcome)))) = (&mut state.lesson, self.judged.made())
            && of.is_of(run)
            && (&run.judgement, &run.measured) != (&outcome.judgement, &outcome.measured)
        {
            if let (None, Some(Ok(judgement))) = (&run.judgement, &outcome.judgement) {
                state.progress.note_guess(&run.id, run.step, judgement.is_right);
            }
            run.judgement.clone_from(&outcome.judgement);
            run.measured.clone_from(&outcome.measured);
            if run.is_solved() {
                state.progress.note_challenge(&run.id, run.step);
            }
        }
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;

    #[test]
    fn left_is_left_in_the_map_that_a_challenge_shows() {
        for convention in Convention::ALL {
            let radar = Radar { elements: 128, ..Radar::default() }.in_convention(convention);
            let mut lambda = ndarray::Array2::zeros((63, 128));
            // Every second column is painted.
            let column = radar.column_of_cos(-0.5) as usize;
            lambda.slice_mut(ndarray::s![.., column..column + 2]).fill(1.0);
            let image = shrunk(&radar, &RangeAngleMap { lambda });
            let bright = (0..64).max_by_key(|x| image.pixels[*x].g()).unwrap();
            assert!((14..19).contains(&bright), "{convention:?}: column {bright} of 64");
        }
    }
}
