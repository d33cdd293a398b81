//! The document: a scene and its radar, their file, and the content that is on disk.
//!
//! Undo, the autosave and the window's title all use it. It is shared and never changed in place: an edit makes another.

use crate::platform::fs;
use crate::radar::Radar;
use crate::recording::{self, Recording, RecordingError, presets};
use crate::scene::Scene;
use crate::scene::file::{self, SceneFile, SceneFileError, SceneFormat};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Clone, PartialEq, Default)]
struct Content {
    scene: Arc<Scene>,
    radar: Arc<Radar>,
}

impl Content {
    fn of(file: SceneFile) -> Self {
        Content { scene: Arc::new(file.scene), radar: Arc::new(file.radar) }
    }

    fn same(&self, other: &Content) -> bool {
        (Arc::ptr_eq(&self.scene, &other.scene) || self.scene == other.scene) && self.radar == other.radar
    }
}

/// A scene and its radar, with their path and the content that was saved.
///
/// Cheap to clone. Two documents are the same one, at different times, where their [`Document::id`] is the same.
#[derive(Debug, Clone)]
pub struct Document {
    id: u64,
    content: Content,
    path: Option<Arc<Path>>,
    /// The content on disk, or one that can be made again as easily; `None` for none.
    saved: Option<Content>,
    measured: Option<Measured>,
}

/// Name of the table of a scene file that names the recording under the scene.
const BACKGROUND_TABLE: &str = "over";

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Over {
    recording: String,
}

fn recording_source(path: &Path, name: &str) -> String {
    let is_shipped = presets::Preset::by_id(name).is_some();
    let beside = || path.parent().map(|folder| folder.join(name).to_string_lossy().into_owned());
    if is_shipped { name.to_owned() } else { beside().unwrap_or_else(|| name.to_owned()) }
}

/// A recording in place of the scene's echoes: the scene lies over it.
#[derive(Debug, Clone)]
struct Measured {
    recording: Arc<Recording>,
    /// The path of its TOML, or the name of the preset.
    source: Arc<str>,
}

impl Measured {
    fn again(source: &str) -> Result<Self, RecordingError> {
        let recording = match presets::Preset::by_id(source) {
            Some(preset) => preset.load()?,
            None => recording::file::load(Path::new(source))?,
        };
        Ok(Measured { recording: Arc::new(recording), source: source.into() })
    }
}

impl Default for Document {
    fn default() -> Self {
        Document::shipped(SceneFile::default())
    }
}

impl Document {
    fn new(content: Content, path: Option<Arc<Path>>, saved: Option<Content>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Document { id: NEXT.fetch_add(1, Ordering::Relaxed), content, path, saved, measured: None }
    }

    /// A scene that comes with the program: untitled and never unsaved.
    pub fn shipped(file: SceneFile) -> Self {
        let content = Content::of(file);
        Document::new(content.clone(), None, Some(content))
    }

    /// Reads the document at `path`.
    /// # Errors
    /// [`SceneFileError`] names the file, the line or key, and what was expected.
    pub fn read(path: &Path) -> Result<Self, SceneFileError> {
        let (file, over) = file::load_beside::<Over>(path, BACKGROUND_TABLE)?;
        let path = whole_path(path);
        let mut document = Document::opened(&path, file);
        if let Some(Over { recording }) = over {
            let unlike = "its radar is another than the scene's".to_owned();
            let laid = document.lay_over(&recording_source(&path, &recording)).map_err(|e| e.to_string());
            let fits = |d: &Document| d.recording().is_some_and(|r| r.fits(d.radar()));
            laid.and_then(|()| if fits(&document) { Ok(()) } else { Err(format!("{recording}: {unlike}")) })
                .map_err(|message| SceneFileError::Over { path, message })?;
        }
        Ok(document)
    }

    /// Writes the document to `path`, a whole path, as a scene; with the name of the recording under it, where the format has room.
    /// # Errors
    /// [`SceneFileError`]; the file is then as it was. A recording is never replaced.
    pub(super) fn write(&self, path: &Path) -> Result<(), SceneFileError> {
        let own = self.recording_source().map(Path::new);
        let is_data = own.is_some_and(|own| recording::file::data_path(own).is_some_and(|d| whole_path(&d) == path));
        if is_data || recording::file::is_recording_at(path) {
            return Err(SceneFileError::Recording { path: path.to_owned() });
        }
        match own.filter(|_| SceneFormat::of_path(path).is_ok_and(|f| f == SceneFormat::Toml)) {
            None => file::save(path, &self.to_file()),
            Some(own) => {
                let name = own.file_name().filter(|_| own.parent() == path.parent()).map_or(own, Path::new);
                let over = Over { recording: name.to_string_lossy().into_owned() };
                file::save_beside(path, &self.to_file(), BACKGROUND_TABLE, &over)
            }
        }
    }

