//! `apertura reconstruct`: an estimate of the whole array's map from the samples of the two ends.

use super::arguments::FloorArgs;
use super::input::{ConfigArg, check_kept, check_no_config, load_recording, shared_text};
use super::layout_arg::LayoutArg;
use super::network_args::NetworkArgs;
use super::radar_arg::RadarArg;
use super::{CommandError, frames, print};
use crate::files::ends_in;
use crate::files::kind::kind_at;
use crate::files::npz::{Npz, NpzError, NpzOutput, write_npz};
use crate::maps::archive::{add_columns, read_radar};
use crate::methods;
use crate::platform::console::note;
use crate::radar::{Radar, counted};
use crate::reconstruct::found::{MAX_COARSE_ELEMENTS, find};
use crate::reconstruct::{Detection, NoisePrior, ReconstructError, Reconstructor, Request};
use crate::recording::{self, Recording};
use crate::scene::file;
use crate::signal::{LayoutSamples, TwoEnds};
use ndarray::{Array1, Array2, Array3, Axis, Ix2, Ix3, arr0};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Estimate the whole array's map from the samples of the two ends
///
/// IN has sub0 and sub1: complex128 [512, 12], or [samples, elements of an end] of another radar, of any gain; or ends, [2, elements of an end,
/// samples], as a dataset has them. For the thesis' networks it may have
/// polar_partial_mag_phase (f64 [4, 512, 1024]) instead. With --layout it has heard: complex128 [elements of the layout, samples]. Of a
/// recording of every element, --layout picks elements. An archive of `apertura maps` and a recording's .toml name their own radar.
///
/// OUT gets net_output (f32 [512, 1024] or [samples, elements], 0 to 1), eta (the threshold of this answer) and
/// milliseconds; cos_theta (f64 [1024]) and columns_left_to_right (0 where cos_theta falls from column to column) say which way the columns run.
/// It also gets the echoes found, the strongest first: the method's reflectors, or the peaks of its map within 20 dB. These are found_cos_theta,
/// found_range_metres (NaN for a snapshot of unknown range), found_db (relative to the strongest) and found_confidence (0 to 1: the fraction that
/// this echo explains of the energy around its range that the other echoes leave; NaN where the method has none). The ten strongest are
/// printed.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Archive with the samples (.npz), or a recording (.toml, or a raw capture)
    input: PathBuf,

    #[command(flatten)]
    capture: ConfigArg,

    /// Archive to write (.npz)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,

    /// Reconstruction method [default: that of --method-command, or else live where it takes the radar, or else iaa; of a layout
    /// iaa where it hears it, or else matched-filter]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,

    /// Recording: every frame. OUT gets net_output (f32 [frames, samples, elements]) and found_frame (i64), the frame of each echo
    #[arg(long)]
    all_frames: bool,

    #[command(flatten)]
    radar: RadarArg,

    #[command(flatten)]
    layout: LayoutArg,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        if !ends_in(&self.output, &["npz"]) {
            return Err(CommandError::on(&self.output)("an archive is written; expected a name ending in .npz"));
        }
        check_kept(&self.input, &self.output)?;
        if recording::file::is_recording_at(&self.input) {
            self.floor.check_unset(None, &self.input)?;
        }
        let own = self.network.start_own()?;
        // A wrong name is reported before any file is read.
        let asked = self.method.as_deref().or(own.first().copied()).map(|name| self.method(name)).transpose()?;
        if self.all_frames {
            return self.of_frames(asked);
        }
        let input = self.input()?;
        let radar = &input.radar;
        let method = asked.map_or_else(|| self.usual(radar), Ok)?;
        let answer = answer(method.as_ref(), &input).map_err(CommandError::on(&self.input))?;
        self.write(radar, &answer).map_err(CommandError::on(&self.output))?;
        if let Samples::Ends(_) = input.samples {
            print_echoes(&answer.found)?;
        }
        if radar.elements <= MAX_COARSE_ELEMENTS && !method.lists_few_elements() {
            let name = method.name();
            note(&format!(
                "note: {name} lists no echoes of {MAX_COARSE_ELEMENTS} elements or fewer: its places are those of the map's cells"
            ));
        }
        let doubtful = answer.found.iter().filter(|f| f.confidence.is_some_and(|c| c < MIN_SURE_CONFIDENCE)).count();
        if doubtful > 0 {
            let of = answer.found.len();
            print(&format!(
                "{doubtful} of {of} echoes are doubtful: found_confidence is less than {MIN_SURE_CONFIDENCE}"
            ))?;
        }
        print(&format!("wrote {} ({}, {:.1} ms)", self.output.display(), method.name(), answer.milliseconds))
    }

    fn of_frames(&self, asked: Option<Arc<dyn Reconstructor>>) -> Result<(), CommandError> {
        if !recording::file::is_recording_at(&self.input) {
            return Err(CommandError::on(&self.input)("expected a recording beside --all-frames"));
        }
        let opened = load_recording(&self.input, self.capture.config.as_deref())?;
        let (radar, count) = (&opened.radar, frames::count(&opened));
        let method = asked.map_or_else(|| self.usual(radar), Ok)?;
        let mut found: Vec<(usize, Detection)> = Vec::new();
        let shape = [count, radar.samples, radar.elements];
        let answer_to = |n: usize| -> Result<Answer, CommandError> {
            let input = self.of_recording(frames::frame(&opened, n)?)?;
            answer(method.as_ref(), &input).map_err(CommandError::on(&self.input))
        };
        let written = write_npz(&self.output, |out| {
            let (mut etas, mut times) = (Vec::new(), Vec::new());
            out.add_stack("net_output", shape, |n| {
                let answer = answer_to(n).map_err(|e| NpzError::Io(std::io::Error::other(e.0)))?;
                etas.push(f64::from(answer.eta));
                times.push(answer.milliseconds);
                found.extend(answer.found.into_iter().map(|echo| (n, echo)));
                Ok(answer.map)
            })?;
            add_columns(out, radar)?;
            out.add("eta", &Array1::from(etas))?;
            out.add("milliseconds", &Array1::from(times))?;
            out.add("found_frame", &found.iter().map(|(n, _)| *n as i64).collect::<Array1<i64>>())?;
            add_found(out, &found.iter().map(|(_, echo)| echo))
        });
        written.map_err(CommandError::on(&self.output))?;
        let (count, echoes) = (counted(count, "frame", "frames"), counted(found.len(), "echo", "echoes"));
        print(&format!("wrote {} ({}, {count}, {echoes})", self.output.display(), method.name()))
    }

    fn method(&self, name: &str) -> Result<Arc<dyn Reconstructor>, CommandError> {
        let found = self.network.methods(&[name.to_owned()])?;
        found.into_iter().next().ok_or_else(|| CommandError("--method takes one name".into()))
    }

    fn input(&self) -> Result<Input, CommandError> {
        if recording::file::is_recording_at(&self.input) {
            if self.radar.is_given() {
                return Err(CommandError::on(&self.input)("a recording says which radar made it; leave --radar out"));
            }
            return self.of_recording(load_recording(&self.input, self.capture.config.as_deref())?);
        }
        let (asked, range_metres) = self.radar.load()?;
        let mut archive = Npz::open(&self.input).map_err(|error| self.not_samples(error))?;
        let has_samples = ["sub0", "ends", "heard", "polar_partial_mag_phase"].iter().any(|key| archive.has(key));
        if !has_samples && archive.has("all_point_x") {
            return Err(self.is_scene());
        }
        check_no_config(&self.input, self.capture.config.as_deref())?;
        let own = read_radar(&mut archive).map_err(CommandError::on(&self.input))?;
        if self.radar.is_given() && own.as_ref().is_some_and(|own| *own != asked) {
            let message = "the archive says which radar made it, and --radar names another; leave --radar out";
            return Err(CommandError::on(&self.input)(message));
        }
        let radar = own.unwrap_or(asked);
        let layout = self.layout.numbers(&radar)?;
        let ready_made = !archive.has("sub0") && !archive.has("ends") && archive.has("polar_partial_mag_phase");
        let noise = self.floor.floor().into();
        let mut request = Request { noise, snapshot_range_metres: range_metres, ..Request::default() };
        let samples = if let Some(layout) = layout {
            let samples = archive.complexes::<Ix2>("heard").map_err(CommandError::on(&self.input))?;
            request.layout_samples = Some(Arc::new(LayoutSamples { layout, samples }));
            Samples::Ends(silence(&radar))
        } else if ready_made {
            let array = archive.reals::<Ix3>("polar_partial_mag_phase").map_err(CommandError::on(&self.input))?;
            Samples::MagPhase(array)
        } else {
            Samples::Ends(self.two_ends(&mut archive, &radar)?)
        };
        Ok(Input { radar, request, samples })
    }

    fn not_samples(&self, error: NpzError) -> CommandError {
        if shared_text(&self.input).is_some() || file::load(&self.input).is_ok() {
            return self.is_scene();
        }
        match kind_at(&self.input) {
            Some(kind) if !kind.contains(".npz") => {
                let expected =
                    "an archive (.npz) with sub0 and sub1, the samples of the two ends, or a recording (.toml)";
                CommandError(format!("{} is {kind}; expected {expected}", self.input.display()))
            }
            _ => CommandError::on(&self.input)(error),
        }
    }

    fn is_scene(&self) -> CommandError {
        let name = self.input.display();
        CommandError(format!(
            "{name} is a scene; expected samples of the two ends: `apertura maps {name} -o IN.npz` computes them, for \
             `apertura reconstruct IN.npz -o OUT.npz`"
        ))
    }

    fn two_ends(&self, archive: &mut Npz, radar: &Radar) -> Result<TwoEnds, CommandError> {
        let Radar { samples, end_elements, .. } = radar;
        let whose = if self.radar.is_given() { "--radar says" } else { "table 3.1 has; --radar FILE names another" };
        let shape = |key: &str, found: &[usize], expected: String| {
            let expected = format!("{expected}: the samples and elements of an end that {whose}");
            NpzError::Shape { key: key.to_owned(), found: format!("{found:?}"), expected }
        };
        if !archive.has("sub0") && archive.has("ends") {
            let both = archive.complexes::<Ix3>("ends").map_err(CommandError::on(&self.input))?;
            if both.dim() != (2, *end_elements, *samples) {
                let wrong = shape("ends", both.shape(), format!("[2, {end_elements}, {samples}]"));
                return Err(CommandError::on(&self.input)(wrong));
            }
            let end = |i: usize| both.index_axis(Axis(0), i).to_owned();
            return Ok(TwoEnds { first: end(0), last: end(1) });
        }
        let [first, last] = ["sub0", "sub1"].map(|key| {
            let array = archive.complexes::<Ix2>(key)?;
            if array.dim() != (*samples, *end_elements) {
                return Err(shape(key, array.shape(), format!("[{samples}, {end_elements}]")));
            }
            Ok(array.reversed_axes().as_standard_layout().into_owned())
        });
        let first = first.map_err(CommandError::on(&self.input))?;
        Ok(TwoEnds { first, last: last.map_err(CommandError::on(&self.input))? })
    }

    fn usual(&self, radar: &Radar) -> Result<Arc<dyn Reconstructor>, CommandError> {
        let layout = self.layout.numbers(radar)?;
        let usual = layout
            .map_or_else(|| methods::preferred_for(radar), |layout| methods::preferred_for_layout(radar, &layout));
        self.method(usual.name())
    }

    fn of_recording(&self, recording: Recording) -> Result<Input, CommandError> {
        let (noise, snapshot_range_metres) = (NoisePrior::UNKNOWN, recording.range_metres);
        let mut request = Request { noise, snapshot_range_metres, ..Request::default() };
        let ends = match self.layout.numbers(&recording.radar)? {
            None => recording.two_ends(),
            Some(layout) => {
                let alone = "the recording holds the samples of the two ends alone; leave --layout out";
                let alone = || CommandError::on(&self.input)(alone);
                request.layout_samples = Some(Arc::new(recording.signal().ok_or_else(alone)?.of_layout(&layout)));
                silence(&recording.radar)
            }
        };
        Ok(Input { radar: recording.radar, request, samples: Samples::Ends(ends) })
    }

    fn write(&self, radar: &Radar, answer: &Answer) -> Result<(), NpzError> {
        write_npz(&self.output, |out| {
            out.add("net_output", &answer.map)?;
            add_columns(out, radar)?;
            out.add("eta", &arr0(f64::from(answer.eta)))?;
            out.add("milliseconds", &arr0(answer.milliseconds))?;
            add_found(out, &answer.found.iter())
        })
    }
}

