//! A question before a scene is written to a file.

use crate::scene::file::FileLoss;
use std::path::PathBuf;

/// What would be written where, and what speaks against it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SaveQuestion {
    /// The file.
    pub path: PathBuf,
    /// Why it isn't written at once.
    pub doubt: Doubt,
}

/// Why a file isn't written at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Doubt {
    /// It would not give these back.
    Losses(Vec<FileLoss>),
    /// Another program has written something else to it.
    Changed,
}

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SaveAnswer {
    /// Write it, and lose what must be lost.
    Anyway,
    /// Write all of it to another file.
    Elsewhere,
    /// Write nothing.
    Cancel,
}
