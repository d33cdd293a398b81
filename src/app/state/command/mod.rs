//! Every command that a button, a menu entry, a shortcut, the palette or a panel can send, in groups. Each group has a file here and one of the same name in
//! `app::apply`, which does the commands.

mod document;
mod edit;
mod export;
mod file;
mod lesson;
mod radar;
mod rows;
mod view;
mod window;
mod work;

pub use document::{DocumentCommand, Way};
pub use edit::EditCommand;
pub use export::ExportCommand;
pub use file::Purpose;
pub use lesson::LessonCommand;
pub use radar::RadarCommand;
pub use rows::RowsCommand;
pub use view::ViewCommand;
pub use window::WindowCommand;
pub use work::WorkCommand;

use super::CardPlan;
use crate::scene::generate::Kind;
use std::path::PathBuf;

/// A kind of object to add.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NewObject {
    /// One reflector.
    Point,
    /// A vertical line.
    Line,
    /// A Gaussian cluster.
    Cluster,
    /// A straight wall.
    Wall,
    /// A rectangle of a car's size.
    Box,
    /// A round post.
    Post,
    /// A closed outline of straight faces.
    Polygon,
}

impl NewObject {
    /// All kinds, in the order of menus.
    pub const ALL: [NewObject; 7] = [
        NewObject::Point,
        NewObject::Line,
        NewObject::Cluster,
        NewObject::Wall,
        NewObject::Box,
        NewObject::Post,
        NewObject::Polygon,
    ];
}

/// The required rate of false alarms for a threshold, and the scenes to try the method on.
#[derive(Debug, Clone, PartialEq)]
pub struct ThresholdChoice {
    /// The rate, percent of the target's dark cells.
    pub false_alarm_percent: f64,
    /// Kinds of validation scenes.
    pub kinds: Vec<Kind>,
    /// Scenes of each kind.
    pub count: u32,
}

/// A command to the app.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Open, save or make a document.
    Document(DocumentCommand),
    /// Select objects, or change the scene.
    Edit(EditCommand),
    /// Change the radar, its elements or other disturbances.
    Radar(RadarCommand),
    /// Change the view of scene and maps.
    View(ViewCommand),
    /// Try methods on many scenes, or use their rows.
    Rows(RowsCommand),
    /// Take a lesson.
    Lesson(LessonCommand),
    /// Start long work or stop it.
    Work(WorkCommand),
    /// Export a file or copy to the clipboard.
    Export(ExportCommand),
    /// Arrange the window.
    Window(WindowCommand),
    /// Ask for a file, then do the command of its purpose.
    AskFile(Purpose),
    /// Do the commands of a button of the guide; one undo takes back changed settings, too.
    Guided(Vec<Command>),
}

/// Conversion of each group's commands to [`Command`].
macro_rules! groups {
    ($($group:ident($commands:ident)),*) => {$(
        impl From<$commands> for Command {
            fn from(command: $commands) -> Command {
                Command::$group(command)
            }
        }
    )*};
}

groups!(
    Document(DocumentCommand),
    Edit(EditCommand),
    Radar(RadarCommand),
    View(ViewCommand),
    Rows(RowsCommand),
    Lesson(LessonCommand),
    Work(WorkCommand),
    Export(ExportCommand),
    Window(WindowCommand),
    AskFile(Purpose)
);

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
}
