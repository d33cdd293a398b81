//! The input of a subcommand: a scene that is simulated, or a recording.

use super::CommandError;
use crate::platform::console::note;
use crate::recording::raw::boards::{self, Board};
use crate::recording::{self, Recording};
use crate::scene::file::{self, SceneFile};
use crate::share::{SharedScene, is_shared};
use std::path::{Path, PathBuf};

#[derive(Debug, Clone)]
pub enum InputArgs {
    Scene(Box<SceneFile>),
    Recording(Box<Recording>),
}

impl InputArgs {
    /// Reads a shared text as a scene, a `.toml` with a table `[recording]` or a raw capture as a recording, any other file as a scene.
    pub fn load(path: &Path) -> Result<InputArgs, CommandError> {
        InputArgs::load_with(path, None)
    }

    /// [`InputArgs::load`] with the `.cfg` of a raw capture.
    pub fn load_with(path: &Path, config: Option<&Path>) -> Result<InputArgs, CommandError> {
        let shared = shared_text(path);
        if shared.is_none() && recording::file::is_recording_at(path) {
            return Ok(InputArgs::Recording(Box::new(load_recording(path, config)?)));
        }
        let scene = match shared {
            Some(text) => SharedScene::from_text(text)?.file,
            None => file::load(path)?,
        };
        check_no_config(path, config)?;
        Ok(InputArgs::Scene(Box::new(scene)))
    }
}

/// Refuses to write over the file `input`, or over the samples that a recording's TOML names: a measurement can't be made again.
pub fn check_kept(input: &Path, output: &Path) -> Result<(), CommandError> {
    let Ok(there) = std::fs::canonicalize(output) else { return Ok(()) };
    let data = recording::file::data_path(input);
    let is_read = |path: &Path| std::fs::canonicalize(path).is_ok_and(|path| path == there);
    match is_read(input) || data.is_some_and(|path| is_read(&path)) {
        true => Err(CommandError::on(output)("holds what this command reads; expected another name to write to")),
        false => Ok(()),
    }
}

/// The `.cfg` of a raw capture.
#[derive(Debug, clap::Args)]
pub struct ConfigArg {
    /// Raw capture: the .cfg that set the radar up [default: the one of the same name beside it, or the only one there]
    #[arg(long, value_name = "CFG")]
    pub config: Option<PathBuf>,
}

/// Refuses the `.cfg` of a raw capture beside the file `path`, which is none.
pub fn check_no_config(path: &Path, config: Option<&Path>) -> Result<(), CommandError> {
    let message = "--config is that of a raw capture or an array; expected one as input";
    config.map_or(Ok(()), |_| Err(CommandError::on(path)(message)))
}

/// Reads a recording, and prints warnings about it on standard error; `config` is the `.cfg` of a raw capture.
pub fn load_recording(path: &Path, config: Option<&Path>) -> Result<Recording, CommandError> {
    if !recording::raw::is_raw_at(path) {
        check_no_config(path, config)?;
    }
    let recording = match config {
        None => recording::file::load(path),
        Some(config) => recording::raw::open(path, Some(config)),
    }?;
    print_doubts(path, &recording.doubts);
    Ok(recording)
}

/// Prints the doubts about the file `path` on standard error.
pub fn print_doubts(path: &Path, doubts: &[String]) {
    doubts.iter().for_each(|doubt| note(&format!("note: {}: {doubt}", path.display())));
}

pub fn load_board(name: &str) -> Result<&'static Board, CommandError> {
    boards::by_name(name).ok_or_else(|| {
        let names: Vec<&str> = boards::ALL.iter().map(|b| b.name).collect();
        CommandError(format!("--board {name}: no such board is known; expected {}", names.join(", ")))
    })
}

/// The text itself, where it stands in place of a file's name.
pub fn shared_text(path: &Path) -> Option<&str> {
    path.to_str().filter(|text| is_shared(text))
}
