//! The parts of the window that a lesson needs.

use super::question::Answer;
use super::{Lesson, StepView};

/// The parts that a lesson needs beside scene, radar and the maps of ends and whole array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uses {
    /// A method's output: a question or a challenge measures it, or a step names a method of its own.
    pub output: bool,
    /// A threshold: a question asks for one, or a step detects by a detector.
    pub threshold: bool,
}

impl Uses {
    /// All parts, as without a lesson.
    pub const ALL: Uses = Uses { output: true, threshold: true };
}

impl Lesson {
    /// The parts that the lesson's steps need.
    pub fn uses(&self) -> Uses {
        let usual = StepView::default().method;
        let output = self.steps.iter().any(|step| {
            step.view.method != usual
                || step.predict.as_ref().is_some_and(|question| question.needs_output())
                || step.challenge.as_ref().is_some_and(|c| c.needs_output() || c.needs_hidden_output())
        });
        let threshold = self.steps.iter().any(|step| {
            let asks =
                step.predict.as_ref().is_some_and(|question| matches!(question.answer, Answer::Threshold { .. }));
            asks || step.view.cfar.is_some()
        });
        Uses { output, threshold }
    }
}
