//! The TOML of a recording; `docs/recordings.md` has its keys.

use super::raw;
use super::recording_text::{RecordingText, open_file, open_in, read_text};
use super::{Fault, Origin, ReadingOption, Recording, RecordingError};
use crate::files::ends_in;
use std::path::Path;
use std::sync::Arc;

pub use super::recording_text::data_path;

/// Whether `text` is the TOML of a recording: it has a table `[recording]`.
pub fn is_recording(text: &str) -> bool {
    toml::de::DeTable::parse(text).is_ok_and(|table| table.get_ref().contains_key("recording"))
}

/// Whether the file `path` is a recording: the TOML of one, a raw capture, an array, or the `.cfg` of one.
pub fn is_recording_at(path: &Path) -> bool {
    raw::is_raw_at(path) || is_toml_at(path)
}

/// Whether the file `path` is the TOML of a recording; false where it can't be read.
fn is_toml_at(path: &Path) -> bool {
    ends_in(path, &["toml"]) && open_file(path).is_ok_and(|file| read_text(file).is_ok_and(|text| is_recording(&text)))
}

/// Reads a recording: the TOML `path` with the files that it names, or a raw capture ([`raw::open`]).
/// # Errors
/// [`RecordingError`] names the file, the key or the array, and what was expected of it.
pub fn load(path: &Path) -> Result<Recording, RecordingError> {
    if raw::is_raw_at(path) {
        return raw::open(path, None);
    }
    let text = read_text(open_file(path).map_err(|e| Fault::from(e).of(path))?).map_err(|e| e.of(path))?;
    let open = open_in(path.parent().unwrap_or(Path::new("")));
    let parsed = RecordingText::parse(&text, path, &open, None)?;
    let recording = parsed.recording()?;
    let origin = parsed.frames()?.map(|[frames, frame]| {
        let description = "Read as its TOML says".to_owned();
        let offer = ReadingOption { description, log_odds: 0.0, power: Vec::new(), toml: text.clone() };
        Arc::new(Origin { data: path.to_owned(), offers: vec![offer], frames, frame, ..Origin::default() })
    });
    Ok(Recording { origin, ..recording })
}

#[cfg(test)]
mod tests;
