//! A question before a scene is written to a file that can't hold all of it.

use crate::scene::file::Loss;
use std::path::PathBuf;

/// What would be written where, and what would be lost.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LossySave {
    /// The file.
    pub path: PathBuf,
    /// What it would not give back.
    pub losses: Vec<Loss>,
}

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossyAnswer {
    /// Write a copy without what can't be held.
    Anyway,
    /// Write all of it to a TOML file.
    AsToml,
    /// Write nothing.
    Cancel,
}
