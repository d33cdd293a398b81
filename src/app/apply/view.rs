//! Commands that change the view of scene and maps.

use super::document;
use crate::app::jobs::Jobs;
use crate::app::state::{MapViews, Panel, PinnedCut, State, ViewCommand, pin_cut};
use crate::maps::cfar::Cfar;
use crate::reconstruct::Reconstructor;

pub fn apply(state: &mut State, jobs: &Jobs, command: ViewCommand) {
    let settings = &mut state.settings;
    match command {
        ViewCommand::Hover(cursor) => state.pointer.hover(cursor),
        ViewCommand::FitScene => state.scene_view.fit = true,
        ViewCommand::ResetMaps => state.map_views = MapViews::default(),
        ViewCommand::ToggleProjection => settings.projection = settings.projection.other(),
        ViewCommand::SetProjection(projection) => settings.projection = projection,
        ViewCommand::ToggleUnits => settings.units = settings.units.other(),
        ViewCommand::SetUnits(units) => settings.units = units,
        ViewCommand::SetDirections(directions) => settings.directions = directions,
        ViewCommand::ToggleOneScale => settings.one_scale ^= true,
        ViewCommand::ToggleFineColumns => settings.fine_columns ^= true,
        ViewCommand::ToggleAbsoluteDifference => settings.difference.absolute ^= true,
        ViewCommand::ToggleWholeDifference => settings.difference.whole ^= true,
        ViewCommand::Colours(colours) => settings.colours = colours,
        ViewCommand::Normalise(normalisation) => settings.normalisation = normalisation,
        ViewCommand::SetFloor(floor) => settings.set_floor(floor),
        ViewCommand::SetTargetEta(eta) => settings.target_eta = eta,
        ViewCommand::SetCfar(cfar) => settings.detect_by(cfar),
        ViewCommand::Detect(by) => {
            let last = settings.last_cfar;
            settings.detect_by(by.map(|statistic| Cfar { statistic, ..last }));
        }
        ViewCommand::SetMethodEta(method, eta) => settings.set_method_eta(method, eta),
        ViewCommand::SetBounds(bounds) => settings.bounds = bounds,
        ViewCommand::SetChirp(chirp) => settings.chirp = chirp,
        ViewCommand::SetTime(seconds) => state.timeline.set(state.editor.scene(), seconds),
        ViewCommand::TogglePlay => toggle_play(state),
        ViewCommand::TakeOutStaticClutter(is_out) => settings.static_clutter_out = is_out,
        ViewCommand::SetPhasors(phasors) => settings.phasors = phasors,
        ViewCommand::MarkReflectors => settings.show_reflectors = true,
        ViewCommand::ToggleDeveloper => settings.developer ^= true,
        ViewCommand::ToggleReflectors => settings.show_reflectors ^= true,
        ViewCommand::ToggleFound => settings.show_found ^= true,
        ViewCommand::ToggleFieldsOfView => settings.show_fields_of_view ^= true,
        ViewCommand::SetSeveral(several) => settings.several = *several,
        ViewCommand::ToggleTheory => settings.show_theory ^= true,
        ViewCommand::MarkKinds => settings.show_kinds = true,
        ViewCommand::ToggleKinds => settings.show_kinds ^= true,
        ViewCommand::SetCompare(compare) => settings.compare = *compare,
        ViewCommand::Method(name) => settings.method = name.to_owned(),
        ViewCommand::Hear(layout) => settings.layout = layout,
        ViewCommand::Flip => {
            settings.compare.flip();
            if !state.arrangement.shown().contains(&Panel::Compare) {
                state.arrangement.set_open(Panel::Compare, true);
            }
        }
        ViewCommand::NextMethod => next_method(state),
        ViewCommand::PinCuts => {
            let (radar, cursor) = (state.radar().clone(), state.cut_cursor());
            pin_cut(&mut state.pins, PinnedCut { radar, cursor, maps: jobs.pipeline.cut_maps() });
        }
        ViewCommand::Unpin(index) if index < state.pins.len() => _ = state.pins.remove(index),
        ViewCommand::Unpin(_) => {}
        ViewCommand::UnpinAll => state.pins.clear(),
    }
}

/// Selects the next method that takes the layout in use.
fn next_method(state: &mut State) {
    let layout = state.settings.layout_numbers(state.radar());
    let hears = |method: &dyn Reconstructor| {
        layout.as_ref().is_none_or(|layout| method.check_elements(state.radar(), layout).is_ok())
    };
    let next = state.method().and_then(|now| state.methods.after(now.name(), hears));
    next.into_iter().for_each(|name| state.settings.method = name.to_owned());
}

/// Plays or stops the frames of a recording, or a scene that moves.
fn toggle_play(state: &mut State) {
    let is_playing = !state.timeline.is_playing;
    if state.frames().is_some() {
        document::play_frames(state, is_playing);
    } else {
        let scene = state.editor.scene();
        state.timeline.play(scene, is_playing && scene.is_moving());
    }
}
