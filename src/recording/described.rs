//! The recording that a text describes: the TOML, and what it names.

use super::doubts::doubts;
use super::profile::lines::text_of;
use super::said_radar::said_radar;
use super::said_recording::Table;
use super::samples::{Open, read_loops, read_samples};
use super::signs::{FORMAT, Signs, oldest};
use super::{Fault, RadarProfile, Recording, RecordingError};
use crate::platform::fs::File;
use crate::radar::Radar;
use crate::scene::file::SceneTextError;
use crate::signal::ChirpSamples;
use serde::Deserialize;
use std::io::{self, Read};
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

pub(super) fn read_text(file: impl Read) -> Result<String, Fault> {
    let mut text = Vec::new();
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut text)?;
    if text.len() as u64 > MAX_TEXT_BYTES {
        return Err(Fault::key(
            "the text",
            "is longer than 1 MiB",
            "a description; samples stand in a file of their own",
        ));
    }
    String::from_utf8(text).map_err(|_| Fault::key("the text", "is not UTF-8", "text in UTF-8"))
}

/// The text of a `.cfg`, in any encoding.
pub(super) fn config_text(file: impl Read) -> Result<String, Fault> {
    let mut bytes = Vec::new();
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_TEXT_BYTES {
        return Err(Fault::key("the .cfg", "is longer than 1 MiB", "the commands that set a radar up"));
    }
    Ok(text_of(&bytes))
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

/// What a recording's text says, before its samples are read.
pub(super) struct Parts {
    pub format: u32,
    pub name: String,
    pub notes: String,
    pub table: Table,
    pub radar: Radar,
    pub profile: Option<RadarProfile>,
    pub signs: Signs,
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
            Some(read().map_err(|fault| fault.of(&beside))?)
        }
    };
    let mut radar = said_radar(document.radar, profile.as_ref()).map_err(|fault| fault.of(path))?;
    table.has_places = !radar.is_monostatic();
    if table.reverse_elements {
        radar.antennas = radar.antennas.map(|antennas| antennas.mirrored());
    }
    table.check(&radar).map_err(|fault| fault.of(path))?;
    let signs = table.signs(document.format, &radar, profile.is_some()).map_err(|fault| fault.of(path))?;
    radar.carrier_hz = signs.carrier_hz;
    radar.validate().map_err(|e| Fault::from(e).of(path))?;
    Ok(Parts { format: document.format, name: document.name, notes: document.notes, table, radar, profile, signs })
}

/// Reads a recording from the text of its TOML, which stands at `path`, and what `open` opens.
pub(super) fn from_parts(text: &str, path: &Path, open: Open<'_>) -> Result<Recording, RecordingError> {
    let Parts { format, name, notes, table, radar, profile, signs } = parts(text, path, open)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let data = folder.join(&table.file);
    // Keys stand in the TOML, those about other files too.
    let place = |fault: Fault| match fault {
        Fault::Key { .. } | Fault::Calibration(_) => fault.of(path),
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

/// Every loop of the frame that a text describes: the radar with their number and interval, and the samples, `[loops, elements, samples]`.
pub(super) fn loops_of(text: &str, path: &Path, open: Open<'_>) -> Result<(Radar, ChirpSamples), RecordingError> {
    let Parts { table, mut radar, profile, signs, .. } = parts(text, path, open)?;
    let Some(profile) = profile else {
        let expected = "it: without a .cfg nothing says the interval of chirps";
        return Err(Fault::key("recording.capture.config", "is missing", expected).of(path));
    };
    let samples = read_loops(&table, open, Some(&profile), signs).map_err(|fault| fault.of(path))?;
    radar.chirps = samples.dim().0;
    radar.chirp_interval_seconds =
        (profile.chirp_interval_seconds * profile.chirp_transmitters.len() as f64).max(radar.chirp_seconds);
    radar.validate().map_err(|e| Fault::from(e).of(path))?;
    Ok((radar, ChirpSamples { samples }))
}