    pub(super) fn losses(&self, format: SceneFormat) -> Vec<String> {
        let mut losses = format.losses(&self.to_file());
        if format == SceneFormat::Npz && self.measured.is_some() {
            losses.push("the recording that it is laid over".to_owned());
        }
        losses
    }

    /// The document's path, or the path of a scene beside the recording that it is laid over.
    pub fn likely_path(&self) -> Option<PathBuf> {
        let beside = |recording: &str| {
            let recording = Path::new(recording);
            let stem = recording.file_stem().unwrap_or_default().to_string_lossy();
            recording.with_file_name(format!("{stem}-overlay.toml"))
        };
        self.path().map(Path::to_path_buf).or_else(|| self.recording_source().map(beside))
    }

    /// A document that was read from `path`, a whole path without links.
    pub fn opened(path: &Path, file: SceneFile) -> Self {
        let content = Content::of(file);
        Document::new(content.clone(), Some(path.into()), Some(content))
    }

    /// A document that is nowhere on disk, or an autosave's copy of the one at `path`, which differs from the file.
    pub fn unsaved(path: Option<&Path>, file: SceneFile) -> Self {
        Document::new(Content::of(file), path.map(Arc::from), None)
    }

    /// An empty scene over the recording whose TOML is `path`.
    /// # Errors
    /// [`RecordingError`] names the file, the key or the array, and what was expected of it.
    pub fn read_recording(path: &Path) -> Result<Self, RecordingError> {
        Measured::again(&whole_path(path).to_string_lossy()).map(Document::over)
    }

    /// An empty scene over a recording that comes with the program.
    /// # Errors
    /// None for the presets there are.
    pub fn shipped_recording(preset: &presets::Preset) -> Result<Self, RecordingError> {
        Measured::again(preset.id).map(Document::over)
    }

    /// An empty scene over a frame of a capture card, whose `.cfg` is `config`.
    pub fn of_frame(recording: Recording, config: &Path) -> Self {
        let source = whole_path(config).to_string_lossy().as_ref().into();
        Document::over(Measured { recording: Arc::new(recording), source })
    }

    fn over(measured: Measured) -> Self {
        let Recording { name, notes, radar, .. } = &*measured.recording;
        let scene = Scene { name: name.clone(), notes: notes.clone(), ..Scene::default() };
        let document = Document::shipped(SceneFile { scene, radar: radar.clone() });
        Document { measured: Some(measured), ..document }
    }

    pub(super) fn lay_over(&mut self, source: &str) -> Result<(), RecordingError> {
        self.measured = Some(Measured::again(source)?);
        Ok(())
    }

    /// The document over `recording`, reread from the same file, with the same scene where the radar stays the same; `None` without a recording.
    pub fn reread(&self, recording: Recording) -> Option<Self> {
        let before = self.measured.as_ref()?;
        let is_same_radar = recording.radar == before.recording.radar;
        let measured = Measured { recording: Arc::new(recording), source: before.source.clone() };
        if !is_same_radar {
            return Some(Document::over(measured));
        }
        let document = Document::new(self.content.clone(), self.path.clone(), self.saved.clone());
        Some(Document { measured: Some(measured), ..document })
    }

    /// The recording in place of the scene's echoes, if there is one.
    pub fn recording(&self) -> Option<&Arc<Recording>> {
        self.measured.as_ref().map(|m| &m.recording)
    }

    pub(super) fn recording_source(&self) -> Option<&str> {
        self.measured.as_ref().map(|m| &*m.source)
    }

    /// Number of the document, the same through all its edits.
    pub fn id(&self) -> u64 {
        self.id
    }

    pub fn scene(&self) -> &Arc<Scene> {
        &self.content.scene
    }

    pub fn radar(&self) -> &Arc<Radar> {
        &self.content.radar
    }

