//! `--radar NAME|RADAR.toml`: the radar of samples that come without one, and of random scenes.

use super::CommandError;
use crate::files::read_bounded;
use crate::radar::Radar;
use crate::radar::presets::{self, RadarPreset};
use crate::scene::file::{MAX_FILE_BYTES, radar_of};
use std::path::{Path, PathBuf};

/// The radar of samples, or of scenes.
#[derive(Debug, Clone, clap::Args)]
pub struct RadarArg {
    /// Radar: the name of a preset, such as cascade-12x16, or any .toml with a table [radar], a scene or a
    /// recording [default: table-3.1]
    #[arg(long, value_name = "NAME|RADAR.toml")]
    radar: Option<PathBuf>,
}

impl RadarArg {
    pub fn is_given(&self) -> bool {
        self.radar.is_some()
    }

    /// The radar, and where a recording's file tells it, the range of its snapshot. Keys that the file leaves out are table 3.1's.
    pub fn load(&self) -> Result<(Radar, Option<f64>), CommandError> {
        self.radar.as_deref().map_or_else(|| Ok((Radar::default(), None)), load)
    }
}

fn load(path: &Path) -> Result<(Radar, Option<f64>), CommandError> {
    if let Some(preset) = path.to_str().and_then(RadarPreset::by_id) {
        return Ok((preset.radar.clone(), None));
    }
    let wrong = |what: String| CommandError(format!("{}: {what}", path.display()));
    if path.extension().is_none() && !path.exists() {
        let names: Vec<&str> = presets::ALL.iter().map(|preset| preset.id).collect();
        return Err(wrong(format!(
            "there is no such file, and no preset of this name; presets are {}",
            names.join(", ")
        )));
    }
    let bytes = read_bounded(path, MAX_FILE_BYTES).map_err(CommandError::on(path))?;
    let text = String::from_utf8(bytes)
        .map_err(|_| wrong("is not text; expected a TOML file with a table [radar]".to_owned()))?;
    radar_of(&text).map_err(wrong)
}
