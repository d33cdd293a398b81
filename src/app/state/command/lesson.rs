//! Commands of lessons: begin, predict, go on, leave.

use crate::lesson::{Guess, Lesson};
use std::path::PathBuf;
use std::sync::Arc;

/// Commands of lessons: begin, predict, go on, leave.
#[derive(Debug, Clone, PartialEq)]
pub enum LessonCommand {
    /// Begin a lesson that comes with the program.
    Begin(usize),
    /// Begin the lesson in this file.
    OpenFile(PathBuf),
    /// Begin a lesson that was read from a file and tried out.
    Take {
        /// What its progress is kept under.
        id: String,
        /// The lesson.
        lesson: Arc<Lesson>,
    },
    /// Go to a step of the lesson, from 0.
    Step(usize),
    /// Predict.
    Predict(Guess),
    /// Put a solution of the challenge on screen; the challenge then counts as unsolved.
    ShowSolution,
    /// Give lessons the whole screen, for a projector, or end that.
    Present,
    /// End the lesson; scene and settings come back.
    Leave,
    /// Another learner takes over.
    SetLearner(String),
    /// Forget what the learner did.
    ForgetProgress,
}
