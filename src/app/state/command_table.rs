//! The one list of commands: what each is called, what it does, and its key. Menus, tooltips, shortcuts and the palette read it.

use super::command::{
    Command, DocumentCommand, EditCommand, ExportCommand, LessonCommand, NewObject, RadarCommand, RowsCommand,
    ViewCommand, WindowCommand, WorkCommand,
};
use super::help::HelpPage;
use super::page_commands::{on_a_desktop, on_a_page};
use super::panel::{MapKind, Panel};
use super::settings::{Projection, Units};
use super::task_layouts::Task;
use crate::interact::{Alignment, Along, Coordinates};
use crate::maps::Normalisation;
use crate::maps::cfar::Statistic;
use crate::picture::ColourMap;
use crate::platform;
use crate::radar::presets::{self as radar_presets, RadarPreset};
use crate::radar::{Carrier, DecibelMilliwatts, Decibels, WindowFunction};
use crate::recording::presets as recordings;
use crate::scene::generate::Kind;
use crate::scene::presets;
use crate::signal::Floor;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use std::borrow::Cow;
use std::sync::OnceLock;

/// A command that needs nothing more than to be chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// What it is.
    pub command: Command,
    /// Name in menus and the palette.
    pub name: Cow<'static, str>,
    /// One sentence for tooltips.
    pub tooltip: &'static str,
    /// The key that runs it, if one does.
    pub key: Option<KeyboardShortcut>,
}

const fn entry(command: Command, name: &'static str, tooltip: &'static str, key: Option<KeyboardShortcut>) -> Entry {
    Entry { command, name: Cow::Borrowed(name), tooltip, key }
}

const fn key(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::SHIFT, key))
}

