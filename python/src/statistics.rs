//! The comparison of two methods by their rows.

use crate::errors::value;
use crate::rows::rows_of;
use crate::work;
use apertura::evaluate::statistics::Paired;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Two methods on the scenes that rows of both are there of.
///
/// Args:
///     rows: Rows as `evaluate` and `read_rows` give them.
///     first: Name of a method.
///     second: Name of another.
///
/// Returns:
///     `scenes`; `difference`, the mean of the first's squared error less the second's, and its `interval` of 95 % (paired bootstrap; the normal
///     one for more than 5000 scenes); `first_alone` and `second_alone`, the scenes in which that one alone finds every object; `p_value`, McNemar's exact
///     test of these two counts.
///
/// Raises:
///     ValueError: Something is no row, or no scene has rows of both.
#[pyfunction]
pub fn paired<'py>(
    py: Python<'py>,
    rows: Vec<Bound<'py, PyDict>>,
    first: &str,
    second: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let rows = rows_of(py, &rows)?;
    let paired = work::run(py, None, |_| Paired::of(&rows, first, second))?
        .ok_or_else(|| value(format!("no scene has rows of both \"{first}\" and \"{second}\"")))?;
    let Paired { scenes, difference, interval: [low, high], first_alone, second_alone, p_value } = paired;
    let figures = (scenes, difference, (low, high), first_alone, second_alone, p_value);
    py.import("apertura.objects")?.getattr("Paired")?.call1(figures)
}
