//! The TOML of a recording, with the files that it names.

use super::capture::CapturePlan;
use super::chain::{Open, Source};
use super::doubts::doubts;
use super::layout::stream::CaptureStream;
use super::profile::lines::config_text;
use super::radar_table::radar_of_table;
use super::recording_table::RecordingTable;
use super::signs::{FORMAT, Signs, first_format};
use super::{AxisKind, Fault, RadarProfile, Recording, RecordingError, layout};
use crate::platform::fs::{self, File};
use crate::radar::Radar;
use crate::scene::file::SceneTextError;
use crate::signal::ChirpSamples;
use serde::Deserialize;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

const MAX_TEXT_BYTES: u64 = 1 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default = "first_format")]
    format: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    notes: String,
    radar: toml::Table,
    recording: RecordingTable,
}

/// Opens a file, but no folder, device or pipe: opening a pipe would wait for its writer.
pub(super) fn open_file(path: &Path) -> io::Result<File> {
    if fs::metadata(path)?.is_file() {
        File::open(path)
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, "is a folder, device or pipe; expected a file"))
    }
}

/// A function that opens files of `folder` by name.
pub(super) fn open_in(folder: &Path) -> impl Fn(&str) -> io::Result<Box<dyn Source>> {
    |name| Ok(Box::new(BufReader::new(open_file(&folder.join(name))?)))
}

fn read_bounded(file: impl Read, what: &str, expected: &str) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_TEXT_BYTES {
        return Err(Fault::key(what, "is longer than 1 MiB", expected));
    }
    Ok(bytes)
}

pub(super) fn read_text(file: impl Read) -> Result<String, Fault> {
    let text = read_bounded(file, "the text", "a description; samples stand in a file of their own")?;
    String::from_utf8(text).map_err(|_| Fault::key("the text", "is not UTF-8", "text in UTF-8"))
}

/// Reads the text of a `.cfg`, in any encoding.
pub(super) fn read_config_text(file: impl Read) -> Result<String, Fault> {
    read_bounded(file, "the .cfg", "the commands that set a radar up").map(|bytes| config_text(&bytes))
}

/// Path of the samples of the recording whose TOML is `path`; `None` where that is no such TOML.
pub fn data_path(path: &Path) -> Option<PathBuf> {
    let text = read_text(open_file(path).ok()?).ok()?;
    let table: toml::Table = text.parse().ok()?;
    let name = table.get("recording")?.get("file")?.as_str()?;
    Some(folder_of(path).join(name))
}

/// Refuses a text of a later format. Its unknown keys would give a worse message.
fn check_format(text: &str) -> Result<(), Fault> {
    #[derive(Deserialize)]
    struct FormatKey {
        #[serde(default = "first_format")]
        format: u32,
    }
    match toml::from_str(text) {
        Ok(FormatKey { format }) if format > FORMAT => {
            Err(Fault::key("format", format!("is {format}, of a later version of apertura"), "1, 2 or 3"))
        }
        _ => Ok(()),
    }
}

/// The TOML of a recording, read and checked, and its `.cfg`. The samples are not read yet.
pub(super) struct RecordingText<'a> {
    /// File of the TOML, or that of the samples where the TOML is in memory. Names of files in it are relative to its folder.
    path: &'a Path,
    pub open: Open<'a>,
    format: u32,
    name: String,
    notes: String,
    pub table: RecordingTable,
    pub radar: Radar,
    pub profile: Option<RadarProfile>,
    pub signs: Signs,
    /// Whether the TOML has `radar.chirp_interval_seconds`.
    has_interval: bool,
}

/// Every loop of a frame.
#[derive(Debug, Clone)]
pub struct FrameLoops {
    /// The radar, with the number of loops and their interval.
    pub radar: Radar,
    /// `[loops, elements, samples]`.
    pub samples: ChirpSamples,
    /// Whether the interval is known. An unknown one is set for a velocity resolution of 1 m/s.
    pub knows_interval: bool,
}

