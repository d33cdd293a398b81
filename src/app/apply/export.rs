//! Commands that export files and copy to the clipboard.

use super::effect::Effect;
use super::{map_picture, shared};
use crate::app::jobs::{Jobs, tell};
use crate::app::state::{ExportCommand, State};

/// Does an export; the effect is text or a picture for the clipboard.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: ExportCommand) -> Option<Effect> {
    let said = match command {
        ExportCommand::CopyMap(kind) => return map_picture::copy(state, jobs, kind).map(Effect::CopyImage),
        ExportCommand::CopyShared => return shared::text(state).map(Effect::Copy),
        ExportCommand::CopyLink => return shared::link(state).map(Effect::Copy),
        ExportCommand::PictureTo(path) => jobs.exports.picture(state, path),
        ExportCommand::MapsTo(path) => jobs.exports.maps(state, path),
    };
    tell(state, said);
    None
}
