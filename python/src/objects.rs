//! Objects and disturbances of a scene, which are data classes in Python (`apertura/objects.py`).

use crate::arrays::{numbers, owned};
use crate::errors::{value, whole};
use crate::radar::{Radar, or_default};
use apertura::radar::{BuiltArray, Decibels, ElementError, Tolerances};
use apertura::scene::{Block, GaussianCluster, Interferer, Line, Mirror, Object, Point, Polygon, Post, Wall};
use ndarray::Array1;
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Sets fields of a data class to those of the same names.
macro_rules! set {
    ($fields:ident, $of:ident: $($name:ident),+) => {
        $($fields.set_item(stringify!($name), $of.$name)?;)+
    };
}

/// A struct of numbers that a data class has under the same names.
macro_rules! read {
    ($number:ident, $kind:ident { $($name:ident),+ }) => {
        $kind { $($name: $number(stringify!($name))?),+ }
    };
}

/// A field of a data class, as a number; its name is part of the error.
fn field<'py, T>(of: &Bound<'py, PyAny>, name: &str, what: &str) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    let found = of.getattr(name)?;
    found.extract().map_err(|_| {
        let shown = found.repr().map_or_else(|_| "?".to_owned(), |r| r.to_string());
        PyTypeError::new_err(format!("{what}: {name} is {shown}; expected a number"))
    })
}

/// Object `index` of a scene.
pub fn object(from: &Bound<'_, PyAny>, index: usize) -> PyResult<Object> {
    let what = format!("object {}", index + 1);
    let kind: Option<String> = from.getattr_opt("kind")?.and_then(|kind| kind.extract().ok());
    let number = |name: &str| field::<f64>(from, name, &what);
    let count = || field::<usize>(from, "count", &what);
    let velocity =
        || Ok::<_, PyErr>([number("velocity_x_metres_per_second")?, number("velocity_y_metres_per_second")?]);
    let mut object = match kind.as_deref() {
        Some("point") => {
            let point = Point::new(number("x_metres")?, number("y_metres")?);
            Object::Point(point)
        }
        Some("line") => {
            let spacing = number("spacing_metres")?;
            let line = Line::vertical(number("x_metres")?, number("y_start_metres")?, spacing, count()?);
            let direction_degrees = number("direction_degrees")?;
            Object::Line(Line { direction_degrees, ..line })
        }
        Some("gaussian") => {
            let std = [number("x_std_metres")?, number("y_std_metres")?];
            let cluster = GaussianCluster::new([number("x_metres")?, number("y_metres")?], std, count()?);
            let seed = field(from, "seed", &what)?;
            Object::Gaussian(GaussianCluster { seed, ..cluster })
        }
        Some("wall") => Object::Wall(Wall::new(
            number("x_metres")?,
            number("y_metres")?,
            number("length_metres")?,
            number("angle_degrees")?,
        )),
        Some("box") => Object::Box(Block::new(
            [number("x_metres")?, number("y_metres")?],
            [number("length_metres")?, number("width_metres")?],
            number("angle_degrees")?,
        )),
        Some("post") => Object::Post(Post::new(number("x_metres")?, number("y_metres")?, number("radius_metres")?)),
        Some("polygon") => Object::Polygon(Polygon::new(corners(from, &what)?)),
        _ => {
            let found = from.get_type().name()?;
            let expected = "Point, Line, Cluster, Wall, Box, Post or Polygon";
            return Err(PyTypeError::new_err(format!("{what} is a {found}; expected {expected}")));
        }
    };
    object.set_reflectivity(number("reflectivity")?);
    if let Some((roughness_millimetres, seed)) = object.roughness_mut() {
        (*roughness_millimetres, *seed) = (number("roughness_millimetres")?, field(from, "seed", &what)?);
    }
    let [x, y] = velocity()?;
    let [velocity_x, velocity_y] = object.velocity_mut();
    (*velocity_x, *velocity_y) = (x, y);
    let name: String = from.getattr("name")?.extract()?;
    object.set_name(&name);
    Ok(object)
}

fn corners(from: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; 2]>> {
    from.getattr("corners_metres")?.extract().map_err(|_| {
        PyTypeError::new_err(format!("{what}: corners_metres is no sequence of (x, y); expected numbers in metres"))
    })
}

fn data_class<'py>(py: Python<'py>, name: &str, fields: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    py.import("apertura.objects")?.getattr(name)?.call((), Some(fields))
}

