//! The library's errors as Python's, with the same words.

use apertura::files::npz::NpzError;
use apertura::recording::{Fault, RecordingError};
use apertura::scene::file::SceneFileError;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyPermissionError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::io;
use std::path::Path;
use std::str::FromStr;

/// A ValueError with the text of `error`.
pub fn value(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The value that a name stands for, read with `FromStr`.
pub fn named<T: FromStr<Err: Display>>(name: &str) -> PyResult<T> {
    name.parse().map_err(value)
}

/// A RuntimeError: a fault of the library itself.
pub fn runtime(error: impl Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

/// The system could not read or write a file; `words` are the whole message.
pub fn system(source: &io::Error, words: impl Display) -> PyErr {
    let words = words.to_string();
    match source.kind() {
        io::ErrorKind::NotFound => PyFileNotFoundError::new_err(words),
        io::ErrorKind::PermissionDenied => PyPermissionError::new_err(words),
        _ => PyOSError::new_err(words),
    }
}

/// The error of the file at `path` that the system could not read or write.
pub fn at(path: &Path) -> impl Fn(io::Error) -> PyErr {
    move |error| system(&error, format!("{}: {error}", path.display()))
}

pub fn scene_file(error: SceneFileError) -> PyErr {
    match &error {
        SceneFileError::Io { source, .. } | SceneFileError::Archive { source: NpzError::Io(source), .. } => {
            system(source, &error)
        }
        _ => value(error),
    }
}

pub fn recording(error: RecordingError) -> PyErr {
    match &error.fault {
        Fault::Io(source) => system(source, &error),
        _ => value(error),
    }
}

/// An argument of the wrong type: both a TypeError and a ValueError.
pub fn argument(py: Python<'_>, message: String) -> PyErr {
    let made = py.import("apertura.objects").and_then(|m| m.getattr("ArgumentError")?.call1((message,)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// A whole number from 0 to the largest of the unsigned type `T`, as the argument of this name.
pub fn whole<T: TryFrom<i128>>(name: &str, number: i128) -> PyResult<T> {
    let most = u64::MAX >> (64 - 8 * size_of::<T>());
    T::try_from(number).map_err(|_| value(format!("{name} is {number}; expected a whole number from 0 to {most}")))
}
