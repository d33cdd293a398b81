//! `apertura range-doppler`: range against radial velocity of one scene or recording, as numbers or as a picture.

use super::arguments::{self, FloorArgs, real, whole};
use super::input::{ConfigArg, InputArgs, check_kept, load_recording};
use super::{CommandError, check_no_picture, picture_format, print, write_file};
use crate::maps::Normalisation;
use crate::maps::doppler::{RangeDopplerMap, range_doppler, write_range_doppler};
use crate::picture::{ColourMap, PictureFormat, compose_range_doppler};
use crate::platform::console::note;
use crate::radar::{Decibels, MAX_CHIRPS, Radar};
use crate::recording::FrameLoops;
use crate::recording::file::is_recording_at;
use crate::scene::Scene;
use crate::scene::file::SceneFile;
use crate::theory::doppler::folded;
use std::path::PathBuf;

/// Compute the range-Doppler map of a scene whose objects move, or of a recording with loops, to an .npz archive or a .png or .svg picture
///
/// The radar sends several chirps. An object's velocity (velocity_x_metres_per_second and velocity_y_metres_per_second in the scene)
/// turns its phase from chirp to chirp. Powers are averaged over up to 4 elements of each end. A velocity v away from a physical radar
/// also shifts its range by v f T / B: T is the duration of a chirp, f the frequency in its middle. The default radar's chirp falls: there f
/// is 37.5 GHz, and the shift is -v f T / B.
///
/// Of a recording it is the map of the loops of a frame, mean over the elements; the strongest cell is printed.
///
/// The archive has power (f64 [512, chirps]), range_metres (f64 [512]), velocity_metres_per_second (f64 [chirps], away from the radar is
/// positive), unambiguous_velocity_metres_per_second (f64), chirps (i64), chirp_interval_seconds (f64), and all_point_x and all_point_y
/// (f64 [L], metres).
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml or .npz), raw capture, array or recording's .toml to look at
    input: PathBuf,

    #[command(flatten)]
    capture: ConfigArg,

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

    /// Recording: take out what stands still, the mean of all loops
    #[arg(long)]
    static_clutter_out: bool,

    #[command(flatten)]
    floor: FloorArgs,

    /// Picture: scale of Lambda, min-max or db=RANGE (below the peak) [default: db=60]
    #[arg(long, value_name = "min-max|db=RANGE")]
    normalisation: Option<Normalisation>,

    /// Picture: colours of the map [default: inferno]
    #[arg(long, value_name = "inferno|viridis|grey|diverging")]
    colours: Option<ColourMap>,

    /// Seed of the floor's noise; overrides the scene's
    #[arg(long, value_name = "S", value_parser = arguments::seed)]
    seed: Option<u64>,
}

const UNKNOWN_INTERVAL: &str = "Nothing says the interval of chirps: a step of velocity is shown as 1 m/s. radar.chirp_interval_seconds of a TOML says it.";

const USUAL_CHIRPS: usize = 128;

const USUAL_NORMALISATION: Normalisation = Normalisation::DynamicRange(Decibels(60.0));

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let format = picture_format(&self.output, &["npz"], ".npz, .png or .svg")?;
        check_kept(&self.input, &self.output)?;
        if format.is_none() {
            let of_picture = [("--normalisation", self.normalisation.is_some()), ("--colours", self.colours.is_some())];
            check_no_picture(&self.output, &of_picture)?;
        }
        if is_recording_at(&self.input) {
            return self.of_recording(format);
        }
        let config = self.capture.config.as_deref();
        let InputArgs::Scene(file) = InputArgs::load_with(&self.input, config)? else {
            return Err(CommandError::on(&self.input)("expected a scene or a raw capture"));
        };
        if self.static_clutter_out {
            let message = "--static-clutter-out is a recording's; expected one as input";
            return Err(CommandError::on(&self.input)(message));
        }
        let SceneFile { scene, mut radar } = *file;
        if let Some(microseconds) = self.interval {
            radar.chirp_interval_seconds = 1e-6 * microseconds;
        }
        radar.chirps = self.chirps.unwrap_or(if radar.chirps > 1 { radar.chirps } else { USUAL_CHIRPS });
        let scene = scene.at(self.time);
        let seed = self.seed.unwrap_or(scene.noise_seed);
        let map = range_doppler(&radar, &scene, self.floor.floor(), seed).map_err(CommandError::on(&self.input))?;
        if let Some(sentence) = folded(&radar, &scene) {
            note(&format!("note: {sentence}"));
        }
        self.write(&radar, &scene, &map, format)
    }

    fn of_recording(&self, format: Option<PictureFormat>) -> Result<(), CommandError> {
        let told = [
            ("--chirps", self.chirps.is_some()),
            ("--interval", self.interval.is_some()),
            ("--time", self.time != 0.0),
        ];
        if let Some((name, _)) = told.into_iter().find(|(_, said)| *said) {
            let message = format!("{name} is a scene's; a recording has chirps of its own");
            return Err(CommandError::on(&self.input)(message));
        }
        self.floor.check_unset(self.seed, &self.input)?;
        let recording = load_recording(&self.input, self.capture.config.as_deref())?;
        let Some(origin) = &recording.origin else {
            return Err(CommandError::on(&self.input)("counts no loops; one chirp tells no velocity"));
        };
        let FrameLoops { radar, mut samples, knows_interval } = origin.loops()?;
        if !knows_interval {
            note(&format!("note: {}: {UNKNOWN_INTERVAL}", self.input.display()));
        }
        if self.static_clutter_out {
            samples.remove_static();
        }
        let map = RangeDopplerMap::of(&radar, samples);
        let (bin, column) = map.peak();
        let (range, velocity) =
            (radar.range_of_bin_metres(bin as f64), radar.velocity_of_column_metres_per_second(column as f64));
        let (chirps, most) = (radar.chirps, radar.unambiguous_velocity_metres_per_second());
        print(&format!(
            "strongest: {range:.2} m, {velocity:.2} m/s away, of {chirps} velocities up to {most:.2} m/s either way"
        ))?;
        self.write(&radar, &Scene::default(), &map, format)
    }

    fn write(
        &self,
        radar: &Radar,
        scene: &Scene,
        map: &RangeDopplerMap,
        format: Option<PictureFormat>,
    ) -> Result<(), CommandError> {
        match format {
            None => write_range_doppler(&self.output, radar, scene, map).map_err(CommandError::on(&self.output))?,
            Some(format) => {
                let normalisation = self.normalisation.unwrap_or(USUAL_NORMALISATION);
                let colours = self.colours.unwrap_or_default();
                let bytes = compose_range_doppler(radar, map, normalisation, colours, format)?;
                write_file(&self.output, &bytes)?;
            }
        }
        print(&format!("wrote {}", self.output.display()))
    }
}
