//! NumPy arrays in and out.

use crate::errors::{argument, value};
use apertura::radar::{LayoutKind, Radar};
use apertura::scene::Reflector;
use apertura::signal::TwoEnds;
use ndarray::{Array, Array2, ArrayBase, Axis, Data, Dimension, IntoDimension};
use num_complex::Complex64;
use numpy::{Element, PyArray, PyArrayDescrMethods, PyReadonlyArray, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// An array of this library as NumPy's, which owns it: nothing is copied.
pub fn owned<T: Element, D: Dimension>(py: Python<'_>, array: Array<T, D>) -> Bound<'_, PyArray<T, D>> {
    PyArray::from_owned_array(py, array)
}

/// An array that lives in `container`, as a read-only view that keeps it alive: nothing is copied.
///
/// # Safety
/// The array must neither move nor change as long as `container` lives.
pub unsafe fn view<'py, S, D>(
    array: &ArrayBase<S, D>,
    container: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray<S::Elem, D>>>
where
    S: Data,
    S::Elem: Element,
    D: Dimension,
{
    // SAFETY: as the caller promises.
    let view = unsafe { PyArray::borrow_from_array(array, container) };
    let flags = [("write", false)];
    view.call_method("setflags", (), Some(&pyo3::types::IntoPyDict::into_py_dict(flags, view.py())?))?;
    Ok(view)
}

/// Anything that NumPy can make an array of, as a copy with elements of `T`; `what` and `shape` are for messages.
///
/// Kinds of numbers that `T` can't hold are refused: text, objects, and complex numbers where real ones are wanted.
pub fn numbers<T, D>(from: &Bound<'_, PyAny>, what: &str, shape: &str) -> PyResult<Array<T, D>>
where
    T: Element + Clone,
    D: Dimension,
{
    let py = from.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (from,))?;
    let array = array.cast_into::<PyUntypedArray>().map_err(|e| value(format!("{what}: {e}")))?;
    let wanted = T::get_dtype(py);
    let kind = array.dtype().kind();
    let kinds: &[u8] = if wanted.kind() == b'c' { b"biufc" } else { b"biuf" };
    if !kinds.contains(&kind) {
        return Err(value(format!("{what}: its dtype is {}; expected {wanted}, shape {shape}", array.dtype())));
    }
    if let Some(ndim) = D::NDIM
        && array.ndim() != ndim
    {
        return Err(value(format!("{what}: its shape is {:?}; expected {shape}", array.shape())));
    }
    let array = array.call_method1("astype", (wanted,))?;
    let array: PyReadonlyArray<'_, T, D> =
        array.extract().map_err(|_| value(format!("{what}: can't be read as {shape}")))?;
    Ok(array.as_array().to_owned())
}

pub fn samples<D: Dimension>(
    from: &Bound<'_, PyAny>,
    what: &str,
    shape: impl IntoDimension<Dim = D>,
) -> PyResult<Array<Complex64, D>> {
    let shape = shape.into_dimension();
    let array: Array<Complex64, D> = numbers(from, what, &format!("{:?}", shape.slice()))?;
    if array.raw_dim() != shape {
        let found = array.shape();
        return Err(value(format!("{what}: their shape is {found:?}; expected {:?}", shape.slice())));
    }
    Ok(array)
}

/// The samples of both ends, `[2, end elements, samples]`.
pub fn ends(from: &Bound<'_, PyAny>, radar: &Radar) -> PyResult<TwoEnds> {
    let both = samples(from, "ends", [2, radar.end_elements, radar.samples])?;
    let end = |i: usize| both.index_axis(Axis(0), i).to_owned();
    Ok(TwoEnds { first: end(0), last: end(1) })
}

/// Two arrays of one shape as one, `[2, rows, columns]`.
pub fn stacked<T: Clone>(both: [&Array2<T>; 2]) -> ndarray::Array3<T> {
    ndarray::stack(Axis(0), &both.map(|one| one.view())).expect("the two have one shape")
}

/// Both ends as one array, `[2, end elements, samples]`.
pub fn both_ends(ends: &TwoEnds) -> ndarray::Array3<Complex64> {
    stacked([&ends.first, &ends.last])
}

/// Numbers of the elements that an argument `layout` names or lists; `None` for the two ends.
pub fn layout_of(any: Option<&Bound<'_, PyAny>>, radar: &Radar) -> PyResult<Option<Vec<usize>>> {
    let Some(any) = any else { return Ok(None) };
    if let Ok(name) = any.extract::<String>() {
        let wrong = |error: String| value(format!("layout: {error}"));
        let kind: LayoutKind = name.parse().map_err(wrong)?;
        let numbers = || kind.numbers(radar).map_err(|e| wrong(e.to_string()));
        return if kind == LayoutKind::TwoEnds { Ok(None) } else { numbers().map(Some) };
    }
    any.extract().map(Some).or_else(|_| {
        let expected = "a name, or numbers of elements, as apertura.layout takes and gives them";
        let message = format!("layout is {}; expected {expected}", any.repr()?);
        Err(argument(any.py(), message))
    })
}

/// Reflectors as rows of x, y (metres) and reflectivity.
pub fn rows_of(reflectors: &[Reflector]) -> Array2<f64> {
    Array2::from_shape_fn((reflectors.len(), 3), |(i, j)| {
        let Reflector { x_metres, y_metres, reflectivity } = reflectors[i];
        [x_metres, y_metres, reflectivity][j]
    })
}

/// Rows of x, y (metres) and, where there is a third column, reflectivity, which is 1 otherwise.
pub fn reflectors(from: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<Reflector>> {
    let shape = "[reflectors, 2] or [reflectors, 3]";
    let rows: Array2<f64> = numbers(from, what, shape)?;
    if !(2..=3).contains(&rows.ncols()) {
        return Err(value(format!("{what}: its shape is {:?}; expected {shape}", rows.shape())));
    }
    let reflector = |row: ndarray::ArrayView1<'_, f64>| Reflector {
        x_metres: row[0],
        y_metres: row[1],
        reflectivity: row.get(2).copied().unwrap_or(1.0),
    };
    Ok(rows.outer_iter().map(reflector).collect())
}
