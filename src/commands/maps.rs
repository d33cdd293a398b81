//! `apertura maps`: the maps of one scene, as numbers or as a picture.

use super::arguments::{self, FloorArgs};
use super::{CommandError, print};
use crate::files::archive::write_maps;
use crate::files::write_bytes;
use crate::maps::Normalisation;
use crate::methods;
use crate::picture::{ColourMap, Format, Style, compose};
use crate::radar::Carrier;
use crate::scene::file;
use crate::signal;
use std::path::{Path, PathBuf};

/// Compute the maps of a scene, to an .npz archive or a .png or .svg picture
///
/// The archive holds all_point_x, all_point_y (f64 [L], metres), sub0, sub1 (complex128 [512, 12], the samples of the two ends),
/// polar_full (f64 [1, 512, 1024], log10 magnitude of the whole array, not normalised) and polar_partial_mag_phase
/// (f64 [4, 512, 1024], the network's input): the keys of the thesis author's program.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene to look at (.toml or .npz)
    scene: PathBuf,

    /// File to write (.npz, .png or .svg)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,

    #[command(flatten)]
    floor: FloorArgs,

    /// How the carrier's phase is read; overrides the scene's radar
    #[arg(long, value_parser = arguments::carrier(), value_name = "one-way|two-way")]
    carrier: Option<Carrier>,

    /// Picture: how decades become Lambda, min-max (the thesis) or db=RANGE (below the peak)
    #[arg(long, value_name = "min-max|db=RANGE", default_value_t = Normalisation::MinMax)]
    normalisation: Normalisation,

    /// Picture: reconstruction to show as the output [default: the best at hand]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,

    /// Picture: colours of the maps
    #[arg(long, value_name = "inferno|viridis|grey|diverging", default_value_t = ColourMap::default())]
    colours: ColourMap,

    /// Seed of the floor's noise; overrides the scene's
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
}

impl Args {
    /// Simulates the scene and writes its maps.
    pub fn run(self) -> Result<(), CommandError> {
        let output = Output::of_path(&self.output)?;
        let file::SceneFile { scene, mut radar } = file::load(&self.scene).map_err(CommandError::failed)?;
        if let Some(carrier) = self.carrier {
            radar.carrier = carrier;
        }
        let seed = self.seed.unwrap_or(scene.noise_seed);
        let signal = signal::simulate(&radar, &scene, self.floor.floor, seed).map_err(CommandError::on(&self.scene))?;
        match output {
            Output::Archive => {
                write_maps(&self.output, &radar, &scene, &signal, None).map_err(CommandError::on(&self.output))?;
            }
            Output::Picture(format) => {
                let method = match &self.method {
                    Some(name) => methods::by_name(name).map_err(CommandError::failed)?,
                    None => methods::preferred(),
                };
                let style = Style {
                    floor: self.floor.floor,
                    normalisation: self.normalisation,
                    colours: self.colours,
                    eta: None,
                };
                let bytes =
                    compose(&radar, &scene, &signal, method.as_ref(), &style, format).map_err(CommandError::failed)?;
                write_bytes(&self.output, &bytes)
                    .map_err(|source| CommandError::File { path: self.output.clone(), source })?;
            }
        }
        print(&format!("wrote {}", self.output.display()))
    }
}

enum Output {
    Archive,
    Picture(Format),
}

impl Output {
    fn of_path(path: &Path) -> Result<Output, CommandError> {
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("npz")) {
            return Ok(Output::Archive);
        }
        Format::of_path(path).map(Output::Picture).ok_or_else(|| {
            CommandError::Usage(format!(
                "{}: can't tell what to write from this name; expected one ending in .npz, .png or .svg",
                path.display()
            ))
        })
    }
}
