//! Opening, saving and replacing documents, and the unsaved ones that were replaced.

use crate::interact::{Document, Editor, Restored, Selection, document};
use crate::scene::file::{SceneFileError, SceneFormat};
use std::path::Path;

/// Most unsaved documents that are kept after another took their place; the oldest make room.
const MAX_LEFT: usize = 64;

/// The outcome of writing a document to a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Saved {
    /// The file holds all of it and is its own from now on.
    Whole,
    /// The file holds a copy without the named losses; the document keeps its path, as unsaved as it was.
    Copy(Vec<String>),
}

impl Editor {
    /// The editor of a new window, on the document `asked` for by name, else the unsaved one of the last window that died, else `otherwise`.
    ///
    /// Where both of the first are there, the unsaved one lies one undo step behind. Nothing that was restored is lost: it stays in [`Editor::left`].
    pub fn start(restored: Restored, asked: Option<Document>, otherwise: Document) -> Self {
        let Restored { on_screen, left, .. } = restored;
        let mut editor = match (on_screen, asked) {
            (Some(unsaved), asked) => {
                let mut editor = Editor::of(unsaved);
                if let Some(asked) = asked {
                    editor.open(asked);
                }
                editor
            }
            (None, asked) => Editor::of(asked.unwrap_or(otherwise)),
        };
        editor.left.splice(0..0, left);
        editor
    }

    /// Unsaved documents that another replaced on screen, the latest last.
    pub fn left(&self) -> &[Document] {
        &self.left
    }

    /// The losses of writing the document to `path`; empty for none.
    /// # Errors
    /// [`SceneFileError::Extension`] for a name that says no format.
    pub fn losses(&self, path: &Path) -> Result<Vec<String>, SceneFileError> {
        Ok(self.document.losses(SceneFormat::of_path(path)?))
    }

    /// Whether `path` is the document's own file and has another content than was last read or written here: another window or program wrote it.
    pub fn would_replace_anothers(&self, path: &Path) -> bool {
        self.document.path() == Some(&*document::whole_path(path)) && self.document.is_outdated()
    }

    /// Writes the document to `path`, which is its own file from then on; where the format can't hold all of it, a copy only. A scene over a
    /// recording is written alone: the recording stays as it is.
    ///
    /// Not a step of the history: undo changes the document, not its path.
    /// # Errors
    /// [`SceneFileError`]; the file is then as it was, and the document too.
    pub fn save(&mut self, path: &Path) -> Result<Saved, SceneFileError> {
        let losses = self.losses(path)?;
        self.document.write(&document::whole_path(path))?;
        if !losses.is_empty() {
            // Documents of that path are told that it holds another content now.
            self.note_kept(&Document::read(path)?, &document::whole_path(path));
            return Ok(Saved::Copy(losses));
        }
        self.note_kept(&self.document.clone(), &document::whole_path(path));
        Ok(Saved::Whole)
    }

    fn note_kept(&mut self, kept: &Document, path: &Path) {
        let behind = self.history.documents_mut().chain(&mut self.left);
        behind.chain([&mut self.document]).for_each(|d| d.note_kept(kept, path));
        self.left.retain(Document::is_modified);
    }

    /// Puts another document in the place of this one. Undo brings this one back, path and all.
    pub fn open(&mut self, document: Document) {
        self.cancel_drag();
        let before = self.snapshot();
        self.replace(document);
        self.selection = Selection::default();
        self.history.push(None, before);
        self.history.seal();
        if let Some(path) = self.document.path().filter(|_| !self.is_modified()).map(Path::to_owned) {
            self.note_kept(&self.document.clone(), &path);
        }
    }

    /// Replaces this frame by another of the same recording: the selection stays, and frames that follow one another are one step of undo.
    pub fn open_frame(&mut self, document: Document) {
        self.cancel_drag();
        let before = self.snapshot();
        self.replace(document);
        self.selection.clamp(self.scene().objects.len());
        self.history.push(Some("frame"), before);
    }

    /// Puts the document `id` of [`Editor::left`] back on screen, as one undo step; false where there is none.
    pub fn recover(&mut self, id: u64) -> bool {
        let found = self.left.iter().find(|d| d.id() == id).cloned();
        found.map(|document| self.open(document)).is_some()
    }

    /// Drops the document `id` from [`Editor::left`]: only the history holds its last state then.
    pub fn discard(&mut self, id: u64) {
        self.left.retain(|d| d.id() != id);
    }

    /// Makes `document` the current one, and keeps the one before in [`Editor::left`] if it was unsaved and is another.
    pub(super) fn replace(&mut self, document: Document) {
        let before = std::mem::replace(&mut self.document, document);
        let now = self.document.id();
        if before.id() != now {
            self.left.retain(|d| d.id() != before.id() && d.id() != now);
            self.left.extend(Some(before).filter(Document::is_modified));
            let excess = self.left.len().saturating_sub(MAX_LEFT);
            self.left.drain(..excess);
        }
    }
}
