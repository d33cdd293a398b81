//! Files in memory, for a page: named bytes in folders, with the functions of [`std::fs`] that the program uses.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

#[derive(Default)]
struct Tree {
    files: BTreeMap<PathBuf, Arc<[u8]>>,
    folders: BTreeSet<PathBuf>,
}

static TREE: Mutex<Tree> = Mutex::new(Tree { files: BTreeMap::new(), folders: BTreeSet::new() });

fn tree() -> MutexGuard<'static, Tree> {
    super::lock(&TREE)
}

fn missing(path: &Path) -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, format!("there is no file \"{}\"", path.display()))
}

/// Writes a whole file and makes its folders.
pub fn put(path: &Path, bytes: Vec<u8>) {
    let mut tree = tree();
    tree.folders.extend(path.ancestors().skip(1).map(Path::to_path_buf));
    tree.files.insert(path.to_owned(), bytes.into());
}

/// The bytes of a file.
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    tree().files.get(path).map(|bytes| bytes.to_vec()).ok_or_else(|| missing(path))
}

/// The text of a file.
/// # Errors
/// Where there is none, or where it is no UTF-8.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|e| io::Error::new(io::ErrorKind::InvalidData, e))
}

/// Removes a file.
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none.
pub fn remove_file(path: &Path) -> io::Result<()> {
    tree().files.remove(path).map(|_| ()).ok_or_else(|| missing(path))
}

/// Makes a folder; never an error.
pub fn create_dir(path: &Path) -> io::Result<()> {
    create_dir_all(path)
}

/// Makes a folder and those above it; never an error.
pub fn create_dir_all(path: &Path) -> io::Result<()> {
    tree().folders.extend(path.ancestors().map(Path::to_path_buf));
    Ok(())
}

/// Whether there is a file or a folder.
pub fn exists(path: &Path) -> bool {
    let tree = tree();
    tree.files.contains_key(path) || tree.folders.contains(path)
}

/// Whether there is a folder.
pub fn is_dir(path: &Path) -> bool {
    tree().folders.contains(path)
}

/// The path itself: there are no links.
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is neither a file nor a folder.
pub fn canonicalize(path: &Path) -> io::Result<PathBuf> {
    if exists(path) { Ok(path.to_owned()) } else { Err(missing(path)) }
}

/// Kind and length of a file or folder.
#[derive(Debug, Clone, Copy)]
pub struct Metadata {
    bytes: Option<u64>,
}

impl Metadata {
    /// Whether it is a file.
    pub fn is_file(&self) -> bool {
        self.bytes.is_some()
    }

    /// Whether it is a folder.
    pub fn is_dir(&self) -> bool {
        self.bytes.is_none()
    }

    /// Length of a file, in bytes.
    #[allow(clippy::len_without_is_empty, reason = "as std::fs has it")]
    pub fn len(&self) -> u64 {
        self.bytes.unwrap_or(0)
    }
}

/// Kind and length of a file or folder.
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is neither.
pub fn metadata(path: &Path) -> io::Result<Metadata> {
    let tree = tree();
    match tree.files.get(path) {
        Some(bytes) => Ok(Metadata { bytes: Some(bytes.len() as u64) }),
        None if tree.folders.contains(path) => Ok(Metadata { bytes: None }),
        None => Err(missing(path)),
    }
}

/// Entry of a folder.
#[derive(Debug)]
pub struct DirEntry(PathBuf);

impl DirEntry {
    /// Whole path of the entry.
    pub fn path(&self) -> PathBuf {
        self.0.clone()
    }

    /// Its name, without the folder.
    pub fn file_name(&self) -> OsString {
        self.0.file_name().unwrap_or_default().to_owned()
    }
}

/// Entries of a folder.
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is no such folder.
pub fn read_dir(folder: &Path) -> io::Result<impl Iterator<Item = io::Result<DirEntry>> + use<>> {
    let tree = tree();
    if !tree.folders.contains(folder) {
        return Err(missing(folder));
    }
    let inside = |path: &&PathBuf| path.parent() == Some(folder);
    let found: Vec<PathBuf> = tree.files.keys().chain(&tree.folders).filter(inside).cloned().collect();
    Ok(found.into_iter().map(|path| Ok(DirEntry(path))))
}

/// A file open for reading.
#[derive(Debug)]
pub struct File(Cursor<Arc<[u8]>>);

impl File {
    /// Opens a file to read it.
    /// # Errors
    /// [`io::ErrorKind::NotFound`] where there is none.
    pub fn open(path: &Path) -> io::Result<File> {
        tree().files.get(path).map(|bytes| File(Cursor::new(bytes.clone()))).ok_or_else(|| missing(path))
    }

    /// Kind and length of the file; never an error.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata { bytes: Some(self.0.get_ref().len() as u64) })
    }
}

impl Read for File {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.0.read(into)
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read() {
        let path = Path::new("/a/b/one.txt");
        put(path, b"one".to_vec());
        assert_eq!(read_to_string(path).unwrap(), "one");
        let (found, folder) = (metadata(path).unwrap(), metadata(Path::new("/a")).unwrap());
        assert!(found.is_file() && found.len() == 3 && folder.is_dir());
        let mut file = File::open(path).unwrap();
        file.seek(SeekFrom::Start(1)).unwrap();
        let mut rest = String::new();
        file.read_to_string(&mut rest).unwrap();
        assert_eq!(rest, "ne");
    }

    #[test]
    fn a_folder_lists_its_own_entries_alone() {
        put(Path::new("/list/x.toml"), Vec::new());
        put(Path::new("/list/deeper/y.toml"), Vec::new());
        let mut names: Vec<OsString> =
            read_dir(Path::new("/list")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["deeper", "x.toml"]);
    }

    #[test]
    fn what_was_removed_is_missing() {
        let path = Path::new("/gone/one.txt");
        put(path, Vec::new());
        remove_file(path).unwrap();
        assert_eq!(read(path).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert_eq!(remove_file(path).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert!(!exists(path));
    }
}
