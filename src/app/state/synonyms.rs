//! Further search words for commands in the palette.

use super::command::{
    Command, DocumentCommand, EditCommand, ExportCommand, LessonCommand, Purpose, RadarCommand, ViewCommand,
    WindowCommand,
};
use super::panel::Panel;

/// Search words for a command that its name lacks.
pub fn synonyms(command: &Command) -> &'static str {
    match command {
        Command::Document(command) => match command {
            DocumentCommand::New => "empty clear",
            DocumentCommand::Save => "write store file",
            DocumentCommand::Preset(_) => "example scene demo",
            DocumentCommand::Recording(_) => "measured data samples real radar",
            DocumentCommand::RandomScene(_) => "generate test set example",
            _ => "",
        },
        Command::Edit(command) => match command {
            EditCommand::Undo => "undo drag back revert take mistake",
            EditCommand::Redo => "again forward",
            EditCommand::Add(..) => "new insert object reflector wall car target",
            EditCommand::Delete => "remove erase clear",
            EditCommand::Duplicate => "clone copy",
            EditCommand::SetCoordinates(_) => "coordinates polar cartesian units",
            _ => "",
        },
        Command::View(command) => view_words(command),
        Command::Lesson(LessonCommand::Present) => "projector beamer class fullscreen teach slides",
        Command::Lesson(_) => "teach learn tutorial course",
        Command::Export(command) => match command {
            ExportCommand::CopyShared => "share link send",
            ExportCommand::CopyLink => "share text send url",
            _ => "",
        },
        Command::Window(command) => window_words(command),
        Command::Radar(RadarCommand::Preset(_)) => "mimo virtual array",
        Command::AskFile(purpose) => file_words(*purpose),
        _ => "",
    }
}

fn file_words(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Open => "load file import",
        Purpose::SaveScene => "write store file",
        Purpose::OpenLesson => "teach learn tutorial course",
        Purpose::ExportPicture => "screenshot png svg image save print",
        Purpose::ExportMaps => "numpy npz data arrays save",
        _ => "",
    }
}

fn view_words(command: &ViewCommand) -> &'static str {
    match command {
        ViewCommand::Colours(_) => "colormap colourmap color palette gray heat",
        ViewCommand::ToggleProjection | ViewCommand::SetProjection(_) => "polar xy coordinates bend projection",
        ViewCommand::ToggleUnits | ViewCommand::SetUnits(_) => "decibel lambda scale logarithmic units",
        ViewCommand::ToggleOneScale => "level weaker stronger common absolute",
        ViewCommand::ToggleFineColumns => "smooth interpolate padding coarse pixels few elements",
        ViewCommand::Normalise(_) => "dynamic range contrast normalize",
        ViewCommand::Detect(_) => "cfar constant false alarm rate threshold guard training rohling",
        ViewCommand::SetFloor(_) => "noise snr thermal",
        ViewCommand::ToggleReflectors => "truth ground true rings show objects",
        ViewCommand::ToggleFound => "detections crosses points",
        ViewCommand::ToggleKinds => "missed merged ghost false alarm wrong tooth failure",
        ViewCommand::ToggleTheory => "formulas beam lobes bound resolution",
        ViewCommand::FitScene | ViewCommand::ResetMaps => "zoom reset view all home",
        ViewCommand::Method(_) | ViewCommand::NextMethod => "reconstruction algorithm network solver",
        ViewCommand::Flip => "compare blink swap",
        ViewCommand::ToggleDeveloper => "research timing training",
        _ => "",
    }
}

fn window_words(command: &WindowCommand) -> &'static str {
    match command {
        WindowCommand::Present => "projector beamer class fullscreen whole screen large lecture",
        WindowCommand::ToggleTheme => "light mode day night theme brightness",
        WindowCommand::ZoomIn | WindowCommand::ZoomOut | WindowCommand::ZoomReset => {
            "font text size scale bigger smaller"
        }
        WindowCommand::ResetLayout => "arrangement windows panels restore",
        WindowCommand::ArrangeFor(_) => "layout workspace windows panels",
        WindowCommand::Help(_) => "help manual shortcuts keyboard mouse version licence sources",
        WindowCommand::ToggleCaptions => "help explain labels what is this start",
        WindowCommand::TogglePanel(Panel::Guide) => "help manual explain tutorial",
        WindowCommand::TogglePanel(Panel::Lesson) => "help teach learn tutorial course",
        WindowCommand::TogglePanel(Panel::Controls) => "options preferences method threshold",
        WindowCommand::TogglePanel(Panel::Failures) => "evaluate campaign rows scenes",
        WindowCommand::TogglePanel(Panel::Evaluation) => "evaluate tables thesis printed research",
        WindowCommand::TogglePanel(Panel::RunTime) => "evaluate front speed research",
        WindowCommand::TogglePanel(Panel::Timing | Panel::Training) => "developer research",
        WindowCommand::TogglePanel(Panel::Radar) => "bandwidth elements carrier constants",
        WindowCommand::TogglePanel(Panel::Chirp) => {
            "waveform fmcw sweep ramp beat signal frequency time spectrum fft interferer"
        }
        WindowCommand::TogglePanel(Panel::RangeDoppler) => {
            "waveform velocity speed chirps timeline time play motion moving doppler"
        }
        WindowCommand::TogglePanel(Panel::Phasors) => "complex plane vector sum cornu spiral contributions elements",
        WindowCommand::TogglePanel(Panel::Bounds) => "cramer rao ambiguity crlb resolution",
        WindowCommand::TogglePanel(_) => "window open close",
        _ => "",
    }
}
