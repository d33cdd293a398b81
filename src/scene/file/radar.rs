//! The radar of a file that holds one: a scene, a recording, or nothing else.

use super::content::SceneTextError;
use super::read::{of_toml, span_of};
use crate::radar::Radar;
use serde::Deserialize;
use toml::de::DeTable;

/// The table `[radar]` of a TOML text, whose missing keys are table 3.1's, and where a recording's text tells it the range of its snapshot in metres.
/// # Errors
/// The fault, its line, and the expected value.
pub fn radar_of(text: &str) -> Result<(Radar, Option<f64>), String> {
    #[derive(Deserialize)]
    struct Head {
        radar: Option<Radar>,
        #[serde(default)]
        recording: Told,
    }
    #[derive(Deserialize, Default)]
    struct Told {
        range_metres: Option<f64>,
    }
    const EXPECTED: &str = "expected a TOML file with a table [radar]";
    let head: Head = toml::from_str(text).map_err(|e| {
        let has_radar = DeTable::parse(text).is_ok_and(|table| table.get_ref().contains_key("radar"));
        let told = of_toml(text, &e, 0);
        if has_radar { told.to_string() } else { format!("{told}; {EXPECTED}") }
    })?;
    let radar = head.radar.ok_or_else(|| format!("has no table [radar]; {EXPECTED}"))?;
    radar.validate().map_err(|error| {
        SceneTextError::at(text, span_of(text, "radar", None, error.field()).start, error.to_string()).to_string()
    })?;
    Ok((radar, head.recording.range_metres))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_a_radar_have_their_place() {
        let told = |text: &str| radar_of(text).unwrap_err();
        let negative = told("[radar]\nsamples = 64\ncarrier_hz = -5");
        assert!(negative.starts_with("line 3, column 14: radar.carrier_hz is -5"), "{negative}");
        let uneven = told("[radar]\ntransmitter_x_metres = [0, 1, 1.7]\nreceiver_x_metres = [0, 0.31]");
        assert!(uneven.ends_with("expected at most 1.675 mm"), "{uneven}");
        for text in ["a = ", "a = 3"] {
            assert!(told(text).ends_with("expected a TOML file with a table [radar]"), "{}", told(text));
        }
    }
}
