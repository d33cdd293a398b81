//! Everything a button, a menu entry, a shortcut, the palette or a panel can ask for.

use super::bounds_settings::BoundsSettings;
use super::compare::Compare;
use super::failures::{FailureChoice, SearchChoice};
use super::panel::{MapKind, Panel};
use super::save_question::SaveAnswer;
use super::settings::{Projection, Units};
use super::several::Several;
use super::view::Cursor;
use crate::interact::blob::BlobHit;
use crate::interact::{Alignment, Along, Change, Coordinates, Field, Place, SelectionMode, Snap};
use crate::lesson::{Guess, Lesson};
use crate::maps::Normalisation;
use crate::picture::ColourMap;
use crate::radar::{BuiltArray, Carrier, Radar, WindowFunction};
use crate::scene::generate::Kind;
use crate::scene::{Interferer, Mirror};
use crate::signal::Floor;
use std::path::PathBuf;
use std::sync::Arc;

/// A kind of object to add.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NewObject {
    /// One reflector.
    Point,
    /// A vertical line.
    Line,
    /// A Gaussian cluster.
    Cluster,
}

/// Which methods are to be evaluated, and on what.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EvaluationChoice {
    /// Names of methods.
    pub methods: Vec<&'static str>,
    /// Test sets, 1 to 3.
    pub sets: Vec<usize>,
    /// Scenes of each set.
    pub count: u32,
    /// Seed of the scenes.
    pub seed: u64,
}

