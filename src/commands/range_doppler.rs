//! `apertura range-doppler`: range against radial velocity of one scene, as numbers or as a picture.

use super::arguments::{self, FloorArgs, real, whole};
use super::input::Input;
use super::{CommandError, print};
use crate::files::write_bytes;
use crate::maps::Normalisation;
use crate::maps::doppler::{range_doppler, write_range_doppler};
use crate::picture::{ColourMap, Format, compose_range_doppler};
use crate::radar::{Decibels, MAX_CHIRPS};
use crate::scene::file::SceneFile;
use crate::theory::doppler::folded;
use std::path::PathBuf;

/// Compute the range-Doppler map of a scene whose objects move, to an .npz archive or a .png or .svg picture
///
/// The radar sends several chirps. An object's velocity (velocity_x_metres_per_second and velocity_y_metres_per_second in the scene)
/// turns its phase from chirp to chirp. Powers are averaged over up to 4 elements of each end. A velocity
/// shifts the range by v f T / B within a chirp of duration T.
///
/// The archive has power (f64 [512, chirps]), range_metres (f64 [512]), velocity_metres_per_second (f64 [chirps], away from the radar is
/// positive), unambiguous_velocity_metres_per_second (f64), chirps (i64), chirp_interval_seconds (f64), and all_point_x and all_point_y
/// (f64 [L], metres).
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml or .npz) to look at
    input: PathBuf,

    /// File to write (.npz, .png or .svg)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,

    /// Chirps, one after another; overrides the scene's radar [default: those of the scene, 128 where it has one]
    #[arg(long, value_name = "N", value_parser = whole(2..=MAX_CHIRPS))]
    chirps: Option<usize>,

    /// From the beginning of a chirp to that of the next, microseconds, at least the duration of a chirp; overrides the scene's radar
    #[arg(long, value_name = "US", value_parser = real(0.1..=1e6))]
    interval: Option<f64>,

    /// Time at which the scene is looked at, seconds: every object has moved by its velocity
    #[arg(long, value_name = "S", default_value_t = 0.0, value_parser = real(-1e3..=1e3))]
    time: f64,

    #[command(flatten)]
    floor: FloorArgs,

    /// Picture: scale of Lambda, min-max or db=RANGE (below the peak)
    #[arg(long, value_name = "min-max|db=RANGE", default_value_t = Normalisation::DynamicRange(Decibels(60.0)))]
    normalisation: Normalisation,

    /// Picture: colours of the map
    #[arg(long, value_name = "inferno|viridis|grey|diverging", default_value_t = ColourMap::default())]
    colours: ColourMap,

    /// Seed of the floor's noise; overrides the scene's
    #[arg(long, value_name = "S", value_parser = arguments::seed)]
    seed: Option<u64>,
}

/// Chirps where neither the scene nor the command says how many.
const CHIRPS: usize = 128;

impl Args {
    /// Simulates the chirps and writes their map.
    pub fn run(self) -> Result<(), CommandError> {
        let is_archive = self.output.extension().is_some_and(|e| e.eq_ignore_ascii_case("npz"));
        let format = Format::of_path(&self.output);
        if format.is_none() && !is_archive {
            let name = self.output.display();
            return Err(CommandError::Usage(format!(
                "{name}: can't tell what to write from this name; expected one ending in .npz, .png or .svg"
            )));
        }
        let Input::Scene(file) = Input::load(&self.input)? else {
            return Err(CommandError::Usage(
                "a recording has one chirp, which tells no velocity; expected a scene".into(),
            ));
        };
        let SceneFile { scene, mut radar } = *file;
        if let Some(microseconds) = self.interval {
            radar.chirp_interval_seconds = 1e-6 * microseconds;
        }
        radar.chirps = self.chirps.unwrap_or(if radar.chirps > 1 { radar.chirps } else { CHIRPS });
        let scene = scene.at(self.time);
        let seed = self.seed.unwrap_or(scene.noise_seed);
        let map = range_doppler(&radar, &scene, self.floor.floor, seed);
        let map = map.map_err(CommandError::on(&self.input))?;
        if let Some(sentence) = folded(&radar, &scene) {
            eprintln!("note: {sentence}");
        }
        match format {
            None => write_range_doppler(&self.output, &radar, &scene, &map).map_err(CommandError::on(&self.output))?,
            Some(format) => {
                let bytes = compose_range_doppler(&radar, &map, self.normalisation, self.colours, format);
                let bytes = bytes.map_err(CommandError::failed)?;
                let failed = |source| CommandError::File { path: self.output.clone(), source };
                write_bytes(&self.output, &bytes).map_err(failed)?;
            }
        }
        print(&format!("wrote {}", self.output.display()))
    }
}
