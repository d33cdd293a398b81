//! The radar of a file that holds one: a scene, a recording, or nothing else.

use crate::radar::Radar;
use serde::Deserialize;

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
    let wrong = |what: String| format!("{what}; expected a TOML file with a table [radar]");
    let head: Head = toml::from_str(text).map_err(|e| {
        let place = e.span().map_or(0, |s| text[..s.start].matches('\n').count() + 1);
        wrong(format!("line {place}: {}", e.message().lines().collect::<Vec<_>>().join(", ")))
    })?;
    let radar = head.radar.ok_or_else(|| wrong("has no table [radar]".to_owned()))?;
    radar.validate().map_err(|error| error.to_string())?;
    Ok((radar, head.recording.range_metres))
}
