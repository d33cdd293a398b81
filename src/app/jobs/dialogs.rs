//! Which file? Dialogs off the UI thread; what is chosen comes back as a command.

use crate::app::state::Command;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a file is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A scene to open.
    Open,
    /// The log of a training to watch.
    OpenLog,
    /// Where the scene is to be saved.
    SaveScene,
    /// Where a picture is to be written.
    ExportPicture,
    /// Where the maps are to be written.
    ExportMaps,
    /// Where the figures are to be written.
    ExportMetrics,
}

impl Purpose {
    /// What is done with the file.
    fn command(self, path: PathBuf) -> Command {
        match self {
            Purpose::Open => Command::OpenPath(path),
            Purpose::OpenLog => Command::WatchLog(path),
            Purpose::SaveScene => Command::SaveTo(path),
            Purpose::ExportPicture => Command::ExportPictureTo(path),
            Purpose::ExportMaps => Command::ExportMapsTo(path),
            Purpose::ExportMetrics => Command::ExportMetricsTo(path),
        }
    }

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

/// File dialogs on threads of their own: a window that waits for one would look dead.
pub struct Dialogs {
    answers: (Sender<Command>, Receiver<Command>),
}

impl Default for Dialogs {
    fn default() -> Self {
        Dialogs { answers: channel() }
    }
}

impl Dialogs {
    /// Asks the user for a file, at first in `folder`; [`Dialogs::answer`] has the command later.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn ask(
        &self,
        purpose: Purpose,
        folder: Option<PathBuf>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let answers = self.answers.0.clone();
        std::thread::Builder::new().name("file dialog".to_owned()).spawn(move || {
            let dialog = purpose.dialog();
            let dialog = if let Some(folder) = folder { dialog.set_directory(folder) } else { dialog };
            let reads = matches!(purpose, Purpose::Open | Purpose::OpenLog);
            let chosen = if reads { dialog.pick_file() } else { dialog.save_file() };
            if let Some(path) = chosen {
                // The window may be gone by now.
                let _closed = answers.send(purpose.command(path));
                wake();
            }
        })?;
        Ok(())
    }

    /// What the user chose, if a dialog has been closed.
    pub fn answer(&self) -> Option<Command> {
        self.answers.1.try_recv().ok()
    }
}
