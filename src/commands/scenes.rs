//! `apertura scenes`: test scenes as files.

use super::arguments::{seed, whole};
use super::radar_arg::RadarArg;
use super::{CommandError, print};
use crate::files::make_folder;
use crate::platform::console::note;
use crate::radar::counted;
use crate::scene::file::{self, SceneFile, SceneFormat};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use std::path::{Path, PathBuf};

/// Write random test scenes of one kind to a folder
#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(long, value_name = "KIND", help = format!(
        "Kind of the scenes: {}. 1, 2 and 3 are the sets of the thesis author's program (one point; 3 to 6 points; 3 to 6 points and lines); its \
         text draws other ones (--thesis-text). Scenes of noise are empty: give --floor dbm=LEVEL to the command that reads them", Kind::names()))]
    set: Kind,

    /// Number of scenes
    #[arg(long, value_name = "N", required_unless_present = "index", value_parser = whole(1..=1_000_000u32))]
    count: Option<u32>,

    /// Write only the scene with this index, as in the rows of `apertura evaluate --rows`
    #[arg(long, value_name = "I", conflicts_with_all = ["count", "format"], value_parser = whole(0..=u32::MAX))]
    index: Option<u32>,

    /// Seed: the same seed gives the same scenes
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    #[command(flatten)]
    radar: RadarArg,

    /// Folder to write to; with --index, the file (.toml or .npz). Folders are made where they are missing
    #[arg(short, long, value_name = "OUT")]
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
        let (radar, _) = self.radar.load()?;
        let reading = if self.thesis_text { Reading::Text } else { Reading::Program };
        let generator = Generator::new(&radar, reading, Purpose::Test, self.seed);
        if let Some(index) = self.index {
            SceneFormat::of_path(&self.output)?;
            let scene = generator.scene(self.set, index);
            let seed = scene.noise_seed;
            if let Some(folder) = self.output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                make(folder)?;
            }
            save(&self.output, &SceneFile { scene, radar }, &mut false)?;
            return print(&format!("wrote {} (noise seed {seed})", self.output.display()));
        }
        make(&self.output)?;
        let extension = match self.format {
            FileFormat::Toml => "toml",
            FileFormat::Npz => "npz",
        };
        let (prefix, what) = if self.set.test_set().is_some() { ("set", "set ") } else { ("", "") };
        let count = self.count.unwrap_or_default();
        let mut is_told = false;
        for number in 0..count {
            let name = format!("{prefix}{}-seed{}-{number:04}.{extension}", self.set, self.seed);
            let scene = generator.scene(self.set, number);
            let file = SceneFile { scene, radar: radar.clone() };
            save(&self.output.join(name), &file, &mut is_told)?;
        }
        let scenes = counted(count, "scene", "scenes");
        print(&format!("wrote {scenes} of {what}{} to {}", self.set, self.output.display()))
    }
}

const BODIES_NOTE: &str =
    "note: an archive (.npz) holds positions alone: a body becomes points, where it echoes to the middle of the array";

/// Saves a scene. Before the first archive of a scene with bodies, standard error says what becomes of them.
fn save(path: &Path, file: &SceneFile, is_told: &mut bool) -> Result<(), CommandError> {
    let has_body = || file.scene.objects.iter().any(|object| object.body().is_some());
    if !*is_told && SceneFormat::of_path(path)? == SceneFormat::Npz && has_body() {
        note(BODIES_NOTE);
        *is_told = true;
    }
    Ok(file::save(path, file)?)
}

fn make(folder: &Path) -> Result<(), CommandError> {
    make_folder(folder).map_err(CommandError::on(folder))
}
