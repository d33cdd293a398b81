//! Commands that change the radar, its elements, and other disturbances of the scene.

use crate::app::state::{RadarCommand, State};
use crate::radar::{BuiltArray, Radar, presets};
use crate::scene::Disturbances;

pub fn apply(state: &mut State, command: RadarCommand) -> Result<(), String> {
    match command {
        RadarCommand::SetCarrier(carrier) => edit(state, "carrier", None, |r| r.carrier = carrier)?,
        RadarCommand::SetWindow(window) => edit(state, "window", None, |r| r.window = window)?,
        RadarCommand::Set(radar) => {
            let field = changed_field(state.radar(), &radar);
            edit(state, field, Some(field), |r| *r = *radar)?;
        }
        RadarCommand::SetElements(elements) => disturb(state, "built elements", |d| {
            d.elements = if elements.is_ideal() { BuiltArray::default() } else { BuiltArray::clone(&elements) };
        })?,
        RadarCommand::SetInterferer(interferer) => disturb(state, "interferer", |d| d.interferer = interferer)?,
        RadarCommand::SetMirror(mirror) => disturb(state, "mirror", |d| d.mirror = mirror)?,
        RadarCommand::Preset(index) => {
            if let Some(preset) = presets::ALL.get(index) {
                edit(state, "radar preset", None, |r| *r = preset.radar.clone())?;
                state.scene_view.fit |= state.scene_view.fitted.is_some();
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
    state.editor.edit(what, Some(what), |scene, _| scene.disturbances = changed);
    Ok(())
}

/// Name of the first field that differs: edits of one field merge into one undo step.
fn changed_field(before: &Radar, after: &Radar) -> &'static str {
    // A drag of one antenna also changes the number of elements and their spacing.
    let has_moved = before.antennas.is_some() && after.antennas.is_some() && before.antennas != after.antennas;
    let changes = [
        ("antennas", has_moved),
        (
            "convention",
            before.carrier != after.carrier && after.element_spacing_metres == after.filled_spacing_metres(),
        ),
        ("carrier frequency", before.carrier_hz != after.carrier_hz),
        ("bandwidth", before.bandwidth_hz != after.bandwidth_hz),
        ("samples", before.samples != after.samples),
        ("duration of a chirp", before.chirp_seconds != after.chirp_seconds),
        ("elements", before.elements != after.elements),
        ("elements of an end", before.end_elements != after.end_elements),
        ("spacing", before.element_spacing_metres != after.element_spacing_metres),
        ("antennas", before.antennas != after.antennas),
        ("focusing", before.focus_off_line != after.focus_off_line),
        ("chirps", before.chirps != after.chirps),
        ("interval of chirps", before.chirp_interval_seconds != after.chirp_interval_seconds),
        ("link budget", before.budget != after.budget),
        ("power", before.transmit_power_watts != after.transmit_power_watts),
    ];
    changes.into_iter().find(|(_, changed)| *changed).map_or("radar", |(name, _)| name)
}

/// Changes the radar as one undo step.
fn edit(
    state: &mut State,
    label: &str,
    merge_key: Option<&str>,
    change: impl FnOnce(&mut Radar),
) -> Result<(), String> {
    let mut changed = state.radar().clone();
    change(&mut changed);
    let recording = state.editor.document().recording();
    if recording.is_some_and(|r| !r.fits(&changed)) {
        let advice = "Open a scene to look with another.";
        return Err(format!("The radar on screen is the one that the recording was made with. {advice}"));
    }
    state.editor.edit_radar(label, merge_key, |r| *r = changed).map(drop).map_err(|e| e.to_string())
}
