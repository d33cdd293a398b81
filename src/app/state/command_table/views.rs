//! Commands for maps, scales, the floor, the detector, the radar's signal, colours, lessons and the window.

use super::super::command::{Command, LessonCommand, Purpose, RadarCommand, ViewCommand, WindowCommand, WorkCommand};
use super::super::{Directions, Projection, Units};
use super::entry::{Entry, command, entries, entry, key, shift};
use crate::maps::Normalisation;
use crate::maps::cfar::Statistic;
use crate::picture::ColourMap;
use crate::radar::{Carrier, DecibelMilliwatts, Decibels, WindowFunction};
use crate::signal::Floor;
use eframe::egui::Key;

/// The commands, in the order of the palette.
pub(super) const COMMANDS: &[Entry] = {
    use Command::*;
    entries! {
        View(ViewCommand::FitScene), "Fit scene", "Show the whole scene", key(Key::F);
        View(ViewCommand::TogglePlay), "Play or stop motion", "Let every object move by its velocity; the file keeps time 0", key(Key::Q);
        View(ViewCommand::SetTime(0.0)), "Back to time 0", "Show the scene as its file has it", None;
        View(ViewCommand::ResetMaps), "Show whole maps", "Undo zoom and pan of the maps", key(Key::Home);
        AskFile(Purpose::OpenLesson), "Open lesson…", "Begin a lesson from a TOML file", None;
        Lesson(LessonCommand::Present), "Lessons: whole screen",
            "Lesson, scene and maps on the whole screen, in large type", shift(Key::F11);
        Lesson(LessonCommand::Leave), "Exit lesson", "End the lesson; your scene and settings come back", None;
        Window(WindowCommand::ResetLayout), "Reset layout", "Put all panels where they were at first", None;
        View(ViewCommand::ToggleProjection), "Cartesian / range-angle", "Draw maps over x and y, or over cos θ and range", key(Key::C);
        View(ViewCommand::SetProjection(Projection::RangeAngle)), "Maps: range-angle", "Draw maps over cos θ and range", None;
        View(ViewCommand::SetProjection(Projection::Cartesian)), "Maps: Cartesian", "Draw maps over x and y", None;
        View(ViewCommand::Normalise(Normalisation::MinMax)), "Normalise: min-max",
            "Λ is 0 at the smallest cell and 1 at the largest (the thesis)", key(Key::M);
        View(ViewCommand::ToggleUnits), "Λ / dB",
            "Tell Λ, or decibels relative to the peak, on colour bars, cuts, readouts and thresholds", key(Key::D);
        View(ViewCommand::SetUnits(Units::Lambda)), "Scale: Λ", "Tell Λ, 0 to 1, on colour bars, cuts, readouts and thresholds", None;
        View(ViewCommand::SetUnits(Units::Decibels)), "Scale: dB",
            "Tell decibels relative to the peak on colour bars, cuts, readouts and thresholds", None;
        View(ViewCommand::SetDirections(Directions::Cosine)), "Directions: cos θ",
            "Count cos θ along the axis of directions of every map", None;
        View(ViewCommand::SetDirections(Directions::Degrees)), "Directions: degrees",
            "Count degrees from straight ahead along the axis of directions of every map", None;
        View(ViewCommand::ToggleOneScale), "One scale for all maps",
            "Draw inputs, target and output on the scale of the strongest: what is weaker looks weaker", None;
        View(ViewCommand::ToggleFineColumns), "Maps on 256 columns",
            "Draw maps of few elements on 256 columns: values between are interpolated, and nothing more is resolved", None;
        View(ViewCommand::ToggleAbsoluteDifference), "|Difference|", "Draw the difference with its sign or without", None;
        View(ViewCommand::ToggleWholeDifference), "Difference: automatic scale",
            "Draw the difference on a scale that just holds it, or on one up to 1", None;
        View(ViewCommand::PinCuts), "Pin cuts", "Keep the cuts that are shown while the cursor moves on", key(Key::K);
        View(ViewCommand::UnpinAll), "Unpin cuts", "Let all pinned cuts go", None;
        View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(40.0)))), "Normalise: 40 dB",
            "Λ is 0 at 40 dB below the peak", None;
        View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(60.0)))), "Normalise: 60 dB",
            "Λ is 0 at 60 dB below the peak", None;
        View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(100.0)))), "Normalise: 100 dB",
            "Λ is 0 at 100 dB below the peak", key(Key::B);
        View(ViewCommand::SetFloor(Floor::Thesis)), "Floor: thesis", "The rounding noise of the thesis' f64 evaluation", None;
        View(ViewCommand::SetFloor(Floor::Exact)), "Floor: exact", "No noise at all", None;
        View(ViewCommand::SetFloor(Floor::Snr(Decibels(20.0)))), "Floor: thermal noise", "White noise at a signal-to-noise ratio", None;
        View(ViewCommand::SetFloor(Floor::Level(DecibelMilliwatts(-20.0)))), "Floor: thermal noise of a level",
            "White noise of −20 dBm in every sample, for any scene: an empty scene is noise alone", None;
        View(ViewCommand::SetFloor(Floor::Thermal)), "Floor: noise of the receivers", "kTBF, by the radar's link budget", None;
        View(ViewCommand::Detect(None)), "Detect: global threshold", "Cells whose Λ exceeds η or η' count as detections", None;
        View(ViewCommand::Detect(Some(Statistic::CellAveraging))), "Detect: cell averaging (CFAR)",
            "Each cell against the mean power of the cells around it, at a constant false-alarm rate", None;
        View(ViewCommand::Detect(Some(Statistic::OrderedStatistics))), "Detect: ordered statistics (CFAR)",
            "Each cell against a high rank of the cells around it: strong neighbours don't hide it", None;
        Radar(RadarCommand::SetCarrier(Carrier::OneWay)), "Carrier: one-way", "The thesis' convention: unambiguous over all of cos θ", None;
        Radar(RadarCommand::SetCarrier(Carrier::TwoWay)), "Carrier: two-way",
            "As equation 3.1 is printed: each column stands for two directions", None;
        Radar(RadarCommand::SetWindow(WindowFunction::Hann)), "Window: Hann", "Side lobes that fall fast (the thesis)", None;
        Radar(RadarCommand::SetWindow(WindowFunction::Hamming)), "Window: Hamming", "The first side lobes lower, the far ones higher", None;
        Radar(RadarCommand::SetWindow(WindowFunction::Blackman)), "Window: Blackman", "Lower side lobes still, a wider main lobe", None;
        Radar(RadarCommand::SetWindow(WindowFunction::Rectangular)), "Window: rectangular",
            "No weights: the narrowest main lobe, the highest side lobes", None;
        Radar(RadarCommand::SetInterferer(None)), "Interferer: none", "No other radar sends", None;
        Radar(RadarCommand::SetMirror(None)), "Mirror: none", "No wall mirrors", None;
        View(ViewCommand::Colours(ColourMap::Grey)), "Colours: grey", "The thesis' grey", None;
        View(ViewCommand::Colours(ColourMap::Viridis)), "Colours: viridis", "Colours of even brightness steps", None;
        View(ViewCommand::Colours(ColourMap::Diverging)), "Colours: diverging", "Blue below the middle, red above", None;
        View(ViewCommand::Colours(ColourMap::Inferno)), "Colours: inferno", "Dark to bright through red", None;
        View(ViewCommand::ToggleReflectors), "Mark true reflectors", "Draw the scene's reflectors over the maps", key(Key::R);
        View(ViewCommand::ToggleFound), "Mark found reflectors", "Draw the reflectors that the method found", None;
        View(ViewCommand::ToggleFieldsOfView), "Fields of view", "Draw what each end can see in the scene", key(Key::V);
        View(ViewCommand::ToggleTheory), "Theory on the maps",
            "Draw the formulas' figures of the selected reflector: beam, lobes, streak, comb, bound, wraps and folds", key(Key::T);
        View(ViewCommand::ToggleKinds), "Mark kinds of failure",
            "Mark in the maps which objects are found, missed, merged or on the wrong tooth, and false alarms", key(Key::H);
        View(ViewCommand::ToggleDeveloper), "Developer",
            "List the panels for developers of the program and of methods: Timing and Training", None;
        View(ViewCommand::Flip), "Flip two maps",
            "Put the other of the two maps of the panel Compare in the place of the one on screen", key(Key::X);
        View(ViewCommand::NextMethod), "Next method", "Reconstruct with the next method", key(Key::N);
        Work(WorkCommand::CancelMethod), "Cancel reconstruction", "Stop the reconstruction that runs", None;
        Window(WindowCommand::Present), "Presentation",
            "The scene and the maps on the whole screen, in large type; the same key brings everything back", key(Key::F11);
        Window(WindowCommand::ToggleCaptions), "Captions on the maps", "Say on every map what it shows, until the next drag", None;
        Window(WindowCommand::CloseMessages), "Close messages", "Close every message over the status bar", None;
        Window(WindowCommand::ToggleTheme), "Dark", "Switch between dark and light", command(Key::T);
        Window(WindowCommand::ZoomIn), "Zoom in", "Larger interface", command(Key::Plus);
        Window(WindowCommand::ZoomOut), "Zoom out", "Smaller interface", command(Key::Minus);
        Window(WindowCommand::ZoomReset), "Normal size", "Interface at its normal size", command(Key::Num0);
        Window(WindowCommand::Palette), "Command palette", "Find any command by name", command(Key::K);
        Window(WindowCommand::Quit), "Quit", "Close the window; an unsaved scene is restored at the next start", command(Key::Q);
    }
};
