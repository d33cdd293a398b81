//! What a subcommand looks at: a scene that is simulated, or a recording.

use super::CommandError;
use crate::recording::{self, Recording};
use crate::scene::file::{self, SceneFile};
use crate::share::{Shared, is_shared};
use std::path::Path;

/// A scene or a recording, as the file says.
#[derive(Debug, Clone)]
pub enum Input {
    /// A scene and the radar that looks at it.
    Scene(Box<SceneFile>),
    /// Samples and the radar that measured them.
    Recording(Box<Recording>),
}

impl Input {
    /// Reads what another copy of the program shared as text, a `.toml` with a table `[recording]` as a recording, anything else as a scene.
    pub fn load(path: &Path) -> Result<Input, CommandError> {
        if let Some(text) = shared_text(path) {
            return Ok(Input::Scene(Box::new(Shared::from_text(text).map_err(CommandError::failed)?.file)));
        }
        if recording::file::is_recording_at(path) {
            return Ok(Input::Recording(Box::new(load_recording(path)?)));
        }
        Ok(Input::Scene(Box::new(file::load(path).map_err(CommandError::failed)?)))
    }
}

/// Reads a recording, and says on standard error what looks wrong about it.
pub fn load_recording(path: &Path) -> Result<Recording, CommandError> {
    let recording = recording::file::load(path).map_err(CommandError::failed)?;
    recording.doubts.iter().for_each(|doubt| eprintln!("note: {}: {doubt}", path.display()));
    Ok(recording)
}

/// The text itself, where it stands in place of a file's name.
pub fn shared_text(path: &Path) -> Option<&str> {
    path.to_str().filter(|text| is_shared(text))
}
