//! Rows of evaluations: read, written, and as dicts.

use crate::errors::{at, runtime, value};
use crate::work;
use apertura::evaluate::rows::{self, Column, Row, read_rows as read, write_rows};
use apertura::files::{ends_in, write_atomically};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PyList, PyString, PyType};
use serde_json::Value as Json;
use std::path::PathBuf;

/// Writes rows in the program's format, in one step.
///
/// Args:
///     path: A CSV file.
///     rows: Rows as `evaluate` and `read_rows` give them.
///
/// Raises:
///     ValueError: Something is no row, and the message names its line in the file and the column; or the name ends in `.parquet`.
///     OSError: The file can't be written.
#[pyfunction]
#[pyo3(name = "write_rows")]
pub fn write_rows_to(py: Python<'_>, path: PathBuf, rows: Vec<Bound<'_, PyDict>>) -> PyResult<()> {
    let rows = rows_of(py, &rows)?;
    if ends_in(&path, &["parquet"]) {
        let told =
            format!("{}: rows are written as CSV; expected a name that does not end in .parquet", path.display());
        return Err(value(told));
    }
    write_atomically(&path, |out| write_rows(out, &rows)).map_err(at(&path))
}

/// Rows from dicts, read as the program reads a file of rows.
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
    let file = std::fs::File::open(&path).map_err(at(&path))?;
    let rows = work::run(py, None, |_| read(file))?.map_err(|e| value(format!("{}: {e}", path.display())))?;
    list_of(py, &rows)
}

pub fn list_of<'py>(py: Python<'py>, rows: &[Row]) -> PyResult<Bound<'py, PyList>> {
    let dicts: PyResult<Vec<_>> = rows.iter().map(|row| dict_of(py, row)).collect();
    PyList::new(py, dicts?)
}

pub fn dict_of<'py>(py: Python<'py>, row: &Row) -> PyResult<Bound<'py, PyDict>> {
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
        rows::CellKind::Text => py.get_type::<PyString>(),
        rows::CellKind::Whole => py.get_type::<PyInt>(),
        rows::CellKind::Real => py.get_type::<PyFloat>(),
    };
    Column::all().map(|column| (column.name(), python_type(column), Column::ORIGIN.contains(&column))).collect()
}
