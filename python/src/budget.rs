//! The link budget of a radar.

use crate::errors::value;
use apertura::radar;
use apertura::radar::budget;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

/// What the radar equation needs beside the radar's other constants. A point of reflectivity g has a radar cross section of g^2 square metres.
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
        let radar::LinkBudget { transmit_power_dbm, antenna_gain_dbi, noise_figure_db, half_power_width_degrees } =
            self.0;
        (
            PyType::new::<LinkBudget>(py),
            (transmit_power_dbm, antenna_gain_dbi, noise_figure_db, half_power_width_degrees),
        )
    }
}