fn add_found<'a>(
    out: &mut NpzOutput<'_>,
    found: &(impl Iterator<Item = &'a Detection> + Clone),
) -> Result<(), NpzError> {
    let list = |of: fn(&Detection) -> f64| found.clone().map(of).collect::<Array1<f64>>();
    out.add("found_cos_theta", &list(|f| f.cos_theta))?;
    out.add("found_range_metres", &list(|f| f.range_metres))?;
    out.add("found_db", &list(|f| f.relative_power.0))?;
    out.add("found_confidence", &list(|f| f.confidence.unwrap_or(f64::NAN)))
}

/// `number` to so many decimals, never -0.
fn rounded(number: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    (number * scale).round() / scale + 0.0
}

/// Most echoes that are printed; OUT has all.
const MAX_PRINTED_ECHOES: usize = 10;

fn print_echoes(found: &[Detection]) -> Result<(), CommandError> {
    if found.is_empty() {
        return print("no echo found");
    }
    for echo in found.iter().take(MAX_PRINTED_ECHOES) {
        let Detection { cos_theta, range_metres, .. } = echo;
        let range = if range_metres.is_finite() { format!("{range_metres:8.2} m") } else { "unknown range".to_owned() };
        let angle = rounded(cos_theta.clamp(-1.0, 1.0).asin().to_degrees(), 2);
        let cos_theta = rounded(*cos_theta, 3);
        let confidence = echo.confidence.map_or(String::new(), |c| format!(", confidence {c:.2}"));
        print(&format!(
            "{range}, cos θ {cos_theta:6.3} ({angle:6.2}° off broadside), {:5.1} dB{confidence}",
            rounded(echo.relative_power.0, 1)
        ))?;
    }
    match found.len().saturating_sub(MAX_PRINTED_ECHOES) {
        0 => Ok(()),
        more => print(&format!("and {more} weaker")),
    }
}

