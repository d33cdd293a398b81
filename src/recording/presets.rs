//! Recordings that come with the program: the files of `assets/recordings`, embedded in it.

use super::chain::Open;
use super::recording_text::RecordingText;
use super::{Recording, RecordingError};
use std::io::{self, Cursor};
use std::path::Path;

/// A recording that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Name of its file in `assets/recordings`, without `.toml`.
    pub id: &'static str,
    /// The file's text.
    pub toml: &'static str,
    /// Name of the file with the samples.
    pub data_name: &'static str,
    /// The samples, as that file has them.
    pub data: &'static [u8],
    /// The notice required by its licence.
    pub licence: &'static str,
}

macro_rules! preset {
    ($id:literal, $data:literal) => {
        Preset {
            id: $id,
            toml: include_str!(concat!("../../assets/recordings/", $id, ".toml")),
            data_name: $data,
            data: include_bytes!(concat!("../../assets/recordings/", $data)),
            licence: include_str!(concat!("../../assets/recordings/", $id, ".LICENSE")),
        }
    };
}

/// Every recording, in the order they are listed.
pub const ALL: &[Preset] = &[preset!("cascade-86", "cascade-86.mat"), preset!("chip-8", "chip-8.npz")];

impl Preset {
    /// The recording.
    /// # Errors
    /// None for the presets of [`ALL`]: a test reads each of them.
    pub fn load(&self) -> Result<Recording, RecordingError> {
        let path = format!("{}.toml", self.id);
        let open: Open<'_> = &|name| {
            if name == self.data_name {
                Ok(Box::new(Cursor::new(self.data)))
            } else {
                Err(io::Error::new(io::ErrorKind::NotFound, format!("expected {}", self.data_name)))
            }
        };
        RecordingText::parse(self.toml, Path::new(&path), open, None)?.recording()
    }

    /// The preset called `id`.
    pub fn by_id(id: &str) -> Option<&'static Preset> {
        ALL.iter().find(|p| p.id == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_names_its_source() {
        for preset in ALL {
            let recording = preset.load().unwrap_or_else(|e| panic!("{e}"));
            assert!(!recording.name.is_empty() && recording.notes.len() > 80, "{}", preset.id);
            assert!(recording.notes.contains("licence"), "{}: notes name the licence", preset.id);
            assert!(preset.licence.contains("Copyright"), "{}", preset.id);
            assert!(recording.signal().is_some(), "{}: all elements", preset.id);
        }
    }

    #[test]
    fn every_file_is_listed() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/recordings");
        let tomls = std::fs::read_dir(folder)
            .unwrap()
            .filter(|e| e.as_ref().unwrap().path().extension().is_some_and(|e| e == "toml"));
        assert_eq!(tomls.count(), ALL.len(), "recordings in {folder}");
    }
}
