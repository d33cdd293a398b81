//! Scene files of the app: dialogs off the UI thread, recent files.

use crate::interact::{Autosave, Document};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

/// How many recent files are remembered.
const RECENT: usize = 10;

/// What a file is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    Open,
    OpenLog,
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
            Purpose::OpenLog => dialog.set_title("Open the log of a training").add_filter("Table", &["csv"]),
            Purpose::SaveScene => {
                dialog.set_title("Save the scene").add_filter("Scenes", &["toml", "npz"]).set_file_name("scene.toml")
            }
            Purpose::ExportPicture => dialog
                .set_title("Export a picture")
                .add_filter("Picture", &["png", "svg"])
                .set_file_name("apertura.png"),
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

/// Files opened lately, and where unsaved documents are kept.
pub(super) struct Files {
    /// Files opened or saved lately, latest first.
    pub recent: Vec<PathBuf>,
    /// Where an unsaved scene is kept, if anywhere.
    pub autosave: Option<Autosave>,
    answers: (Sender<Answer>, Receiver<Answer>),
    #[cfg(feature = "network")]
    folder: Option<PathBuf>,
}

impl Files {
    /// `folder` is where the autosave is kept; without it there is none.
    pub fn new(folder: Option<&Path>, recent: Vec<PathBuf>) -> std::io::Result<Self> {
        Ok(Files {
            recent,
            autosave: folder.map(Autosave::claim).transpose()?,
            answers: channel(),
            #[cfg(feature = "network")]
            folder: folder.map(Path::to_path_buf),
        })
    }

    /// Asks the user for a file on a thread of its own; [`Files::answer`] has it later.
    pub fn ask(
        &self,
        purpose: Purpose,
        beside: Option<&Path>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let answers = self.answers.0.clone();
        let folder = beside.and_then(Path::parent).map(Path::to_path_buf);
        std::thread::Builder::new().name("file dialog".to_owned()).spawn(move || {
            let dialog = purpose.dialog();
            let dialog = if let Some(folder) = folder { dialog.set_directory(folder) } else { dialog };
            let reads = matches!(purpose, Purpose::Open | Purpose::OpenLog);
            let chosen = if reads { dialog.pick_file() } else { dialog.save_file() };
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

    /// Reads a document.
    pub fn open(&mut self, path: &Path) -> Result<Document, String> {
        let document = Document::read(path).map_err(|e| e.to_string())?;
        self.remember(path);
        Ok(document)
    }

    /// Puts a file among the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }

    /// A folder of its own for a training by the recipe called `name`; `None` where the app keeps no files.
    #[cfg(feature = "network")]
    pub fn new_run(&self, name: &str) -> Option<PathBuf> {
        let runs = self.folder.as_ref()?.join("runs");
        (1u32..).map(|n| runs.join(format!("{name}-{n}"))).find(|run| !run.exists())
    }
}
