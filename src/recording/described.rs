//! The recording that a text describes: the TOML, and the files that it names.

use super::capture::Plan;
use super::chain::Source;
use super::doubts::doubts;
use super::layout::stream::Stream;
use super::profile::lines::text_of;
use super::said_radar::said_radar;
use super::said_recording::Table;
use super::samples::{Open, count_frames, open_capture, read_loops, read_samples};
use super::signs::{FORMAT, Signs, oldest};
use super::{AxisKind, Fault, RadarProfile, Recording, RecordingError, layout};
use crate::platform::fs::File;
use crate::radar::Radar;
use crate::scene::file::SceneTextError;
use crate::signal::ChirpSamples;
use serde::Deserialize;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// Longest text that is read, bytes.
const MAX_TEXT_BYTES: u64 = 1 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default = "oldest")]
    format: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    notes: String,
    radar: toml::Table,
    recording: Table,
}

pub(super) fn open_file(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    if file.metadata()?.is_file() {
        Ok(file)
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, "is a folder, device or pipe; expected a file"))
    }
}

/// Opens the data files in a folder by their names.
pub(super) fn beside(folder: &Path) -> impl Fn(&str) -> io::Result<Box<dyn Source>> {
    |name| Ok(Box::new(BufReader::new(open_file(&folder.join(name))?)))
}

fn text_bytes(file: impl Read, what: &str, expected: &str) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_TEXT_BYTES {
        return Err(Fault::key(what, "is longer than 1 MiB", expected));
    }
    Ok(bytes)
}

pub(super) fn read_text(file: impl Read) -> Result<String, Fault> {
    let text = text_bytes(file, "the text", "a description; samples stand in a file of their own")?;
    String::from_utf8(text).map_err(|_| Fault::key("the text", "is not UTF-8", "text in UTF-8"))
}

/// The text of a `.cfg`, in any encoding.
pub(super) fn config_text(file: impl Read) -> Result<String, Fault> {
    text_bytes(file, "the .cfg", "the commands that set a radar up").map(|bytes| text_of(&bytes))
}

/// Refuses a text of a later format before its unknown keys are.
fn check_format(text: &str) -> Result<(), Fault> {
    #[derive(Deserialize)]
    struct Said {
        #[serde(default = "oldest")]
        format: u32,
    }
    match toml::from_str(text) {
        Ok(Said { format: later }) if later > FORMAT => {
            Err(Fault::key("format", format!("is {later}, of a later version of apertura"), "1, 2 or 3"))
        }
        _ => Ok(()),
    }
}

/// The parts of a recording's text, before its samples are read.
pub(super) struct Parts {
    pub format: u32,
    pub name: String,
    pub notes: String,
    pub table: Table,
    pub radar: Radar,
    pub profile: Option<RadarProfile>,
    pub signs: Signs,
    /// Whether the text says the interval of loops.
    says_interval: bool,
}

pub(super) fn parts(text: &str, path: &Path, open: Open<'_>) -> Result<Parts, RecordingError> {
    check_format(text).map_err(|fault| fault.of(path))?;
    let document: Document = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        Fault::Text(SceneTextError::at(text, start, error.message().lines().collect::<Vec<_>>().join(", "))).of(path)
    })?;
    let mut table = document.recording;
    let folder = path.parent().unwrap_or(Path::new(""));
    let profile = match table.capture.as_ref().and_then(|capture| Some((capture, capture.config.as_ref()?))) {
        None => None,
        Some((capture, config)) => {
            let beside = folder.join(config);
            let read = || -> Result<RadarProfile, Fault> {
                Ok(RadarProfile::of_sub_frame(&config_text(open(config)?)?, capture.sub_frame)?)
            };
            let mut profile = read().map_err(|fault| fault.of(&beside))?.on_chips(1 + capture.chips.len());
            // A layout that contradicts the .cfg follows the samples.
            profile.real = capture.parts.map_or(profile.real, |parts| parts == layout::Parts::Real);
            Some(profile)
        }
    };
    let says_interval = document.radar.contains_key("chirp_interval_seconds");
    let mut radar = said_radar(document.radar, profile.as_ref()).map_err(|fault| fault.of(path))?;
    table.has_places = !radar.is_monostatic();
    if table.reverse_elements {
        radar.antennas = radar.antennas.map(|antennas| antennas.mirrored());
    }
    table.check(&radar).map_err(|fault| fault.of(path))?;
    let signs = table.signs(document.format, &radar, profile.is_some()).map_err(|fault| fault.of(path))?;
    radar.carrier_hz = signs.carrier_hz;
    radar.validate().map_err(|e| Fault::from(e).of(path))?;
    let Document { format, name, notes, .. } = document;
    Ok(Parts { format, name, notes, table, radar, profile, signs, says_interval })
}

