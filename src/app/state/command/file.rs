//! What files are asked for: how they are called and how their names end.

use std::path::{Path, PathBuf};

/// What is known of a purpose.
struct PurposeFacts {
    title: &'static str,
    kind: &'static str,
    endings: &'static [&'static str],
    name: &'static str,
}

/// The list of purposes. A line has a purpose's name, the dialog's title, what the files are, how their names may end, and the usual name where
/// the file is written.
macro_rules! purposes {
    ($($(#[$meta:meta])* $purpose:ident $(($payload:ty))?: $title:literal, $kind:literal $endings:expr, $name:literal;)*) => {
        /// What a file is asked for.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Purpose {
            $($(#[$meta])* $purpose $(($payload))?,)*
        }

        impl Purpose {
            fn facts(self) -> PurposeFacts {
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
    /// A scene to open.
    Open: "Open a scene or a recording", "Scenes, recordings and weights"
        ["toml", "npz", "bin", "dat", "raw", "cfg", "npy", "mat", "h5", "hdf5", "safetensors"], "";
    /// The `.cfg` of a capture card to listen to on this UDP port.
    Listen(u16): "Listen with the .cfg that set the radar up", "Settings of a radar" ["cfg"], "";
    /// The log of a training to watch.
    OpenLog: "Open the log of a training", "Table" ["csv"], "";
    /// A lesson to begin.
    OpenLesson: "Open a lesson", "Lessons" ["toml"], "";
    /// Where the scene is to be saved.
    SaveScene: "Save the scene", "Scenes" ["toml", "npz"], "scene.toml";
    /// Where a picture is to be written.
    ExportPicture: "Export a picture", "Picture" ["png", "svg"], "apertura.png";
    /// Where the maps are to be written.
    ExportMaps: "Export the maps", "NumPy arrays" ["npz"], "maps.npz";
    /// Rows of an evaluation to show.
    OpenRows: "Open rows of an evaluation", "Table" ["csv"], "";
    /// Where the rows are to be saved.
    SaveRows: "Save the rows", "Table" ["csv"], "rows.csv";
    /// A scene of the folder of one's own.
    OwnScenes: "Open any scene of your folder", "Scenes" ["toml", "npz"], "";
}

impl Purpose {
    /// Whether the file is read, not written.
    pub fn reads(self) -> bool {
        self.name().is_empty()
    }

    /// Title of the dialog.
    pub fn title(self) -> &'static str {
        self.facts().title
    }

    /// What such files are, and how their names may end.
    pub fn kind(self) -> (&'static str, &'static [&'static str]) {
        let PurposeFacts { kind, endings, .. } = self.facts();
        (kind, endings)
    }

    /// Name of the file where no other is chosen; empty for a file that is read.
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// The file that is written where `path` was chosen: with the usual ending where it has none.
    ///
    /// # Errors
    /// A sentence with the endings that there are, where it has another.
    pub fn destination(self, path: PathBuf) -> Result<PathBuf, String> {
        let endings = self.kind().1;
        match path.extension() {
            _ if self.reads() => Ok(path),
            None => Ok(path.with_extension(endings[0])),
            Some(ending) if endings.iter().any(|known| ending.eq_ignore_ascii_case(known)) => Ok(path),
            Some(_) => Err(self.unknown_ending(&path)),
        }
    }

    /// What is said of a file with another ending.
    pub fn unknown_ending(self, path: &Path) -> String {
        let endings: Vec<String> = self.kind().1.iter().map(|ending| format!(".{ending}")).collect();
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
