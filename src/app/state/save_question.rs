//! A question before a scene is written to a file.

use std::path::PathBuf;

/// A file to be written, and the doubt about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SaveQuestion {
    pub path: PathBuf,
    pub doubt: Doubt,
}

/// The reason why a file isn't written at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Doubt {
    /// The file would lose these parts of the scene.
    Losses(Vec<String>),
    /// Another program has changed the file.
    Changed,
}

/// The user's answer to the question.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SaveAnswer {
    /// Write the file without the parts that it would lose.
    Anyway,
    /// Write the whole scene to another file.
    Elsewhere,
    Cancel,
}
