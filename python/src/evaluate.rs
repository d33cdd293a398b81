//! Figures of merit, and methods over many scenes.

use crate::arrays::{numbers, owned};
use crate::errors::named;
use crate::errors::{runtime, system, value};
use crate::radar::{Radar, or_default};
use crate::scene::{purpose_of, reading_of, set_name};
use crate::work::{self, Progress};
use apertura::evaluate::campaign::{Campaign, CampaignError};
use apertura::evaluate::rows::{self, Column, Row, read_rows as read, write_rows};
use apertura::evaluate::sets::SceneSet;
use apertura::evaluate::{Metrics, Roc};
use apertura::files::{write_atomically, write_bytes};
use apertura::maps::RangeAngleMap;
use apertura::maps::cfar::Cfar;
use apertura::reconstruct::Reconstructor;
use apertura::scene::generate::Kind;
use ndarray::{Array1, Array2};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PyList, PyString, PyType};
use serde_json::Value as Json;
use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::Arc;

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

/// Both maps, of one shape.
fn both(target: &Bound<'_, PyAny>, output: &Bound<'_, PyAny>) -> PyResult<[RangeAngleMap; 2]> {
    let both = [map_of(target, "target")?, map_of(output, "output")?];
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
///     ValueError: The shapes differ, a map is empty, or a cell is not finite.
#[pyfunction]
#[pyo3(signature = (target, output, eta, *, has_echoes=true))]
pub fn metrics<'py>(
    py: Python<'py>,
    target: &Bound<'py, PyAny>,
    output: &Bound<'py, PyAny>,
    eta: f32,
    has_echoes: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if !eta.is_finite() {
        return Err(value(format!("eta is {eta}; expected a finite number")));
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
///     ValueError: The shapes differ, a map is empty, or a cell is not finite.
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

/// Tries methods on random scenes: the rows of `apertura evaluate --rows`.
///
/// Args:
///     methods: Names of methods.
///     sets: Names of sets as `Scene.random` takes them.
///     count: Scenes of each set.
///     seed: Seed of the sets.
///     floor: What lies beneath the reflectors.
///     normalisation: How every map is normalised.
///     purpose: "test", "validation" or "training".
///     reading: "program" or "text".
///     radar: The radar; that of table 3.1 where none is given.
///     on_row: Called with each row as it is found.
///     progress: Called with the part that is done, 0 to 1.
///     cfar: A detector as `cfar` takes it, which is tried on every output beside the threshold; rows say it in `cfar_detection`,
///         `cfar_false_alarm` and `cfar`.
///     path: A CSV file that all rows are written to in one step, in the program's format.
///     only: The rows to find, as (set, number of the scene, method), in place of all rows of the run.
///
/// Returns:
///     One dict a row, sorted by set, scene and method: the columns of the program's CSV and what made the row. `echoes` and `echoes_found`
///     are texts of six numbers, one for every 10 dB below the strongest echo; None for scenes without bodies. `doubt` is the squared
///     error if every cell were off by `Reconstruction.doubt`, and `within_doubt` the part of the cells that are off by at most it; None for
///     methods that say no doubt.
///
/// Raises:
///     ValueError: A name is unknown or given twice, `count` is 0, or a method can't work on a scene.
///     OSError: `path` can't be written.
#[pyfunction]
#[pyo3(signature = (methods, sets, *, count=100, seed=0, floor="thesis", normalisation="min-max", purpose="test", reading="program",
                    radar=None, on_row=None, progress=None, path=None, only=None, cfar=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn evaluate<'py>(
    py: Python<'py>,
    methods: Vec<String>,
    sets: Vec<Bound<'py, PyAny>>,
    count: u32,
    seed: u64,
    floor: &str,
    normalisation: &str,
    purpose: &str,
    reading: &str,
    radar: Option<&Radar>,
    on_row: Option<&Bound<'py, PyAny>>,
    progress: Progress<'_, 'py>,
    path: Option<PathBuf>,
    only: Option<Vec<(String, u32, String)>>,
    cfar: Option<&str>,
) -> PyResult<Bound<'py, PyList>> {
    if count == 0 {
        return Err(value("count is 0; expected at least 1"));
    }
    let (purpose, reading) = (purpose_of(purpose)?, reading_of(reading)?);
    let (floor, normalisation) = (named(floor)?, named(normalisation)?);
    let campaign = Campaign {
        radar: or_default(radar),
        reading,
        purpose,
        seed,
        count,
        floor,
        normalisation,
        cfar: cfar.map(named).transpose()?,
        ..Campaign::default()
    };
    let kinds: PyResult<Vec<_>> = sets.iter().map(|s| named::<Kind>(&set_name(s)?)).collect();
    let sets: Vec<SceneSet> = kinds?.into_iter().map(SceneSet::Generated).collect();
    let known: Result<Vec<Arc<dyn Reconstructor>>, _> = methods.iter().map(|m| apertura::methods::by_name(m)).collect();
    let known = known.map_err(value)?;
    let methods: Vec<&dyn Reconstructor> = known.iter().map(AsRef::as_ref).collect();
    let only: Option<HashSet<_>> = only.map(|only| only.into_iter().collect());
    let all =
        only.as_ref().map_or(f64::from(count) * sets.len() as f64 * methods.len() as f64, |only| only.len() as f64);
    let empty = campaign.empty_rows(&sets, &methods).map_err(value)?;
    check_only(only.as_ref(), &sets, &methods, count)?;
    // Most scenes of a long run are left out by their number alone.
    let numbers = only.iter().flatten().map(|(_, index, _)| *index);
    let between = numbers.clone().min().unwrap_or(1)..=numbers.max().unwrap_or(0);
    let is_left_out = |set: &str, index: u32, method: &str| {
        only.as_ref().is_some_and(|only| {
            !between.contains(&index) || !only.contains(&(set.to_owned(), index, method.to_owned()))
        })
    };
    let mut done = 0.0;
    let rows = work::run_watched(
        py,
        None,
        |task, finder| {
            let on_row = |row: &Row, _: &_, _: &_| finder.found(row.clone());
            campaign.run_rest(&sets, &methods, &empty, &is_left_out, task, on_row)
        },
        |row| {
            done += 1.0;
            if let Some(on_row) = on_row {
                on_row.call1((dict_of(py, &row)?,))?;
            }
            if let Some(progress) = progress {
                progress.call1((done / all,))?;
            }
            Ok(())
        },
    )?
    .map_err(|error: CampaignError| value(error))?;
    if let Some(path) = path {
        let mut text = Vec::new();
        write_rows(&mut text, &rows).map_err(runtime)?;
        write_bytes(&path, &text).map_err(|e| system(&e, format!("{}: {e}", path.display())))?;
    }
    list_of(py, &rows)
}

