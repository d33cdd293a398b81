//! Effects of commands on state and jobs. Only this module changes settings and starts work.

mod document;
mod edit;
mod export;
mod failure_view;
mod lesson;
mod map_picture;
mod radar;
mod rows;
mod saving;
mod shared;
mod view;
mod window;
mod work;

pub use document::{next_frame, opened, read};
pub use failure_view::follow as follow_failure;
pub use lesson::follow_challenge;
pub use shared::of as shared_text;

use super::jobs::Jobs;
use super::state::{Command, State};
use eframe::egui::Context;

/// Does a command, or tells why it can't be done; then makes the layout in use fit the document on screen.
pub fn apply(ctx: &Context, state: &mut State, jobs: &mut Jobs, command: Command) {
    if let Err(error) = done(ctx, state, jobs, command) {
        state.notices.error(error);
    }
    document::select_method_for_layout(state);
}

/// Does a command by the file of its group.
///
/// # Errors
/// The reason why it can't be done, as a message for the user.
fn done(ctx: &Context, state: &mut State, jobs: &mut Jobs, command: Command) -> Result<(), String> {
    match command {
        Command::Document(command) => document::apply(state, jobs, command)?,
        Command::Edit(command) => edit::apply(ctx, state, command)?,
        Command::Radar(command) => radar::apply(state, command)?,
        Command::View(command) => view::apply(state, jobs, command),
        Command::Rows(command) => rows::apply(state, jobs, command)?,
        Command::Lesson(command) => lesson::apply(state, jobs, command)?,
        Command::Work(command) => work::apply(state, jobs, command),
        Command::Export(command) => export::apply(ctx, state, jobs, command),
        Command::Window(command) => window::apply(ctx, state, command),
        Command::AskFile(purpose) => jobs.choose_file(state, purpose),
        Command::Guided(commands) => guided(ctx, state, jobs, commands),
    }
    Ok(())
}

/// Does the commands of a button of the guide, which one undo takes back.
fn guided(ctx: &Context, state: &mut State, jobs: &mut Jobs, commands: Vec<Command>) {
    let before = state.setup();
    for command in commands {
        apply(ctx, state, jobs, command);
    }
    let after = state.setup();
    state.guided.push(before, after);
}
