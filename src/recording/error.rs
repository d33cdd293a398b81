//! Errors of recordings, with the file they are in.

use crate::files::hdf5::Hdf5Error;
use crate::files::npz::NpzError;
use crate::radar::{RadarError, counted};
use crate::scene::file::SceneTextError;
use std::io;
use std::path::{Path, PathBuf};

/// An error of reading a recording, with its file.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct RecordingError {
    /// The file.
    pub path: PathBuf,
    /// The fault.
    pub fault: Fault,
}

/// A fault in one of a recording's files.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum Fault {
    /// The system could not read it.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The TOML can't be understood.
    #[error("{0}")]
    Text(#[from] SceneTextError),
    /// A key has a value that can't be used, or is missing.
    #[error("{key} {found}; expected {expected}")]
    Key { key: String, found: String, expected: String },
    #[error("{0}")]
    Radar(#[from] RadarError),
    #[error("{0}")]
    Npz(#[from] NpzError),
    #[error("{0}")]
    Hdf5(#[from] Hdf5Error),
    /// Samples that can't be read, or contradict the text or the `.cfg`: the whole message.
    #[error("{0}")]
    Data(String),
}

impl Fault {
    pub(super) fn key(key: &str, found: impl Into<String>, expected: impl Into<String>) -> Fault {
        Fault::Key { key: key.to_owned(), found: found.into(), expected: expected.into() }
    }

    /// The error of `found` elements, samples or pairs (the noun for one, and for many) in an array of this shape.
    pub(super) fn count([one, many]: [&str; 2], found: usize, expected: &str, shape: (usize, usize)) -> Fault {
        let (elements, samples) = (counted(shape.0, "element", "elements"), counted(shape.1, "sample", "samples"));
        let found = counted(found, one, many);
        Fault::Data(format!("holds {found}; expected {expected} (it is read as {elements} by {samples})"))
    }

    pub(super) fn of(self, path: &Path) -> RecordingError {
        RecordingError { path: path.to_owned(), fault: self }
    }
}
