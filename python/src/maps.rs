//! Samples and the maps made of them.

use crate::arrays::{self, both_ends, owned, stacked, view};
use crate::errors::{named, value};
use crate::objects::{self, of_elements};
use crate::radar::{Radar, or_default};
use crate::work;
use apertura::maps::focus::map_of;
use apertura::maps::{Aperture, LogMap, Normalisation, RangeAngleMap};
use apertura::radar::{self, BuiltArray, End};
use apertura::signal::BeatSignal;
use num_complex::Complex64;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::OnceLock;

/// The samples of a radar's elements, and the range-angle maps made of them. A map is computed when it is first asked for.
///
/// Arrays are read-only views of what this object holds, which they keep alive. Row k of a map is range `radar.range_metres[k]`, column k is
/// the direction `radar.cos_theta[k]`; `target[:, radar.rising_columns]` has left on the left in any convention.
#[pyclass(module = "apertura", frozen)]
pub struct Maps {
    radar: radar::Radar,
    normalisation: Normalisation,
    /// Places and errors of the elements that heard the samples.
    elements: BuiltArray,
    signal: BeatSignal,
    full: OnceLock<LogMap>,
    target: OnceLock<RangeAngleMap>,
}

impl Maps {
    pub fn new(radar: radar::Radar, elements: BuiltArray, signal: BeatSignal, normalisation: Normalisation) -> Self {
        Maps { radar, normalisation, elements, signal, full: OnceLock::new(), target: OnceLock::new() }
    }

    /// The whole array's map. Two threads that ask at once may both compute it: a lock held across the computation could hold the interpreter up.
    fn full(&self, py: Python<'_>) -> PyResult<&LogMap> {
        if let Some(full) = self.full.get() {
            return Ok(full);
        }
        let (radar, elements, signal) = (&self.radar, &self.elements, &self.signal);
        let full = work::run(py, None, |_| map_of(radar, elements, signal, Aperture::Full).log_magnitude())?;
        Ok(self.full.get_or_init(|| full))
    }
}

#[pymethods]
impl Maps {
    /// The radar.
    #[getter]
    fn radar(&self) -> Radar {
        Radar(self.radar.clone())
    }

    /// Normalisation of decades to Lambda in `target` and `inputs`.
    #[getter]
    fn normalisation(&self) -> String {
        self.normalisation.to_string()
    }

    /// Samples of all elements, complex128 `[elements, samples]`.
    #[getter]
    fn samples<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        // SAFETY: a frozen object's samples neither move nor change.
        unsafe { view(&slf.get().signal.samples, slf.clone().into_any()) }
    }

    /// Samples of the first and the last elements, complex128 `[2, end_elements, samples]`: what a method gets. A copy.
    #[getter]
    fn ends<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<Complex64>> {
        owned(py, both_ends(&self.signal.two_ends(&self.radar)))
    }

    /// Decades of amplitude of the whole array's map, float64 `[samples, elements]`, not normalised.
    #[getter]
    fn decades<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let full = slf.get().full(slf.py())?;
        // SAFETY: a frozen object's map, once there, neither moves nor changes.
        unsafe { view(full.decades(), slf.clone().into_any()) }
    }

    /// Lambda of the whole array's map, float32 `[samples, elements]`, every cell in [0, 1]: what a method should draw.
    #[getter]
    fn target<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let own = slf.get();
        let full = own.full(slf.py())?;
        let target = own.target.get_or_init(|| full.normalise(own.normalisation));
        // SAFETY: as above.
        unsafe { view(&target.lambda, slf.clone().into_any()) }
    }

    /// The whole array's map itself, complex128 `[samples, elements]`: `decades` is log10 of its magnitude, with a guard far below its noise. Computed
    /// anew each time.
    #[getter]
    fn complex<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let (radar, elements, signal) = (&self.radar, &self.elements, &self.signal);
        Ok(owned(py, work::run(py, None, |_| map_of(radar, elements, signal, Aperture::Full).cells)?))
    }

    /// Lambda of each end's own map, float32 `[2, samples, elements]`. Computed anew each time.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let (radar, normalisation) = (&self.radar, self.normalisation);
        let (elements, signal) = (&self.elements, &self.signal);
        let [first, last] = work::run(py, None, |_| {
            let map = |end| map_of(radar, elements, signal, Aperture::End(end)).log_magnitude();
            End::BOTH.map(|end| map(end).normalise(normalisation).lambda)
        })?;
        Ok(owned(py, stacked([&first, &last])))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        let fields = PyDict::new(py);
        fields.set_item("samples", owned(py, self.signal.samples.clone()))?;
        fields.set_item("radar", Radar(self.radar.clone()))?;
        fields.set_item("normalisation", self.normalisation.to_string())?;
        let elements = (!self.elements.is_ideal()).then(|| of_elements(py, &self.elements)).transpose()?;
        fields.set_item("elements", elements)?;
        Ok((py.import("apertura._pickle")?.getattr("maps")?, (fields,)))
    }

    fn __repr__(&self) -> String {
        format!("<Maps of {} elements by {} samples>", self.radar.elements, self.radar.samples)
    }
}

/// Maps of samples that come from elsewhere.
///
/// Args:
///     samples: Complex numbers `[elements, samples]`; they are copied.
///     radar: The radar that sampled them; that of table 3.1 where none is given.
///     normalisation: "min-max" or "db=RANGE".
///
/// Raises:
///     ValueError: The shape is not the radar's, a sample is not finite, or a name is unknown.
#[pyfunction]
#[pyo3(signature = (samples, radar=None, *, normalisation="min-max"))]
pub fn maps(samples: &Bound<'_, PyAny>, radar: Option<&Radar>, normalisation: &str) -> PyResult<Maps> {
    let radar = or_default(radar);
    let samples = arrays::samples(samples, "samples", [radar.elements, radar.samples])?;
    if let Some(((element, sample), _)) = samples.indexed_iter().find(|(_, v)| !(v.re.is_finite() && v.im.is_finite()))
    {
        return Err(value(format!("sample {sample} of element {element} is not finite")));
    }
    Ok(Maps::new(radar, BuiltArray::default(), BeatSignal { samples }, named(normalisation)?))
}

/// Maps from their pickled fields.
#[pyfunction]
#[pyo3(name = "_maps", signature = (samples, radar, normalisation, elements=None))]
pub fn pickled(
    samples: &Bound<'_, PyAny>,
    radar: &Radar,
    normalisation: &str,
    elements: Option<&Bound<'_, PyAny>>,
) -> PyResult<Maps> {
    let made = maps(samples, Some(radar), normalisation)?;
    let elements = elements.map(objects::elements).transpose()?.unwrap_or_default();
    Ok(Maps { elements, ..made })
}
