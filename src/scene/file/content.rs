//! The content of a scene file, its two formats, and its errors.

use crate::files::ends_in;
use crate::files::npz::NpzError;
use crate::radar::Radar;
use crate::scene::{Scene, SceneError};
use std::io;
use std::path::{Path, PathBuf};

/// Most bytes that a scene file may have: twice what the largest scene takes as TOML.
pub const MAX_FILE_BYTES: u64 = 64 << 20;

/// A scene and the radar that looks at it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneFile {
    pub scene: Scene,
    /// The radar: table 3.1 unless the file says otherwise.
    pub radar: Radar,
}

/// An error of reading or writing a scene file.
#[derive(Debug, thiserror::Error)]
pub enum SceneFileError {
    #[error("{}: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
    #[error("{}: {source}", path.display())]
    Text { path: PathBuf, source: SceneTextError },
    #[error("{}: {source}", path.display())]
    Archive { path: PathBuf, source: NpzError },
    #[error("{}: {source}", path.display())]
    Scene { path: PathBuf, source: SceneError },
    #[error("{}: {source}", path.display())]
    Unwritable { path: PathBuf, source: toml::ser::Error },
    #[error("{}: holds a recording, which a scene must not replace; choose another name", path.display())]
    Recording { path: PathBuf },
    #[error("{}: is laid over a recording: {message}; without its table [over] the scene opens alone", path.display())]
    Over { path: PathBuf, message: String },
    #[error("{}: not a scene file by its name; expected one ending in .toml or .npz", path.display())]
    Extension { path: PathBuf },
}

/// The two kinds of scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneFormat {
    Toml,
    /// Positions only, as the thesis author's program reads and writes them.
    Npz,
}

impl SceneFormat {
    /// The format by the ending of a file's name.
    /// # Errors
    /// [`SceneFileError::Extension`] for any ending but `.toml` and `.npz`.
    pub fn of_path(path: &Path) -> Result<SceneFormat, SceneFileError> {
        let known = [("toml", SceneFormat::Toml), ("npz", SceneFormat::Npz)];
        let found = known.into_iter().find(|(ending, _)| ends_in(path, &[ending]));
        found.map(|(_, format)| format).ok_or_else(|| SceneFileError::Extension { path: path.to_owned() })
    }
}

/// A fault in a scene's text, with its line and column. Objects are counted from 1, as lines are.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct SceneTextError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    pub message: String,
}

impl SceneTextError {
    pub(crate) fn at(text: &str, offset: usize, message: String) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        SceneTextError {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message,
        }
    }
}

pub(super) fn one_line(message: &str) -> String {
    message.lines().collect::<Vec<_>>().join(", ").replace('`', "\"")
}