/// Reads a recording from the text of its TOML at `path`, and from the files that `open` opens; `frame` is taken in place of the text's.
pub(super) fn from_parts(
    text: &str,
    path: &Path,
    open: Open<'_>,
    frame: Option<u64>,
) -> Result<Recording, RecordingError> {
    let Parts { format, name, notes, mut table, radar, profile, signs, .. } = parts(text, path, open)?;
    table.look_at(frame);
    let folder = path.parent().unwrap_or(Path::new(""));
    let data = folder.join(&table.file);
    // Keys stand in the TOML, those about other files too.
    let place = |fault: Fault| match fault {
        Fault::Key { .. } => fault.of(path),
        fault => fault.of(&data),
    };
    let (samples, found) = read_samples(&table, &radar, open, profile.as_ref(), signs).map_err(place)?;
    let Table { mut missing, range_metres, .. } = table;
    missing.extend((0..radar.elements).filter(|n| radar.is_gap(*n)));
    missing.sort_unstable();
    missing.dedup();
    let mut doubts = doubts(&radar, &samples, format > oldest());
    doubts.extend(found);
    Ok(Recording { name, notes, radar, samples, missing, range_metres, doubts, origin: None })
}

/// Number of whole frames in the recording of a text, and the number of the frame that the text takes; `None` where the text counts neither frames
/// nor loops.
pub(super) fn frames_of(text: &str, path: &Path, open: Open<'_>) -> Result<Option<[u64; 2]>, RecordingError> {
    let Parts { table, profile, .. } = parts(text, path, open)?;
    let counted = || -> Result<u64, Fault> {
        let Some(capture) = &table.capture else { return count_frames(&table, open) };
        let stream = Stream::new(open_capture(&table, open, capture)?)?;
        Ok(Plan::new(capture, profile.as_ref(), stream.bytes())?.frames.max(1))
    };
    let repeats = |kind: &AxisKind| matches!(kind, AxisKind::Frame | AxisKind::Chirp);
    if table.capture.is_none() && !table.axes.iter().flatten().any(repeats) {
        return Ok(None);
    }
    let frame = table.capture.as_ref().map_or(table.frame, |capture| Some(capture.frame));
    Ok(Some([counted().map_err(|fault| fault.of(path))?, frame.unwrap_or(0) as u64]))
}

/// Every loop of a frame, for a range-Doppler map.
#[derive(Debug, Clone)]
pub struct FrameLoops {
    /// The radar, with the number of loops and their interval.
    pub radar: Radar,
    /// `[loops, elements, samples]`.
    pub samples: ChirpSamples,
    /// Whether the interval is known; an unknown one is set so that velocities are 1 m/s apart.
    pub knows_interval: bool,
}

/// Every loop of the frame that a text describes, or of `frame`.
pub(super) fn loops_of(
    text: &str,
    path: &Path,
    open: Open<'_>,
    frame: Option<u64>,
) -> Result<FrameLoops, RecordingError> {
    let Parts { mut table, mut radar, profile, signs, says_interval, .. } = parts(text, path, open)?;
    table.look_at(frame);
    let samples = read_loops(&table, open, profile.as_ref(), signs).map_err(|fault| fault.of(path))?;
    radar.chirps = samples.dim().0;
    if let Some(profile) = &profile {
        radar.chirp_interval_seconds = profile.chirp_interval_seconds * profile.chirp_transmitters.len() as f64;
    } else if !says_interval {
        radar.chirp_interval_seconds = 1.0;
        radar.chirp_interval_seconds = radar.velocity_resolution_metres_per_second();
        radar.chirp_seconds = radar.chirp_seconds.min(radar.chirp_interval_seconds);
    }
    radar.chirp_interval_seconds = radar.chirp_interval_seconds.max(radar.chirp_seconds);
    radar.validate().map_err(|e| Fault::from(e).of(path))?;
    let knows_interval = profile.is_some() || says_interval;
    Ok(FrameLoops { radar, samples: ChirpSamples { samples }, knows_interval })
}
