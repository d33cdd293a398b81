//! Commands of lessons: begin, predict, go on, leave.

use crate::lesson::{Guess, Lesson};
use std::path::PathBuf;
use std::sync::Arc;

/// A command of lessons: begin, predict, go on, leave.
#[derive(Debug, Clone, PartialEq)]
pub enum LessonCommand {
    /// Begin a lesson that comes with the program.
    Begin(usize),
    /// Begin the lesson in this file.
    OpenFile(PathBuf),
    /// Begin a lesson that was read from a file and tried out.
    Take {
        /// Key under which its progress is kept.
        id: String,
        /// The lesson.
        lesson: Arc<Lesson>,
    },
    /// Go to a step of the lesson, from 0.
    Step(usize),
    /// Answer the step's question.
    Predict(Guess),
    /// Put a solution of the challenge on screen; the challenge then counts as unsolved.
    ShowSolution,
    /// Give the lesson the whole screen, for a projector, or end that.
    Present,
    /// End the lesson; scene and settings come back.
    Leave,
    /// Switch to the progress of another learner.
    SetLearner(String),
    /// Delete the learner's progress.
    ForgetProgress,
}