const fn command(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn command_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

/// Every command whose name isn't that of a panel, a scene or a method.
const TABLE: &[Entry] = {
    use Command::*;
    &[
        entry(Edit(EditCommand::Add(NewObject::Point, None)), "Add point", "Add one reflector", key(Key::P)),
        entry(
            Edit(EditCommand::Add(NewObject::Line, None)),
            "Add line",
            "Add a vertical line of 75 reflectors",
            key(Key::L),
        ),
        entry(
            Edit(EditCommand::Add(NewObject::Cluster, None)),
            "Add cluster",
            "Add a Gaussian cluster of 40 reflectors",
            key(Key::G),
        ),
        entry(
            Edit(EditCommand::Add(NewObject::Wall, None)),
            "Add wall",
            "Add a wall of 5 m: it shines where it faces the array, and hides what stands behind it",
            None,
        ),
        entry(
            Edit(EditCommand::Add(NewObject::Box, None)),
            "Add box",
            "Add a box of a car's size, 4.5 m by 1.8 m",
            None,
        ),
        entry(Edit(EditCommand::Add(NewObject::Post, None)), "Add post", "Add a round post of 0.2 m radius", None),
        entry(
            Edit(EditCommand::Add(NewObject::Polygon, None)),
            "Add polygon",
            "Add an outline with an inner corner, whose corners can be dragged",
            None,
        ),
        entry(
            Document(DocumentCommand::New),
            "New scene",
            "Start with an empty scene; undo brings this one back",
            command(Key::N),
        ),
        entry(
            Document(DocumentCommand::Open),
            "Open…",
            "Open a scene (.toml or .npz) or a recording (.toml)",
            command(Key::O),
        ),
        entry(Document(DocumentCommand::Save), "Save", "Save the scene as TOML", command(Key::S)),
        entry(
            Document(DocumentCommand::SaveAs),
            "Save as…",
            "Save the scene under another name (.toml or .npz)",
            command_shift(Key::S),
        ),
        entry(Work(WorkCommand::OpenLog), "Open training log…", "Watch the loss of a training (its log.csv)", None),
        entry(Rows(RowsCommand::Open), "Open rows…", "Show the rows of an evaluation (.csv of evaluate --rows)", None),
        entry(Rows(RowsCommand::Save), "Save rows…", "Save the rows of the panel Failures as CSV", None),
        entry(
            Rows(RowsCommand::ChooseOwnScenes),
            "Folder of own scenes…",
            "Choose where Keep puts scenes: pick any scene of the folder",
            None,
        ),
        entry(
            Export(ExportCommand::Picture),
            "Export picture…",
            "Save the window as PNG, or all panels as SVG",
            command(Key::E),
        ),
        entry(Export(ExportCommand::Maps), "Export maps…", "Save samples and maps as NumPy arrays (.npz)", None),
        entry(
            Export(ExportCommand::RecordDrag),
            "Record a drag…",
            "Record the next drag as an animation (.gif) for slides",
            None,
        ),
        entry(
            Export(ExportCommand::DrawLesson),
            "Draw lesson…",
            "Draw every step of the lesson as a picture (.png) for slides",
            None,
        ),
        entry(
            Export(ExportCommand::StopRecording),
            "Stop recording",
            "Give up what is recorded or drawn; nothing is written",
            None,
        ),
        entry(Export(ExportCommand::Metrics), "Export metrics…", "Save P_D, P_FA and SE of this scene as CSV", None),
        entry(Edit(EditCommand::Undo), "Undo", "Undo the last change of the scene", command(Key::Z)),
        entry(Edit(EditCommand::Redo), "Redo", "Redo what was undone", command_shift(Key::Z)),
        entry(Edit(EditCommand::Cut), "Cut", "Move the selected objects to the clipboard, as TOML", command(Key::X)),
        entry(Edit(EditCommand::Copy), "Copy", "Copy the selected objects to the clipboard, as TOML", command(Key::C)),
        entry(
            Export(ExportCommand::CopyShared),
            "Copy all as text",
            "Copy scene, radar, view, method and lesson step as one line; paste it into another apertura, or start one with it",
            None,
        ),
        entry(
            Export(ExportCommand::CopyLink),
            "Copy link",
            "Copy an address that opens this page with scene, radar, view, method and lesson step",
            None,
        ),
        entry(
            Edit(EditCommand::Paste),
            "Paste",
            "Add the objects on the clipboard, or open what was copied as text",
            command(Key::V),
        ),
        entry(Edit(EditCommand::Duplicate), "Duplicate", "Copy the selected objects a metre aside", command(Key::D)),
        entry(Edit(EditCommand::Delete), "Delete", "Delete the selected objects", key(Key::Delete)),
        entry(Edit(EditCommand::SelectAll), "Select all", "Select every object", command(Key::A)),
        entry(
            Edit(EditCommand::SelectNext),
            "Select next object",
            "Select the object after the one that was picked last",
            key(Key::O),
        ),
        entry(
            Edit(EditCommand::SelectPrevious),
            "Select previous object",
            "Select the object before it",
            shift(Key::O),
        ),
        entry(
            Edit(EditCommand::SetCoordinates(Coordinates::Cartesian)),
            "Places: x and y",
            "Tell and enter places as x and y",
            None,
        ),
        entry(
            Edit(EditCommand::SetCoordinates(Coordinates::Polar)),
            "Places: range and angle",
            "Tell and enter places as range and direction",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Left)),
            "Align left",
            "Move the selected objects' left ends to the leftmost",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Centre)),
            "Align centres",
            "Move the selected objects one behind the other",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Right)),
            "Align right",
            "Move the selected objects' right ends to the rightmost",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Near)),
            "Align near",
            "Move the selected objects' near ends to the nearest",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Middle)),
            "Align middles",
            "Move the selected objects one beside the other",
            None,
        ),
        entry(
            Edit(EditCommand::Align(Alignment::Far)),
            "Align far",
            "Move the selected objects' far ends to the farthest",
            None,
        ),
        entry(
            Edit(EditCommand::Distribute(Along::X)),
            "Distribute along x",
            "The same distance in x between selected objects",
            None,
        ),
        entry(
            Edit(EditCommand::Distribute(Along::Y)),
            "Distribute along y",
            "The same distance in y between selected objects",
            None,
        ),
        entry(
            Window(WindowCommand::Escape),
            "Deselect",
            "Cancel a drag, show all panels, select nothing",
            key(Key::Escape),
        ),
        entry(View(ViewCommand::FitScene), "Fit scene", "Show the whole scene", key(Key::F)),
        entry(
            View(ViewCommand::TogglePlay),
            "Play or stop motion",
            "Let every object move by its velocity; the file keeps time 0",
            key(Key::Q),
        ),
        entry(View(ViewCommand::SetTime(0.0)), "Back to time 0", "Show the scene as its file has it", None),
        entry(View(ViewCommand::ResetMaps), "Show whole maps", "Undo zoom and pan of the maps", key(Key::Home)),
        entry(Lesson(LessonCommand::Open), "Open lesson…", "Begin a lesson from a TOML file", None),
        entry(
            Lesson(LessonCommand::Present),
            "Lessons: whole screen",
            "Lesson, scene and maps on the whole screen, in large type",
            shift(Key::F11),
        ),
        entry(Lesson(LessonCommand::Leave), "Exit lesson", "End the lesson; your scene and settings come back", None),
        entry(Window(WindowCommand::ResetLayout), "Reset layout", "Put all panels where they were at first", None),
        entry(
            View(ViewCommand::ToggleProjection),
            "Cartesian / range-angle",
            "Draw maps over x and y, or over cos θ and range",
            key(Key::C),
        ),
        entry(
            View(ViewCommand::SetProjection(Projection::RangeAngle)),
            "Maps: range-angle",
            "Draw maps over cos θ and range",
            None,
        ),
        entry(
            View(ViewCommand::SetProjection(Projection::Cartesian)),
            "Maps: Cartesian",
            "Draw maps over x and y",
            None,
        ),
        entry(
            View(ViewCommand::Normalise(Normalisation::MinMax)),
            "Normalise: min-max",
            "Λ is 0 at the smallest cell and 1 at the largest (the thesis)",
            key(Key::M),
        ),
        entry(
            View(ViewCommand::ToggleUnits),
            "Λ / dB",
            "Tell Λ, or decibels relative to the peak, on colour bars, cuts, readouts and thresholds",
            key(Key::D),
        ),
        entry(
            View(ViewCommand::SetUnits(Units::Lambda)),
            "Scale: Λ",
            "Tell Λ, 0 to 1, on colour bars, cuts, readouts and thresholds",
            None,
        ),
        entry(
            View(ViewCommand::SetUnits(Units::Decibels)),
            "Scale: dB",
            "Tell decibels relative to the peak on colour bars, cuts, readouts and thresholds",
            None,
        ),
        entry(
            View(ViewCommand::ToggleAbsoluteDifference),
            "|Difference|",
            "Draw the difference with its sign or without",
            None,
        ),
        entry(
            View(ViewCommand::ToggleWholeDifference),
            "Difference: automatic scale",
            "Draw the difference on a scale that just holds it, or on one up to 1",
            None,
        ),
        entry(
            View(ViewCommand::PinCuts),
            "Pin cuts",
            "Keep the cuts that are shown while the cursor moves on",
            key(Key::K),
        ),
        entry(View(ViewCommand::UnpinAll), "Unpin cuts", "Let all pinned cuts go", None),
        entry(
            View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(40.0)))),
            "Normalise: 40 dB",
            "Λ is 0 at 40 dB below the peak",
            None,
        ),
        entry(
            View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(60.0)))),
            "Normalise: 60 dB",
            "Λ is 0 at 60 dB below the peak",
            None,
        ),
        entry(
            View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(100.0)))),
            "Normalise: 100 dB",
            "Λ is 0 at 100 dB below the peak",
            key(Key::B),
        ),
        entry(
            View(ViewCommand::SetFloor(Floor::Thesis)),
            "Floor: thesis",
            "The rounding noise of the thesis' f64 evaluation",
            None,
        ),
        entry(View(ViewCommand::SetFloor(Floor::Exact)), "Floor: exact", "No noise at all", None),
        entry(
            View(ViewCommand::SetFloor(Floor::Snr(Decibels(20.0)))),
            "Floor: thermal noise",
            "White noise at a signal-to-noise ratio",
            None,
        ),
        entry(
            View(ViewCommand::SetFloor(Floor::Level(DecibelMilliwatts(-20.0)))),
            "Floor: thermal noise of a level",
            "White noise of -20 dBm in every sample, whatever the scene: an empty scene is noise alone",
            None,
        ),
        entry(
            View(ViewCommand::SetFloor(Floor::Thermal)),
            "Floor: noise of the receivers",
            "kTBF, by the radar's link budget",
            None,
        ),
        entry(
            View(ViewCommand::Detect(None)),
            "Detect: global threshold",
            "Cells whose Λ exceeds η or η' count as detections",
            None,
        ),
        entry(
            View(ViewCommand::Detect(Some(Statistic::CellAveraging))),
            "Detect: cell averaging (CFAR)",
            "Each cell against the mean power of the cells around it, at a constant false-alarm rate",
            None,
        ),
        entry(
            View(ViewCommand::Detect(Some(Statistic::OrderedStatistics))),
            "Detect: ordered statistics (CFAR)",
            "Each cell against a high rank of the cells around it: strong neighbours don't hide it",
            None,
        ),
        entry(
            Radar(RadarCommand::SetCarrier(Carrier::OneWay)),
            "Carrier: one-way",
            "The thesis' convention: unambiguous over all of cos θ",
            None,
        ),
        entry(
            Radar(RadarCommand::SetCarrier(Carrier::TwoWay)),
            "Carrier: two-way",
            "As equation 3.1 is printed: each column stands for two directions",
            None,
        ),
        entry(
            Radar(RadarCommand::SetWindow(WindowFunction::Hann)),
            "Window: Hann",
            "Side lobes that fall fast (the thesis)",
            None,
        ),
        entry(
            Radar(RadarCommand::SetWindow(WindowFunction::Hamming)),
            "Window: Hamming",
            "The first side lobes lower, the far ones higher",
            None,
        ),
        entry(
            Radar(RadarCommand::SetWindow(WindowFunction::Blackman)),
            "Window: Blackman",
            "Lower side lobes still, a wider main lobe",
            None,
        ),
        entry(
            Radar(RadarCommand::SetWindow(WindowFunction::Rectangular)),
            "Window: rectangular",
            "No weights: the narrowest main lobe, the highest side lobes",
            None,
        ),
        entry(Radar(RadarCommand::SetInterferer(None)), "Interferer: none", "No other radar sends", None),
        entry(Radar(RadarCommand::SetMirror(None)), "Mirror: none", "No wall mirrors", None),
        entry(View(ViewCommand::Colours(ColourMap::Grey)), "Colours: grey", "The thesis' grey", None),
        entry(
            View(ViewCommand::Colours(ColourMap::Viridis)),
            "Colours: viridis",
            "Colours of even brightness steps",
            None,
        ),
        entry(
            View(ViewCommand::Colours(ColourMap::Diverging)),
            "Colours: diverging",
            "Blue below the middle, red above",
            None,
        ),
        entry(View(ViewCommand::Colours(ColourMap::Inferno)), "Colours: inferno", "Dark to bright through red", None),
        entry(
            View(ViewCommand::ToggleReflectors),
            "Mark true reflectors",
            "Draw the scene's reflectors over the maps",
            key(Key::R),
        ),
        entry(
            View(ViewCommand::ToggleFound),
            "Mark found reflectors",
            "Draw the reflectors that the method found",
            None,
        ),
        entry(
            View(ViewCommand::ToggleFieldsOfView),
            "Fields of view",
            "Draw what each end can see in the scene",
            key(Key::V),
        ),
        entry(
            View(ViewCommand::ToggleTheory),
            "Theory on the maps",
            "Draw what the formulas say of the selected reflector: beam, lobes, streak, comb, bound, what wraps and folds",
            key(Key::T),
        ),
        entry(
            View(ViewCommand::ToggleKinds),
            "Mark kinds of failure",
            "Mark in the maps which objects are found, missed, merged or on the wrong tooth, and ghosts",
            key(Key::H),
        ),
        entry(
            View(ViewCommand::Flip),
            "Flip two maps",
            "Put the other of the two maps of the panel Compare in the place of the one on screen",
            key(Key::X),
        ),
        entry(View(ViewCommand::NextMethod), "Next method", "Reconstruct with the next method", key(Key::N)),
        entry(
            Work(WorkCommand::MeasureMethodTimes),
            "Measure the methods' times",
            "Run every method once on the scene on screen",
            None,
        ),
        entry(Work(WorkCommand::CancelMethod), "Cancel reconstruction", "Stop the reconstruction that runs", None),
        entry(
            Window(WindowCommand::Present),
            "Presentation",
            "The scene and the maps on the whole screen, in large type; the same key brings everything back",
            key(Key::F11),
        ),
        entry(
            Window(WindowCommand::ToggleCaptions),
            "Captions on the maps",
            "Say on every map what it shows, until the next drag",
            None,
        ),
        entry(Window(WindowCommand::CloseMessages), "Close messages", "Close every message in the corner", None),
        entry(Window(WindowCommand::ToggleTheme), "Light / dark", "Switch between light and dark", command(Key::T)),
        entry(Window(WindowCommand::ZoomIn), "Zoom in", "Larger interface", command(Key::Plus)),
        entry(Window(WindowCommand::ZoomOut), "Zoom out", "Smaller interface", command(Key::Minus)),
        entry(Window(WindowCommand::ZoomReset), "Normal size", "Interface at its normal size", command(Key::Num0)),
        entry(Window(WindowCommand::Palette), "Command palette", "Find any command by name", command(Key::K)),
        entry(
            Window(WindowCommand::Quit),
            "Quit",
            "Close the window; an unsaved scene is restored at the next start",
            command(Key::Q),
        ),
    ]
};

