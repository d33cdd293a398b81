//! The lesson in progress: its step, predictions and measurements.

use super::guided::Setup;
use super::lesson_focus::{kind_of, part_of};
use super::panel::{MapKind, Panel};
use super::task_layouts::Task;
use super::view::{MapView, MapViews, SceneView};
use crate::lesson::question::Answer;
use crate::lesson::{Cell, Guess, Judgement, Lesson, Measured, Step, Truth};
use crate::radar::Radar;
use crate::scene::Scene;
use std::collections::BTreeMap;
use std::sync::Arc;

type Answered = (Guess, Option<Result<Judgement, String>>);

/// State of the window before a lesson.
#[derive(Default)]
pub struct Before {
    pub setup: Setup,
    pub scene_view: SceneView,
    pub map_views: MapViews,
    pub task: Task,
}

#[derive(Default)]
pub struct LessonRun {
    /// Key under which its progress is kept.
    pub id: String,
    pub lesson: Arc<Lesson>,
    pub step: usize,
    pub guess: Option<Guess>,
    /// The judgement of the prediction, or the reason why it can't be judged.
    pub judgement: Option<Result<Judgement, String>>,
    /// The challenge's requirements with their measured values, or the reason why they can't be measured.
    pub measured: Option<Result<Vec<Measured>, String>>,
    /// Whether the challenge's solution was shown, so that it counts as unsolved.
    pub gave_up: bool,
    /// The scene of the step before the learner's edits.
    pub set_up: Option<Arc<Scene>>,
    /// Number of changes in the history once the step was set up. Undo goes back no farther.
    pub depth: usize,
    /// Panels closed because the lesson doesn't use them, and whether each tab was in front.
    pub closed: Vec<(Panel, bool)>,
    /// Panels opened for a step, which another step or the end of the lesson closes.
    pub opened: Vec<Panel>,
    pub before: Before,
    /// The part of the maps last shown for the challenge, until the learner zooms.
    pub part: Option<MapView>,
    /// Predictions of other steps, by step.
    answered: BTreeMap<usize, Answered>,
}

impl LessonRun {
    /// A lesson at its first step.
    pub fn new(id: String, lesson: Arc<Lesson>, before: Before) -> Self {
        LessonRun { id, lesson, before, ..LessonRun::default() }
    }

    /// The step on screen. A lesson has at least one, and `step` is kept among them.
    pub fn current(&self) -> Option<&Step> {
        self.lesson.steps.get(self.step)
    }

    /// Goes to a step, at most to the last. A prediction made there before comes back.
    pub fn go_to(&mut self, step: usize) {
        if let Some(guess) = self.guess.take() {
            self.answered.insert(self.step, (guess, self.judgement.take()));
        }
        self.step = step.min(self.lesson.steps.len().saturating_sub(1));
        let (guess, judgement) = self.answered.remove(&self.step).unzip();
        (self.guess, self.judgement) = (guess, judgement.flatten());
        (self.measured, self.gave_up, self.part) = (None, false, None);
    }

    /// The part of the maps that the challenge is about; `None` while a prediction is asked for, and where the whole map counts.
    pub fn challenged_part(&self, radar: &Radar, scene: &Scene) -> Option<MapView> {
        let challenge = self.current()?.challenge.as_ref().filter(|_| !self.is_predicting())?;
        part_of(challenge, radar, scene)
    }

    /// Whether the maps are still hidden, since a prediction is asked for.
    pub fn is_predicting(&self) -> bool {
        self.guess.is_none() && self.current().is_some_and(|s| s.predict.is_some())
    }

    /// The map to be clicked, if the prediction is a place in one.
    pub fn clicked_map(&self) -> Option<MapKind> {
        self.asked_map().filter(|_| self.is_predicting())
    }

    /// The map in which the step asks for a place.
    fn asked_map(&self) -> Option<MapKind> {
        let Answer::Click { map, .. } = &self.current()?.predict.as_ref()?.answer else { return None };
        Some(kind_of(*map))
    }

    /// The predicted cell of a map and the true one, as long as the scene and the radar are the step's.
    pub fn places(&self, kind: MapKind, radar: &Radar, scene: &Arc<Scene>) -> Option<(Cell, Cell)> {
        let is_step = self.set_up.as_ref().is_some_and(|set_up| Arc::ptr_eq(set_up, scene));
        let is_asked = self.asked_map() == Some(kind) && self.current()?.radar == *radar;
        let Some(Ok(judged)) = self.judgement.as_ref().filter(|_| is_step && is_asked) else { return None };
        match (self.guess?, judged.truth) {
            (Guess::Place(guess), Truth::Place(truth)) => Some((guess, truth)),
            _ => None,
        }
    }

    pub fn is_met(&self) -> bool {
        self.measured.as_ref().is_some_and(|m| m.as_ref().is_ok_and(|m| m.iter().all(|m| m.holds)))
    }

    /// Whether the learner met the step's challenge.
    pub fn is_solved(&self) -> bool {
        self.is_met() && !self.gave_up && !self.is_predicting()
    }
}
