//! Figures of merit of maps.

use crate::arrays::{numbers, owned};
use crate::errors::{named, value};
use crate::work;
use apertura::evaluate::{Metrics, Roc};
use apertura::maps::RangeAngleMap;
use apertura::maps::cfar::Cfar;
use ndarray::{Array1, Array2};
use numpy::PyArray1;
use pyo3::prelude::*;

/// One number a threshold, float64.
type Numbers<'py> = Bound<'py, PyArray1<f64>>;

const SHAPE: &str = "[range bins, columns]";

/// Lambda of every cell, all of them finite.
fn map_of(from: &Bound<'_, PyAny>, what: &str) -> PyResult<RangeAngleMap> {
    let lambda: Array2<f32> = numbers(from, what, SHAPE)?;
    match lambda.indexed_iter().find(|(_, v)| !v.is_finite()) {
        Some((cell, v)) => Err(value(format!("{what}: {v} at {cell:?}; expected finite numbers only"))),
        None => Ok(RangeAngleMap { lambda }),
    }
}

/// Largest part by which rounding takes Lambda out of 0 to 1.
const ROUNDING: f32 = 1e-3;

/// Lambda of every cell, within 0 and 1.
fn lambda_of(from: &Bound<'_, PyAny>, what: &str) -> PyResult<RangeAngleMap> {
    let map = map_of(from, what)?;
    match map.lambda.indexed_iter().find(|(_, v)| !(-ROUNDING..=1.0 + ROUNDING).contains(*v)) {
        Some((cell, v)) => Err(value(format!(
            "{what}: {v} at {cell:?}; expected Lambda, 0 to 1: decades d become it by (d - d.min()) / (d.max() - d.min()), bytes by / 255"
        ))),
        None => Ok(map),
    }
}

/// Both maps, of one shape.
fn both(target: &Bound<'_, PyAny>, output: &Bound<'_, PyAny>) -> PyResult<[RangeAngleMap; 2]> {
    let both = [lambda_of(target, "target")?, lambda_of(output, "output")?];
    let [target, output] = both.each_ref().map(|map| map.lambda.shape().to_vec());
    if target != output {
        return Err(value(format!("output: its shape is {output:?}; expected {target:?}, the target's")));
    }
    if target.contains(&0) {
        return Err(value(format!("target: its shape is {target:?}; expected at least one cell")));
    }
    Ok(both)
}

/// The three figures of the thesis' tables for one scene.
///
/// Args:
///     target: Lambda of the whole array, numbers `[range bins, columns]`, read as float32.
///     output: Lambda as a method estimates it, of the same shape.
///     eta: Threshold of the output.
///     has_echoes: False where nothing reflects: then nothing can be detected, and what exceeds eta is a false alarm.
///
/// Returns:
///     `squared_error`, `detection` (None where the target has no cell above 0.9) and `false_alarm`.
///
/// Raises:
///     ValueError: The shapes differ, a map is empty, or a cell is not within 0 and 1: decades and bytes are no Lambda.
#[pyfunction]
#[pyo3(signature = (target, output, eta, *, has_echoes=true))]
pub fn metrics<'py>(
    py: Python<'py>,
    target: &Bound<'py, PyAny>,
    output: &Bound<'py, PyAny>,
    eta: f32,
    has_echoes: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if !(0.0..=1.0).contains(&eta) {
        return Err(value(format!("eta is {eta}; expected 0 to 1")));
    }
    let [target, output] = both(target, output)?;
    let found = Metrics::of_echoes(has_echoes, &target, &output, eta);
    let figures = (found.squared_error, found.detection, found.false_alarm);
    py.import("apertura.objects")?.getattr("Metrics")?.call1(figures)
}

/// Detects at a constant false-alarm rate: each cell against a threshold from the cells around it.
///
/// Args:
///     power: Linear power, numbers `[range bins, columns]`, as in `10 ** (2 * maps.decades)`; its unit doesn't matter. Columns wrap around.
///     detector: "ca" (cell averaging, Finn and Johnson 1968) or "os" (ordered statistics, Rohling 1983), with guard and training cells a
///         side as range bins x columns and the wanted rate, as in "ca:guard=4x0:training=16x0:rate=0.0001".
///
/// Returns:
///     bool `[range bins, columns]`: True where a cell is a detection. The rate holds for noise of exponentially distributed power that is
///     independent from cell to cell.
///
/// Raises:
///     ValueError: The text is no detector, the window leaves no training cell, or a cell is negative or not finite.
#[pyfunction]
#[pyo3(signature = (power, detector="ca"))]
pub fn cfar<'py>(
    py: Python<'py>,
    power: &Bound<'py, PyAny>,
    detector: &str,
) -> PyResult<Bound<'py, numpy::PyArray2<bool>>> {
    let cfar: Cfar = named(detector)?;
    let power: Array2<f64> = numbers(power, "power", SHAPE)?;
    if let Some((cell, v)) = power.indexed_iter().find(|(_, v)| !(v.is_finite() && **v >= 0.0)) {
        return Err(value(format!("power: {v} at {cell:?}; expected finite numbers from 0")));
    }
    let mask = work::run(py, None, |_| cfar.detect(power.view()))?.map_err(value)?;
    Ok(owned(py, mask.cells))
}

/// P_D and P_FA over 4097 thresholds from 0 to 1.
///
/// Args:
///     target: Lambda of the whole array, numbers `[range bins, columns]`, read as float32.
///     output: Lambda as a method estimates it, of the same shape.
///
/// Returns:
///     `eta`, `detection` and `false_alarm`, float64 `[4097]` each; empty where the target has no cell above 0.9, or no other.
///
/// Raises:
///     ValueError: The shapes differ, a map is empty, or a cell is not within 0 and 1.
#[pyfunction]
pub fn roc<'py>(
    py: Python<'py>,
    target: &Bound<'py, PyAny>,
    output: &Bound<'py, PyAny>,
) -> PyResult<(Numbers<'py>, Numbers<'py>, Numbers<'py>)> {
    let [target, output] = both(target, output)?;
    let roc = work::run(py, None, |_| Roc::of(&target, &output))?;
    let column = |of: fn(apertura::evaluate::RocPoint) -> f64| owned(py, roc.points().map(of).collect::<Array1<f64>>());
    Ok((column(|p| p.eta.into()), column(|p| p.detection), column(|p| p.false_alarm)))
}
