//! Where a recording that was opened without a text comes from, and what else its bytes could be.

use super::described::{from_parts, loops_of, open_file};
use super::samples::Open;
use super::{Recording, RecordingError};
use crate::radar::Radar;
use crate::signal::ChirpSamples;
use std::io::{BufReader, Cursor};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One way to read a file: a layout of a raw capture, or what the axes of an array count.
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

/// Where a recording comes from that was opened without a TOML.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// The file with the samples.
    pub data: PathBuf,
    /// The `.cfg` that was read, where there is one.
    pub config: Option<PathBuf>,
    /// Ways to read the file, the most likely first.
    pub offers: Vec<Offer>,
    /// Which of them was taken.
    pub taken: usize,
    /// What was found, a sentence each.
    pub sentences: Vec<String>,
    /// What is doubtful whichever way the file is read, a sentence each.
    pub doubts: Vec<String>,
    /// The board whose antennas were taken, where one was.
    pub board: Option<&'static str>,
    /// Whole frames of the file.
    pub frames: u64,
    /// Which of them is looked at, from 0.
    pub frame: u64,
}

/// The line of a text that says which frame is looked at.
pub(super) const FIRST_FRAME: &str = "\nframe = 0\n";

impl Origin {
    /// The text of the way that was taken.
    pub fn toml(&self) -> String {
        let toml = self.offers.get(self.taken).map_or("", |offer| offer.toml.as_str());
        toml.replacen(FIRST_FRAME, &format!("\nframe = {}\n", self.frame), 1)
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
        let folder = self.data.parent().unwrap_or(Path::new("")).to_owned();
        self.read(&|name| Ok(Box::new(BufReader::new(open_file(&folder.join(name))?))))
    }

    /// The same of a frame whose bytes are here in place of the file.
    ///
    /// # Errors
    /// As [`Origin::recording`].
    pub fn recording_of(&self, bytes: &[u8]) -> Result<Recording, RecordingError> {
        let folder = self.data.parent().unwrap_or(Path::new("")).to_owned();
        let own = self.data.file_name().map(|name| name.to_string_lossy().into_owned());
        self.read(&|name| match own.as_deref() == Some(name) {
            true => Ok(Box::new(Cursor::new(bytes.to_vec()))),
            false => Ok(Box::new(BufReader::new(open_file(&folder.join(name))?))),
        })
    }

    /// Every loop of the frame, for a range-Doppler map: the radar with their number and interval, and the samples,
    /// `[loops, elements, samples]`.
    ///
    /// # Errors
    /// As [`Origin::recording`], and where no `.cfg` says the interval of chirps.
    pub fn loops(&self) -> Result<(Radar, ChirpSamples), RecordingError> {
        let folder = self.data.parent().unwrap_or(Path::new("")).to_owned();
        loops_of(&self.toml(), &self.data.with_extension("toml"), &|name| {
            Ok(Box::new(BufReader::new(open_file(&folder.join(name))?)))
        })
    }

    fn read(&self, open: Open<'_>) -> Result<Recording, RecordingError> {
        let mut recording = from_parts(&self.toml(), &self.data.with_extension("toml"), open)?;
        let known = recording.doubts.clone();
        recording.doubts.splice(0..0, self.doubts.iter().filter(|d| !known.contains(d)).cloned());
        recording.origin = Some(Arc::new(self.clone()));
        Ok(recording)
    }
}
