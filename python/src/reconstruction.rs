//! Answers of methods.

use crate::arrays::{numbers, owned, reflectors, rows_of, view};
use crate::errors::value;
use crate::radar::Radar;
use apertura::maps::RangeAngleMap;
use apertura::reconstruct;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A method's answer.
#[pyclass(module = "apertura", frozen)]
pub struct Reconstruction {
    answer: reconstruct::Reconstruction,
    eta: f32,
    radar: apertura::radar::Radar,
}

impl Reconstruction {
    pub fn new(answer: reconstruct::Reconstruction, eta: f32, radar: apertura::radar::Radar) -> Self {
        Reconstruction { answer, eta, radar }
    }
}

#[pymethods]
impl Reconstruction {
    /// Estimate of the whole array's Lambda, float32 `[samples, elements]`, a read-only view of this object.
    #[getter]
    fn map<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        // SAFETY: a frozen object's map neither moves nor changes.
        unsafe { view(&slf.get().answer.lambda.lambda, slf.clone().into_any()) }
    }

    /// The threshold for this answer: the method's own, or one that it read off the samples.
    #[getter]
    fn eta(&self) -> f32 {
        self.eta
    }

    /// How far off the method expects its map to be, float32 `[samples, elements]`: nine of ten cells are no farther than this from the true
    /// Lambda, on scenes and over noise like those it was trained on. `None` where the method does not say; a copy.
    #[getter]
    fn doubt<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f32>>> {
        self.answer.doubt.as_ref().map(|map| owned(py, map.lambda.clone()))
    }

    /// The reflectors it believes in, float64 `[reflectors, 3]`: x and y in metres, reflectivity. Empty where the method draws maps only.
    ///
    /// A reflectivity's sign is a guess where noise leaves the range uncertain by half a turn of the echo's phase: half a wavelength where the
    /// way counts once, a quarter where it counts twice. The sum of all is positive by convention.
    #[getter]
    fn reflectors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        owned(py, rows_of(&self.answer.reflectors))
    }

    /// How far each reflector is needed, float64 `[reflectors]`, 0 to 1; empty where the method does not say.
    #[getter]
    fn confidences<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        owned(py, Array1::from(self.answer.confidences.clone()))
    }

    /// The reflectors as the array's centre hears them, the strongest first, float64 `[reflectors, 4]`: cos(theta), range in metres, power
    /// in dB below the strongest, confidence (NaN where the method does not say).
    #[getter]
    fn detections<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let found = self.answer.detections(&self.radar);
        let rows = Array2::from_shape_fn((found.len(), 4), |(i, j)| {
            let d = &found[i];
            [d.cos_theta, d.range_metres, d.relative_power.0, d.confidence.unwrap_or(f64::NAN)][j]
        });
        owned(py, rows)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        let fields = PyDict::new(py);
        fields.set_item("map", owned(py, self.answer.lambda.lambda.clone()))?;
        fields.set_item("eta", self.eta)?;
        fields.set_item("doubt", self.doubt(py))?;
        fields.set_item("reflectors", self.reflectors(py))?;
        fields.set_item("confidences", self.confidences(py))?;
        fields.set_item("radar", Radar(self.radar.clone()))?;
        Ok((py.import("apertura._apertura")?.getattr("_reconstruction")?, (fields,)))
    }

    fn __repr__(&self) -> String {
        format!("<Reconstruction: {} reflectors, eta {}>", self.answer.reflectors.len(), self.eta)
    }
}

/// A reconstruction from its pickled fields.
#[pyfunction]
#[pyo3(name = "_reconstruction")]
pub fn reconstruction(fields: &Bound<'_, PyDict>) -> PyResult<Reconstruction> {
    let given =
        |key: &str| fields.get_item(key)?.ok_or_else(|| value(format!("a pickled reconstruction has no \"{key}\"")));
    let radar = given("radar")?.extract::<PyRef<'_, Radar>>()?.0.clone();
    let map = |any: &Bound<'_, PyAny>, what: &str| -> PyResult<RangeAngleMap> {
        let lambda: Array2<f32> = numbers(any, what, "[samples, elements]")?;
        if lambda.dim() != (radar.samples, radar.elements) {
            return Err(value(format!("{what}: its shape is {:?}, which the radar has not", lambda.shape())));
        }
        Ok(RangeAngleMap { lambda })
    };
    let doubt = given("doubt")?;
    let confidences: Array1<f64> = numbers(&given("confidences")?, "confidences", "[reflectors]")?;
    let eta: f32 = given("eta")?.extract()?;
    let answer = reconstruct::Reconstruction {
        lambda: map(&given("map")?, "map")?,
        reflectors: reflectors(&given("reflectors")?, "reflectors")?,
        confidences: confidences.to_vec(),
        eta: Some(eta),
        doubt: if doubt.is_none() { None } else { Some(map(&doubt, "doubt")?) },
        ..reconstruct::Reconstruction::silence(&radar)
    };
    Ok(Reconstruction { answer, eta, radar })
}
