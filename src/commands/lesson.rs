//! `apertura lesson`: the app on a lesson.

use super::{CommandError, print};
use crate::app::{self, AppError};
use crate::lesson::{Lesson, shipped};
use crate::radar::counted;
use std::path::PathBuf;

/// Begin a lesson: one that comes with the program, or a file
///
/// Reads and checks the lesson, then opens it in the window. Without a display it prints what the lesson contains. docs/lessons.md describes
/// the format.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The lesson: a file (.toml), or the name of a lesson that comes with the program. The beginning of the name is enough where only one lesson
    /// has it
    #[arg(value_name = "FILE|NAME")]
    lesson: PathBuf,

    /// Only check the lesson
    #[arg(long)]
    check: bool,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let (lesson, options) = self.load()?;
        let about = format!("{}: {}. {}", lesson.title, counted(lesson.steps.len(), "step", "steps"), lesson.about);
        if self.check {
            return print(&about);
        }
        match app::run(options) {
            Err(AppError::Window(_)) => print(&about),
            other => Ok(other?),
        }
    }

    fn load(&self) -> Result<(Lesson, app::Options), CommandError> {
        let (lesson, command) =
            match self.lesson.to_str().filter(|name| !name.contains(['.', '/', '\\']) && !self.lesson.exists()) {
                Some(name) => {
                    let index = shipped::by_name(name)?;
                    let lesson = shipped::ALL[index].load()?;
                    (lesson, app::LessonCommand::Begin(index))
                }
                None => {
                    let lesson = Lesson::load(&self.lesson)?;
                    (lesson, app::LessonCommand::OpenFile(self.lesson.clone()))
                }
            };
        Ok((lesson, app::Options { commands: vec![command.into()], ..app::Options::default() }))
    }
}
