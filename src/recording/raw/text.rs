//! The TOML of a raw capture.

use super::axes::Reading;
use super::line::{Line, USUAL_CARRIER_HZ};
use crate::radar::{Antennas, Radar, SPEED_OF_LIGHT};
use crate::recording::layout::Parts;
use crate::recording::profile::RadarProfile;
use crate::recording::{AxisKind, Capture};
use std::fmt::Write;
use std::path::Path;

/// The files, the radar and the notes of a capture, for its text.
pub(super) struct About<'a> {
    pub data: &'a Path,
    pub profile: Option<&'a RadarProfile>,
    pub line: &'a Line,
    pub sentences: &'a [String],
}

/// The text that describes a capture of `samples` samples in a chirp.
pub(super) fn of_capture(capture: &Capture, samples: usize, about: &About<'_>) -> String {
    let mut out = heading(about);
    let halves = if capture.parts == Some(Parts::Real) { 2 } else { 1 };
    radar(&mut out, None, samples.div_ceil(halves), about);
    out.push_str("\n[recording]\n");
    put(&mut out, "file", &quoted(&beside(about.data, about.data)));
    signs(&mut out, about.profile, about.profile.is_none());
    // The table has texts, numbers and lists of them alone: it can't fail to be written.
    let table = toml::to_string(capture).unwrap_or_default();
    let told = table.replace("\nloop = ", "\n# Or a number from 0, or \"mean\".\nloop = ");
    out.push_str(&format!("\n[recording.capture]\n{told}"));
    out
}

fn heading(about: &About<'_>) -> String {
    let name = about.data.file_stem().unwrap_or_default().to_string_lossy();
    format!("format = 3\nname = {}\nnotes = {}\n", quoted(&name), quoted(&about.sentences.join("\n")))
}

pub(super) struct Array<'a> {
    pub reading: &'a Reading,
    pub shape: &'a [usize],
    /// Its name in the file.
    pub key: Option<&'a str>,
    /// Number of transmitters that send in turn along the axis of chirps.
    pub in_turn: Option<usize>,
}

pub(super) fn of_array(array: &Array<'_>, about: &About<'_>) -> String {
    let Array { reading, shape, key, in_turn } = *array;
    let mut out = heading(about);
    let samples = reading.len(AxisKind::Sample, shape);
    let said = about.profile.map(|p| {
        let bandwidth = p.slope_hz_per_second.abs() * samples as f64 / p.samples_per_second;
        [p.carrier_hz(), bandwidth, samples as f64 / p.samples_per_second]
    });
    radar(&mut out, said, samples, about);
    if let Some(profile) = about.profile {
        let chirps = in_turn.unwrap_or(reading.len(AxisKind::Transmitter, shape)).max(1);
        put(&mut out, "chirp_interval_seconds", &number(profile.chirp_interval_seconds * chirps as f64));
    }
    out.push_str("\n[recording]\n");
    put(&mut out, "file", &quoted(&beside(about.data, about.data)));
    if let Some(key) = key {
        put(&mut out, "array", &quoted(key));
    }
    let is_pair = in_turn.is_some() || reading.kinds.contains(&AxisKind::Transmitter);
    let named = |kind: &AxisKind| quoted(&kind.to_string());
    put(&mut out, "axes", &format!("[{}]", reading.kinds.iter().map(named).collect::<Vec<_>>().join(", ")));
    signs(&mut out, about.profile, true);
    if reading.kinds.contains(&AxisKind::Frame) {
        out.push_str("frame = 0\n");
    }
    if reading.kinds.contains(&AxisKind::Chirp) {
        out.push_str("# Or a number from 0, or \"mean\".\nchirp = \"strongest\"\n");
    }
    if let Some(transmitters) = in_turn {
        put(&mut out, "transmitters_in_turn", &transmitters.to_string());
    }
    if is_pair && about.line.chirps.len() < in_turn.unwrap_or(reading.len(AxisKind::Transmitter, shape)) {
        put(&mut out, "transmitters_taken", &format!("{:?}", about.line.chirps));
    }
    if let Some(taken) = about.line.receivers.as_ref().filter(|_| is_pair) {
        put(&mut out, "receivers_taken", &format!("{taken:?}"));
    }
    out
}

/// Writes the direction in which phases turn, and the place of the carrier on the chirp.
fn signs(out: &mut String, profile: Option<&RadarProfile>, says_carrier: bool) {
    let falls = profile.is_some_and(|p| !p.rises());
    put(out, "beat_sign", if falls { "\"-\"" } else { "\"+\"" });
    if falls {
        put(out, "sweep", "\"down\"");
    }
    if says_carrier {
        put(out, "carrier_at", "\"middle\"");
    }
}

/// Writes the table `[radar]`; `said` are carrier, bandwidth and seconds of the samples where the `.cfg` is not named in the text.
fn radar(out: &mut String, said: Option<[f64; 3]>, samples: usize, about: &About<'_>) {
    out.push_str("\n[radar]\nconvention = \"physical\"\n");
    if let Some([carrier, bandwidth, seconds]) = said {
        put(out, "carrier_hz", &number(carrier));
        put(out, "bandwidth_hz", &number(bandwidth));
        put(out, "chirp_seconds", &number(seconds));
        put(out, "samples", &samples.to_string());
    } else if about.profile.is_none() {
        out.push_str("# Not known: a bin of range is one metre with this bandwidth.\n");
        put(out, "carrier_hz", &number(USUAL_CARRIER_HZ));
        put(out, "bandwidth_hz", &number(SPEED_OF_LIGHT / 2.0));
        put(out, "samples", &samples.to_string());
    }
    let Line { transmitter_x_metres, receiver_x_metres, .. } = about.line;
    put(out, "transmitter_x_metres", &list(transmitter_x_metres));
    put(out, "receiver_x_metres", &list(receiver_x_metres));
    let pairs = transmitter_x_metres.len() * receiver_x_metres.len();
    let elements = Antennas::new(transmitter_x_metres, receiver_x_metres).map_or(pairs, |a| a.pairs().len());
    let most = Radar { elements, ..Radar::default() }.most_end_elements();
    put(out, "end_elements", &most.max(1).to_string());
}

fn put(out: &mut String, key: &str, value: &str) {
    // Writing into a string can't fail.
    let _written = writeln!(out, "{key} = {value}");
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Name of `path` in the text beside `data`: its file name where both stand in one folder.
pub(super) fn beside(path: &Path, data: &Path) -> String {
    let whole = |path: &Path| crate::platform::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (path_whole, data_whole) = (whole(path), whole(data));
    let name =
        path.file_name().filter(|_| path.parent() == data.parent() || path_whole.parent() == data_whole.parent());
    name.map_or_else(|| path_whole.to_string_lossy().into_owned(), |name| name.to_string_lossy().into_owned())
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn list(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|v| number((v * 1e9).round() / 1e9)).collect();
    format!("[{}]", numbers.join(", "))
}
