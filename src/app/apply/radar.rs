//! Commands that change the radar, its elements, and other disturbances of the scene.

use super::document::select_usable_method;
use crate::app::state::{RadarCommand, State};
use crate::radar::{BuiltArray, Radar, presets};
use crate::scene::Disturbances;

pub fn apply(state: &mut State, command: RadarCommand) -> Result<(), String> {
    match command {
        RadarCommand::SetCarrier(carrier) => edit(state, None, |r| r.carrier = carrier)?,
        RadarCommand::SetWindow(window) => edit(state, None, |r| r.window = window)?,
        RadarCommand::Set(radar) => edit(state, Some("radar"), |r| *r = *radar)?,
        RadarCommand::SetElements(elements) => disturb(state, "built elements", |d| {
            d.elements = if elements.is_ideal() { BuiltArray::default() } else { BuiltArray::clone(&elements) };
        })?,
        RadarCommand::SetInterferer(interferer) => disturb(state, "interferer", |d| d.interferer = interferer)?,
        RadarCommand::SetMirror(mirror) => disturb(state, "mirror", |d| d.mirror = mirror)?,
        RadarCommand::Preset(index) => {
            if let Some(preset) = presets::ALL.get(index) {
                edit(state, None, |r| *r = preset.radar.clone())?;
                state.scene_view.fit |= state.scene_view.fitted.is_some();
                select_usable_method(state);
            }
        }
    }
    Ok(())
}

/// Changes the scene's disturbances; changes under one name are one undo step until the pointer is released.
fn disturb(state: &mut State, what: &str, change: impl FnOnce(&mut Disturbances)) -> Result<(), String> {
    let mut changed = state.editor.scene().disturbances.clone();
    change(&mut changed);
    changed.validate(state.radar()).map_err(|e| e.to_string())?;
    state.editor.edit(Some(what), |scene, _| scene.disturbances = changed);
    Ok(())
}

/// Changes the radar as one undo step.
fn edit(state: &mut State, merge_key: Option<&str>, change: impl FnOnce(&mut Radar)) -> Result<(), String> {
    let mut changed = state.radar().clone();
    change(&mut changed);
    let recording = state.editor.document().recording();
    if recording.is_some_and(|r| !r.fits(&changed)) {
        let advice = "Open a scene to look with another.";
        return Err(format!("The radar on screen is the one that the recording was made with. {advice}"));
    }
    state.editor.edit_radar(merge_key, |r| *r = changed).map(drop).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radar_of_the_list_selects_a_method_that_can_do_it() {
        let mut state = State::new(crate::methods::all());
        state.settings.method = "live".to_owned();
        let can_do = |state: &State, radar: &Radar| state.method().is_some_and(|m| m.check_array(radar).is_ok());
        let refused = presets::ALL.iter().position(|preset| !can_do(&state, &preset.radar)).expect("a small radar");
        apply(&mut state, RadarCommand::Preset(refused)).expect("a valid radar");
        assert!(can_do(&state, state.radar()));
        assert_eq!(state.notices.list.len(), 1, "it is said once");
    }
}
