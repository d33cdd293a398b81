//! The recording that a text describes: the TOML, and the files that it names.

use super::capture::Plan;
use super::chain::{Open, Source};
use super::doubts::doubts;
use super::layout::stream::Stream;
use super::profile::lines::text_of;
use super::said_radar::said_radar;
use super::said_recording::Table;
use super::signs::{FORMAT, Signs, oldest};
use super::{AxisKind, Fault, RadarProfile, Recording, RecordingError, layout};
use crate::platform::fs::File;
use crate::radar::Radar;
use crate::scene::file::SceneTextError;
use crate::signal::ChirpSamples;
use serde::Deserialize;
use std::io::{self, BufReader, Read};
use std::path::Path;

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

/// The recording that a text describes, before its samples are read.
pub(super) struct Described<'a> {
    /// The text's file. Names in the text are those of files beside it.
    path: &'a Path,
    pub open: Open<'a>,
    format: u32,
    name: String,
    notes: String,
    pub table: Table,
    pub radar: Radar,
    pub profile: Option<RadarProfile>,
    pub signs: Signs,
    says_interval: bool,
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

impl<'a> Described<'a> {
    /// The text of the file `path`, whose data files `open` opens by their names; `frame` is taken in place of the text's.
    pub fn by(text: &str, path: &'a Path, open: Open<'a>, frame: Option<u64>) -> Result<Self, RecordingError> {
        check_format(text).map_err(|fault| fault.of(path))?;
        let document: Document = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            Fault::Text(SceneTextError::at(text, start, message)).of(path)
        })?;
        let Document { format, name, notes, radar, recording: mut table } = document;
        table.look_at(frame);
        let profile = profile_of(&table, path, open)?;
        let says_interval = radar.contains_key("chirp_interval_seconds");
        let mut radar = said_radar(radar, profile.as_ref()).map_err(|fault| fault.of(path))?;
        table.has_places = !radar.is_monostatic();
        if table.reverse_elements {
            radar.antennas = radar.antennas.map(|antennas| antennas.mirrored());
        }
        table.check(&radar).map_err(|fault| fault.of(path))?;
        let signs = table.signs(format, &radar, profile.is_some()).map_err(|fault| fault.of(path))?;
        radar.carrier_hz = signs.carrier_hz;
        radar.validate().map_err(|e| Fault::from(e).of(path))?;
        Ok(Described { path, open, format, name, notes, table, radar, profile, signs, says_interval })
    }

    /// Reads the samples.
    pub fn recording(&self) -> Result<Recording, RecordingError> {
        let Described { radar, table, .. } = self;
        // Keys stand in the TOML, those about other files too.
        let place = |fault: Fault| match fault {
            Fault::Key { .. } => fault.of(self.path),
            fault => fault.of(&folder_of(self.path).join(&table.file)),
        };
        let (samples, found) = self.samples().map_err(place)?;
        let mut missing = table.missing.clone();
        missing.extend((0..radar.elements).filter(|n| radar.is_gap(*n)));
        missing.sort_unstable();
        missing.dedup();
        let mut doubts = doubts(radar, &samples, self.format > oldest());
        doubts.extend(found);
        let (name, notes, range_metres) = (self.name.clone(), self.notes.clone(), table.range_metres);
        Ok(Recording { name, notes, radar: radar.clone(), samples, missing, range_metres, doubts, origin: None })
    }

    /// Number of whole frames in the recording, and the number of the frame that the text takes; `None` where the text counts neither frames
    /// nor loops.
    pub fn frames(&self) -> Result<Option<[u64; 2]>, RecordingError> {
        let Described { table, profile, .. } = self;
        let counted = || -> Result<u64, Fault> {
            let Some(capture) = &table.capture else { return self.count_frames() };
            let stream = Stream::new(self.open_capture(capture)?)?;
            Ok(Plan::new(capture, profile.as_ref(), stream.bytes())?.frames.max(1))
        };
        let repeats = |kind: &AxisKind| matches!(kind, AxisKind::Frame | AxisKind::Chirp);
        if table.capture.is_none() && !table.axes.iter().flatten().any(repeats) {
            return Ok(None);
        }
        let frame = table.capture.as_ref().map_or(table.frame, |capture| Some(capture.frame));
        Ok(Some([counted().map_err(|fault| fault.of(self.path))?, frame.unwrap_or(0) as u64]))
    }

    pub fn loops(&self) -> Result<FrameLoops, RecordingError> {
        let Described { path, profile, says_interval, .. } = self;
        let samples = self.every_loop().map_err(|fault| fault.of(path))?;
        let mut radar = Radar { chirps: samples.dim().0, ..self.radar.clone() };
        if let Some(profile) = profile {
            radar.chirp_interval_seconds = profile.chirp_interval_seconds * profile.chirp_transmitters.len() as f64;
        } else if !says_interval {
            radar.chirp_interval_seconds = 1.0;
            radar.chirp_interval_seconds = radar.velocity_resolution_metres_per_second();
            radar.chirp_seconds = radar.chirp_seconds.min(radar.chirp_interval_seconds);
        }
        radar.chirp_interval_seconds = radar.chirp_interval_seconds.max(radar.chirp_seconds);
        radar.validate().map_err(|e| Fault::from(e).of(path))?;
        let knows_interval = profile.is_some() || *says_interval;
        Ok(FrameLoops { radar, samples: ChirpSamples { samples }, knows_interval })
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The `.cfg` that a table of a capture names.
fn profile_of(table: &Table, path: &Path, open: Open<'_>) -> Result<Option<RadarProfile>, RecordingError> {
    let Some(capture) = &table.capture else { return Ok(None) };
    let Some(config) = &capture.config else { return Ok(None) };
    let read = || -> Result<RadarProfile, Fault> {
        RadarProfile::of_sub_frame(&config_text(open(config)?)?, capture.sub_frame)
    };
    let read = read().map_err(|fault| fault.of(&folder_of(path).join(config)))?;
    let mut profile = read.on_chips(1 + capture.chips.len());
    // A layout that contradicts the .cfg follows the samples.
    profile.real = capture.parts.map_or(profile.real, |parts| parts == layout::Parts::Real);
    Ok(Some(profile))
}
