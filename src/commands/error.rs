//! Errors of commands.

use std::error::Error;
use std::path::{Path, PathBuf};

/// An error of a command. Every message names the file or argument, the fault and the expected value.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // The messages name every field.
pub enum CommandError {
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    /// The arguments make no sense together.
    #[error("{0}")]
    Usage(String),
    /// An error of the room that the subcommand uses.
    #[error("{0}")]
    Failed(Box<dyn Error + Send + Sync>),
    /// An error of the room that the subcommand uses, about a file.
    #[error("{}: {source}", path.display())]
    FailedOn { path: PathBuf, source: Box<dyn Error + Send + Sync> },
}

impl CommandError {
    /// An error of another room.
    pub fn failed(source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        CommandError::Failed(source.into())
    }

    /// For `map_err`: an error of another room, about the file `path`.
    pub fn on<E: Error + Send + Sync + 'static>(path: &Path) -> impl FnOnce(E) -> Self {
        move |source| CommandError::FailedOn { path: path.to_owned(), source: Box::new(source) }
    }
}
