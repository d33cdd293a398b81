//! What files are asked for: how they are called, how their names end, and what is done with them.

use crate::app::state::{CardPlan, Command, DocumentCommand, ExportCommand, LessonCommand, RowsCommand, WorkCommand};
use std::path::{Path, PathBuf};

/// How the names of files to open may end.
const OPENED_ENDINGS: &[&str] = &["toml", "npz", "bin", "dat", "raw", "cfg", "npy", "mat", "safetensors"];

/// What a file is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A scene to open.
    Open,
    /// The `.cfg` of a capture card to listen to on this UDP port.
    Listen(u16),
    /// The log of a training to watch.
    OpenLog,
    /// A lesson to begin.
    OpenLesson,
    /// Where the scene is to be saved.
    SaveScene,
    /// Where a picture is to be written.
    ExportPicture,
    /// Where the maps are to be written.
    ExportMaps,
    /// Where the next drag is to be recorded.
    RecordDrag,
    /// Where the steps of a lesson are to be drawn.
    DrawLesson,
    /// Where the figures are to be written.
    ExportMetrics,
    /// Rows of an evaluation to show.
    OpenRows,
    /// Where the rows are to be saved.
    SaveRows,
    /// A scene of the folder of one's own.
    OwnScenes,
}

impl Purpose {
    /// What is done with the file.
    pub fn command(self, path: PathBuf) -> Command {
        match self {
            Purpose::Open => Command::Document(DocumentCommand::OpenPath(path)),
            Purpose::Listen(port) => Command::Work(WorkCommand::Listen(CardPlan { port, config: path, board: None })),
            Purpose::OpenLog => Command::Work(WorkCommand::WatchLog(path)),
            Purpose::OpenLesson => Command::Lesson(LessonCommand::OpenFile(path)),
            Purpose::SaveScene => Command::Document(DocumentCommand::SaveTo(path)),
            Purpose::ExportPicture => Command::Export(ExportCommand::PictureTo(path)),
            Purpose::ExportMaps => Command::Export(ExportCommand::MapsTo(path)),
            Purpose::RecordDrag => Command::Export(ExportCommand::RecordDragTo(path)),
            Purpose::DrawLesson => Command::Export(ExportCommand::DrawLessonTo(path)),
            Purpose::ExportMetrics => Command::Export(ExportCommand::MetricsTo(path)),
            Purpose::OpenRows => Command::Rows(RowsCommand::OpenFile(path)),
            Purpose::SaveRows => Command::Rows(RowsCommand::SaveTo(path)),
            Purpose::OwnScenes => Command::Rows(RowsCommand::SetOwnScenes(path)),
        }
    }

    /// Whether the file is read, not written.
    pub fn reads(self) -> bool {
        use Purpose::{Listen, Open, OpenLesson, OpenLog, OpenRows, OwnScenes};
        matches!(self, Listen(_) | Open | OpenLog | OpenLesson | OpenRows | OwnScenes)
    }

    /// Title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Purpose::Open => "Open a scene or a recording",
            Purpose::Listen(_) => "Listen with the .cfg that set the radar up",
            Purpose::OpenLog => "Open the log of a training",
            Purpose::OpenLesson => "Open a lesson",
            Purpose::SaveScene => "Save the scene",
            Purpose::ExportPicture => "Export a picture",
            Purpose::ExportMaps => "Export the maps",
            Purpose::RecordDrag => "Record the next drag",
            Purpose::DrawLesson => "Draw the steps of the lesson",
            Purpose::ExportMetrics => "Export the metrics",
            Purpose::OpenRows => "Open rows of an evaluation",
            Purpose::SaveRows => "Save the rows",
            Purpose::OwnScenes => "Open any scene of your folder",
        }
    }

    /// How the file's name may end, and what such files are.
    pub fn kind(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Purpose::Open => ("Scenes, recordings and weights", OPENED_ENDINGS),
            Purpose::SaveScene | Purpose::OwnScenes => ("Scenes", &["toml", "npz"]),
            Purpose::Listen(_) => ("Settings of a radar", &["cfg"]),
            Purpose::OpenLesson => ("Lessons", &["toml"]),
            Purpose::OpenLog | Purpose::ExportMetrics | Purpose::OpenRows | Purpose::SaveRows => ("Table", &["csv"]),
            Purpose::ExportPicture => ("Picture", &["png", "svg"]),
            Purpose::ExportMaps => ("NumPy arrays", &["npz"]),
            Purpose::RecordDrag => ("Animation", &["gif"]),
            Purpose::DrawLesson => ("Pictures", &["png"]),
        }
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

    /// Name of the file where no other is chosen.
    pub fn name(self) -> &'static str {
        match self {
            Purpose::Listen(_)
            | Purpose::Open
            | Purpose::OpenLog
            | Purpose::OpenLesson
            | Purpose::OpenRows
            | Purpose::OwnScenes => "",
            Purpose::SaveScene => "scene.toml",
            Purpose::ExportPicture => "apertura.png",
            Purpose::ExportMaps => "maps.npz",
            Purpose::RecordDrag => "drag.gif",
            Purpose::DrawLesson => "lesson.png",
            Purpose::ExportMetrics => "metrics.csv",
            Purpose::SaveRows => "rows.csv",
        }
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
