//! The table `[radar]` of a recording's TOML.

use super::{Fault, RadarProfile};
use crate::radar::Radar;
use std::fmt::Display;

/// The radar of a recording, whose text must give its constants.
pub(super) fn said_radar(mut table: toml::Table, profile: Option<&RadarProfile>) -> Result<Radar, Fault> {
    if let Some(profile) = profile {
        for (key, value) in [("carrier_hz", profile.carrier_hz()), ("bandwidth_hz", profile.bandwidth_hz())] {
            let said = table.entry(key).or_insert(value.into());
            let number = said.as_float().or(said.as_integer().map(|v| v as f64));
            if number.is_none_or(|n| ((n - value) / value).abs() > 1e-4) {
                return Err(unlike(key, said, value));
            }
        }
        table.entry("chirp_seconds").or_insert(profile.chirp_seconds().into());
        let samples = profile.complex_samples();
        let said = table.entry("samples").or_insert((samples as i64).into());
        if said.as_integer() != Some(samples as i64) {
            return Err(unlike("samples", said, samples));
        }
    }
    let snapshot = table.get("samples").and_then(toml::Value::as_integer) == Some(1);
    let needed = ["carrier_hz", "bandwidth_hz", "element_spacing_metres", "elements", "end_elements", "samples"];
    let of_pairs = table.contains_key("transmitter_x_metres") || table.contains_key("receiver_x_metres");
    let is_known = |key: &str| match key {
        "bandwidth_hz" => snapshot,
        "element_spacing_metres" | "elements" => of_pairs,
        _ => false,
    };
    if let Some(key) = needed.iter().find(|key| !(table.contains_key(**key) || is_known(key))) {
        return Err(Fault::key(&format!("radar.{key}"), "is missing", "it: a recording says which radar measured it"));
    }
    let radar: Radar = table.try_into().map_err(|e: toml::de::Error| {
        Fault::key("[radar]", format!("can't be read ({})", e.message().trim_end()), "the radar's numbers")
    })?;
    radar.validate()?;
    Ok(radar)
}

/// The error of a key that says another `value` than the `.cfg`.
fn unlike(key: &str, said: &toml::Value, value: impl Display) -> Fault {
    Fault::key(&format!("radar.{key}"), format!("is {said}"), format!("{value}, as the .cfg says, or no such key"))
}
