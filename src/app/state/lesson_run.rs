//! The lesson being taken: its step, what was predicted, and what came of it.

use super::guided::Setup;
use super::panel::MapKind;
use crate::lesson::question::Answer;
use crate::lesson::{Guess, Judgement, Lesson, MapName, Measured, Step};
use std::sync::Arc;

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
    /// As everything was before the lesson.
    pub before: Setup,
}

impl LessonRun {
    /// A lesson at its first step.
    pub fn new(id: String, lesson: Lesson, before: Setup) -> Self {
        LessonRun { id, lesson: Arc::new(lesson), step: 0, guess: None, judgement: None, measured: None, before }
    }

    /// The step on screen. A lesson has at least one, and `step` is kept among them.
    pub fn current(&self) -> Option<&Step> {
        self.lesson.steps.get(self.step)
    }

    /// Goes to a step; past the last one stays there.
    pub fn go_to(&mut self, step: usize) {
        self.step = step.min(self.lesson.steps.len().saturating_sub(1));
        (self.guess, self.judgement, self.measured) = (None, None, None);
    }

    /// Whether the maps are still hidden, since a prediction is asked for.
    pub fn is_predicting(&self) -> bool {
        self.guess.is_none() && self.current().is_some_and(|s| s.predict.is_some())
    }

    /// The map that is to be clicked, if the prediction is made so.
    pub fn clicked_map(&self) -> Option<MapKind> {
        let question = self.current()?.predict.as_ref().filter(|_| self.is_predicting())?;
        let Answer::Click { map, .. } = &question.answer else { return None };
        Some(match map {
            MapName::Input0 => MapKind::Input0,
            MapName::Input1 => MapKind::Input1,
            MapName::Target => MapKind::Target,
            MapName::Output => MapKind::Output,
        })
    }

    /// Whether the step's challenge is met.
    pub fn is_met(&self) -> bool {
        self.measured.as_ref().is_some_and(|m| m.as_ref().is_ok_and(|m| m.iter().all(|m| m.holds)))
    }
}