/// The data class of an object.
pub fn of_object<'py>(py: Python<'py>, object: &Object) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("reflectivity", object.reflectivity())?;
    let [velocity_x, velocity_y] = object.velocity_metres_per_second();
    fields.set_item("velocity_x_metres_per_second", velocity_x)?;
    fields.set_item("velocity_y_metres_per_second", velocity_y)?;
    fields.set_item("name", object.name())?;
    if let Some(body) = object.body() {
        fields.set_item("roughness_millimetres", body.roughness_millimetres)?;
        fields.set_item("seed", body.seed)?;
    }
    let name = match object {
        Object::Point(p) => {
            set!(fields, p: x_metres, y_metres);
            "Point"
        }
        Object::Line(l) => {
            set!(fields, l: x_metres, y_start_metres, spacing_metres, direction_degrees, count);
            "Line"
        }
        Object::Gaussian(g) => {
            set!(fields, g: x_metres, y_metres, x_std_metres, y_std_metres, count, seed);
            "Cluster"
        }
        Object::Wall(w) => {
            set!(fields, w: x_metres, y_metres, length_metres, angle_degrees);
            "Wall"
        }
        Object::Box(b) => {
            set!(fields, b: x_metres, y_metres, length_metres, width_metres, angle_degrees);
            "Box"
        }
        Object::Post(p) => {
            set!(fields, p: x_metres, y_metres, radius_metres);
            "Post"
        }
        Object::Polygon(p) => {
            let corners: Vec<(f64, f64)> = p.corners_metres.iter().map(|c| (c[0], c[1])).collect();
            fields.set_item("corners_metres", corners)?;
            "Polygon"
        }
    };
    data_class(py, name, &fields)
}

pub fn interferer(from: &Bound<'_, PyAny>) -> PyResult<Interferer> {
    let number = |name: &str| field::<f64>(from, name, "interferer");
    Ok(read!(number, Interferer { x_metres, y_metres, strength, crossing, duration }))
}

pub fn of_interferer<'py>(py: Python<'py>, of: &Interferer) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    set!(fields, of: x_metres, y_metres, strength, crossing, duration);
    data_class(py, "Interferer", &fields)
}

pub fn mirror(from: &Bound<'_, PyAny>) -> PyResult<Mirror> {
    let number = |name: &str| field::<f64>(from, name, "mirror");
    Ok(read!(number, Mirror { x_metres, y_metres, direction_degrees, reflection }))
}

pub fn of_mirror<'py>(py: Python<'py>, of: &Mirror) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    set!(fields, of: x_metres, y_metres, direction_degrees, reflection);
    data_class(py, "Mirror", &fields)
}

/// Elements as they are built: lists of equal length, one number an element. No number at all in `forward_millimetres` is a straight line.
pub fn elements(from: &Bound<'_, PyAny>) -> PyResult<BuiltArray> {
    let list = |name: &str| -> PyResult<Array1<f64>> {
        numbers(&from.getattr(name)?, &format!("elements: {name}"), "[elements]")
    };
    let (gain, phase) = (list("gain_db")?, list("phase_degrees")?);
    let (position, forward) = (list("position_millimetres")?, list("forward_millimetres")?);
    let dead = from.getattr("dead")?;
    let dead: Vec<usize> = dead.extract().map_err(|_| value("elements: dead is no list of numbers of elements"))?;
    let count = gain.len();
    let lengths = [
        ("phase_degrees", phase.len()),
        ("position_millimetres", position.len()),
        ("forward_millimetres", if forward.is_empty() { count } else { forward.len() }),
    ];
    for (name, len) in lengths {
        if len != count {
            return Err(value(format!("elements: {name} has {len} numbers; expected {count} as gain_db has")));
        }
    }
    if let Some(n) = dead.iter().find(|n| **n >= count) {
        return Err(value(format!("elements: element {n} is dead, of {count}")));
    }
    let element = |n: usize| ElementError {
        gain: Decibels(gain[n]),
        phase_degrees: phase[n],
        position_millimetres: position[n],
        forward_millimetres: forward.get(n).copied().unwrap_or(0.0),
        dead: dead.contains(&n),
    };
    Ok(BuiltArray { elements: (0..count).map(element).collect() })
}

pub fn of_elements<'py>(py: Python<'py>, of: &BuiltArray) -> PyResult<Bound<'py, PyAny>> {
    let list = |value: fn(&ElementError) -> f64| -> Bound<'py, PyArray1<f64>> {
        owned(py, of.elements.iter().map(value).collect::<Array1<f64>>())
    };
    let fields = PyDict::new(py);
    fields.set_item("gain_db", list(|e| e.gain.0))?;
    fields.set_item("phase_degrees", list(|e| e.phase_degrees))?;
    fields.set_item("position_millimetres", list(|e| e.position_millimetres))?;
    fields.set_item("forward_millimetres", list(|e| e.forward_millimetres))?;
    fields.set_item("dead", (0..of.elements.len()).filter(|n| of.elements[*n].dead).collect::<Vec<_>>())?;
    data_class(py, "Elements", &fields)
}

/// Draws the elements of an array that was built with tolerances; see `Elements.built`.
#[pyfunction]
#[pyo3(signature = (gain_db, phase_degrees, position_millimetres, seed, radar=None))]
pub fn built_elements<'py>(
    py: Python<'py>,
    gain_db: f64,
    phase_degrees: f64,
    position_millimetres: f64,
    seed: i128,
    radar: Option<&Radar>,
) -> PyResult<Bound<'py, PyAny>> {
    let seed = whole("seed", seed)?;
    let tolerances = Tolerances { gain: Decibels(gain_db), phase_degrees, position_millimetres };
    let radar = or_default(radar);
    let built = tolerances.build(&radar, seed);
    built.validate(&radar).map_err(value)?;
    of_elements(py, &built)
}