const MIN_SURE_CONFIDENCE: f64 = 0.5;

struct Input {
    radar: Radar,
    /// What is known of the samples, and those of a layout.
    request: Request,
    samples: Samples,
}

enum Samples {
    /// Those of the two ends; silence where a layout is heard in their place.
    Ends(TwoEnds),
    MagPhase(Array3<f64>),
}

fn silence(radar: &Radar) -> TwoEnds {
    let end = Array2::zeros((radar.end_elements, radar.samples));
    TwoEnds { first: end.clone(), last: end }
}

struct Answer {
    map: Array2<f32>,
    eta: f32,
    milliseconds: f64,
    found: Vec<Detection>,
}

fn answer(method: &dyn Reconstructor, input: &Input) -> Result<Answer, ReconstructError> {
    let Input { radar, request, samples } = input;
    let started = Instant::now();
    let answer = match samples {
        Samples::Ends(ends) => method.reconstruct(radar, ends, request)?,
        Samples::MagPhase(array) => method.reconstruct_mag_phase(radar, array)?,
    };
    let milliseconds = started.elapsed().as_secs_f64() * 1e3;
    let mut found = match samples {
        Samples::Ends(ends) => find(method, radar, ends, request, &answer)?,
        Samples::MagPhase(_) => Vec::new(),
    };
    if radar.samples == 1 {
        // The range of a single sample's echoes comes from elsewhere.
        found.iter_mut().for_each(|f| f.range_metres = request.snapshot_range_metres.unwrap_or(f64::NAN));
    }
    Ok(Answer { eta: method.eta_of(&answer), map: answer.lambda.lambda, milliseconds, found })
}
