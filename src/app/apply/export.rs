//! Commands that export files and copy to the clipboard.

use super::{map_picture, shared};
use crate::app::jobs::{Jobs, tell};
use crate::app::state::{ExportCommand, State};
use eframe::egui::Context;

pub fn apply(ctx: &Context, state: &mut State, jobs: &mut Jobs, command: ExportCommand) {
    let said = match command {
        ExportCommand::CopyMap(kind) => map_picture::copy(ctx, state, jobs, kind),
        ExportCommand::CopyShared => {
            copied(ctx, shared::of(state).map_err(|e| e.to_string()), "Paste into another Apertura window.")
        }
        ExportCommand::CopyLink => copied(ctx, shared::link(state), "The link opens what is on screen."),
        ExportCommand::PictureTo(path) => jobs.exports.picture(state, path),
        ExportCommand::MapsTo(path) => jobs.exports.maps(state, path),
    };
    tell(state, said);
}

/// Copies `text`; returns the message for the user.
fn copied(ctx: &Context, text: Result<String, String>, advice: &str) -> Result<String, String> {
    ctx.copy_text(text.map_err(|error| format!("Nothing was copied: {error}"))?);
    Ok(format!("Copied. {advice}"))
}