/// Keys that show or hide a panel.
const PANEL_KEYS: &[(Panel, Key)] = &[
    (Panel::Guide, Key::F1),
    (Panel::Controls, Key::F2),
    (Panel::Inspector, Key::F3),
    (Panel::Cuts, Key::F4),
    (Panel::Lesson, Key::F5),
    (Panel::Roc, Key::F6),
    (Panel::Timing, Key::F7),
    (Panel::Bounds, Key::F8),
    (Panel::Evaluation, Key::F9),
    (Panel::Failures, Key::E),
    (Panel::RunTime, Key::F10),
    (Panel::Several, Key::S),
    (Panel::Compare, Key::J),
    (Panel::Values, Key::I),
    (Panel::Phasors, Key::A),
    (Panel::Chirp, Key::U),
    (Panel::RangeDoppler, Key::Y),
    (Panel::Radar, Key::W),
    (Panel::Training, Key::F12),
];

/// Keys of [`Task::ALL`].
const TASK_KEYS: [Key; 4] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];

fn arrange(task: Task, digit: Key) -> Entry {
    let name = format!("Arrange for: {}", task.name());
    named(Command::Window(WindowCommand::ArrangeFor(task)), name, task.describe(), key(digit))
}

fn named(command: Command, name: String, tooltip: &'static str, key: Option<KeyboardShortcut>) -> Entry {
    Entry { command, name: name.into(), tooltip, key }
}

