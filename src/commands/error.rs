//! Errors of commands.

use std::error::Error;
use std::fmt::{self, Display};
use std::path::Path;

/// An error of a command, or of a room that it uses. The message names the file or argument, the fault and the expected value.
#[derive(Debug)]
pub struct CommandError(pub String);

impl Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl<E: Error> From<E> for CommandError {
    fn from(error: E) -> Self {
        CommandError(error.to_string())
    }
}

impl CommandError {
    /// For `map_err`: an error about the file `path`.
    pub fn on<E: Display>(path: &Path) -> impl FnOnce(E) -> Self {
        move |source| CommandError(format!("{}: {source}", path.display()))
    }
}
