//! The file of a recording, its frames, and other ways to read it.

use super::chain::Open;
use super::recording_text::{FrameLoops, RecordingText, open_in};
use super::{Recording, RecordingError};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One way to read a file: a layout of a raw capture, or kinds of an array's axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadingOption {
    /// The layout or the axes, as a part of a sentence.
    pub description: String,
    /// Natural logarithm of its odds, up to a constant that is the same for all offers of a file.
    pub log_odds: f64,
    /// Mean power of each range bin, in the square of the file's unit.
    pub power: Vec<f64>,
    /// The TOML of the recording read this way, for the folder of the data.
    pub toml: String,
}

/// The file of a recording that can be read in other ways, or that has other frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// The file with the samples, or the TOML that describes them.
    pub data: PathBuf,
    /// The `.cfg` that was read.
    pub config: Option<PathBuf>,
    /// Ways to read the file, the most likely first; the only one where the file has a TOML.
    pub offers: Vec<ReadingOption>,
    /// Index in `offers` of the way that is used.
    pub taken: usize,
    /// Findings on the file, a sentence each.
    pub sentences: Vec<String>,
    /// Doubts that hold for every way to read the file, a sentence each.
    pub doubts: Vec<String>,
    /// Name of the board whose antennas are used.
    pub board: Option<&'static str>,
    /// Number of whole frames in the file.
    pub frames: u64,
    /// Index of the frame that is read.
    pub frame: u64,
}

impl Origin {
    /// The TOML of the way that is used; empty without offers.
    pub fn toml(&self) -> &str {
        self.offers.get(self.taken).map_or("", |offer| offer.toml.as_str())
    }

    /// The same file read another way, or another frame of it.
    /// # Errors
    /// As [`Origin::recording`].
    pub fn with(&self, taken: usize, frame: u64) -> Result<Recording, RecordingError> {
        Origin { taken, frame, ..self.clone() }.recording()
    }

    /// Reads the recording the way that is used.
    /// # Errors
    /// [`RecordingError`] names the file, the key or the array.
    pub fn recording(&self) -> Result<Recording, RecordingError> {
        self.read(&open_in(self.folder()))
    }

    /// The recording of a frame, with `bytes` in place of the file's.
    /// # Errors
    /// As [`Origin::recording`].
    pub fn recording_of(&self, bytes: &[u8]) -> Result<Recording, RecordingError> {
        let open_other = open_in(self.folder());
        let own = self.data.file_name().map(|name| name.to_string_lossy().into_owned());
        self.read(&|name| match own.as_deref() == Some(name) {
            true => Ok(Box::new(Cursor::new(bytes.to_vec()))),
            false => open_other(name),
        })
    }

    /// Every loop of the frame, for a range-Doppler map.
    /// # Errors
    /// As [`Origin::recording`], and where the file holds no loops.
    pub fn loops(&self) -> Result<FrameLoops, RecordingError> {
        let open = open_in(self.folder());
        RecordingText::parse(self.toml(), &self.data, &open, Some(self.frame))?.loops()
    }

    fn folder(&self) -> &Path {
        self.data.parent().unwrap_or(Path::new(""))
    }

    fn read(&self, open: Open<'_>) -> Result<Recording, RecordingError> {
        let mut recording = RecordingText::parse(self.toml(), &self.data, open, Some(self.frame))?.recording()?;
        let own_doubts = recording.doubts.clone();
        recording.doubts.splice(0..0, self.doubts.iter().filter(|d| !own_doubts.contains(d)).cloned());
        recording.origin = Some(Arc::new(self.clone()));
        Ok(recording)
    }
}
