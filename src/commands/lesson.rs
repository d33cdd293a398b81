//! `apertura lesson`: the app on a lesson.

use super::{CommandError, print};
use crate::app::{self, AppError};
use crate::lesson::Lesson;
use crate::radar::counted;
use std::path::PathBuf;

/// Begin a lesson from a file
///
/// Reads and checks the lesson, then opens it in the window. Without a display it prints what the lesson contains. docs/lessons.md describes
/// the format.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The lesson (.toml)
    file: PathBuf,

    /// Only check the file
    #[arg(long)]
    check: bool,
}

impl Args {
    /// Opens the lesson.
    pub fn run(self) -> Result<(), CommandError> {
        let lesson = Lesson::load(&self.file).map_err(CommandError::failed)?;
        let about = format!("{}: {}. {}", lesson.title, counted(lesson.steps.len(), "step", "steps"), lesson.about);
        if self.check {
            return print(&about);
        }
        match app::run(app::Options { lesson: Some(self.file), ..app::Options::default() }) {
            Err(AppError::Window(_)) => print(&about),
            other => other.map_err(CommandError::failed),
        }
    }
}
