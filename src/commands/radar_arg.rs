//! `--radar RADAR.toml`: the radar of samples that come without one.

use super::CommandError;
use crate::radar::Radar;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Which radar measured the samples.
#[derive(Debug, Clone, clap::Args)]
pub struct RadarArg {
    /// Radar that measured the samples: any .toml with a table [radar], a scene or a recording [default: table 3.1]
    #[arg(long, value_name = "RADAR.toml")]
    radar: Option<PathBuf>,
}

impl RadarArg {
    /// The radar: what the file leaves out is table 3.1's.
    pub fn load(&self) -> Result<Radar, CommandError> {
        self.radar.as_deref().map_or_else(|| Ok(Radar::default()), load)
    }
}

fn load(path: &Path) -> Result<Radar, CommandError> {
    #[derive(Deserialize)]
    struct Head {
        radar: Radar,
    }
    let text = std::fs::read_to_string(path).map_err(|source| CommandError::File { path: path.to_owned(), source })?;
    let head: Head = toml::from_str(&text).map_err(|e| {
        let place = e.span().map_or(0, |s| text[..s.start].matches('\n').count() + 1);
        let message = e.message().lines().collect::<Vec<_>>().join(", ");
        CommandError::Usage(format!("{}: line {place}: {message}; expected a table [radar]", path.display()))
    })?;
    head.radar.validate().map_err(CommandError::on(path))?;
    Ok(head.radar)
}