/// Something the app can do.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Start with an empty scene.
    New,
    /// Ask for a scene file and open it.
    Open,
    /// Open this scene file.
    OpenPath(PathBuf),
    /// Save the scene where it came from, or ask where.
    Save,
    /// Ask where to save the scene.
    SaveAs,
    /// Save the scene in this file.
    SaveTo(PathBuf),
    /// Whether the scene is saved in a file that can't hold all of it, or that somebody else has written to.
    AnswerSave(SaveAnswer),
    /// Put this unsaved document, which another took the place of, on screen again.
    Recover(u64),
    /// Give this unsaved document up.
    Discard(u64),
    /// Open a scene that comes with the program.
    Preset(usize),
    /// Open a recording that comes with the program.
    Recording(usize),
    /// Make a random test scene.
    RandomScene(Kind),
    /// Which random scene is next.
    SetNextRandom {
        /// Seed of its stream.
        seed: u64,
        /// Its number in the stream.
        number: u32,
    },
    /// Ask for the log of a training and watch it.
    OpenLog,
    /// Watch this log of a training.
    WatchLog(PathBuf),
    /// Start a training by the recipe of this name, and watch it.
    Train(&'static str),
    /// Stop the training that was started here.
    CancelTraining,
    /// Ask where to save the window as a picture, or the scene's panels as a drawing.
    ExportPicture,
    /// Save the window (.png) or the scene's panels (.svg) in this file.
    ExportPictureTo(PathBuf),
    /// Ask where to save the maps as NumPy arrays.
    ExportMaps,
    /// Save the maps in this file.
    ExportMapsTo(PathBuf),
    /// Ask where to record the next drag.
    RecordDrag,
    /// Record the next drag in this file.
    RecordDragTo(PathBuf),
    /// Ask where to draw the steps of the lesson.
    DrawLesson,
    /// Draw them beside this file, numbered.
    DrawLessonTo(PathBuf),
    /// Give up what is recorded or drawn.
    StopRecording,
    /// Ask where to save the figures as CSV.
    ExportMetrics,
    /// Save the figures in this file.
    ExportMetricsTo(PathBuf),
    /// Undo the last change of the scene.
    Undo,
    /// Redo what was undone.
    Redo,
    /// End the current undo step, as when the mouse button is let go.
    Seal,
    /// Cut the selected objects to the clipboard.
    Cut,
    /// Copy the selected objects as TOML.
    Copy,
    /// Copy scene, radar, view, method and lesson step as one line of text.
    CopyShared,
    /// Open such a text.
    OpenShared(String),
    /// Ask the system for the clipboard and add its objects.
    Paste,
    /// Add the objects in this text.
    PasteText(String),
    /// Copy the selected objects a little aside.
    Duplicate,
    /// Delete the selected objects.
    Delete,
    /// Select every object.
    SelectAll,
    /// Select these objects.
    Select(Vec<usize>, SelectionMode),
    /// Select the object after the one that was picked last.
    SelectNext,
    /// Select the one before it.
    SelectPrevious,
    /// Change a number of every selected object.
    SetField(Field, Change),
    /// Align the selected objects.
    Align(Alignment),
    /// Put the selected objects the same distance apart.
    Distribute(Along),
    /// Start dragging the object behind a blob.
    Grab(BlobHit),
    /// Drag what is held here.
    DragTo(Place),
    /// Let go of it.
    Drop,
    /// In which numbers places are told and entered.
    SetCoordinates(Coordinates),
    /// Select nothing, end maximising, close the palette.
    Escape,
    /// Add an object, at a place or where there is room.
    Add(NewObject, Option<Place>),
    /// Move the selected objects.
    Nudge {
        /// Along the array.
        dx_metres: f64,
        /// Ahead of it.
        dy_metres: f64,
    },
    /// The pointer is here, in whichever panel.
    Hover(Cursor),
    /// Show the whole scene.
    FitScene,
    /// Show whole maps.
    ResetMaps,
    /// Hide a panel that is in sight, or bring it into sight.
    TogglePanel(Panel),
    /// Hide a panel.
    ClosePanel(Panel),
    /// Show a panel, in front.
    OpenPanel(Panel),
    /// Let a panel fill the window, or end that.
    Maximise(Panel),
    /// Put all panels where they were at first.
    ResetLayout,
    /// Range-angle or Cartesian maps, the other way round.
    ToggleProjection,
    /// Range-angle or Cartesian maps.
    SetProjection(Projection),
    /// Lambda or decibels, the other way round.
    ToggleUnits,
    /// Lambda or decibels on colour bars, cuts, readouts and thresholds.
    SetUnits(Units),
    /// The difference with its sign or without, the other way round.
    ToggleAbsoluteDifference,
    /// The difference on a scale that just holds it or on one up to 1, the other way round.
    ToggleWholeDifference,
    /// Keep the cuts that are shown, whatever the cursor does.
    PinCuts,
    /// Let the pinned cuts of this number go.
    Unpin(usize),
    /// Let all pinned cuts go.
    UnpinAll,
    /// Colours of the maps.
    Colours(ColourMap),
    /// How maps are normalised.
    Normalise(Normalisation),
    /// What lies beneath the reflectors.
    SetFloor(Floor),
    /// Seed of the noise beneath the scene, which is part of it.
    SetNoiseSeed(u64),
    /// How the carrier's phase is read.
    SetCarrier(Carrier),
    /// Which window both transforms use.
    SetWindow(WindowFunction),
    /// Elements as they are built.
    SetElements(Arc<BuiltArray>),
    /// Another radar that sends at the same time, or none.
    SetInterferer(Option<Interferer>),
    /// A wall that mirrors, or none.
    SetMirror(Option<Mirror>),
    /// This radar before the scene.
    SetRadar(Box<Radar>),
    /// A radar of the list of presets.
    RadarPreset(usize),
    /// eta', the threshold of the target.
    SetTargetEta(f32),
    /// eta of the method of this name; its own where `None`.
    SetMethodEta(&'static str, Option<f32>),
    /// Where dragged objects come to rest.
    SetSnap(Snap),
    /// What bounds are computed for.
    SetBounds(BoundsSettings),
    /// Draw true reflectors over the maps.
    MarkReflectors,
    /// Draw true reflectors over the maps or not.
    ToggleReflectors,
    /// Draw the reflectors that the method found or not.
    ToggleFound,
    /// Draw the ends' fields of view or not.
    ToggleFieldsOfView,
    /// Draw over the maps what the formulas say of the selected reflector, or not.
    ToggleTheory,
    /// Mark every object by what became of it in the output.
    MarkKinds,
    /// Mark every object by what became of it in the output, or not.
    ToggleKinds,
    /// Which map is shown several times, and what differs.
    SetSeveral(Box<Several>),
    /// Which two methods and maps are compared, and how.
    SetCompare(Box<Compare>),
    /// Put the other of two compared maps in the place of the one on screen.
    Flip,
    /// Move the edge between two compared maps to this part of their width.
    Swipe(f32),
    /// Stop the second method's reconstruction.
    CancelSecond,
    /// Reconstruct with the method of this name.
    Method(&'static str),
    /// The next reconstruction method.
    NextMethod,
    /// Stop the reconstruction that runs.
    CancelMethod,
    /// Evaluate methods on test sets.
    Evaluate(EvaluationChoice),
    /// Stop the evaluation.
    CancelEvaluation,
    /// Copy what the evaluation found, as CSV.
    CopyEvaluation,
    /// Try methods on scenes, row by row.
    TryMethods(FailureChoice),
    /// Stop trying; the rows stay.
    CancelTrying,
    /// Ask for a table of rows and show it.
    OpenRows,
    /// Show the rows of this file.
    OpenRowsFile(PathBuf),
    /// Show what this CSV file holds: rows, or the log of a training.
    OpenTable(PathBuf),
    /// Ask where to save the rows as CSV.
    SaveRows,
    /// Save the rows in this file.
    SaveRowsTo(PathBuf),
    /// Forget every row.
    ClearRows,
    /// Bring the rows back that others took the place of.
    BringRowsBack,
    /// Put the scene of this row on screen, with its floor and method.
    OpenRow(usize),
    /// Look for a worse scene near the one on screen, or for its repair.
    Search(SearchChoice),
    /// Stop looking; what was found stays.
    CancelSearch,
    /// Put what the search found on screen.
    TakeFinding,
    /// Forget the search and its path.
    ForgetSearch,
    /// Keep the scene on screen among one's own, with this note.
    KeepScene(String),
    /// Ask for the folder of one's own scenes.
    ChooseOwnScenes,
    /// The folder of one's own scenes is the one that this file lies in.
    SetOwnScenes(PathBuf),
    /// Measure run time against error.
    Measure {
        /// Every algorithm and more reflectors, for about a minute.
        thorough: bool,
    },
    /// Stop measuring.
    CancelMeasurement,
    /// Do these for the guide: undo takes back the settings they change, too.
    Guided(Vec<Command>),
    /// Begin a lesson that comes with the program.
    BeginLesson(usize),
    /// Ask for a lesson file and begin it.
    OpenLesson,
    /// Begin the lesson in this file.
    OpenLessonFile(PathBuf),
    /// Begin a lesson that was read from a file and tried out.
    TakeLesson {
        /// What its progress is kept under.
        id: String,
        /// The lesson.
        lesson: Arc<Lesson>,
    },
    /// Go to a step of the lesson, from 0.
    LessonStep(usize),
    /// Predict.
    Predict(Guess),
    /// Put a solution of the challenge on screen; the challenge then counts as unsolved.
    ShowSolution,
    /// Give lessons the whole screen, for a projector, or end that.
    PresentLesson,
    /// End the lesson; scene and settings come back.
    LeaveLesson,
    /// Somebody else learns now.
    SetLearner(String),
    /// Forget what the learner did.
    ForgetProgress,
    /// The scene and the maps in large type, or everything as before.
    Present,
    /// Copy the picture of a map to the clipboard.
    CopyMap(MapKind),
    /// Close every message.
    CloseMessages,
    /// Light or dark.
    ToggleTheme,
    /// Larger interface.
    ZoomIn,
    /// Smaller interface.
    ZoomOut,
    /// Interface at its normal size.
    ZoomReset,
    /// Show or hide the palette of commands.
    Palette,
    /// Close the window.
    Quit,
}