/// Rows that are asked for and can't be.
fn check_only(
    only: Option<&HashSet<(String, u32, String)>>,
    sets: &[SceneSet],
    methods: &[&dyn Reconstructor],
    count: u32,
) -> PyResult<()> {
    for (set, index, method) in only.into_iter().flatten() {
        let known = sets.iter().any(|s| s.to_string() == *set) && methods.iter().any(|m| m.name() == method);
        if !known || *index >= count {
            return Err(value(format!("only: scene {index} of set {set} by {method} is no row of this run")));
        }
    }
    Ok(())
}

/// Writes rows in the program's format, in one step.
///
/// Args:
///     path: A CSV file.
///     rows: Rows as `evaluate` and `read_rows` give them.
///
/// Raises:
///     ValueError: Something is no row; the message names its line in the file and the column.
///     OSError: The file can't be written.
#[pyfunction]
#[pyo3(name = "write_rows")]
pub fn write_rows_to(py: Python<'_>, path: PathBuf, rows: Vec<Bound<'_, PyDict>>) -> PyResult<()> {
    let rows = rows_of(py, &rows)?;
    write_atomically(&path, |out| write_rows(out, &rows)).map_err(|e| system(&e, format!("{}: {e}", path.display())))
}

/// Rows of dicts, read as the program reads a file of them.
pub fn rows_of(py: Python<'_>, rows: &[Bound<'_, PyDict>]) -> PyResult<Vec<Row>> {
    let names: Vec<&str> = Column::all().map(Column::name).collect();
    let mut text = names.join(",");
    for row in rows {
        text.push('\n');
        for (i, name) in names.iter().enumerate() {
            let cell = row.get_item(name)?.filter(|cell| !cell.is_none());
            let cell = cell.map_or_else(|| Ok(String::new()), |cell| cell.str().map(|s| s.to_string()))?;
            if i > 0 {
                text.push(',');
            }
            text.push_str(&format!("\"{}\"", cell.replace('"', "\"\"")));
        }
    }
    text.push('\n');
    work::run(py, None, |_| read(text.as_bytes()))?.map_err(value)
}

/// Reads the rows of `apertura evaluate --rows`.
///
/// Returns:
///     One dict a row, as `evaluate` gives them; figures that an older table does not say are None, and texts empty.
///
/// Raises:
///     OSError: The file can't be read.
///     ValueError: It is no such table; the message names the line and column.
#[pyfunction]
pub fn read_rows(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyList>> {
    let file = std::fs::File::open(&path).map_err(|e| system(&e, format!("{}: {e}", path.display())))?;
    let rows = work::run(py, None, |_| read(file))?.map_err(|e| value(format!("{}: {e}", path.display())))?;
    list_of(py, &rows)
}

fn list_of<'py>(py: Python<'py>, rows: &[Row]) -> PyResult<Bound<'py, PyList>> {
    let dicts: PyResult<Vec<_>> = rows.iter().map(|row| dict_of(py, row)).collect();
    PyList::new(py, dicts?)
}

fn dict_of<'py>(py: Python<'py>, row: &Row) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let Json::Object(cells) = serde_json::to_value(row).map_err(runtime)? else { return Ok(dict) };
    for name in Column::all().map(Column::name) {
        match &cells[name] {
            Json::String(text) => dict.set_item(name, text)?,
            Json::Number(number) => match number.as_u64() {
                Some(whole) if !number.is_f64() => dict.set_item(name, whole)?,
                _ => dict.set_item(name, number.as_f64())?,
            },
            _ => dict.set_item(name, py.None())?,
        }
    }
    Ok(dict)
}

/// The columns of rows, in the file's order: name, type (str, int or float), and whether it says what made a row.
pub fn row_columns(py: Python<'_>) -> Vec<(&'static str, Bound<'_, PyType>, bool)> {
    let python_type = |column: Column| match column.kind() {
        rows::Kind::Text => py.get_type::<PyString>(),
        rows::Kind::Whole => py.get_type::<PyInt>(),
        rows::Kind::Real => py.get_type::<PyFloat>(),
    };
    Column::all().map(|column| (column.name(), python_type(column), Column::ORIGIN.contains(&column))).collect()
}
