//! Commands that put another scene on screen, or this one in a file.

use crate::app::state::{LiveFrame, SaveAnswer};
use crate::scene::generate::Kind;
use std::path::PathBuf;

/// Another way to read the file of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// By this of the layouts that are offered.
    Layout(usize),
    /// Another frame, from 0.
    Frame(u64),
    /// With the antennas of the board of this name.
    Board(&'static str),
}

/// Commands that put another scene on screen, or this one in a file.
#[derive(Debug, Clone, PartialEq)]
pub enum DocumentCommand {
    /// Start with an empty scene.
    New,
    /// Open this scene file.
    OpenPath(PathBuf),
    /// Save the scene where it came from, or ask where.
    Save,
    /// Save the scene in this file.
    SaveTo(PathBuf),
    /// Whether the scene is saved in a file that can't hold all of it, or that another program has written to.
    AnswerSave(SaveAnswer),
    /// Put this unsaved document, which another took the place of, on screen again.
    Recover(u64),
    /// Give this unsaved document up.
    Discard(u64),
    /// Open a scene that comes with the program.
    Preset(usize),
    /// Open a recording that comes with the program.
    Recording(usize),
    /// Read the file of the recording another way.
    ReadAnotherWay(Way),
    /// Show the newest frame of the capture card that is listened to.
    ShowFrame(LiveFrame),
    /// Make a random test scene.
    RandomScene(Kind),
    /// Which random scene is next.
    SetNextRandom {
        /// Seed of its stream.
        seed: u64,
        /// Its number in the stream.
        number: u32,
    },
    /// Open such a text.
    OpenShared(String),
}
