//! What each command does: the only place that changes settings, and the only one that starts work.

mod document;
mod edit;
mod export;
mod lesson;
mod map_picture;
mod radar;
mod rows;
mod saving;
mod shared;
mod view;
mod window;
mod work;

pub use document::{read, show_recording_panels};
pub use shared::of as shared_text;

use super::jobs::Jobs;
use super::state::{Brightness, Command, State};
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

/// Does a command: each group in the file of its name.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Effect> {
    match command {
        Command::Document(command) => document::apply(state, jobs, command),
        Command::Edit(command) => return edit::apply(state, command),
        Command::Radar(command) => radar::apply(state, command),
        Command::View(command) => view::apply(state, jobs, command),
        Command::Rows(command) => rows::apply(state, jobs, command),
        Command::Lesson(command) => lesson::apply(state, jobs, command),
        Command::Work(command) => work::apply(state, jobs, command),
        Command::Export(command) => return export::apply(state, jobs, command),
        Command::Window(command) => return window::apply(state, command),
        Command::Guided(commands) => guided(state, jobs, commands),
    }
    None
}

/// Does what a button of the guide asks for; one undo takes all of it back.
fn guided(state: &mut State, jobs: &mut Jobs, commands: Vec<Command>) {
    let before = state.setup();
    for command in commands {
        apply(state, jobs, command);
    }
    let after = state.setup();
    state.guided.push(before, after);
}