    /// Path of the document's file; `None` where it has none yet.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    pub fn name(&self) -> String {
        let name = self.path().or(self.recording_source().map(Path::new)).and_then(Path::file_name);
        let of_scene = || match self.scene().name.as_str() {
            "" => "untitled".to_owned(),
            name => name.to_owned(),
        };
        name.map_or_else(of_scene, |n| n.to_string_lossy().into_owned())
    }

    /// The document's name, with a mark while it is unsaved.
    pub fn title(&self) -> String {
        format!("{}{}", self.name(), if self.is_modified() { " •" } else { "" })
    }

    /// Whether it differs from what is on disk.
    pub fn is_modified(&self) -> bool {
        !self.saved.as_ref().is_some_and(|saved| saved.same(&self.content))
    }

    /// Whether the document's file is there with another content than was last read or written here; false after a restart, which forgets that.
    pub(super) fn is_outdated(&self) -> bool {
        let (Some(path), Some(saved)) = (self.path(), &self.saved) else { return false };
        fs::exists(path) && !Document::read(path).is_ok_and(|on_disk| on_disk.content.same(saved))
    }

    /// The document as a file holds it.
    pub fn to_file(&self) -> SceneFile {
        SceneFile { scene: Scene::clone(self.scene()), radar: Radar::clone(self.radar()) }
    }

    pub(super) fn same_as(&self, other: &Document) -> bool {
        self.path == other.path
            && self.recording_source() == other.recording_source()
            && self.content.same(&other.content)
    }

    /// Whether `other` is this document without any change since, by comparing pointers alone.
    pub(super) fn untouched_since(&self, other: &Document) -> bool {
        self.id == other.id
            && self.path == other.path
            && Arc::ptr_eq(&self.content.scene, &other.content.scene)
            && Arc::ptr_eq(&self.content.radar, &other.content.radar)
    }

    pub(super) fn scene_mut(&mut self) -> &mut Scene {
        Arc::make_mut(&mut self.content.scene)
    }

    pub(super) fn set_scene(&mut self, scene: Arc<Scene>) {
        self.content.scene = scene;
    }

    pub(super) fn radar_mut(&mut self) -> &mut Radar {
        Arc::make_mut(&mut self.content.radar)
    }

    /// Records that `path` now holds the content of `kept`; `kept` is this document or another one.
    ///
    /// A document that is the same as `kept` goes by that path from now on. Another of the same path now differs from its file.
    pub(super) fn note_kept(&mut self, kept: &Document, path: &Path) {
        if self.id == kept.id {
            self.path = Some(path.into());
        }
        if self.path() == Some(path) {
            self.saved = Some(kept.content.clone());
        }
    }
}

/// The documents that a dead window left.
#[derive(Debug, Default)]
pub struct Restored {
    /// The document that was on screen, if it was unsaved.
    pub on_screen: Option<Document>,
    /// Unsaved documents that were not on screen, the latest last.
    pub left: Vec<Document>,
    /// Files that could not be read: the reason, and the place where they are kept.
    pub problems: Vec<String>,
}

pub(super) fn whole_path(path: &Path) -> PathBuf {
    fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_title_marks_what_is_unsaved() {
        let file = |name: &str| {
            let scene = Scene { name: name.to_owned(), ..Scene::of_points([(1.0, 2.0)]) };
            SceneFile { scene, ..SceneFile::default() }
        };
        let path = Path::new("/there/a.toml");
        for (document, title) in [
            (Document::default(), "untitled"),
            (Document::shipped(file("")), "untitled"),
            (Document::shipped(file("A street")), "A street"),
            (Document::opened(path, file("A street")), "a.toml"),
            (Document::unsaved(Some(path), file("")), "a.toml •"),
            (Document::unsaved(None, file("")), "untitled •"),
        ] {
            assert_eq!(document.title(), title);
        }
    }

    #[test]
    fn an_edit_undone_by_hand_is_no_edit() {
        let mut document = Document::default();
        document.scene_mut().name = "a".to_owned();
        assert!(document.is_modified());
        document.scene_mut().name.clear();
        assert!(!document.is_modified());
        document.radar_mut().elements = 64;
        assert!(document.is_modified());
    }

    #[test]
    fn a_file_is_noted_by_every_document_of_its_path() {
        let (path, other) = (Path::new("/there/a.toml"), Path::new("/there/b.toml"));
        let mut a = Document::opened(path, SceneFile::default());
        let mut same_file = Document::opened(path, SceneFile::default());
        let mut b = Document::opened(other, SceneFile::default());
        a.scene_mut().name = "changed".to_owned();
        let kept = a.clone();
        for document in [&mut a, &mut same_file, &mut b] {
            document.note_kept(&kept, path);
        }
        assert!(!a.is_modified() && same_file.is_modified() && !b.is_modified());
        a.note_kept(&kept, other);
        assert_eq!(a.name(), "b.toml");
    }
}