impl<'a> RecordingText<'a> {
    /// Parses the TOML `text` of the file `path`. `open` opens its other files, and `frame` replaces the frame of the text.
    pub fn parse(text: &str, path: &'a Path, open: Open<'a>, frame: Option<u64>) -> Result<Self, RecordingError> {
        check_format(text).map_err(|fault| fault.of(path))?;
        let document: Document = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            Fault::Text(SceneTextError::at(text, start, message)).of(path)
        })?;
        let Document { format, name, notes, radar, recording: mut table } = document;
        table.select_frame(frame);
        let profile = profile_of(&table, path, open)?;
        let has_interval = radar.contains_key("chirp_interval_seconds");
        let mut radar = radar_of_table(radar, profile.as_ref()).map_err(|fault| fault.of(path))?;
        table.has_antenna_places = !radar.is_monostatic();
        if table.reverse_elements {
            radar.antennas = radar.antennas.map(|antennas| antennas.mirrored());
        }
        table.check(&radar).map_err(|fault| fault.of(path))?;
        let signs = table.signs(format, &radar, profile.is_some()).map_err(|fault| fault.of(path))?;
        radar.carrier_hz = signs.carrier_hz;
        radar.validate().map_err(|e| Fault::from(e).of(path))?;
        Ok(RecordingText { path, open, format, name, notes, table, radar, profile, signs, has_interval })
    }

    pub fn recording(&self) -> Result<Recording, RecordingError> {
        let RecordingText { radar, table, .. } = self;
        // Keys are in the TOML, those about other files too.
        let with_path = |fault: Fault| match fault {
            Fault::Key { .. } => fault.of(self.path),
            fault => fault.of(&folder_of(self.path).join(&table.file)),
        };
        let (samples, notes_on_samples) = self.samples().map_err(with_path)?;
        let mut missing = table.missing.clone();
        missing.extend((0..radar.elements).filter(|n| radar.is_gap(*n)));
        missing.sort_unstable();
        missing.dedup();
        let mut doubts = doubts(radar, &samples, self.format > first_format());
        doubts.extend(notes_on_samples);
        let (name, notes, range_metres) = (self.name.clone(), self.notes.clone(), table.range_metres);
        Ok(Recording { name, notes, radar: radar.clone(), samples, missing, range_metres, doubts, origin: None })
    }

    /// Number of whole frames in the recording, and the number of the frame that is read; `None` where the arrays have neither frames nor chirps.
    pub fn frames(&self) -> Result<Option<[u64; 2]>, RecordingError> {
        let RecordingText { table, profile, .. } = self;
        let count = || -> Result<u64, Fault> {
            let Some(capture) = &table.capture else { return self.count_frames() };
            let stream = CaptureStream::new(self.open_capture(capture)?)?;
            Ok(CapturePlan::new(capture, profile.as_ref(), stream.bytes())?.frames.max(1))
        };
        let repeats = |kind: &AxisKind| matches!(kind, AxisKind::Frame | AxisKind::Chirp);
        if table.capture.is_none() && !table.axes.iter().flatten().any(repeats) {
            return Ok(None);
        }
        let frame = table.capture.as_ref().map_or(table.frame, |capture| Some(capture.frame));
        Ok(Some([count().map_err(|fault| fault.of(self.path))?, frame.unwrap_or(0) as u64]))
    }

    /// Every loop of the frame, for a range-Doppler map; an error where there are none.
    pub fn loops(&self) -> Result<FrameLoops, RecordingError> {
        let RecordingText { path, profile, has_interval, .. } = self;
        let samples = self.read_loops().map_err(|fault| fault.of(path))?;
        let mut radar = Radar { chirps: samples.dim().0, ..self.radar.clone() };
        if let Some(profile) = profile {
            radar.chirp_interval_seconds = profile.chirp_interval_seconds * profile.chirp_transmitters.len() as f64;
        } else if !has_interval {
            // The velocity resolution is inversely proportional to the interval: it becomes 1 m/s.
            radar.chirp_interval_seconds = 1.0;
            radar.chirp_interval_seconds = radar.velocity_resolution_metres_per_second();
            radar.chirp_seconds = radar.chirp_seconds.min(radar.chirp_interval_seconds);
        }
        radar.chirp_interval_seconds = radar.chirp_interval_seconds.max(radar.chirp_seconds);
        radar.validate().map_err(|e| Fault::from(e).of(path))?;
        let knows_interval = profile.is_some() || *has_interval;
        Ok(FrameLoops { radar, samples: ChirpSamples { samples }, knows_interval })
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The radar of the `.cfg` that the table names, on as many chips as the table has files.
fn profile_of(table: &RecordingTable, path: &Path, open: Open<'_>) -> Result<Option<RadarProfile>, RecordingError> {
    let Some(capture) = &table.capture else { return Ok(None) };
    let Some(config) = &capture.config else { return Ok(None) };
    let read = || -> Result<RadarProfile, Fault> {
        RadarProfile::of_sub_frame(&read_config_text(open(config)?)?, capture.sub_frame)
    };
    let read = read().map_err(|fault| fault.of(&folder_of(path).join(config)))?;
    let mut profile = read.on_chips(1 + capture.chips.len());
    // A layout that contradicts the .cfg follows the samples.
    profile.real = capture.part_order.map_or(profile.real, |part_order| part_order == layout::PartOrder::Real);
    Ok(Some(profile))
}
