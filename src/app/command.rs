//! Everything a button, a menu entry, a shortcut or the palette can ask for.

use super::layout::Panel;
use super::settings::Projection;
use crate::interact::Place;
use crate::maps::Normalisation;
use crate::picture::ColourMap;
use crate::radar::{Carrier, Decibels, WindowFunction};
use crate::scene::generate::Kind;
use crate::scene::presets;
use crate::signal::Floor;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use std::borrow::Cow;
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
    /// Open a scene that comes with the program.
    Preset(usize),
    /// Make a random test scene.
    RandomScene(Kind),
    /// Ask for the log of a training and watch it.
    OpenLog,
    /// Save the window as a picture, or the scene's panels as a drawing.
    ExportPicture,
    /// Save the maps as NumPy arrays.
    ExportMaps,
    /// Save the figures as CSV.
    ExportMetrics,
    /// Undo the last change of the scene.
    Undo,
    /// Redo what was undone.
    Redo,
    /// Cut the selected objects to the clipboard.
    Cut,
    /// Copy the selected objects as TOML.
    Copy,
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
    /// Select nothing, end maximising, close the palette.
    Escape,
    /// Add an object, at a place or where there is room.
    Add(NewObject, Option<Place>),
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
    /// Colours of the maps.
    Colours(ColourMap),
    /// How maps are normalised.
    Normalise(Normalisation),
    /// What lies beneath the reflectors.
    SetFloor(Floor),
    /// How the carrier's phase is read.
    SetCarrier(Carrier),
    /// Which window both transforms use.
    SetWindow(WindowFunction),
    /// Draw true reflectors over the maps or not.
    ToggleReflectors,
    /// Draw the ends' fields of view or not.
    ToggleFieldsOfView,
    /// Reconstruct with the method of this name.
    Method(&'static str),
    /// The next reconstruction method.
    NextMethod,
    /// Stop the reconstruction that runs.
    CancelMethod,
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

/// Name, explanation and key of a command.
#[derive(Debug, Clone, PartialEq)]
pub struct Spec {
    /// Name in menus and the palette.
    pub name: Cow<'static, str>,
    /// One sentence for tooltips.
    pub tooltip: &'static str,
    /// The key that runs it, if one does.
    pub shortcut: Option<KeyboardShortcut>,
}

const fn key(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn command(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn command_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

impl Command {
    /// The commands that need nothing more than to be chosen, in the order the palette lists them. The methods are not among them: they
    /// are the app's.
    pub fn all() -> Vec<Command> {
        use Command::*;
        let mut all = vec![
            Add(NewObject::Point, None),
            Add(NewObject::Line, None),
            Add(NewObject::Cluster, None),
            New,
            Open,
            Save,
            SaveAs,
            OpenLog,
            ExportPicture,
            ExportMaps,
            ExportMetrics,
            Undo,
            Redo,
            Cut,
            Copy,
            Paste,
            Duplicate,
            Delete,
            SelectAll,
            Escape,
            FitScene,
            ResetMaps,
            ResetLayout,
            ToggleProjection,
            SetProjection(Projection::RangeAngle),
            SetProjection(Projection::Cartesian),
            Normalise(Normalisation::MinMax),
            Normalise(Normalisation::DynamicRange(Decibels(60.0))),
            Normalise(Normalisation::DynamicRange(Decibels(100.0))),
            SetFloor(Floor::Thesis),
            SetFloor(Floor::Exact),
            SetFloor(Floor::Snr(Decibels(20.0))),
            SetCarrier(Carrier::OneWay),
            SetCarrier(Carrier::TwoWay),
            ToggleReflectors,
            ToggleFieldsOfView,
            NextMethod,
            CancelMethod,
            CloseMessages,
            ToggleTheme,
            ZoomIn,
            ZoomOut,
            ZoomReset,
            Palette,
            Quit,
        ];
        all.extend(Kind::all().map(RandomScene));
        all.extend(WindowFunction::ALL.map(SetWindow));
        all.extend(ColourMap::ALL.map(Colours));
        all.extend(Panel::all().into_iter().map(TogglePanel));
        all.extend(Panel::all().into_iter().map(Maximise));
        all.extend((0..presets::ALL.len()).map(Preset));
        all
    }

    /// Name, explanation and key.
    pub fn spec(&self) -> Spec {
        use Command::*;
        let spec = |name: &'static str, tooltip, shortcut| Spec { name: name.into(), tooltip, shortcut };
        let named = |name: String, tooltip, shortcut| Spec { name: name.into(), tooltip, shortcut };
        match self {
            New => spec("New scene", "Start with an empty scene; undo brings this one back", command(Key::N)),
            Open | OpenPath(_) => spec("Open…", "Open a scene (.toml or .npz)", command(Key::O)),
            Save => spec("Save", "Save the scene as TOML", command(Key::S)),
            SaveAs => spec("Save as…", "Save the scene under another name (.toml or .npz)", command_shift(Key::S)),
            Preset(index) => {
                let id = presets::ALL.get(*index).map_or("", |preset| preset.id);
                named(format!("Preset: {}", id.replace('-', " ")), "Open a scene the thesis talks about", None)
            }
            RandomScene(kind) => {
                let keys = [Key::Num1, Key::Num2, Key::Num3];
                let (tooltip, shortcut) = match kind.test_set() {
                    Some(set) => ("A scene of this test set of the thesis", key(keys[set - 1])),
                    None => ("A scene of a kind that the thesis' sets leave out", None),
                };
                named(format!("Random scene: {}", kind.description()), tooltip, shortcut)
            }
            OpenLog => spec("Open training log…", "Watch the loss of a training (its log.csv)", None),
            ExportPicture => spec("Export picture…", "Save the window as PNG, or all panels as SVG", command(Key::E)),
            ExportMaps => spec("Export maps…", "Save samples and maps as NumPy arrays (.npz)", None),
            ExportMetrics => spec("Export metrics…", "Save P_D, P_FA and SE of this scene as CSV", None),
            Undo => spec("Undo", "Undo the last change of the scene", command(Key::Z)),
            Redo => spec("Redo", "Redo what was undone", command_shift(Key::Z)),
            Cut => spec("Cut", "Move the selected objects to the clipboard, as TOML", command(Key::X)),
            Copy => spec("Copy", "Copy the selected objects to the clipboard, as TOML", command(Key::C)),
            Paste | PasteText(_) => spec("Paste", "Add the objects on the clipboard", command(Key::V)),
            Duplicate => spec("Duplicate", "Copy the selected objects a metre aside", command(Key::D)),
            Delete => spec("Delete", "Delete the selected objects", key(Key::Delete)),
            SelectAll => spec("Select all", "Select every object", command(Key::A)),
            Escape => spec("Deselect", "Cancel a drag, show all panels, select nothing", key(Key::Escape)),
            Add(NewObject::Point, _) => spec("Add point", "Add one reflector", key(Key::P)),
            Add(NewObject::Line, _) => spec("Add line", "Add a vertical line of 75 reflectors", key(Key::L)),
            Add(NewObject::Cluster, _) => spec("Add cluster", "Add a Gaussian cluster of 40 reflectors", key(Key::G)),
            FitScene => spec("Fit scene", "Show the whole scene", key(Key::F)),
            ResetMaps => spec("Show whole maps", "Undo zoom and pan of the maps", key(Key::Home)),
            TogglePanel(panel) | OpenPanel(panel) | ClosePanel(panel) => {
                named(format!("Show or hide: {}", panel.title()), panel.describe(), panel_key(*panel))
            }
            Maximise(panel) => named(format!("Maximise: {}", panel.title()), panel.describe(), None),
            ResetLayout => spec("Reset layout", "Put all panels where they were at first", None),
            ToggleProjection => {
                spec("Cartesian / range-angle", "Draw maps over x and y, or over cos θ and range", key(Key::C))
            }
            SetProjection(Projection::RangeAngle) => spec("Maps: range-angle", "Draw maps over cos θ and range", None),
            SetProjection(Projection::Cartesian) => spec("Maps: Cartesian", "Draw maps over x and y", None),
            Colours(ColourMap::Grey) => spec("Colours: grey", "The thesis' grey", None),
            Colours(ColourMap::Viridis) => spec("Colours: viridis", "Colours of even brightness steps", None),
            Colours(ColourMap::Diverging) => spec("Colours: diverging", "Blue below the middle, red above", None),
            Colours(ColourMap::Inferno) => spec("Colours: inferno", "Dark to bright through red", None),
            Normalise(Normalisation::MinMax) => {
                spec("Normalise: min-max", "Λ is 0 at the smallest cell and 1 at the largest (the thesis)", key(Key::M))
            }
            Normalise(Normalisation::DynamicRange(db)) if db.0 == 60.0 => {
                spec("Normalise: 60 dB", "Λ is 0 at 60 dB below the peak", None)
            }
            Normalise(_) => spec("Normalise: 100 dB", "Λ is 0 at 100 dB below the peak", key(Key::B)),
            SetFloor(Floor::Thesis) => spec("Floor: thesis", "The rounding noise of the thesis' f64 evaluation", None),
            SetFloor(Floor::Exact) => spec("Floor: exact", "No noise at all", None),
            SetFloor(_) => spec("Floor: thermal noise", "White noise at a signal-to-noise ratio", None),
            SetCarrier(Carrier::OneWay) => spec("Carrier: one-way", "Unambiguous over all of cos θ", None),
            SetCarrier(Carrier::TwoWay) => {
                spec("Carrier: two-way", "As equation 3.1 is printed: cos θ folds twice", None)
            }
            SetWindow(WindowFunction::Hann) => spec("Window: Hann", "Side lobes that fall fast (the thesis)", None),
            SetWindow(WindowFunction::Hamming) => {
                spec("Window: Hamming", "The first side lobes lower, the far ones higher", None)
            }
            SetWindow(WindowFunction::Blackman) => {
                spec("Window: Blackman", "Lower side lobes still, a wider main lobe", None)
            }
            SetWindow(WindowFunction::Rectangular) => {
                spec("Window: rectangular", "No weights: the narrowest main lobe, the highest side lobes", None)
            }
            ToggleReflectors => spec("Mark true reflectors", "Draw the scene's reflectors over the maps", key(Key::R)),
            ToggleFieldsOfView => spec("Fields of view", "Draw what each end can see in the scene", key(Key::V)),
            Method(name) => named(format!("Method: {name}"), "Reconstruct with this method", None),
            NextMethod => spec("Next method", "Reconstruct with the next method", key(Key::N)),
            CancelMethod => spec("Cancel reconstruction", "Stop the reconstruction that runs", None),
            CloseMessages => spec("Close messages", "Close every message in the corner", None),
            ToggleTheme => spec("Light / dark", "Switch between light and dark", command(Key::T)),
            ZoomIn => spec("Zoom in", "Larger interface", command(Key::Plus)),
            ZoomOut => spec("Zoom out", "Smaller interface", command(Key::Minus)),
            ZoomReset => spec("Normal size", "Interface at its normal size", command(Key::Num0)),
            Palette => spec("Command palette", "Find any command by name", command(Key::K)),
            Quit => spec("Quit", "Close the window; an unsaved scene is restored at the next start", command(Key::Q)),
        }
    }
}

fn panel_key(panel: Panel) -> Option<KeyboardShortcut> {
    match panel {
        Panel::Controls => key(Key::F2),
        Panel::Inspector => key(Key::F3),
        Panel::Cuts => key(Key::F4),
        Panel::Roc => key(Key::F6),
        Panel::Timing => key(Key::F7),
        Panel::Bounds => key(Key::F8),
        Panel::Evaluation => key(Key::F9),
        Panel::Front => key(Key::F10),
        Panel::Training => key(Key::F12),
        Panel::Guide => key(Key::F1),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        let (mut keys, mut names) = (BTreeMap::new(), BTreeMap::new());
        for command in Command::all() {
            let spec = command.spec();
            assert!(names.insert(spec.name.clone(), ()).is_none(), "{} twice", spec.name);
            assert!(!spec.tooltip.is_empty());
            if let Some(shortcut) = spec.shortcut {
                let text = format!("{shortcut:?}");
                assert!(keys.insert(text, spec.name.clone()).is_none(), "{} shares its key", spec.name);
            }
        }
    }
}
