//! Commands that open, save and make documents.

use crate::app::state::{LiveFrame, SaveAnswer};
use crate::scene::generate::Kind;
use std::path::PathBuf;

/// Another way to read the file of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// In another of the offered layouts.
    Layout(usize),
    /// At another frame, from 0.
    Frame(u64),
    /// With the antennas of the board of this name.
    Board(&'static str),
}

/// A command that opens, saves or makes a document.
#[derive(Debug, Clone, PartialEq)]
pub enum DocumentCommand {
    /// Open an empty scene.
    New,
    /// Open this scene file.
    OpenPath(PathBuf),
    /// Save the scene in its own file, or ask for one.
    Save,
    /// Save the scene in this file.
    SaveTo(PathBuf),
    /// The answer to a question before a scene is saved.
    AnswerSave(SaveAnswer),
    /// Bring back the unsaved document of this id, which another one replaced.
    Recover(u64),
    /// Discard the unsaved document of this id.
    Discard(u64),
    /// Open the scene preset of this index.
    Preset(usize),
    /// Open the recording preset of this index.
    Recording(usize),
    /// Read the recording's file in another way.
    ReadAnotherWay(Way),
    /// Show the newest frame of the capture card in use.
    ShowFrame(LiveFrame),
    /// Make a random test scene.
    RandomScene(Kind),
    /// Choose the next random scene.
    SetNextRandom {
        /// Seed of the random stream.
        seed: u64,
        /// Number in the stream.
        number: u32,
    },
    /// Open a text that was shared ([`crate::share`]).
    OpenShared(String),
}
