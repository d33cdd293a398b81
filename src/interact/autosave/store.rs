//! The files of one slot: reading them, and writing the documents of a plan.

use crate::files::read_bounded;
use crate::interact::{Document, Editor, Restored};
use crate::platform::{self, fs};
use crate::scene::file::{self, MAX_FILE_BYTES, SceneFileError};
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

const TABLE: &str = "document";

/// The table of an autosaved scene that names its own file, or the recording that it is laid over.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    /// Path of the document's own file. A path that is not Unicode is not kept: the document comes back untitled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    path: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    recording: Option<String>,
}

/// The documents that the files are to hold: the one on screen where it is unsaved, and unsaved ones before it.
#[derive(Debug, Clone)]
pub(super) struct StartPlan {
    on_screen: Option<Document>,
    /// Unsaved documents that another replaced on screen, the latest last.
    left: Vec<Document>,
}

impl StartPlan {
    pub(super) fn of(editor: &Editor) -> StartPlan {
        let on_screen = editor.is_modified().then(|| editor.document().clone());
        StartPlan { on_screen, left: editor.left().to_vec() }
    }

    fn documents(&self) -> impl Iterator<Item = &Document> {
        self.left.iter().chain(&self.on_screen)
    }

    pub(super) fn is_same(&self, other: &StartPlan) -> bool {
        self.has_same_documents(other) && self.documents().zip(other.documents()).all(|(a, b)| a.untouched_since(b))
    }

    pub(super) fn has_same_documents(&self, other: &StartPlan) -> bool {
        self.left.len() == other.left.len()
            && self.on_screen.is_some() == other.on_screen.is_some()
            && self.documents().zip(other.documents()).all(|(a, b)| a.id() == b.id())
    }
}

/// A document that another replaced on screen, and the file of its copy.
#[derive(Debug)]
struct Behind {
    number: u64,
    document: Document,
}

/// The files of one slot. Clones share them.
#[derive(Debug, Clone)]
pub(super) struct AutosaveStore {
    folder: PathBuf,
    stem: String,
    behind: Arc<Mutex<Vec<Behind>>>,
}

impl AutosaveStore {
    pub(super) fn new(folder: &Path, stem: String) -> AutosaveStore {
        AutosaveStore { folder: folder.to_owned(), stem, behind: Arc::default() }
    }

    fn on_screen_path(&self) -> PathBuf {
        self.folder.join(format!("{}.toml", self.stem))
    }

    fn behind_path(&self, number: u64) -> PathBuf {
        self.folder.join(format!("{}.behind-{number}.toml", self.stem))
    }

    fn behind_numbers(&self) -> Vec<u64> {
        let prefix = format!("{}.behind-", self.stem);
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let names = entries.filter_map(|e| e.file_name().into_string().ok());
        let number = |name: String| name.strip_prefix(&prefix)?.strip_suffix(".toml")?.parse().ok();
        let mut numbers: Vec<u64> = names.filter_map(number).collect();
        numbers.sort_unstable();
        numbers
    }

    pub(super) fn has_copies(&self) -> bool {
        fs::exists(&self.on_screen_path()) || !self.behind_numbers().is_empty()
    }

    pub(super) fn restore(&self) -> Restored {
        let mut restored = Restored::default();
        let mut behind = Vec::new();
        for number in self.behind_numbers() {
            let path = self.behind_path(number);
            match read(&path) {
                Ok(document) => behind.push(Behind { number, document }),
                Err(error) => restored.problems.push(set_aside(&path, &error)),
            }
        }
        let path = self.on_screen_path();
        if fs::exists(&path) {
            match read(&path) {
                // A kill between two files leaves a document in both.
                Ok(document) if behind.iter().any(|b| b.document.same_as(&document)) => {}
                Ok(document) => restored.on_screen = Some(document),
                Err(error) => restored.problems.push(set_aside(&path, &error)),
            }
        }
        restored.left = behind.iter().map(|b| b.document.clone()).collect();
        *platform::lock(&self.behind) = behind;
        restored
    }

    /// Writes the documents of `plan` and then deletes other files, so that at no moment a document is in no file.
    pub(super) fn carry_out(&self, plan: &StartPlan) -> Result<(), String> {
        if plan.documents().next().is_some() {
            fs::create_dir_all(&self.folder).map_err(|e| format!("{}: {e}", self.folder.display()))?;
        }
        let mut behind = platform::lock(&self.behind);
        for document in &plan.left {
            if behind.iter().any(|b| b.document.untouched_since(document)) {
                continue;
            }
            let number = behind.iter().map(|b| b.number).chain(self.behind_numbers()).max().map_or(1, |n| n + 1);
            write(&self.behind_path(number), document).map_err(|e| e.to_string())?;
            behind.push(Behind { number, document: document.clone() });
        }
        let path = self.on_screen_path();
        match &plan.on_screen {
            Some(document) => write(&path, document).map_err(|e| e.to_string())?,
            None => remove(&path)?,
        }
        while let Some(stale) = behind.iter().position(|b| !plan.left.iter().any(|d| b.document.untouched_since(d))) {
            remove(&self.behind_path(behind[stale].number))?;
            behind.remove(stale);
        }
        Ok(())
    }
}

fn write(path: &Path, document: &Document) -> Result<(), SceneFileError> {
    let kept = Kept {
        path: document.path().and_then(Path::to_str).map(str::to_owned),
        recording: document.recording_source().map(str::to_owned),
    };
    file::save_beside(path, &document.to_file(), TABLE, &kept)
}

fn read(path: &Path) -> Result<Document, SceneFileError> {
    let io = |source| SceneFileError::Io { path: path.to_owned(), source };
    let bytes = read_bounded(path, MAX_FILE_BYTES).map_err(io)?;
    let text = String::from_utf8(bytes).map_err(|e| io(std::io::Error::other(e.utf8_error())))?;
    let (file, kept) = file::from_toml_beside::<Kept>(&text, TABLE)
        .map_err(|source| SceneFileError::Text { path: path.to_owned(), source })?;
    let Kept { path: own, recording } = kept.unwrap_or_default();
    let mut document = Document::unsaved(own.as_deref().map(Path::new), file);
    if let Some(source) = recording
        && let Err(error) = document.lay_over(&source)
    {
        tracing::warn!("a scene comes back without the recording it was laid over: {error}");
    }
    Ok(document)
}

fn remove(path: &Path) -> Result<(), String> {
    match fs::remove_file(path) {
        Err(error) if ![ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) => {
            Err(format!("{}: {error}", path.display()))
        }
        _ => Ok(()),
    }
}

fn set_aside(path: &Path, error: &SceneFileError) -> String {
    let free = (1u32..).map(|n| path.with_extension(format!("broken-{n}.txt"))).find(|p| !fs::exists(p));
    match free.filter(|aside| fs::rename(path, aside).is_ok()) {
        Some(aside) => format!("{error}; it was kept as {}", aside.display()),
        None => error.to_string(),
    }
}
