//! The table `[radar]` of a recording's TOML.

use super::{Fault, RadarProfile};
use crate::radar::Radar;
use std::fmt::Display;

/// The radar that the table describes, with the values of the `.cfg`; an error where they contradict each other.
pub(super) fn radar_of_table(mut table: toml::Table, profile: Option<&RadarProfile>) -> Result<Radar, Fault> {
    if let Some(profile) = profile {
        for (key, value) in [("carrier_hz", profile.carrier_hz()), ("bandwidth_hz", profile.bandwidth_hz())] {
            let found = table.entry(key).or_insert(value.into());
            let number = found.as_float().or(found.as_integer().map(|v| v as f64));
            if number.is_none_or(|n| ((n - value) / value).abs() > 1e-4) {
                return Err(contradiction(key, found, value));
            }
        }
        table.entry("chirp_seconds").or_insert(profile.chirp_seconds().into());
        let samples = profile.complex_samples();
        let found = table.entry("samples").or_insert((samples as i64).into());
        if found.as_integer() != Some(samples as i64) {
            return Err(contradiction("samples", found, samples));
        }
    }
    let is_snapshot = table.get("samples").and_then(toml::Value::as_integer) == Some(1);
    let needed = ["carrier_hz", "bandwidth_hz", "element_spacing_metres", "elements", "end_elements", "samples"];
    let has_antennas = table.contains_key("transmitter_x_metres") || table.contains_key("receiver_x_metres");
    let is_optional = |key: &str| match key {
        "bandwidth_hz" => is_snapshot,
        "element_spacing_metres" | "elements" => has_antennas,
        _ => false,
    };
    if let Some(key) = needed.iter().find(|key| !(table.contains_key(**key) || is_optional(key))) {
        return Err(Fault::key(&format!("radar.{key}"), "is missing", "it: a recording says which radar measured it"));
    }
    let radar: Radar = table.try_into().map_err(|e: toml::de::Error| {
        Fault::key("[radar]", format!("can't be read ({})", e.message().trim_end()), "the radar's numbers")
    })?;
    radar.validate()?;
    Ok(radar)
}

fn contradiction(key: &str, found: &toml::Value, expected: impl Display) -> Fault {
    Fault::key(&format!("radar.{key}"), format!("is {found}"), format!("{expected}, as the .cfg says, or no such key"))
}