fn random(kind: Kind) -> Entry {
    let keys = [Key::Num1, Key::Num2, Key::Num3];
    let (tooltip, key) = match kind.test_set() {
        Some(set) => ("A scene of this test set of the thesis", command(keys[set - 1])),
        None if kind == Kind::Noise => ("An empty scene over thermal noise of a level of its own", None),
        None => ("A scene of a kind that the thesis' sets leave out", None),
    };
    let name = format!("Random scene: {}", kind.description());
    named(Command::Document(DocumentCommand::RandomScene(kind)), name, tooltip, key)
}

/// What shows and hides each panel, pages of help, what lets a panel fill the window, and what copies a map.
fn of_panels() -> Vec<Entry> {
    let panel_key = |panel| PANEL_KEYS.iter().find(|(p, _)| *p == panel).and_then(|(_, k)| key(*k));
    let toggle = |panel: Panel| {
        let name = format!("Show or hide: {}", panel.title());
        named(Command::Window(WindowCommand::TogglePanel(panel)), name, panel.describe(), panel_key(panel))
    };
    let maximise = |panel: Panel| {
        let name = format!("Maximise: {}", panel.title());
        named(Command::Window(WindowCommand::Maximise(panel)), name, panel.describe(), None)
    };
    let help = |page: HelpPage| {
        named(Command::Window(WindowCommand::Help(page)), page.title().to_owned(), page.describe(), None)
    };
    let copy = |kind: MapKind| {
        let tooltip = "Copy the whole map to the clipboard as a picture, a pixel a cell";
        named(Command::Export(ExportCommand::CopyMap(kind)), format!("Copy picture: {}", kind.title()), tooltip, None)
    };
    let panels = || Panel::all().into_iter();
    let listed = panels().map(toggle).chain(HelpPage::ALL.map(help)).chain(panels().map(maximise));
    listed.chain(MapKind::ALL.map(copy)).collect()
}

