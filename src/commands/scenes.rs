//! `apertura scenes`: test scenes as files.

use super::{CommandError, print};
use crate::radar::Radar;
use crate::scene::file::{self, SceneFile};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use std::path::PathBuf;

/// Write random test scenes of one kind to a folder
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Test set 1 (one point), 2 (3 to 6 points) or 3 (3 to 6 points and lines); or clusters, walls, spacings, corner, crowd, dynamic, near
    #[arg(long, value_name = "1|2|3|KIND")]
    set: Kind,

    /// Number of scenes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    count: u32,

    /// Seed: the same seed gives the same scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    /// Folder to write to; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,

    /// Kind of file
    #[arg(long, value_enum, default_value_t = FileFormat::Toml)]
    format: FileFormat,

    /// Make lines as the thesis' text describes them, not as its author's program does
    #[arg(long)]
    thesis_text: bool,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum FileFormat {
    /// Objects, readable and editable
    Toml,
    /// Reflector positions, as the thesis author's program writes them
    Npz,
}

impl Args {
    /// Writes `set1-seed0-0000.toml`, `walls-seed0-0000.toml` and so on.
    pub fn run(self) -> Result<(), CommandError> {
        std::fs::create_dir_all(&self.output)
            .map_err(|source| CommandError::File { path: self.output.clone(), source })?;
        let radar = Radar::default();
        let reading = if self.thesis_text { Reading::Text } else { Reading::Program };
        let generator = Generator::new(&radar, reading, Purpose::Test, self.seed);
        let extension = match self.format {
            FileFormat::Toml => "toml",
            FileFormat::Npz => "npz",
        };
        let (prefix, what) = if self.set.test_set().is_some() { ("set", "set ") } else { ("", "") };
        for number in 0..self.count {
            let name = format!("{prefix}{}-seed{}-{number:04}.{extension}", self.set, self.seed);
            let scene = generator.scene(self.set, number);
            let file = SceneFile { scene, radar: radar.clone() };
            file::save(&self.output.join(name), &file).map_err(CommandError::failed)?;
        }
        print(&format!("wrote {} scenes of {what}{} to {}", self.count, self.set, self.output.display()))
    }
}
