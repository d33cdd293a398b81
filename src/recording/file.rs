//! The TOML of a recording.
//!
//! ```toml
//! format = 3                          # of this text; without it, signs and carrier are those of the thesis' formula
//! name = "A post and a wall"
//! notes = "Where it was measured, and what to look for."
//!
//! [radar]                             # all of these are needed; a recording borrows none of table 3.1
//! carrier_hz = 77e9                   # at the sample that carrier_at says
//! carrier = "two-way"                 # or "one-way", if nothing is said
//! bandwidth_hz = 3.07e9               # over the samples; not needed for a snapshot (samples = 1)
//! element_spacing_metres = 0.001947
//! elements = 8
//! end_elements = 3
//! samples = 128
//! # transmitter_x_metres and receiver_x_metres, lists in the file's order, in place of spacing and elements: pairs of antennas;
//! # transmitter_y_metres and receiver_y_metres where they stand off the line
//!
//! [recording]
//! file = "post.npz"                   # .npz, .npy, .mat or .bin, beside this file
//! array = "samples"                   # its name in an .npz or .mat; or first and last, where the two ends have arrays of their own
//! axes = ["chirp", "element", "sample"] # or "transmitter" and "receiver"; "iq" where real and imaginary part have an axis
//! chirp = 0                           # or "mean"
//! elements = "all"                    # or "ends": first the elements of the first end, then those of the last
//! missing = [17]                      # elements of the whole array that measured nothing
//! range_metres = 15.0                 # of a snapshot
//! carrier_at = "first-sample"         # or "middle": where on the chirp carrier_hz lies
//! beat_sign = "+"                     # echoes stand at positive frequencies, or "-"
//! sweep = "up"                        # or "down"
//! reverse_elements = false            # mirrors the array: the file's first element is its last; places of antennas change their sign
//!
//! [recording.calibration]             # taken off the elements of the file
//! gain_db = []
//! phase_degrees = []
//!
//! [recording.capture]                 # for a .bin: a raw capture and the .cfg that set the radar up
//! config = "profile.cfg"              # says carrier_hz, bandwidth_hz, samples and chirp_seconds of [radar]
//! lanes = 2                           # or 4
//! receivers = "one-after-another"     # or "interleaved"
//! chirps = [0, 2]                     # the chirps of a loop that form the line of elements
//! frame = 0
//! loop = 0
//! ```

use super::described::{beside, frames_of, from_parts, open_file, read_text};
use super::raw;
use super::{Fault, Offer, Origin, Recording, RecordingError};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Whether a TOML is that of a recording: whether it has a table `[recording]`.
pub fn is_recording(text: &str) -> bool {
    toml::de::DeTable::parse(text).is_ok_and(|table| table.get_ref().contains_key("recording"))
}

/// Whether the file `path` is a recording: the TOML of one, a raw capture, an array, or the `.cfg` of one.
pub fn is_recording_at(path: &Path) -> bool {
    raw::is_raw_at(path) || is_toml_at(path)
}

/// Whether the file `path` is the TOML of a recording; not where it can't be read or ends otherwise.
fn is_toml_at(path: &Path) -> bool {
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    is_toml && open_file(path).is_ok_and(|file| read_text(file).is_ok_and(|text| is_recording(&text)))
}

/// The file that holds the samples of the recording whose TOML is `path`; `None` where that is no such TOML.
pub fn data_path(path: &Path) -> Option<PathBuf> {
    let text = read_text(open_file(path).ok()?).ok()?;
    let table: toml::Table = text.parse().ok()?;
    let name = table.get("recording")?.get("file")?.as_str()?;
    Some(path.parent().unwrap_or(Path::new("")).join(name))
}

/// Reads a recording: the TOML `path` and what it names beside it, or a raw capture as it is ([`raw::open`]).
///
/// # Errors
/// [`RecordingError`] names the file, the key or the array, and what was expected of it.
pub fn load(path: &Path) -> Result<Recording, RecordingError> {
    if raw::is_raw_at(path) {
        return raw::open(path, None);
    }
    let text = read_text(open_file(path).map_err(|e| Fault::from(e).of(path))?).map_err(|e| e.of(path))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let open = beside(folder);
    let recording = from_parts(&text, path, &open, None)?;
    let origin = frames_of(&text, path, &open)?.map(|frames| Arc::new(of_toml(text, path, frames)));
    Ok(Recording { origin, ..recording })
}

/// Reads the samples that a TOML describes, with their frames.
fn of_toml(toml: String, path: &Path, [frames, frame]: [u64; 2]) -> Origin {
    let offer = Offer { described: "Read as its TOML says".to_owned(), log_odds: 0.0, power: Vec::new(), toml };
    Origin { data: path.to_owned(), offers: vec![offer], frames, frame, ..Origin::default() }
}

#[cfg(test)]
mod tests;
