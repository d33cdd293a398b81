//! What makes a command fail.

use std::error::Error;
use std::path::{Path, PathBuf};

/// Why a command failed. Every message names the file or argument, what is wrong with it and what was expected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The arguments make no sense together.
    #[error("{0}")]
    Usage(String),
    /// The error of a subcommand's own room.
    #[error("{0}")]
    Failed(Box<dyn Error + Send + Sync>),
    /// The same, about a file.
    #[error("{}: {source}", path.display())]
    FailedOn {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<dyn Error + Send + Sync>,
    },
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
