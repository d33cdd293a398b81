//! What each command does: the only place that changes settings, and the only one that starts work.

mod documents;
mod edit;
mod failures;
mod hand;
mod lessons;
mod map_picture;
mod radar;
mod saving;
mod settings;
mod shared;
mod work;

pub use documents::{read, show_recording_panels};
pub use shared::of as shared_text;

use super::jobs::{Jobs, Purpose, tell};
use super::state::{Arrangement, Brightness, Command, MapViews, Panel, State};
use crate::interact::SelectionMode;
use eframe::egui::ColorImage;

/// What a command asks of the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Light or dark.
    Brightness(Brightness),
    /// Another size of the interface, as a factor; back to normal where `None`.
    Zoom(Option<f32>),
    /// This text on the clipboard.
    Copy(String),
    /// This picture on the clipboard.
    CopyImage(ColorImage),
    /// Ask the system for the clipboard.
    RequestPaste,
    /// Show or hide the palette.
    Palette,
    /// Close.
    Close,
}

/// Does a command.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Effect> {
    if let Command::Guided(commands) = command {
        let before = state.setup();
        for command in commands {
            apply(state, jobs, command);
        }
        let after = state.setup();
        state.guided.push(before, after);
        return None;
    }
    // Each looks for its own commands and hands the others on.
    let left = shared::apply(state, jobs, command)
        .and_then(|c| settings::apply(&mut state.settings, c))
        .and_then(|c| edit::apply(state, c))
        .and_then(|c| hand::apply(state, c))
        .and_then(|c| radar::apply(state, c))
        .and_then(|c| documents::apply(state, jobs, c))
        .and_then(|c| lessons::apply(state, jobs, c))
        .and_then(|c| panels(state, c))
        .and_then(|c| exports(state, jobs, c))
        .and_then(|c| failures::apply(state, jobs, c))
        .and_then(|c| work::apply(state, jobs, c))?;
    window(state, jobs, left)
}

/// Commands that move panels, or what they show.
fn panels(state: &mut State, command: Command) -> Option<Command> {
    match command {
        Command::Escape => escape(state),
        Command::Hover(cursor) => state.pointer.hover(cursor),
        Command::FitScene => state.scene_view.fit = true,
        Command::ResetMaps => state.map_views = MapViews::default(),
        Command::TogglePanel(panel) => state.arrangement.toggle(panel),
        Command::ClosePanel(panel) => state.arrangement.set_open(panel, false),
        Command::OpenPanel(panel) => state.arrangement.set_open(panel, true),
        Command::Maximise(panel) => state.arrangement.toggle_maximised(panel),
        Command::ResetLayout => {
            state.stop_presenting();
            state.arrangement = Arrangement::default();
        }
        Command::Flip => {
            state.settings.compare.flip();
            if !state.arrangement.shown().contains(&Panel::Compare) {
                state.arrangement.set_open(Panel::Compare, true);
            }
        }
        Command::Present => state.present(),
        Command::CloseMessages => state.notices.clear(),
        other => return Some(other),
    }
    None
}

/// Commands that write for other programs.
fn exports(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Command> {
    let said = match command {
        Command::ExportPicture => return choose(state, jobs, Purpose::ExportPicture),
        Command::ExportMaps => return choose(state, jobs, Purpose::ExportMaps),
        Command::ExportMetrics => return choose(state, jobs, Purpose::ExportMetrics),
        Command::RecordDrag => return choose(state, jobs, Purpose::RecordDrag),
        Command::DrawLesson => return choose(state, jobs, Purpose::DrawLesson),
        Command::StopRecording => {
            let given_up = jobs.recorder.cancel().or_else(|| jobs.exports.give_up());
            Ok(given_up.unwrap_or_else(|| "Nothing is recorded.".to_owned()))
        }
        Command::RecordDragTo(path) => jobs.recorder.record_drag(path),
        Command::DrawLessonTo(path) => jobs.recorder.draw_lesson(state, path),
        Command::ExportPictureTo(path) => jobs.exports.picture(state, path),
        Command::ExportMapsTo(path) => jobs.exports.maps(state, path),
        Command::ExportMetricsTo(path) => jobs.exports.metrics(state, &jobs.pipeline, path),
        other => return Some(other),
    };
    tell(state, said);
    None
}

fn choose(state: &mut State, jobs: &mut Jobs, purpose: Purpose) -> Option<Command> {
    jobs.choose_file(state, purpose);
    None
}

/// Commands that the window has to do.
fn window(state: &mut State, jobs: &Jobs, command: Command) -> Option<Effect> {
    Some(match command {
        Command::Cut => {
            let copied = copy(state);
            state.editor.delete_selected();
            return copied;
        }
        Command::Copy => return copy(state),
        Command::CopyShared => Effect::Copy(shared::text(state)?),
        Command::CopyEvaluation => Effect::Copy(jobs.evaluation.to_csv()),
        Command::Paste => Effect::RequestPaste,
        Command::CopyMap(kind) => return map_picture::copy(state, jobs, kind).map(Effect::CopyImage),
        Command::ToggleTheme => {
            state.settings.theme = if state.dark { Brightness::Light } else { Brightness::Dark };
            Effect::Brightness(state.settings.theme)
        }
        Command::ZoomIn => Effect::Zoom(Some(0.1)),
        Command::ZoomOut => Effect::Zoom(Some(-0.1)),
        Command::ZoomReset => Effect::Zoom(None),
        Command::Palette => Effect::Palette,
        Command::Quit => Effect::Close,
        unknown => {
            debug_assert!(false, "nobody does {unknown:?}");
            return None;
        }
    })
}

fn copy(state: &mut State) -> Option<Effect> {
    let copied = state.editor.copy().map(Effect::Copy);
    if copied.is_none() {
        state.notices.info("Nothing is selected: click an object, or drag a box around several.");
    }
    copied
}

fn escape(state: &mut State) {
    if state.editor.dragged().is_some() {
        state.editor.cancel_drag();
    } else if state.arrangement.maximised().is_some() {
        state.arrangement.restore();
    } else if state.is_presenting() {
        state.stop_presenting();
    } else {
        state.editor.select([], SelectionMode::Replace);
    }
    state.scene_view.box_start = None;
}
