//! Errors of recordings, with the file they are in.

use super::layout::LayoutError;
use super::{AxesError, CalibrationError, CaptureError, MatError, NumpyError, ProfileError};
use crate::files::hdf5::Hdf5Error;
use crate::radar::RadarError;
use crate::scene::file::SceneTextError;
use std::io;
use std::path::{Path, PathBuf};

/// An error of reading a recording, with its file.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct RecordingError {
    /// The file.
    pub path: PathBuf,
    /// The fault.
    pub fault: Fault,
}

/// A fault in one of a recording's files.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The system could not read it.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The TOML can't be understood.
    #[error("{0}")]
    Text(#[from] SceneTextError),
    /// A key has a value that can't be used, or is missing.
    #[error("{key} {found}; expected {expected}")]
    Key {
        /// The key.
        key: String,
        /// The value found, or that the key is missing.
        found: String,
        /// The values allowed.
        expected: String,
    },
    /// The radar is invalid.
    #[error("{0}")]
    Radar(#[from] RadarError),
    /// The array can't be read.
    #[error("{0}")]
    Numpy(#[from] NumpyError),
    /// The array can't be read.
    #[error("{0}")]
    Mat(#[from] MatError),
    /// The array can't be read.
    #[error("{0}")]
    Hdf5(#[from] Hdf5Error),
    /// The capture can't be read.
    #[error("{0}")]
    Capture(#[from] CaptureError),
    /// The `.cfg` can't be read.
    #[error("{0}")]
    Profile(#[from] ProfileError),
    /// No layout of the capture was found.
    #[error("{0}")]
    Layout(#[from] LayoutError),
    /// The array is not what its axes say.
    #[error("{0}")]
    Axes(#[from] AxesError),
    /// The calibration fits no array.
    #[error("{0}")]
    Calibration(#[from] CalibrationError),
    /// Elements or samples are not as many as the radar's.
    #[error("holds {found} {what}; expected {expected} (it is read as {} elements by {} samples)", .shape.0, .shape.1)]
    Count {
        /// "elements" or "samples".
        what: &'static str,
        /// Their number in the array.
        found: usize,
        /// The number expected, and its reason.
        expected: String,
        /// Elements and samples that the axes make of the array.
        shape: (usize, usize),
    },
    /// A sample is NaN or infinite.
    #[error("sample {sample} of element {element} is not finite; expected finite numbers only")]
    NotFinite {
        /// Element of the file.
        element: usize,
        /// Sample of the chirp.
        sample: usize,
    },
}

impl Fault {
    /// A key that can't be used.
    pub(super) fn key(key: &str, found: impl Into<String>, expected: impl Into<String>) -> Fault {
        Fault::Key { key: key.to_owned(), found: found.into(), expected: expected.into() }
    }

    /// The error about the file `path`.
    pub(super) fn of(self, path: &Path) -> RecordingError {
        RecordingError { path: path.to_owned(), fault: self }
    }
}
