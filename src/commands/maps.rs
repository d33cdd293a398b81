//! `apertura maps`: the maps of one scene or recording, as numbers or as a picture.

use super::arguments::{self, FloorArgs};
use super::input::{ConfigArg, InputArgs, check_kept};
use super::layout_arg::LayoutArg;
use super::own_method::OwnMethodArgs;
use super::{CommandError, check_no_picture, frames, picture_format, print, write_file};
use crate::files::ends_in;
use crate::files::npz::NpzError;
use crate::maps::archive::{write_frames, write_maps, write_recorded_maps};
use crate::maps::cfar::Cfar;
use crate::maps::{LogMap, Normalisation, RangeAngleMap};
use crate::methods;
use crate::picture::{ColourMap, PictureFormat, Style, compose, compose_recording, maps_of};
use crate::radar::{Carrier, Radar};
use crate::reconstruct::{NoisePrior, Reconstructor, Request};
use crate::recording::Recording;
use crate::recording::explain::explain;
use crate::scene::file::{self, SceneFile};
use crate::signal::{self, BeatSignal, LayoutSamples, TwoEnds};
use std::path::PathBuf;
use std::sync::Arc;

/// Compute the maps of a scene or a recording, to an .npz archive or a .png or .svg picture, or a .gif of all frames
///
/// The archive has all_point_x, all_point_y (f64 [L], metres), sub0, sub1 (complex128 [512, 12], the samples of the two ends),
/// polar_full (f64 [1, 512, 1024], log10 magnitude of the whole array, not normalised) and polar_partial_mag_phase
/// (f64 [4, 512, 1024], the network's input). These are the keys of the thesis author's program. The archive of a recording has no
/// positions, and no polar_full where only the two ends were recorded. With --layout it also has heard (complex128 [elements of the layout, 512]) and
/// layout (i64, their numbers), and a method hears these. With --method it also has output (f32 [1, 512, 1024]), the method's
/// estimate of Lambda. The window's "Export maps" writes the same. Over a map of the whole array, a line says how many decibels Lambda spans.
///
/// Further keys are the axes: range_metres (f64 [512]), cos_theta (f64 [1024], 0 straight ahead, 1 along the array to the right),
/// columns_left_to_right (1 where cos_theta rises from column to column; 0 where it falls, as with the two-way carrier: in NumPy
/// polar_full[..., ::-1] then has left on the left), element_x_metres (f64 [1024]; sub0 has the first of them, sub1 the last); the weights of
/// the two transforms: sample_window (f64 [512]), element_window (f64 [1024]); and each of the radar's constants as a number: carrier_hz, bandwidth_hz,
/// element_spacing_metres, transmit_power_watts, carrier_turns_per_wavelength (-1 one-way, +2 two-way), elements, end_elements, samples;
/// chirp_seconds where it is another than 25.6e-6; transmit_power_dbm, antenna_gain_dbi, noise_figure_db and half_power_width_degrees of a link
/// budget. format_version is 2; archives of version 1 have neither axes nor constants and are still read.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml or .npz) or recording (.toml with [recording], or a raw capture) to look at
    input: PathBuf,

    #[command(flatten)]
    capture: ConfigArg,

    /// File to write (.npz, .png or .svg; of a recording also .gif, an animation of all its frames)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,

    #[command(flatten)]
    floor: FloorArgs,

    /// How the carrier's phase is read; overrides the scene's radar
    #[arg(long, value_parser = arguments::carrier(), value_name = "one-way|two-way")]
    carrier: Option<Carrier>,

    /// Focus elements that stand off the array's line towards the direction of each column; else each counts as the nearest place on the line
    #[arg(long)]
    focus_off_line: bool,

    /// Picture and output: scale of Lambda, min-max (the thesis) or db=RANGE (below the peak)
    #[arg(long, value_name = "min-max|db=RANGE", default_value_t = Normalisation::MinMax)]
    normalisation: Normalisation,

    /// Reconstruction to show as the output [default: live where it takes the radar, or else iaa]; an archive has an output only with --method
    #[arg(long, value_name = "NAME")]
    method: Option<String>,

    #[command(flatten)]
    layout: LayoutArg,

    #[command(flatten)]
    own: OwnMethodArgs,

    /// Picture: colours of the maps [default: inferno]
    #[arg(long, value_name = "inferno|viridis|grey|diverging")]
    colours: Option<ColourMap>,

    /// Picture: a detector of constant false-alarm rate in place of both thresholds, as `apertura evaluate --cfar` takes it
    #[arg(long, value_name = "ca|os[:..]")]
    cfar: Option<Cfar>,

    /// Recording: fit the gains of this scene's reflectors, subtract their echoes, and draw the residual
    #[arg(long, value_name = "SCENE")]
    explain: Option<PathBuf>,

    /// Recording and archive: polar_full (f64 [frames, samples, elements]) of every frame, with the axes and constants alone
    #[arg(long)]
    all_frames: bool,

    /// Seed of the floor's noise; overrides the scene's
    #[arg(long, value_name = "S", value_parser = arguments::seed)]
    seed: Option<u64>,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let format = picture_format(&self.output, &["npz", "gif"], ".npz, .png, .svg or .gif")?;
        check_kept(&self.input, &self.output)?;
        let of_frames = self.all_frames || ends_in(&self.output, &["gif"]);
        if ends_in(&self.output, &["npz"]) {
            let of_picture = [("--colours", self.colours.is_some()), ("--cfar", self.cfar.is_some())];
            check_no_picture(&self.output, &of_picture)?;
        }
        self.own.start()?;
        let mut input = InputArgs::load_with(&self.input, self.capture.config.as_deref())?;
        let radar = match &mut input {
            InputArgs::Scene(file) => &mut file.radar,
            InputArgs::Recording(recording) => &mut recording.radar,
        };
        radar.carrier = self.carrier.unwrap_or(radar.carrier);
        radar.focus_off_line |= self.focus_off_line;
        if let InputArgs::Recording(_) = input {
            self.floor.check_unset(self.seed, &self.input)?;
        }
        match input {
            InputArgs::Scene(_) if self.explain.is_some() => {
                return Err(CommandError("--explain takes reflectors off a recording; expected one as input".into()));
            }
            InputArgs::Scene(_) if of_frames => {
                let message = "a scene has no frames; expected a recording for --all-frames or a .gif";
                return Err(CommandError::on(&self.input)(message));
            }
            InputArgs::Scene(file) => self.of_scene(&file, format)?,
            InputArgs::Recording(recording) if of_frames => self.of_frames(&recording, format)?,
            InputArgs::Recording(recording) => self.of_recording(*recording, format)?,
        }
        print(&format!("wrote {}", self.output.display()))
    }

    fn of_scene(
        &self,
        SceneFile { scene, radar }: &SceneFile,
        format: Option<PictureFormat>,
    ) -> Result<(), CommandError> {
        let signal = signal::simulate(radar, scene, self.floor.floor(), self.seed.unwrap_or(scene.noise_seed))
            .map_err(CommandError::on(&self.input))?;
        if let Some(format) = format {
            let style = Style { floor: self.floor.floor(), ..self.style() };
            let bytes = compose(radar, scene, &signal, self.method(radar)?.as_ref(), &style, format)?;
            return write_file(&self.output, &bytes);
        }
        let layout_samples = self.layout_samples(radar, Some(&signal))?;
        let (noise, normalisation) = (self.floor.floor().into(), self.normalisation);
        let request = Request { noise, normalisation, layout_samples: layout_samples.clone(), ..Request::default() };
        let output = self.estimate(radar, &signal.two_ends(radar), &request)?;
        let full = write_maps(&self.output, radar, scene, &signal, layout_samples.as_deref(), output.as_ref())
            .map_err(CommandError::on(&self.output))?;
        print(&span(&full))
    }

    fn of_frames(&self, recording: &Recording, format: Option<PictureFormat>) -> Result<(), CommandError> {
        let radar = &recording.radar;
        if self.explain.is_some() {
            return Err(CommandError("--explain takes one frame".into()));
        }
        if format.is_some() {
            let message = "a picture shows one frame; expected .gif or .npz beside --all-frames";
            return Err(CommandError::on(&self.output)(message));
        }
        if ends_in(&self.output, &["gif"]) {
            let (method, style) = (self.method(radar)?, self.style());
            return frames::animate(recording, &self.output, |frame| {
                compose_recording(frame, method.as_ref(), &style, PictureFormat::Png)
                    .map_err(CommandError::on(&self.input))
            });
        }
        if self.method.is_some() {
            let other = "`apertura reconstruct --all-frames` writes a method's";
            return Err(CommandError(format!("--all-frames writes maps without a method; {other}")));
        }
        let failed = |told: String| NpzError::Io(std::io::Error::other(told));
        let map = |n: usize| {
            let frame = frames::frame(recording, n).map_err(|error| failed(error.0))?;
            maps_of(&frame).1.ok_or_else(|| failed(ENDS_ALONE_MESSAGE.to_owned()))
        };
        write_frames(&self.output, radar, frames::count(recording), map).map_err(CommandError::on(&self.output))
    }

    fn of_recording(&self, mut recording: Recording, format: Option<PictureFormat>) -> Result<(), CommandError> {
        if let Some(path) = &self.explain {
            let scene = file::load(path)?.scene;
            let found = explain(&recording, &scene).map_err(CommandError::on(path))?;
            print(&format!("{} explains {:.2} % of the power", path.display(), 100.0 * found.explained))?;
            recording = found.residual;
        }
        let radar = &recording.radar;
        if let Some(format) = format {
            let bytes = compose_recording(&recording, self.method(radar)?.as_ref(), &self.style(), format)
                .map_err(CommandError::on(&self.input))?;
            return write_file(&self.output, &bytes);
        }
        let (full, ends, layout_samples) =
            (maps_of(&recording).1, recording.two_ends(), self.layout_samples(radar, recording.signal())?);
        let request = Request {
            noise: NoisePrior::UNKNOWN,
            normalisation: self.normalisation,
            snapshot_range_metres: recording.range_metres,
            layout_samples: layout_samples.clone(),
            ..Request::default()
        };
        let output = self.estimate(radar, &ends, &request)?;
        write_recorded_maps(&self.output, radar, &ends, full.as_ref(), layout_samples.as_deref(), output.as_ref())
            .map_err(CommandError::on(&self.output))?;
        full.as_ref().map_or(Ok(()), |full| print(&span(full)))
    }

    fn estimate(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Option<RangeAngleMap>, CommandError> {
        let Some(name) = self.method.as_deref() else { return Ok(None) };
        let method = methods::by_name(name)?;
        let answer = method.reconstruct(radar, ends, request).map_err(CommandError::on(&self.input))?;
        Ok(Some(answer.lambda))
    }

    fn method(&self, radar: &Radar) -> Result<Arc<dyn Reconstructor>, CommandError> {
        match (self.method.as_deref(), self.layout.numbers(radar)?) {
            (Some(name), _) => Ok(methods::by_name(name)?),
            (None, Some(layout)) => Ok(methods::preferred_for_layout(radar, &layout)),
            (None, None) => Ok(methods::preferred_for(radar)),
        }
    }

    fn layout_samples(
        &self,
        radar: &Radar,
        signal: Option<&BeatSignal>,
    ) -> Result<Option<Arc<LayoutSamples>>, CommandError> {
        let Some(layout) = self.layout.numbers(radar)? else { return Ok(None) };
        let alone = || CommandError(format!("{}: {ENDS_ALONE_MESSAGE}, or no --layout", self.input.display()));
        Ok(Some(Arc::new(signal.ok_or_else(alone)?.of_layout(&layout))))
    }

    fn style(&self) -> Style {
        let (normalisation, layout) = (self.normalisation, self.layout.other().cloned());
        let colours = self.colours.unwrap_or_default();
        Style { normalisation, layout, colours, cfar: self.cfar, ..Style::default() }
    }
}

fn span(full: &LogMap) -> String {
    if full.max() <= full.min() {
        return "every cell of polar_full is the same: nothing is heard, and there is no peak".to_owned();
    }
    let decibels = 20.0 * (full.max() - full.min());
    format!(
        "min-max Lambda of polar_full: 0 to 1 spans {decibels:.1} dB, 0.9 is {:.1} dB below the peak",
        0.1 * decibels
    )
}

const ENDS_ALONE_MESSAGE: &str = "the recording has the two ends alone; expected samples of every element";
