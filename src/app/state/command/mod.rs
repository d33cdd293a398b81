//! Every command of buttons, menus, shortcuts, the palette and panels, in groups. Each group has a file of its name in `app::apply`, which does them.

mod file;

pub use file::{Purpose, PurposeFacts};

use super::{
    BoundsSettings, CardPlan, ChirpSettings, Compare, Cursor, Directions, FailureChoice, HelpPage, LiveFrame, MapKind,
    Panel, PhasorSettings, Projection, SaveAnswer, Several, Task, Units,
};
use crate::evaluate::worsen::WorseningSearch;
use crate::interact::blob::BlobHit;
use crate::interact::{Coordinates, Field, FieldChange, Place, SelectionMode, Snap};
use crate::lesson::{Guess, Lesson};
use crate::maps::Normalisation;
use crate::maps::cfar::{Cfar, Statistic};
use crate::picture::ColourMap;
use crate::radar::{BuiltArray, Carrier, LayoutKind, Radar, WindowFunction};
use crate::scene::generate::Kind;
use crate::scene::{Interferer, Mirror};
use crate::signal::Floor;
use std::path::PathBuf;
use std::sync::Arc;

/// Defines [`Command`] and the conversion of each group's commands to it.
macro_rules! groups {
    ($($(#[$meta:meta])* $group:ident($commands:ty),)*) => {
        #[derive(Debug, Clone, PartialEq)]
        pub enum Command {
            $($(#[$meta])* $group($commands),)*
        }

        $(impl From<$commands> for Command {
            fn from(command: $commands) -> Command {
                Command::$group(command)
            }
        })*
    };
}

groups! {
    Document(DocumentCommand),
    Edit(EditCommand),
    Radar(RadarCommand),
    View(ViewCommand),
    Rows(RowsCommand),
    Lesson(LessonCommand),
    Work(WorkCommand),
    Export(ExportCommand),
    Window(WindowCommand),
    /// Ask for a file, then do the command of its purpose.
    AskFile(Purpose),
    /// Do the commands of a button of the guide; one undo takes back changed settings, too.
    Guided(Vec<Command>),
}

/// A command that opens, saves or makes a document.
#[derive(Debug, Clone, PartialEq)]
pub enum DocumentCommand {
    /// Open an empty scene.
    New,
    OpenPath(PathBuf),
    /// Save the scene in its own file, or ask for one.
    Save,
    SaveTo(PathBuf),
    AnswerSave(SaveAnswer),
    /// Bring back the unsaved document of this id, which another one replaced.
    Recover(u64),
    Discard(u64),
    Preset(usize),
    Recording(usize),
    Reread(Way),
    /// Show the newest frame of the capture card in use.
    ShowFrame(LiveFrame),
    RandomScene(Kind),
    /// Choose seed and number, in its stream, of the next random scene.
    SetNextRandom {
        seed: u64,
        number: u32,
    },
    OpenShared(String),
}

/// Another way to read the file of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// In another of the offered layouts.
    Layout(usize),
    /// At another frame, from 0.
    Frame(u64),
    /// With the antennas of the board of this name.
    Board(&'static str),
}

/// A command that selects objects or changes the scene on screen.
#[derive(Debug, Clone, PartialEq)]
pub enum EditCommand {
    Undo,
    Redo,
    /// End the current undo step, as when the mouse button is released.
    Seal,
    Cut,
    Copy,
    /// Ask the system for the clipboard and add its objects.
    Paste,
    PasteText(String),
    /// Copy the selected objects a little aside.
    Duplicate,
    Delete,
    SelectAll,
    Select(Vec<usize>, SelectionMode),
    /// Select the object after the one selected last.
    SelectNext,
    SelectPrevious,
    SetField(Field, FieldChange),
    Name(String),
    /// Start dragging the object behind a blob.
    Grab(BlobHit),
    DragTo(Place),
    Drop,
    /// Add an object at a place, or where there is room.
    Add(NewObject, Option<Place>),
    /// Move the selected objects along the array (x) and ahead of it (y).
    Nudge {
        dx_metres: f64,
        dy_metres: f64,
    },
    SetNoiseSeed(u64),
    /// Set the grid that dragged objects snap to.
    SetSnap(Snap),
    /// Set the coordinates in which places are shown and entered.
    SetCoordinates(Coordinates),
}

named! {
    /// A kind of object to add.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum NewObject {
        Point = "Point",
        Line = "Line",
        Cluster = "Cluster",
        Wall = "Wall",
        Box = "Box",
        Post = "Post",
        Polygon = "Polygon",
    }
}

/// A command that changes the radar, its elements, or other disturbances of the scene.
#[derive(Debug, Clone, PartialEq)]
pub enum RadarCommand {
    Set(Box<Radar>),
    Preset(usize),
    /// Set the convention of the carrier's phase.
    SetCarrier(Carrier),
    SetWindow(WindowFunction),
    SetElements(Arc<BuiltArray>),
    /// Set or remove an unsynchronised radar.
    SetInterferer(Option<Interferer>),
    /// Set or remove a wall that mirrors.
    SetMirror(Option<Mirror>),
}

/// A command that changes the view of the scene: maps, method or marks.
#[derive(Debug, Clone, PartialEq)]
pub enum ViewCommand {
    /// Set the pointer's place, from any panel.
    Hover(Cursor),
    FitScene,
    ResetMaps,
    ToggleProjection,
    SetProjection(Projection),
    ToggleUnits,
    /// Set Lambda or decibels on colour bars, cuts, readouts and thresholds.
    SetUnits(Units),
    /// Set cos θ or degrees along the axis of directions.
    SetDirections(Directions),
    /// Switch between a common scale for inputs, target and output, and one for each.
    ToggleOneScale,
    /// Switch maps of few elements between 256 columns and their own number.
    ToggleFineColumns,
    /// Switch between the signed and the absolute difference.
    ToggleAbsoluteDifference,
    /// Switch the difference's scale between the smallest that holds it and one up to 1.
    ToggleWholeDifference,
    /// Pin the cuts that are shown; they stay while the cursor moves.
    PinCuts,
    Unpin(usize),
    UnpinAll,
    Colours(ColourMap),
    Normalise(Normalisation),
    SetFloor(Floor),
    SetTargetEta(f32),
    /// Set the detector in place of the thresholds; `None` for thresholds.
    SetCfar(Option<Cfar>),
    /// Detect at a constant false-alarm rate by this statistic, with the last chosen cells, or by thresholds where `None`.
    Detect(Option<Statistic>),
    /// Set eta of the method of this name; its own where `None`.
    SetMethodEta(&'static str, Option<f32>),
    SetBounds(BoundsSettings),
    SetPhasors(PhasorSettings),
    SetTime(f64),
    /// Play or stop the scene's motion or the recording's frames.
    TogglePlay,
    /// Set whether range-Doppler maps of recordings leave out static clutter.
    TakeOutStaticClutter(bool),
    SetChirp(ChirpSettings),
    /// Switch whether menus list the panels for developers.
    ToggleDeveloper,
    MarkReflectors,
    ToggleReflectors,
    ToggleFound,
    ToggleFieldsOfView,
    /// Switch the theory of the selected reflector on the maps.
    ToggleTheory,
    /// Show the verdict on every object in the output.
    MarkKinds,
    /// Switch the verdict on every object in the output.
    ToggleKinds,
    SetSeveral(Box<Several>),
    SetCompare(Box<Compare>),
    /// Show the other one of two compared maps.
    Flip,
    Method(&'static str),
    /// Set the elements that methods use; the two ends where `None`.
    Hear(Option<LayoutKind>),
    NextMethod,
}

impl ViewCommand {
    /// The switches of marks drawn over maps.
    pub const OVERLAYS: [ViewCommand; 4] =
        [ViewCommand::ToggleReflectors, ViewCommand::ToggleFound, ViewCommand::ToggleTheory, ViewCommand::ToggleKinds];
}

/// A command on the rows of the panel Evaluate: try methods, open a row, search for worse scenes, keep scenes.
#[derive(Debug, Clone, PartialEq)]
pub enum RowsCommand {
    /// Try methods on scenes, row by row.
    Try(FailureChoice),
    /// Stop the trial of methods; the rows stay.
    CancelTrying,
    OpenFile(PathBuf),
    /// Show a CSV file: rows, or the log of a training.
    OpenTable(PathBuf),
    SaveTo(PathBuf),
    Clear,
    BringBack,
    /// Open the scene of the row of this index, with its floor and method.
    Show(usize),
    /// Search for a worse scene near the one on screen, or for its repair.
    Search(Box<WorseningSearch>),
    /// Stop the search; its findings stay.
    CancelSearch,
    /// Put the search's last finding on screen.
    TakeFinding,
    ForgetSearch,
    /// Keep the scene on screen in the user's own folder, with this note.
    KeepScene(String),
    /// Make the folder of this file the user's own folder of scenes.
    SetOwnScenes(PathBuf),
}

/// A command of lessons: begin, predict, go on, leave.
#[derive(Debug, Clone, PartialEq)]
pub enum LessonCommand {
    Begin(usize),
    OpenFile(PathBuf),
    /// Begin a lesson that was read from a file and tried out; `id` is the key of its progress.
    Take {
        id: String,
        lesson: Arc<Lesson>,
    },
    /// Go to a step of the lesson, from 0.
    Step(usize),
    Predict(Guess),
    /// Put a solution of the challenge on screen; the challenge then counts as unsolved.
    ShowSolution,
    /// Give the lesson the whole screen, for a projector, or end that.
    Present,
    /// End the lesson; scene and settings come back.
    Leave,
    SetLearner(String),
    ForgetProgress,
}

/// A command that starts or stops long work.
#[derive(Debug, Clone, PartialEq)]
pub enum WorkCommand {
    CancelMethod,
    CancelSecond,
    /// Measure run time against error; `thorough` takes every algorithm with more reflectors, for about a minute.
    Measure {
        thorough: bool,
    },
    CancelMeasurement,
    WatchLog(PathBuf),
    /// Listen to a capture card, and show its newest frame.
    Listen(CardPlan),
    StopListening,
}

/// A command that exports a file or copies to the clipboard.
#[derive(Debug, Clone, PartialEq)]
pub enum ExportCommand {
    /// Save the scene's panels as a picture (.png or .svg) in this file.
    PictureTo(PathBuf),
    MapsTo(PathBuf),
    CopyMap(MapKind),
    /// Copy scene, radar, view, method and lesson step as one line of text.
    CopyShared,
    /// Copy a link to this page that opens the scene on screen.
    CopyLink,
}

#[derive(Debug, Clone, PartialEq)]
pub enum WindowCommand {
    /// End a drag, a maximised panel or a presentation, or select nothing.
    Escape,
    /// Hide a panel in sight, or show any other in front.
    TogglePanel(Panel),
    ClosePanel(Panel),
    OpenPanel(Panel),
    /// Bring a view to the front of its shared tile.
    OpenView(Panel),
    /// Let a panel fill the window, or end that.
    Maximise(Panel),
    /// Switch to the panels of a task, as the user left them.
    ArrangeFor(Task),
    ResetLayout,
    /// Begin or end a presentation of the scene and the maps in large type.
    Present,
    ToggleCaptions,
    Help(HelpPage),
    CloseHelp,
    CloseMessages,
    ToggleTheme,
    ZoomIn,
    ZoomOut,
    ZoomReset,
    Palette,
    Quit,
}
