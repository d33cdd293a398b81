//! Purposes of file dialogs, with their titles, kinds of files and endings.

use super::{CardPlan, Command, DocumentCommand, ExportCommand, LessonCommand, RowsCommand, WorkCommand};
use crate::files::ends_in;
use std::path::{Path, PathBuf};

/// Texts of a purpose, as its line of the list has them.
pub struct PurposeFacts {
    pub title: &'static str,
    pub kind: &'static str,
    pub endings: &'static [&'static str],
    /// Name of the file where no other is chosen; empty for a file that is read.
    pub name: &'static str,
}

/// The list of purposes. A line has a purpose's name, the dialog's title, the kind of the files, their endings, and the usual name of a file that is written.
macro_rules! purposes {
    ($($(#[$meta:meta])* $purpose:ident $(($payload:ty))?: $title:literal, $kind:literal $endings:expr, $name:literal;)*) => {
        /// The purpose of a file dialog.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Purpose {
            $($(#[$meta])* $purpose $(($payload))?,)*
        }

        impl Purpose {
            /// Texts of the dialog.
            pub fn facts(self) -> PurposeFacts {
                match self {
                    $(Purpose::$purpose { .. } => PurposeFacts {
                        title: $title,
                        kind: $kind,
                        endings: &$endings,
                        name: $name,
                    },)*
                }
            }
        }
    };
}

purposes! {
    Open: "Open a scene or a recording", "Scenes, recordings and weights"
        ["toml", "npz", "bin", "dat", "raw", "cfg", "npy", "mat", "h5", "hdf5", "safetensors"], "";
    /// The `.cfg` of a capture card to listen to on this UDP port.
    Listen(u16): "Listen with the .cfg that set the radar up", "Settings of a radar" ["cfg"], "";
    OpenLog: "Open the log of a training", "Table" ["csv"], "";
    OpenLesson: "Open a lesson", "Lessons" ["toml"], "";
    SaveScene: "Save the scene", "Scenes" ["toml", "npz"], "scene.toml";
    ExportPicture: "Export a picture", "Picture" ["png", "svg"], "apertura.png";
    ExportMaps: "Export the maps", "NumPy arrays" ["npz"], "maps.npz";
    OpenRows: "Open rows of an evaluation", "Table" ["csv"], "";
    SaveRows: "Save the rows", "Table" ["csv"], "rows.csv";
    /// A scene of the user's own folder, which chooses the folder.
    OwnScenes: "Open any scene of your folder", "Scenes" ["toml", "npz"], "";
}

impl Purpose {
    /// The command for the chosen file.
    pub fn command(self, path: PathBuf) -> Command {
        match self {
            Purpose::Open => DocumentCommand::OpenPath(path).into(),
            Purpose::Listen(port) => WorkCommand::Listen(CardPlan { port, config: path, board: None }).into(),
            Purpose::OpenLog => WorkCommand::WatchLog(path).into(),
            Purpose::OpenLesson => LessonCommand::OpenFile(path).into(),
            Purpose::SaveScene => DocumentCommand::SaveTo(path).into(),
            Purpose::ExportPicture => ExportCommand::PictureTo(path).into(),
            Purpose::ExportMaps => ExportCommand::MapsTo(path).into(),
            Purpose::OpenRows => RowsCommand::OpenFile(path).into(),
            Purpose::SaveRows => RowsCommand::SaveTo(path).into(),
            Purpose::OwnScenes => RowsCommand::SetOwnScenes(path).into(),
        }
    }

    /// Whether the file is read, not written.
    pub fn reads(self) -> bool {
        self.facts().name.is_empty()
    }

    /// The file to write for a chosen `path`: with the usual ending where it has none.
    ///
    /// # Errors
    /// A sentence with the known endings, where `path` has another.
    pub fn destination(self, path: PathBuf) -> Result<PathBuf, String> {
        let endings = self.facts().endings;
        match path.extension() {
            _ if self.reads() || ends_in(&path, endings) => Ok(path),
            None => Ok(path.with_extension(endings[0])),
            Some(_) => Err(self.unknown_ending(&path)),
        }
    }

    /// The message about a file with an unknown ending.
    pub fn unknown_ending(self, path: &Path) -> String {
        let endings: Vec<String> = self.facts().endings.iter().map(|ending| format!(".{ending}")).collect();
        format!("{}: nothing is written with this ending; expected {}", path.display(), endings.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_ending_is_refused_with_the_list() {
        let to = |purpose: Purpose, name: &str| purpose.destination(name.into());
        assert_eq!(to(Purpose::ExportPicture, "a"), Ok("a.png".into()));
        assert_eq!(to(Purpose::ExportPicture, "a.SVG"), Ok("a.SVG".into()));
        let refused = to(Purpose::ExportPicture, "a.jpg").unwrap_err();
        assert!(refused.starts_with("a.jpg: ") && refused.ends_with("expected .png or .svg"), "{refused}");
        assert!(to(Purpose::SaveRows, "rows.txt").unwrap_err().ends_with("expected .csv"));
    }
}