fn preset((index, preset): (usize, &presets::Preset)) -> Entry {
    let name = format!("Preset: {}", preset.id.replace('-', " "));
    let tooltip = match preset.is_failure() {
        true => "Open a scene on which a method fails, with the reason in its notes",
        false => "Open a scene the thesis talks about",
    };
    named(Command::Document(DocumentCommand::Preset(index)), name, tooltip, None)
}

/// Every command of the table, of every panel, of every kind of random scene and of every preset, in the order the palette lists them, as far as
/// there are such here. The methods are not among them: they are the app's.
pub fn listed() -> &'static [Entry] {
    static LISTED: OnceLock<Vec<Entry>> = OnceLock::new();
    LISTED.get_or_init(|| listed_where(if platform::IN_A_BROWSER { on_a_page } else { on_a_desktop }))
}

/// What there is of [`everything`] where `keys` says, with the keys that it says.
fn listed_where(keys: impl Fn(&Command, Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>>) -> Vec<Entry> {
    everything()
        .into_iter()
        .filter_map(|entry| Some(Entry { key: keys(&entry.command, entry.key)?, ..entry }))
        .collect()
}

/// Every command, whether a desktop has it or a page.
fn everything() -> Vec<Entry> {
    let radar = |(index, preset): (usize, &RadarPreset)| {
        named(Command::Radar(RadarCommand::Preset(index)), format!("Radar: {}", preset.name), preset.about, None)
    };
    let recording = |(index, preset): (usize, &recordings::Preset)| {
        let name = format!("Recording: {}", preset.id.replace('-', " "));
        let tooltip = "Open samples that a radar measured";
        named(Command::Document(DocumentCommand::Recording(index)), name, tooltip, None)
    };
    let mut all = TABLE.to_vec();
    all.extend(Kind::all().map(random));
    all.extend(Task::ALL.into_iter().zip(TASK_KEYS).map(|(task, digit)| arrange(task, digit)));
    all.extend(of_panels());
    all.extend(presets::ALL.iter().enumerate().map(preset));
    all.extend(recordings::ALL.iter().enumerate().map(recording));
    all.extend(radar_presets::ALL.iter().enumerate().map(radar));
    all
}

/// The commands that have a key, longer shortcuts first: Ctrl+Shift+Z would also match Ctrl+Z.
pub fn shortcuts() -> &'static [(KeyboardShortcut, Command)] {
    static SHORTCUTS: OnceLock<Vec<(KeyboardShortcut, Command)>> = OnceLock::new();
    SHORTCUTS.get_or_init(|| {
        let mut all: Vec<_> = listed().iter().filter_map(|e| Some((e.key?, e.command.clone()))).collect();
        all.sort_by_key(|(key, _)| !(key.modifiers.shift || key.modifiers.alt));
        all
    })
}

