//! Scene files of the app: dialogs off the UI thread, recent files, autosave.

use crate::scene::file::{self, SceneFile};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// How many recent files are remembered.
const RECENT: usize = 10;

/// Shortest time between two autosaves.
const AUTOSAVE_EVERY: Duration = Duration::from_secs(2);

/// What a file is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    Open,
    SaveScene,
    ExportPicture,
    ExportMaps,
    ExportMetrics,
}

impl Purpose {
    fn dialog(self) -> rfd::FileDialog {
        let dialog = rfd::FileDialog::new();
        match self {
            Purpose::Open => dialog.set_title("Open a scene").add_filter("Scenes", &["toml", "npz"]),
            Purpose::SaveScene => {
                dialog.set_title("Save the scene").add_filter("Scenes", &["toml", "npz"]).set_file_name("scene.toml")
            }
            Purpose::ExportPicture => {
                dialog.set_title("Export a picture").add_filter("Picture", &["png"]).set_file_name("apertura.png")
            }
            Purpose::ExportMaps => {
                dialog.set_title("Export the maps").add_filter("NumPy arrays", &["npz"]).set_file_name("maps.npz")
            }
            Purpose::ExportMetrics => {
                dialog.set_title("Export the metrics").add_filter("Table", &["csv"]).set_file_name("metrics.csv")
            }
        }
    }
}

/// What a file dialog was closed with.
pub(super) struct Answer {
    pub purpose: Purpose,
    pub path: PathBuf,
}

/// Where the scene came from and where it is kept.
pub(super) struct Files {
    /// The scene's own file, if it has one.
    pub path: Option<PathBuf>,
    /// Files opened or saved lately, latest first.
    pub recent: Vec<PathBuf>,
    answers: (Sender<Answer>, Receiver<Answer>),
    autosave: Option<PathBuf>,
    last_autosave: Option<Instant>,
}

impl Files {
    /// `folder` is where the autosave is kept; without it there is none.
    pub fn new(folder: Option<&Path>, recent: Vec<PathBuf>) -> Self {
        let autosave = folder.map(|f| f.join("autosave.toml"));
        Files { path: None, recent, answers: channel(), autosave, last_autosave: None }
    }

    /// Asks the user for a file on a thread of its own; [`Files::answer`] has it later.
    pub fn ask(&self, purpose: Purpose, wake: impl Fn() + Send + 'static) -> std::io::Result<()> {
        let answers = self.answers.0.clone();
        let folder = self.path.as_ref().and_then(|p| p.parent()).map(Path::to_path_buf);
        std::thread::Builder::new().name("file dialog".to_owned()).spawn(move || {
            let dialog = purpose.dialog();
            let dialog = if let Some(folder) = folder { dialog.set_directory(folder) } else { dialog };
            let chosen = if purpose == Purpose::Open { dialog.pick_file() } else { dialog.save_file() };
            if let Some(path) = chosen {
                // The window may be gone by now.
                let _closed = answers.send(Answer { purpose, path });
                wake();
            }
        })?;
        Ok(())
    }

    /// What the user chose, if a dialog has been closed.
    pub fn answer(&self) -> Option<Answer> {
        self.answers.1.try_recv().ok()
    }

    /// Reads a scene; the file becomes the scene's own.
    pub fn open(&mut self, path: &Path) -> Result<SceneFile, String> {
        let scene = file::load(path).map_err(|e| e.to_string())?;
        self.remember(path);
        Ok(scene)
    }

    /// Writes a scene; the file becomes the scene's own.
    pub fn save(&mut self, path: &Path, scene: &SceneFile) -> Result<(), String> {
        file::save(path, scene).map_err(|e| e.to_string())?;
        self.remember(path);
        self.forget_autosave();
        Ok(())
    }

    fn remember(&mut self, path: &Path) {
        let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path.clone());
        self.recent.truncate(RECENT);
        self.path = Some(path);
    }

    /// Name for the window's title.
    pub fn title(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        name.map_or_else(|| "untitled".to_owned(), |n| n.to_string_lossy().into_owned())
    }

    /// Keeps a copy of an unsaved scene, at most every two seconds. Returns how long until the next may be written, if this one had to wait.
    pub fn autosave(&mut self, scene: &SceneFile) -> Result<Option<Duration>, String> {
        let Some(path) = &self.autosave else { return Ok(None) };
        if let Some(waited) = self.last_autosave.map(|t| t.elapsed()).filter(|t| *t < AUTOSAVE_EVERY) {
            return Ok(Some(AUTOSAVE_EVERY - waited));
        }
        self.last_autosave = Some(Instant::now());
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        }
        file::save(path, scene).map_err(|e| e.to_string())?;
        Ok(None)
    }

    /// Reads what an earlier run left unsaved. A file that can't be read is set aside, not deleted.
    pub fn restore(&self) -> Option<Result<SceneFile, String>> {
        let path = self.autosave.as_ref().filter(|p| p.exists())?;
        Some(file::load(path).map_err(|e| {
            let aside = path.with_extension("broken.toml");
            match std::fs::rename(path, &aside) {
                Ok(()) => format!("{e}; it was kept as {}", aside.display()),
                Err(_) => e.to_string(),
            }
        }))
    }

    /// Deletes the autosave: what it held is safe elsewhere.
    pub fn forget_autosave(&mut self) {
        if let Some(path) = &self.autosave {
            // Not there is as good as deleted.
            let _absent = std::fs::remove_file(path);
        }
    }
}
