//! Everything a button, a menu entry, a shortcut, the palette or a panel can ask for, in groups. Each group has a file here, which says
//! what can be asked, and one of the same name in `app::apply`, which does it.

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
    /// All of them, in the order of menus.
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

/// The rate of false alarms that a threshold is to keep, and the scenes to try the method on.
#[derive(Debug, Clone, PartialEq)]
pub struct ThresholdChoice {
    /// The rate, percent of the target's dark cells.
    pub false_alarm_percent: f64,
    /// Kinds of validation scenes.
    pub kinds: Vec<Kind>,
    /// Scenes of each kind.
    pub count: u32,
}

/// Something the app can do.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Put another scene on screen, or this one in a file.
    Document(DocumentCommand),
    /// Select objects, or change the scene.
    Edit(EditCommand),
    /// Change the radar or what disturbs it.
    Radar(RadarCommand),
    /// Look at the scene in another way.
    View(ViewCommand),
    /// Try methods on many scenes, or look at what came of it.
    Rows(RowsCommand),
    /// Take a lesson.
    Lesson(LessonCommand),
    /// Start long work or stop it.
    Work(WorkCommand),
    /// Write for other programs.
    Export(ExportCommand),
    /// Arrange the window.
    Window(WindowCommand),
    /// Ask for a file, and do with it what it is asked for.
    AskFile(Purpose),
    /// Do these for the guide: undo takes back the settings they change, too.
    Guided(Vec<Command>),
}

/// A command of a group is a command.
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
    /// What is done with the file that was asked for.
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
