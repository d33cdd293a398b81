//! Statistics of rows: comparisons of methods, and rules on bad scenes.

use crate::errors::value;
use crate::rows::rows_of;
use crate::work;
use apertura::evaluate::statistics::{Paired, USUALLY_BAD, rules};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

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

/// What bad rows have in common: rules about what is known of a scene before a method answers.
///
/// Scenes of even number suggest rules, those of odd number test them. Of the rules at most 5 % are expected to be chance.
///
/// Args:
///     rows: Rows as `evaluate` and `read_rows` give them.
///     bad: Which rows are bad, as a filter of the window's panel Evaluate.
///
/// Returns:
///     One object a rule, the surest first: `text` (a filter), `rows` of which it is true and how many of them are `bad`, `other_rows` and
///     `other_bad`, all of the half that tests, and `p_value`, Fisher's exact test.
///
/// Raises:
///     ValueError: Something is no row, or `bad` is no filter.
#[pyfunction(name = "rules")]
#[pyo3(signature = (rows, bad=USUALLY_BAD))]
pub fn rules_of<'py>(py: Python<'py>, rows: Vec<Bound<'py, PyDict>>, bad: &str) -> PyResult<Bound<'py, PyList>> {
    let rows = rows_of(py, &rows)?;
    let shared = work::run(py, None, |_| rules(&rows, bad))?.map_err(|e| value(format!("bad: {e}")))?;
    let class = py.import("apertura.objects")?.getattr("Rule")?;
    let made: PyResult<Vec<_>> = shared
        .rules
        .into_iter()
        .map(|r| class.call1((r.text, r.rows, r.bad, r.other_rows, r.other_bad, r.p_value)))
        .collect();
    PyList::new(py, made?)
}
