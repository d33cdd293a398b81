//! Reconstruction methods.

use crate::arrays::{ends, owned, rows_of, view};
use crate::errors::named;
use crate::errors::value;
use crate::radar::{Radar, or_default};
use crate::work::{self, Progress};
use apertura::external::{self, CommandLine};
use apertura::maps::Normalisation;
use apertura::reconstruct::{self, NoisePrior, Reconstructor, Request};
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use std::time::Duration;

/// A reconstruction method: the two ends' samples in, an estimate of the whole array's map out.
#[pyclass(module = "apertura", frozen)]
pub struct Method(pub Arc<dyn Reconstructor>);

/// What a method found.
#[pyclass(module = "apertura", frozen)]
pub struct Reconstruction {
    answer: reconstruct::Reconstruction,
    eta: f32,
    radar: apertura::radar::Radar,
}

/// The method called `name`.
///
/// Raises:
///     ValueError: There is none; the message lists those there are.
#[pyfunction]
pub fn method(name: &str) -> PyResult<Method> {
    apertura::methods::by_name(name).map(Method).map_err(|error| {
        let burn = !cfg!(feature = "networks") && ["thesis", "thesis-1", "unet"].contains(&name);
        let how = if burn { "; this one needs a build with the feature \"networks\" (python/README.md)" } else { "" };
        value(format!("{error}{how}"))
    })
}

/// Names of all methods.
#[pyfunction]
pub fn methods() -> Vec<&'static str> {
    apertura::methods::all().iter().map(|m| m.name()).collect()
}

#[pymethods]
impl Method {
    /// A program of one's own as a method: starts the command once, and knows it by the name that it says from then on
    /// (docs/own-network.md).
    ///
    /// Args:
    ///     command: Program and arguments, such as "python my_network.py".
    ///     seconds: How long it may take to start, and for each answer.
    ///
    /// Raises:
    ///     ValueError: The command can't be started or is no method; the message has the end of its standard error.
    #[staticmethod]
    #[pyo3(signature = (command, *, seconds=120.0))]
    fn of_command(py: Python<'_>, command: &str, seconds: f64) -> PyResult<Self> {
        if !(seconds > 0.0 && seconds <= 86_400.0) {
            return Err(value(format!("seconds is {seconds}; expected above 0, to 86400")));
        }
        let line: CommandLine = command.parse().map_err(value)?;
        let started = work::run(py, None, |task| external::start(line, Duration::from_secs_f64(seconds), task))?;
        let method: Arc<dyn Reconstructor> = Arc::new(started.map_err(value)?);
        apertura::methods::add(method.clone()).map_err(value)?;
        Ok(Method(method))
    }

    /// Short name.
    #[getter]
    fn name(&self) -> &'static str {
        self.0.name()
    }

    /// One sentence.
    #[getter]
    fn description(&self) -> &'static str {
        self.0.description()
    }

    /// What it knows beside samples and radar.
    #[getter]
    fn told(&self) -> &'static str {
        self.0.about().told
    }

    /// Threshold of its output, chosen on validation scenes.
    #[getter]
    fn eta(&self) -> f32 {
        self.0.eta()
    }

    /// Estimates the whole array's map from the samples of the two ends.
    ///
    /// Args:
    ///     ends: Complex numbers `[2, end_elements, samples]`, of any gain; they are copied.
    ///     radar: The radar that sampled them; that of table 3.1 where none is given.
    ///     floor: What lies beneath them: "thesis", "exact", "thermal", "snr=DB", "dbm=LEVEL", "white" or "white=SIGMA". SIGMA is the root mean
    ///         square of the noise in a sample; the level of any other white noise the method measures.
    ///     normalisation: How the map is normalised: "min-max" or "db=RANGE".
    ///     snapshot_range_metres: Where the echoes of a single sample come from, if anybody knows.
    ///     progress: Called with the part that is done, 0 to 1.
    ///
    /// Raises:
    ///     ValueError: The shape is not the radar's, a sample is not finite, a name is unknown, or the method can't work on these samples.
    #[pyo3(signature = (ends, radar=None, *, floor="thesis", normalisation="min-max", snapshot_range_metres=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "named in Python")]
    fn reconstruct(
        &self,
        py: Python<'_>,
        ends: &Bound<'_, PyAny>,
        radar: Option<&Radar>,
        floor: &str,
        normalisation: &str,
        snapshot_range_metres: Option<f64>,
        progress: Progress<'_, '_>,
    ) -> PyResult<Reconstruction> {
        let (noise, normalisation): (NoisePrior, Normalisation) = (named(floor)?, named(normalisation)?);
        let radar = or_default(radar);
        let ends = self::ends(ends, &radar)?;
        let method = &self.0;
        let answer = work::run(py, progress, |task| {
            let request =
                Request { noise, normalisation, snapshot_range_metres, task: task.clone(), ..Request::default() };
            method.reconstruct(&radar, &ends, &request)
        })?
        .map_err(value)?;
        let eta = self.0.eta_of(&answer);
        Ok(Reconstruction { answer, eta, radar })
    }

    fn __repr__(&self) -> String {
        format!("<Method {}: {}>", self.0.name(), self.0.description())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (&'static str,))> {
        Ok((py.import("apertura")?.getattr("method")?, (self.0.name(),)))
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

    fn __repr__(&self) -> String {
        format!("<Reconstruction: {} reflectors, eta {}>", self.answer.reflectors.len(), self.eta)
    }
}