impl Command {
    /// Its line of the list, where it has one: what is added or closed somewhere in particular is called as anywhere.
    pub fn entry(&self) -> Option<&'static Entry> {
        let like = match self {
            Command::Edit(EditCommand::Add(kind, _)) => Command::Edit(EditCommand::Add(*kind, None)),
            Command::Window(WindowCommand::OpenPanel(panel) | WindowCommand::ClosePanel(panel)) => {
                Command::Window(WindowCommand::TogglePanel(*panel))
            }
            other => other.clone(),
        };
        listed().iter().find(|e| e.command == like)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        let (mut keys, mut names) = (BTreeMap::new(), BTreeMap::new());
        for entry in listed() {
            assert!(names.insert(entry.name.clone(), ()).is_none(), "{} twice", entry.name);
            assert!(!entry.tooltip.is_empty());
            if let Some(key) = entry.key {
                let text = format!("{key:?}");
                assert!(keys.insert(text, entry.name.clone()).is_none(), "{} shares its key", entry.name);
            }
        }
    }

    #[test]
    fn no_command_of_a_page_has_a_key_of_the_browser() {
        let mut keys = BTreeMap::new();
        for entry in listed_where(on_a_page) {
            let Some(KeyboardShortcut { modifiers, logical_key: key }) = entry.key else { continue };
            let of_the_browser = matches!(key, Key::F5 | Key::F11 | Key::F12)
                || modifiers.command && !modifiers.shift && matches!(key, Key::T | Key::W | Key::N);
            assert!(!of_the_browser, "{}", entry.name);
            let before = keys.insert(format!("{modifiers:?} {key:?}"), entry.name.clone());
            assert!(before.is_none(), "{} shares its key with {before:?}", entry.name);
        }
    }

    #[test]
    fn a_page_offers_a_link_in_place_of_closing_the_window() {
        let [link, quit] = [Command::Export(ExportCommand::CopyLink), Command::Window(WindowCommand::Quit)];
        let offers = |list: &[Entry], command: &Command| list.iter().any(|entry| entry.command == *command);
        let (page, desktop) = (listed_where(on_a_page), listed_where(on_a_desktop));
        assert!(offers(&page, &link) && !offers(&page, &quit));
        assert!(!offers(&desktop, &link) && offers(&desktop, &quit));
    }

    #[test]
    fn every_choice_of_a_window_and_of_colours_is_listed() {
        for window in WindowFunction::ALL {
            assert!(Command::Radar(RadarCommand::SetWindow(window)).entry().is_some(), "{window:?}");
        }
        for colours in ColourMap::ALL {
            assert!(Command::View(ViewCommand::Colours(colours)).entry().is_some(), "{colours:?}");
        }
        let map = Panel::Map(MapKind::Target);
        assert_eq!(
            Command::Window(WindowCommand::ClosePanel(map)).entry(),
            Command::Window(WindowCommand::TogglePanel(map)).entry()
        );
    }
}
