//! The lesson being taken: its step, what was predicted, and what came of it.

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

/// What was predicted in a step, and what that was worth.
type Answered = (Guess, Option<Result<Judgement, String>>);

/// How the window was before a lesson.
pub struct Before {
    /// Scene, radar and settings.
    pub setup: Setup,
    /// The visible part of the scene.
    pub scene_view: SceneView,
    /// The visible part of the maps.
    pub map_views: MapViews,
    /// What the panels were arranged for.
    pub task: Task,
}

/// A lesson in progress.
pub struct LessonRun {
    /// What its progress is kept under.
    pub id: String,
    /// The lesson.
    pub lesson: Arc<Lesson>,
    /// The step, from 0.
    pub step: usize,
    /// What was predicted.
    pub guess: Option<Guess>,
    /// What that was worth, or why it can't be told.
    pub judgement: Option<Result<Judgement, String>>,
    /// The challenge's requirements as they stand, or why they can't be measured.
    pub measured: Option<Result<Vec<Measured>, String>>,
    /// Whether the challenge's solution was shown: then it counts as unsolved.
    pub gave_up: bool,
    /// The scene as the step set it up.
    pub set_up: Option<Arc<Scene>>,
    /// Number of changes in the history once the step was set up: undo goes back no farther.
    pub depth: usize,
    /// Panels that the lesson closed, since it doesn't use them, and whether each tab was in front.
    pub closed: Vec<(Panel, bool)>,
    /// As everything was before the lesson.
    pub before: Before,
    /// The part of the maps that was shown for the challenge last, until the learner zooms.
    pub part: Option<MapView>,
    /// What was predicted in other steps.
    answered: BTreeMap<usize, Answered>,
}

impl LessonRun {
    /// A lesson at its first step.
    pub fn new(id: String, lesson: Arc<Lesson>, before: Before) -> Self {
        LessonRun {
            id,
            lesson,
            step: 0,
            guess: None,
            judgement: None,
            measured: None,
            gave_up: false,
            set_up: None,
            depth: 0,
            closed: Vec::new(),
            before,
            part: None,
            answered: BTreeMap::new(),
        }
    }

    /// The step on screen. A lesson has at least one, and `step` is kept among them.
    pub fn current(&self) -> Option<&Step> {
        self.lesson.steps.get(self.step)
    }

    /// Goes to a step, past the last one to the last. What was predicted there before is still predicted.
    pub fn go_to(&mut self, step: usize) {
        if let Some(guess) = self.guess.take() {
            self.answered.insert(self.step, (guess, self.judgement.take()));
        }
        self.step = step.min(self.lesson.steps.len().saturating_sub(1));
        let (guess, judgement) = self.answered.remove(&self.step).unzip();
        (self.guess, self.judgement) = (guess, judgement.flatten());
        (self.measured, self.gave_up, self.part) = (None, false, None);
    }

    /// The part of the maps that the challenge is about; nothing while a prediction is asked for, and where all of a map counts.
    pub fn challenged_part(&self, radar: &Radar, scene: &Scene) -> Option<MapView> {
        let challenge = self.current()?.challenge.as_ref().filter(|_| !self.is_predicting())?;
        part_of(challenge, radar, scene)
    }

    /// Whether the maps are still hidden, since a prediction is asked for.
    pub fn is_predicting(&self) -> bool {
        self.guess.is_none() && self.current().is_some_and(|s| s.predict.is_some())
    }

    /// The map that is to be clicked, if the prediction is made so.
    pub fn clicked_map(&self) -> Option<MapKind> {
        self.asked_map().filter(|_| self.is_predicting())
    }

    /// The map in which the step asks for a place.
    fn asked_map(&self) -> Option<MapKind> {
        let Answer::Click { map, .. } = &self.current()?.predict.as_ref()?.answer else { return None };
        Some(kind_of(*map))
    }

    /// The place that was guessed in a map and the true one, as long as the scene and the radar are the step's.
    pub fn places(&self, kind: MapKind, radar: &Radar, scene: &Arc<Scene>) -> Option<(Cell, Cell)> {
        let is_step = self.set_up.as_ref().is_some_and(|set_up| Arc::ptr_eq(set_up, scene));
        let is_asked = self.asked_map() == Some(kind) && self.current()?.radar == *radar;
        let Some(Ok(judged)) = self.judgement.as_ref().filter(|_| is_step && is_asked) else { return None };
        match (self.guess?, judged.truth) {
            (Guess::Place(guess), Truth::Place(truth)) => Some((guess, truth)),
            _ => None,
        }
    }

    /// Whether the step's challenge is met.
    pub fn is_met(&self) -> bool {
        self.measured.as_ref().is_some_and(|m| m.as_ref().is_ok_and(|m| m.iter().all(|m| m.holds)))
    }

    /// Whether the learner met the step's challenge.
    pub fn is_solved(&self) -> bool {
        self.is_met() && !self.gave_up && !self.is_predicting()
    }
}
