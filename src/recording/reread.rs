//! Recordings read again: by another of the texts that describe a file, or from another frame.

use super::described::{FrameLoops, beside, from_parts, loops_of};
use super::samples::Open;
use super::{Origin, Recording, RecordingError};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

impl Origin {
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
        loops_of(self.toml(), &self.data.with_extension("toml"), &beside(self.folder()), Some(self.frame))
    }

    fn folder(&self) -> &Path {
        self.data.parent().unwrap_or(Path::new(""))
    }

    fn read(&self, open: Open<'_>) -> Result<Recording, RecordingError> {
        let mut recording = from_parts(self.toml(), &self.data.with_extension("toml"), open, Some(self.frame))?;
        let known = recording.doubts.clone();
        recording.doubts.splice(0..0, self.doubts.iter().filter(|d| !known.contains(d)).cloned());
        recording.origin = Some(Arc::new(self.clone()));
        Ok(recording)
    }
}
