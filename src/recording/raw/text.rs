//! The TOML of a raw capture.

use super::line::{Line, USUAL_CARRIER_HZ};
use crate::radar::{Antennas, SPEED_OF_LIGHT};
use crate::recording::layout::{Candidate, Kind, Layout, Parts};
use crate::recording::profile::RadarProfile;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What is told of a capture.
pub(super) struct About<'a> {
    pub data: &'a Path,
    pub config: Option<&'a Path>,
    pub more: &'a [PathBuf],
    pub profile: Option<&'a RadarProfile>,
    pub line: &'a Line,
    pub takes_constant_out: bool,
    pub sentences: &'a [String],
}

/// The text that describes the capture by the candidate's layout.
pub(super) fn text(best: &Candidate, about: &About<'_>) -> String {
    let name = about.data.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut out = format!("format = 3\nname = {}\nnotes = {}\n", quoted(&name), quoted(&about.sentences.join("\n")));
    radar(&mut out, best, about);
    out.push_str("\n[recording]\n");
    put(&mut out, "file", &quoted(&beside(about.data, about.data)));
    let falls = about.profile.is_some_and(|p| !p.rises());
    put(&mut out, "beat_sign", if falls { "\"-\"" } else { "\"+\"" });
    if falls {
        put(&mut out, "sweep", "\"down\"");
    }
    if about.profile.is_none() {
        put(&mut out, "carrier_at", "\"middle\"");
    }
    capture(&mut out, best, about);
    out
}

fn radar(out: &mut String, best: &Candidate, about: &About<'_>) {
    out.push_str("\n[radar]\nconvention = \"physical\"\n");
    if about.profile.is_none() {
        out.push_str("# Not known: a bin of range is one metre with this bandwidth.\n");
        put(out, "carrier_hz", &number(USUAL_CARRIER_HZ));
        put(out, "bandwidth_hz", &number(SPEED_OF_LIGHT / 2.0));
        let halves = if best.layout.parts == Parts::Real { 2 } else { 1 };
        put(out, "samples", &best.counts.samples.div_ceil(halves).to_string());
    }
    let Line { transmitter_x_metres, receiver_x_metres, .. } = about.line;
    put(out, "transmitter_x_metres", &list(transmitter_x_metres));
    put(out, "receiver_x_metres", &list(receiver_x_metres));
    let pairs = transmitter_x_metres.len() * receiver_x_metres.len();
    let elements = Antennas::new(transmitter_x_metres, receiver_x_metres).map_or(pairs, |a| a.pairs().len());
    put(out, "end_elements", &(elements / 2).max(1).to_string());
}

fn capture(out: &mut String, best: &Candidate, about: &About<'_>) {
    let Layout { words, parts, q_first, receivers, header_bytes, .. } = best.layout;
    out.push_str("\n[recording.capture]\n");
    if let Some(config) = about.config {
        put(out, "config", &quoted(&beside(config, about.data)));
    }
    if !about.more.is_empty() {
        let names: Vec<String> = about.more.iter().map(|path| quoted(&beside(path, about.data))).collect();
        put(out, "more_files", &format!("[{}]", names.join(", ")));
    }
    put(out, "words", &quoted(words.name()));
    put(out, "parts", &quoted(parts.name()));
    put(out, "q_first", &q_first.to_string());
    put(out, "receivers", &quoted(receivers.name()));
    if header_bytes > 0 {
        put(out, "header_bytes", &header_bytes.to_string());
    }
    if about.profile.is_none() {
        for (key, value) in [
            ("samples", best.counts.samples),
            ("receiver_count", best.counts.receivers),
            ("loop_chirps", best.counts.chirps),
            ("loops", best.counts.loops),
        ] {
            put(out, key, &value.to_string());
        }
    }
    put(out, "chirps", &format!("{:?}", about.line.chirps));
    if let Some(taken) = &about.line.receivers {
        put(out, "receivers_taken", &format!("{taken:?}"));
    }
    put(out, "frame", "0");
    out.push_str("# Or a number from 0, or \"mean\".\n");
    put(out, "loop", "\"strongest\"");
    if about.takes_constant_out {
        put(out, "constant", "\"out\"");
    }
    let against = best.of_kind(Kind::Config) < 0.0;
    if against {
        out.push_str("# The samples speak against what the .cfg says of their order.\n");
    }
}

fn put(out: &mut String, key: &str, value: &str) {
    // Writing into a string can't fail.
    let _written = writeln!(out, "{key} = {value}");
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// How the text beside `data` names `path`: by its name where both stand in one folder.
fn beside(path: &Path, data: &Path) -> String {
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
