//! Recordings: samples that a radar measured.

use crate::arrays::{self, both_ends, owned, view};
use crate::errors;
use crate::errors::named;
use crate::maps::Maps;
use crate::radar::Radar;
use apertura::radar::BuiltArray;
use apertura::reconstruct::NoisePrior;
use apertura::recording::presets::{ALL, Preset};
use apertura::recording::{self, Recorded, file::load};
use apertura::signal::BeatSignal;
use num_complex::Complex64;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Samples that a radar measured, with the radar.
#[pyclass(module = "apertura", frozen)]
pub struct Recording(recording::Recording);

#[pymethods]
impl Recording {
    /// Reads a recording's TOML and the samples beside it (docs/recordings.md says what they may be).
    ///
    /// Raises:
    ///     OSError: A file can't be read.
    ///     ValueError: A file is not what it should be; the message names file, key and what was expected.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        load(&path).map(Recording).map_err(errors::recording)
    }

    /// Opens a raw capture or an array as it is, its layout found by evidence, or reads a recording's TOML. `doubts` say what is taken for granted.
    ///
    /// Args:
    ///     path: The capture (.bin, .dat, .raw), an array (.npy, .npz, .mat), its .cfg, or a recording's TOML.
    ///     config: The .cfg of a capture; the one of the same name beside it, or the only one there, where none is given.
    ///
    /// Raises:
    ///     OSError: A file can't be read.
    ///     ValueError: A file is not what it should be; the message names it and what would help.
    #[staticmethod]
    #[pyo3(signature = (path, config=None))]
    fn open(path: PathBuf, config: Option<PathBuf>) -> PyResult<Self> {
        if config.is_some() && !recording::raw::is_raw_at(&path) {
            return Err(errors::value(
                "config is the .cfg of a raw capture; expected one (.bin, .dat, .raw) or an array as path",
            ));
        }
        let opened = match config {
            Some(config) => recording::raw::open(&path, Some(&config)),
            None => load(&path),
        };
        opened.map(Recording).map_err(errors::recording)
    }

    /// A recording that comes with the library.
    ///
    /// Raises:
    ///     ValueError: There is none of this name.
    #[staticmethod]
    fn preset(name: &str) -> PyResult<Self> {
        let known = || Recording::presets().join(", ");
        let unknown = || errors::value(format!("no recording is called \"{name}\"; expected {}", known()));
        Preset::by_id(name).ok_or_else(unknown)?.load().map(Recording).map_err(errors::recording)
    }

    /// Names of the recordings that come with the library.
    #[staticmethod]
    fn presets() -> Vec<&'static str> {
        ALL.iter().map(|p| p.id).collect()
    }

    /// The recording's name.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// The recording's source, and hints on its echoes.
    #[getter]
    fn notes(&self) -> &str {
        &self.0.notes
    }

    /// The radar that measured it.
    #[getter]
    fn radar(&self) -> Radar {
        Radar(self.0.radar.clone())
    }

    /// Samples of all elements, complex128 `[elements, samples]`, a read-only view; None where the two ends alone were recorded.
    #[getter]
    fn samples<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<Complex64>>>> {
        // SAFETY: a frozen object's samples neither move nor change.
        slf.get().0.signal().map(|s| unsafe { view(&s.samples, slf.clone().into_any()) }).transpose()
    }

    /// Samples of the two ends, complex128 `[2, end_elements, samples]`. A copy.
    #[getter]
    fn ends<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<Complex64>> {
        owned(py, both_ends(&self.0.two_ends()))
    }

    /// Elements that measured nothing.
    #[getter]
    fn missing(&self) -> Vec<usize> {
        self.0.missing.clone()
    }

    /// Range of everything in a snapshot in metres, or None.
    #[getter]
    fn range_metres(&self) -> Option<f64> {
        self.0.range_metres
    }

    /// Doubts that the samples can't settle, a sentence each.
    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.0.doubts.clone()
    }

    /// The noise that methods take the recording's for: white. They measure its level themselves.
    #[getter]
    fn floor(&self) -> String {
        NoisePrior::UNKNOWN.to_string()
    }

    /// Maps of the samples of all elements.
    ///
    /// Raises:
    ///     ValueError: The two ends alone were recorded, or the name is unknown.
    #[pyo3(signature = (*, normalisation="db=60"))]
    fn maps(&self, normalisation: &str) -> PyResult<Maps> {
        let normalisation = named(normalisation)?;
        let signal = self.0.signal().ok_or_else(|| errors::value("the two ends alone were recorded; use ends"))?;
        Ok(Maps::new(self.0.radar.clone(), BuiltArray::default(), signal.clone(), normalisation))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        let (py, own) = (slf.py(), slf.get());
        let fields = PyDict::new(py);
        fields.set_item("name", own.name())?;
        fields.set_item("notes", own.notes())?;
        fields.set_item("radar", own.radar())?;
        fields.set_item("samples", own.0.signal().map(|signal| owned(py, signal.samples.clone())))?;
        fields.set_item("ends", own.ends(py))?;
        fields.set_item("missing", own.missing())?;
        fields.set_item("range_metres", own.range_metres())?;
        fields.set_item("doubts", own.doubts())?;
        Ok((py.import("apertura._pickle")?.getattr("recording")?, (fields,)))
    }

    fn __repr__(&self) -> String {
        let radar = &self.0.radar;
        format!("<Recording {:?}: {} elements by {} samples>", self.0.name, radar.elements, radar.samples)
    }
}

/// A recording from its pickled fields.
#[pyfunction]
#[pyo3(name = "_recording", signature = (name, notes, radar, samples, ends, missing, range_metres, doubts))]
#[expect(clippy::too_many_arguments, reason = "one a field")]
pub fn pickled(
    name: String,
    notes: String,
    radar: &Radar,
    samples: Option<&Bound<'_, PyAny>>,
    ends: &Bound<'_, PyAny>,
    missing: Vec<usize>,
    range_metres: Option<f64>,
    doubts: Vec<String>,
) -> PyResult<Recording> {
    let radar = radar.0.clone();
    let samples = match samples {
        Some(samples) => {
            let samples = arrays::samples(samples, "samples", [radar.elements, radar.samples])?;
            Recorded::All(BeatSignal { samples })
        }
        None => Recorded::Ends(arrays::ends(ends, &radar)?),
    };
    Ok(Recording(recording::Recording { name, notes, radar, samples, missing, range_metres, doubts, origin: None }))
}
