//! The source of a recording that was opened without a text, and other ways to read its bytes.

use super::chain::Open;
use super::described::{Described, FrameLoops, beside};
use super::{Recording, RecordingError};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One way to read a file: a layout of a raw capture, or kinds of an array's axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Offer {
    /// The layout in a sentence's words.
    pub described: String,
    /// Natural logarithm of its odds, up to a constant that all offers of a file share.
    pub log_odds: f64,
    /// Mean power of each range bin, in the square of the file's unit.
    pub power: Vec<f64>,
    /// The TOML of the recording that is read so, to stand in the folder of the data.
    pub toml: String,
}

/// The source of a recording whose file can be read in another way, or of which another frame can be taken.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// The file with the samples, or the TOML that describes them.
    pub data: PathBuf,
    /// The `.cfg` that was read, where there is one.
    pub config: Option<PathBuf>,
    /// Ways to read the file, the most likely first; the TOML alone where there is one.
    pub offers: Vec<Offer>,
    /// Index of the way that was taken, in `offers`.
    pub taken: usize,
    /// The findings on the file, a sentence each.
    pub sentences: Vec<String>,
    /// Doubts that hold for every way to read the file, a sentence each.
    pub doubts: Vec<String>,
    /// The board whose antennas were taken, where one was.
    pub board: Option<&'static str>,
    /// Whole frames of the file.
    pub frames: u64,
    /// Number of the frame that is looked at, from 0.
    pub frame: u64,
}

impl Origin {
    /// The text of the way that was taken.
    pub fn toml(&self) -> &str {
        self.offers.get(self.taken).map_or("", |offer| offer.toml.as_str())
    }

    /// The same file read another way, or another frame of it.
    ///
    /// # Errors
    /// As [`Origin::recording`].
    pub fn with(&self, taken: usize, frame: u64) -> Result<Recording, RecordingError> {
        Origin { taken, frame, ..self.clone() }.recording()
    }

    /// The recording as the text of the way that was taken describes it.
    ///
    /// # Errors
    /// [`RecordingError`] names the file, the key or the array.
    pub fn recording(&self) -> Result<Recording, RecordingError> {
        self.read(&beside(self.folder()))
    }

    /// The recording of a frame whose bytes are given in place of the file.
    ///
    /// # Errors
    /// As [`Origin::recording`].
    pub fn recording_of(&self, bytes: &[u8]) -> Result<Recording, RecordingError> {
        let other = beside(self.folder());
        let own = self.data.file_name().map(|name| name.to_string_lossy().into_owned());
        self.read(&|name| match own.as_deref() == Some(name) {
            true => Ok(Box::new(Cursor::new(bytes.to_vec()))),
            false => other(name),
        })
    }

    /// Every loop of the frame, for a range-Doppler map.
    ///
    /// # Errors
    /// As [`Origin::recording`], and where the file holds no loops.
    pub fn loops(&self) -> Result<FrameLoops, RecordingError> {
        let (path, open) = (self.data.with_extension("toml"), beside(self.folder()));
        Described::by(self.toml(), &path, &open, Some(self.frame))?.loops()
    }

    fn folder(&self) -> &Path {
        self.data.parent().unwrap_or(Path::new(""))
    }

    fn read(&self, open: Open<'_>) -> Result<Recording, RecordingError> {
        let path = self.data.with_extension("toml");
        let mut recording = Described::by(self.toml(), &path, open, Some(self.frame))?.recording()?;
        let known = recording.doubts.clone();
        recording.doubts.splice(0..0, self.doubts.iter().filter(|d| !known.contains(d)).cloned());
        recording.origin = Some(Arc::new(self.clone()));
        Ok(recording)
    }
}
