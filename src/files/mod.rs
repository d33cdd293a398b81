//! Files that are either whole or not there, and NumPy archives with errors that name the key.

pub mod entries;
pub mod hdf5;
pub mod kind;
pub mod memory;
pub mod npy;
pub mod npz;
mod number;
pub mod sha256;

pub use number::{NumberKind, Numbers};

use crate::platform::fs::{self, Draft, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

/// Whether the name of `path` has one of these endings, in small or capital letters.
pub fn ends_in(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|e| endings.iter().any(|ending| e.eq_ignore_ascii_case(ending)))
}

/// The folder that `path` stands in.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Writes a file in one step: `write` fills a temporary file beside `path`, which then takes its place. A reader sees the
/// old file or the new one, never a part; on any error the old one stays as it was.
/// # Errors
/// The error of `write`, or an [`io::Error`]: the folder is missing, `path` is a folder, a device or a pipe, the disk is full.
pub fn write_atomically<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<Draft>) -> Result<(), E>,
) -> Result<(), E> {
    let path = destination(path)?;
    let folder = folder_of(&path);
    if !fs::is_dir(folder) {
        let message = format!("there is no folder \"{}\" to write into", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, message).into());
    }
    let draft = Draft::begin(folder, &path).map_err(|e| unwritable(folder, &e))?;
    let mut out = BufWriter::new(draft);
    write(&mut out)?;
    out.into_inner().map_err(io::IntoInnerError::into_error)?.persist(&path)?;
    Ok(())
}

/// [`write_atomically`] for text or bytes that are ready.
/// # Errors
/// As [`write_atomically`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_atomically(path, |out| out.write_all(bytes))
}

/// Makes the folder `path`, and those above it, where they are missing.
/// # Errors
/// An [`io::Error`]: `path` or one above it is no folder, or the system makes none.
pub fn make_folder(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path).map_err(|error| {
        let is_file = |part: &&Path| fs::metadata(part).is_ok_and(|found| !found.is_dir());
        let message = match path.ancestors().find(is_file) {
            None => return error,
            Some(part) if part == path => "is a file; expected a folder".to_owned(),
            Some(part) => format!("\"{}\" is a file; expected a folder", part.display()),
        };
        io::Error::new(io::ErrorKind::NotADirectory, message)
    })
}

/// The error of a folder that takes no file. The system's message would name the temporary file.
fn unwritable(folder: &Path, error: &io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("nothing can be written into the folder \"{}\": {}", folder.display(), error.kind()),
    )
}

/// Reads a file of at most `most` bytes.
/// # Errors
/// An [`io::Error`]: [`io::ErrorKind::FileTooLarge`] for a longer file, [`io::ErrorKind::InvalidInput`] for a folder, a device or a pipe, which may
/// never end.
pub fn read_bounded(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    if !found.is_file() {
        return Err(no_file(found.is_dir(), "a file"));
    }
    let too_large = |bytes| {
        let message = format!("has {bytes} bytes; files of at most {most} bytes are read here");
        io::Error::new(io::ErrorKind::FileTooLarge, message)
    };
    if found.len() > most {
        return Err(too_large(found.len()));
    }
    let mut bytes = Vec::with_capacity(found.len() as usize);
    // The file may grow while it is read.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(bytes.len() as u64)) } else { Ok(bytes) }
}

/// The first `most` bytes of a file, or all that it has.
/// # Errors
/// As [`read_bounded`], but for the length.
pub fn read_start(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "is no file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn no_file(is_folder: bool, expected: &str) -> io::Error {
    let what = if is_folder { "a folder" } else { "a device or pipe" };
    io::Error::new(io::ErrorKind::InvalidInput, format!("is {what}; expected {expected}"))
}

fn destination(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => fs::canonicalize(path),
        Ok(found) => Err(no_file(found.is_dir(), "the name of a file")),
        Err(_) => Ok(path.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_or_endless_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_bytes(&path, &[7; 100]).unwrap();
        assert_eq!(read_bounded(&path, 100).unwrap(), [7; 100]);
        assert!(read_bounded(&path, 99).unwrap_err().to_string().contains("has 100 bytes"));
        assert!(read_bounded(folder.path(), 99).unwrap_err().to_string().contains("is a folder"));
        #[cfg(unix)]
        assert!(read_bounded(Path::new("/dev/zero"), 99).unwrap_err().to_string().contains("device"));
    }

    #[test]
    fn unusable_destinations_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_bytes(folder.path(), b"").unwrap_err().to_string().contains("folder"));
        let message = write_bytes(&folder.path().join("no/where.txt"), b"").unwrap_err().to_string();
        assert!(message.contains("there is no folder"), "{message}");
        let file = folder.path().join("file");
        write_bytes(&file, b"").unwrap();
        let told = |path: &Path| make_folder(path).unwrap_err().to_string();
        assert_eq!(told(&file), "is a file; expected a folder");
        assert_eq!(told(&file.join("new")), format!("\"{}\" is a file; expected a folder", file.display()));
        make_folder(&folder.path().join("new/deep")).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_permissions() {
        use std::fs::Permissions;
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::fs::write(&file, "old").unwrap();
        std::fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        write_bytes(&link, b"new").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }
}
