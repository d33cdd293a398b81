//! Scene files on disk.

use super::read::from_bytes;
use super::{MAX_FILE_BYTES, SceneFile, SceneFileError, SceneFormat, to_toml, to_toml_beside};
use crate::files::{read_bounded, write_bytes};
use crate::radar::Radar;
use crate::scene::npz;
use serde::Serialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use std::path::Path;

/// Reads a scene file and checks that it can be simulated.
/// # Errors
/// [`SceneFileError`] names the file, the line or key, and what was expected.
pub fn load(path: &Path) -> Result<SceneFile, SceneFileError> {
    Ok(read::<IgnoredAny>(path, None)?.0)
}

/// [`load`], and the table called `key` that [`save_beside`] wrote; `None` where there is none.
/// # Errors
/// As [`load`].
pub fn load_beside<T: DeserializeOwned>(path: &Path, key: &str) -> Result<(SceneFile, Option<T>), SceneFileError> {
    read(path, Some(key))
}

fn read<T: DeserializeOwned>(path: &Path, beside: Option<&str>) -> Result<(SceneFile, Option<T>), SceneFileError> {
    let owned = || path.to_owned();
    match SceneFormat::of_path(path)? {
        SceneFormat::Toml => {
            let bytes =
                read_bounded(path, MAX_FILE_BYTES).map_err(|source| SceneFileError::Io { path: owned(), source })?;
            from_bytes(&bytes, beside).map_err(|source| SceneFileError::Text { path: owned(), source })
        }
        SceneFormat::Npz => {
            let scene = npz::read(path).map_err(|source| SceneFileError::Archive { path: owned(), source })?;
            let radar = Radar::default();
            scene.validate(&radar).map_err(|source| SceneFileError::Scene { path: owned(), source })?;
            Ok((SceneFile { scene, radar }, None))
        }
    }
}

/// Writes a scene file in one step. An `.npz` keeps the reflectors' positions only.
/// # Errors
/// [`SceneFileError`] when the ending is neither `.toml` nor `.npz`, or the file can't be written.
pub fn save(path: &Path, file: &SceneFile) -> Result<(), SceneFileError> {
    let owned = || path.to_owned();
    match SceneFormat::of_path(path)? {
        SceneFormat::Toml => write(path, to_toml(file)),
        SceneFormat::Npz => {
            npz::write(path, &file.scene).map_err(|source| SceneFileError::Archive { path: owned(), source })
        }
    }
}

/// Writes a scene as TOML in one step, with a further table, called `key`, after it.
/// # Errors
/// [`SceneFileError`] when the file can't be written.
pub fn save_beside(path: &Path, file: &SceneFile, key: &str, value: &impl Serialize) -> Result<(), SceneFileError> {
    write(path, to_toml_beside(file, key, value))
}

fn write(path: &Path, text: Result<String, toml::ser::Error>) -> Result<(), SceneFileError> {
    let owned = || path.to_owned();
    let text = text.map_err(|source| SceneFileError::Unwritable { path: owned(), source })?;
    write_bytes(path, text.as_bytes()).map_err(|source| SceneFileError::Io { path: owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_name_themselves() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        assert!(load(&path).unwrap_err().to_string().contains("a.toml"));
        std::fs::write(&path, b"name = \"\xff\"").unwrap();
        assert!(load(&path).unwrap_err().to_string().contains("UTF-8"));
        save(&path, &SceneFile::default()).unwrap();
        assert_eq!(load(&path).unwrap(), SceneFile::default());
    }
}
