//! The TOML of a raw capture.

use super::axes::Reading;
use super::line::{ElementLine, USUAL_CARRIER_HZ};
use crate::radar::{Antennas, Radar, SPEED_OF_LIGHT};
use crate::recording::layout::PartOrder;
use crate::recording::profile::RadarProfile;
use crate::recording::{AxisKind, Capture};
use std::fmt::Write;
use std::path::Path;

/// The file, the radar, the antennas and the notes that a TOML is about.
pub(super) struct Subject<'a> {
    pub data: &'a Path,
    pub profile: Option<&'a RadarProfile>,
    pub line: &'a ElementLine,
    pub sentences: &'a [String],
}

/// The TOML of a capture of `samples` samples in a chirp.
pub(super) fn of_capture(capture: &Capture, samples: usize, subject: &Subject<'_>) -> String {
    let mut out = heading(subject);
    let halves = if capture.part_order == Some(PartOrder::Real) { 2 } else { 1 };
    radar(&mut out, None, samples.div_ceil(halves), subject);
    out.push_str("\n[recording]\n");
    put_key(&mut out, "file", &quoted(&beside(subject.data, subject.data)));
    signs(&mut out, subject.profile, subject.profile.is_none());
    // A table of texts, numbers and lists of them can always be written.
    let table = toml::to_string(capture).unwrap_or_default();
    let commented_table = table.replace("\nloop = ", "\n# Or a number from 0, or \"mean\".\nloop = ");
    out.push_str(&format!("\n[recording.capture]\n{commented_table}"));
    out
}

fn heading(subject: &Subject<'_>) -> String {
    let name = subject.data.file_stem().unwrap_or_default().to_string_lossy();
    format!("format = 3\nname = {}\nnotes = {}\n", quoted(&name), quoted(&subject.sentences.join("\n")))
}

/// An array and a way to read it.
pub(super) struct Array<'a> {
    pub reading: &'a Reading,
    pub shape: &'a [usize],
    /// Its name in the file.
    pub key: Option<&'a str>,
    /// Number of transmitters that send in turn along the axis of chirps.
    pub turn_transmitters: Option<usize>,
}

pub(super) fn of_array(array: &Array<'_>, subject: &Subject<'_>) -> String {
    let Array { reading, shape, key, turn_transmitters } = *array;
    let mut out = heading(subject);
    let samples = reading.len(AxisKind::Sample, shape);
    let constants = subject.profile.map(|p| {
        let bandwidth = p.slope_hz_per_second.abs() * samples as f64 / p.samples_per_second;
        [p.carrier_hz(), bandwidth, samples as f64 / p.samples_per_second]
    });
    radar(&mut out, constants, samples, subject);
    if let Some(profile) = subject.profile {
        let chirps = turn_transmitters.unwrap_or(reading.len(AxisKind::Transmitter, shape)).max(1);
        put_key(&mut out, "chirp_interval_seconds", &number(profile.chirp_interval_seconds * chirps as f64));
    }
    out.push_str("\n[recording]\n");
    put_key(&mut out, "file", &quoted(&beside(subject.data, subject.data)));
    if let Some(key) = key {
        put_key(&mut out, "array", &quoted(key));
    }
    let is_pair = turn_transmitters.is_some() || reading.kinds.contains(&AxisKind::Transmitter);
    let named = |kind: &AxisKind| quoted(&kind.to_string());
    put_key(&mut out, "axes", &format!("[{}]", reading.kinds.iter().map(named).collect::<Vec<_>>().join(", ")));
    signs(&mut out, subject.profile, true);
    if reading.kinds.contains(&AxisKind::Frame) {
        out.push_str("frame = 0\n");
    }
    if reading.kinds.contains(&AxisKind::Chirp) {
        out.push_str("# Or a number from 0, or \"mean\".\nchirp = \"strongest\"\n");
    }
    if let Some(transmitters) = turn_transmitters {
        put_key(&mut out, "transmitters_in_turn", &transmitters.to_string());
    }
    if is_pair && subject.line.chirps.len() < turn_transmitters.unwrap_or(reading.len(AxisKind::Transmitter, shape)) {
        put_key(&mut out, "transmitters_taken", &format!("{:?}", subject.line.chirps));
    }
    if let Some(taken) = subject.line.receivers.as_ref().filter(|_| is_pair) {
        put_key(&mut out, "receivers_taken", &format!("{taken:?}"));
    }
    out
}

/// Writes the keys `beat_sign`, `sweep` and, where `says_carrier`, `carrier_at`.
fn signs(out: &mut String, profile: Option<&RadarProfile>, says_carrier: bool) {
    let falls = profile.is_some_and(|p| !p.rises());
    put_key(out, "beat_sign", if falls { "\"-\"" } else { "\"+\"" });
    if falls {
        put_key(out, "sweep", "\"down\"");
    }
    if says_carrier {
        put_key(out, "carrier_at", "\"middle\"");
    }
}

/// Writes the table `[radar]`. Without a named `.cfg`, `constants` are carrier and bandwidth, hertz, and duration of the samples, seconds.
fn radar(out: &mut String, constants: Option<[f64; 3]>, samples: usize, subject: &Subject<'_>) {
    out.push_str("\n[radar]\nconvention = \"physical\"\n");
    if let Some([carrier, bandwidth, seconds]) = constants {
        put_key(out, "carrier_hz", &number(carrier));
        put_key(out, "bandwidth_hz", &number(bandwidth));
        put_key(out, "chirp_seconds", &number(seconds));
        put_key(out, "samples", &samples.to_string());
    } else if subject.profile.is_none() {
        out.push_str("# Not known: a bin of range is one metre with this bandwidth.\n");
        put_key(out, "carrier_hz", &number(USUAL_CARRIER_HZ));
        put_key(out, "bandwidth_hz", &number(SPEED_OF_LIGHT / 2.0));
        put_key(out, "samples", &samples.to_string());
    }
    let ElementLine { transmitter_x_metres, receiver_x_metres, .. } = subject.line;
    put_key(out, "transmitter_x_metres", &list(transmitter_x_metres));
    put_key(out, "receiver_x_metres", &list(receiver_x_metres));
    let pairs = transmitter_x_metres.len() * receiver_x_metres.len();
    let elements = Antennas::new(transmitter_x_metres, receiver_x_metres).map_or(pairs, |a| a.pairs().len());
    let max = Radar { elements, ..Radar::default() }.most_end_elements();
    put_key(out, "end_elements", &max.max(1).to_string());
}

fn put_key(out: &mut String, key: &str, value: &str) {
    // Writing to a string can't fail.
    let _written = writeln!(out, "{key} = {value}");
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Name of `path` in the TOML of `data`: its file name where both are in one folder, else its whole path.
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
