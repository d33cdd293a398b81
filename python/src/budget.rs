//! The link budget of a radar.

use crate::errors::value;
use apertura::radar;
use apertura::radar::budget;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

/// Figures of the radar equation beside the radar's other constants. A point of reflectivity g has a radar cross section of g^2 square metres.
///
/// Args:
///     transmit_power_dbm: Power that a transmitter sends, in dBm.
///     antenna_gain_dbi: Gain of an element straight ahead in dBi, for sending and for hearing.
///     noise_figure_db: Noise figure of a receiver in dB.
///     half_power_width_degrees: Width of an element's pattern in degrees; None for isotropic elements. It changes the samples.
///
/// Raises:
///     ValueError: A number is out of range.
#[pyclass(module = "apertura", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct LinkBudget(pub radar::LinkBudget);

/// A budget, or a dict of its fields.
pub fn budget_of(any: &Bound<'_, PyAny>) -> PyResult<radar::LinkBudget> {
    if let Ok(budget) = any.cast::<LinkBudget>() {
        return Ok(budget.get().0);
    }
    let fields = any.cast::<PyDict>().map_err(|_| value("budget is neither a LinkBudget nor a dict of its fields"))?;
    let made = PyType::new::<LinkBudget>(any.py()).call((), Some(fields))?;
    Ok(made.cast::<LinkBudget>()?.get().0)
}

/// The figures of `Radar.link` by their names, decibels.
pub fn link_figures<'py>(
    radar: &radar::Radar,
    py: Python<'py>,
    range_metres: f64,
    cross_section_dbsm: f64,
    angle_degrees: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let are_finite = range_metres.is_finite() && cross_section_dbsm.is_finite() && angle_degrees.is_finite();
    if !(are_finite && range_metres > 0.0) {
        let said = format!(
            "range_metres is {range_metres}, cross_section_dbsm {cross_section_dbsm}, angle_degrees {angle_degrees}"
        );
        return Err(value(format!("{said}; expected finite numbers and a range above 0")));
    }
    let link = radar.link(cross_section_dbsm, range_metres, angle_degrees.to_radians().cos());
    let figures = PyDict::new(py);
    for (key, decibels) in [
        ("received_dbm", link.received.0),
        ("noise_dbm", link.noise.0),
        ("sample_snr_db", link.sample.0),
        ("range_snr_db", link.range.0),
        ("end_snr_db", link.end.0),
        ("array_snr_db", link.array.0),
    ] {
        figures.set_item(key, decibels)?;
    }
    Ok(figures)
}

#[pymethods]
impl LinkBudget {
    #[new]
    #[pyo3(signature = (transmit_power_dbm=None, antenna_gain_dbi=None, noise_figure_db=None, half_power_width_degrees=None))]
    fn new(
        transmit_power_dbm: Option<f64>,
        antenna_gain_dbi: Option<f64>,
        noise_figure_db: Option<f64>,
        half_power_width_degrees: Option<f64>,
    ) -> PyResult<Self> {
        let usual = radar::LinkBudget::default();
        let budget = radar::LinkBudget {
            transmit_power_dbm: transmit_power_dbm.unwrap_or(usual.transmit_power_dbm),
            antenna_gain_dbi: antenna_gain_dbi.unwrap_or(usual.antenna_gain_dbi),
            noise_figure_db: noise_figure_db.unwrap_or(usual.noise_figure_db),
            half_power_width_degrees,
        };
        budget.validate().map_err(value)?;
        Ok(LinkBudget(budget))
    }

    /// Reflectivity of a point of this radar cross section, in decibels over a square metre.
    #[staticmethod]
    fn reflectivity_of(cross_section_dbsm: f64) -> f64 {
        budget::reflectivity_of(cross_section_dbsm)
    }

    /// Power that a transmitter sends, in dBm.
    #[getter]
    fn transmit_power_dbm(&self) -> f64 {
        self.0.transmit_power_dbm
    }

    /// Gain of an element straight ahead in dBi.
    #[getter]
    fn antenna_gain_dbi(&self) -> f64 {
        self.0.antenna_gain_dbi
    }

    /// Noise figure of a receiver in dB.
    #[getter]
    fn noise_figure_db(&self) -> f64 {
        self.0.noise_figure_db
    }

    /// Width of an element's pattern in degrees; None for isotropic elements.
    #[getter]
    fn half_power_width_degrees(&self) -> Option<f64> {
        self.0.half_power_width_degrees
    }

    fn __repr__(&self) -> String {
        let radar::LinkBudget { transmit_power_dbm, antenna_gain_dbi, noise_figure_db, half_power_width_degrees } =
            self.0;
        let width = half_power_width_degrees.map_or("None".to_owned(), |width| format!("{width:?}"));
        format!(
            "LinkBudget(transmit_power_dbm={transmit_power_dbm:?}, antenna_gain_dbi={antenna_gain_dbi:?}, \
             noise_figure_db={noise_figure_db:?}, half_power_width_degrees={width})"
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, (f64, f64, f64, Option<f64>)) {
        let own = self.0;
        let levels = (own.transmit_power_dbm, own.antenna_gain_dbi, own.noise_figure_db, own.half_power_width_degrees);
        (PyType::new::<LinkBudget>(py), levels)
    }
}
