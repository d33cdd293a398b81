//! Elements of layouts, and bounds of unbiased estimators.

use crate::arrays::{numbers, owned, reflectors};
use crate::errors::named;
use crate::errors::value;
use crate::radar::{Radar, or_default};
use crate::work;
use apertura::bounds::{self, Gains, cramer_rao_of, noise_variance};
use apertura::radar::{Decibels, Layout, LayoutKind};
use ndarray::Array1;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyList;

/// Most reflectors that a bound may be asked of: the work grows with their square.
const MAX_REFLECTORS: usize = 64;

fn layout_of(name: &str, radar: &apertura::radar::Radar) -> PyResult<Layout> {
    named::<LayoutKind>(name)?.layout(radar).map_err(value)
}

/// Numbers of the elements of a layout, in rising order; those of a list in its own.
///
/// Args:
///     name: "full"; "two-ends"; "one-end", the first; "nested=AxB", A neighbours and B elements A + 1 apart (Pal and Vaidyanathan 2010);
///         "coprime=MxN", N elements M apart and 2 M elements N apart (Vaidyanathan and Pal 2011); "thinned=K", every K-th element; "random=N" or
///         "random=N:SEED", N elements with the outermost two among them; "mimo=TxR", the pairs of T transmitters and R receivers; or numbers as rows have
///         them, "0-11 1012-1023".
///     radar: The radar; that of table 3.1 where none is given.
///
/// Raises:
///     ValueError: The name is unknown, or the radar has no such elements.
#[pyfunction]
#[pyo3(signature = (name, radar=None))]
pub fn layout(name: &str, radar: Option<&Radar>) -> PyResult<Vec<usize>> {
    named::<LayoutKind>(name)?.numbers(&or_default(radar)).map_err(value)
}

/// Cramer-Rao bounds on the position of each reflector: the smallest errors of any unbiased estimator.
///
/// Args:
///     reflectors: Numbers `[reflectors, 2]` (x and y in metres) or `[reflectors, 3]` (and reflectivity); at most 64.
///     snr_db: Signal-to-noise ratio a sample of the first reflector, averaged over the layout.
///     radar: The radar; that of table 3.1 where none is given.
///     layout: A name that `layout` knows.
///     gains: "one" (all elements hear a reflector coherently) or "per-end".
///
/// Returns:
///     One `PositionBound` a reflector.
///
/// Raises:
///     ValueError: The samples don't determine the reflectors, a name is unknown, or a number can't be used.
#[pyfunction]
#[pyo3(signature = (reflectors, snr_db, radar=None, *, layout="two-ends", gains="one"))]
pub fn cramer_rao<'py>(
    py: Python<'py>,
    reflectors: &Bound<'py, PyAny>,
    snr_db: f64,
    radar: Option<&Radar>,
    layout: &str,
    gains: &str,
) -> PyResult<Bound<'py, PyList>> {
    let radar = or_default(radar);
    let reflectors = self::reflectors(reflectors, "reflectors")?;
    let Some(first) = reflectors.first().filter(|_| reflectors.len() <= MAX_REFLECTORS) else {
        return Err(value(format!("there are {} reflectors; expected 1 to {MAX_REFLECTORS}", reflectors.len())));
    };
    if reflectors.iter().any(|r| ![r.x_metres, r.y_metres, r.reflectivity].iter().all(|v| v.is_finite())) {
        return Err(value("reflectors: not all numbers are finite"));
    }
    let gains = match gains {
        "one" => Gains::One,
        "per-end" => Gains::PerEnd,
        _ => return Err(value(format!("gains is \"{gains}\"; expected one or per-end"))),
    };
    let layout = layout_of(layout, &radar)?;
    let variance = noise_variance(&radar, &layout, first, Decibels(snr_db));
    let found =
        work::run(py, None, |_| cramer_rao_of(&radar, &layout, &reflectors, variance, gains))?.map_err(value)?;
    let class = py.import("apertura.objects")?.getattr("PositionBound")?;
    let bound = |b: &bounds::PositionBound| {
        let fields = (
            b.range_metres,
            b.cos_theta,
            b.x_metres,
            b.y_metres,
            b.xy_covariance_metres2,
            b.amplitude,
            b.position_metres(),
        );
        class.call1(fields)
    };
    PyList::new(py, found.iter().map(bound).collect::<PyResult<Vec<_>>>()?)
}

/// How alike the echoes of other places are to a reflector's.
///
/// Args:
///     x_metres: x of the reflector.
///     y_metres: y of the reflector.
///     range_metres: Ranges of the other places, numbers `[ranges]`.
///     cos_theta: Their cosines from the array's axis, numbers `[cosines]`.
///     radar: The radar; that of table 3.1 where none is given.
///     layout: As in `cramer_rao`.
///
/// Returns:
///     float64 `[ranges, cosines]`, 0 to 1.
///
/// Raises:
///     ValueError: A name is unknown, a number is not finite, or more than a million places are asked for.
#[pyfunction]
#[pyo3(signature = (x_metres, y_metres, range_metres, cos_theta, radar=None, *, layout="two-ends"))]
pub fn ambiguity<'py>(
    py: Python<'py>,
    x_metres: f64,
    y_metres: f64,
    range_metres: &Bound<'py, PyAny>,
    cos_theta: &Bound<'py, PyAny>,
    radar: Option<&Radar>,
    layout: &str,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let radar = or_default(radar);
    let ranges: Array1<f64> = numbers(range_metres, "range_metres", "[ranges]")?;
    let cosines: Array1<f64> = numbers(cos_theta, "cos_theta", "[cosines]")?;
    if ![x_metres, y_metres].iter().chain(&ranges).chain(&cosines).all(|v| v.is_finite()) {
        return Err(value("not all numbers are finite"));
    }
    let places = ranges.len() * cosines.len();
    if places > 1_000_000 {
        return Err(value(format!("{places} places are asked for; at most 1000000")));
    }
    let layout = layout_of(layout, &radar)?;
    let centre = radar.polar_of(x_metres, y_metres);
    let (ranges, cosines) = (ranges.to_vec(), cosines.to_vec());
    let found = work::run(py, None, |_| bounds::ambiguity(&radar, &layout, centre, &ranges, &cosines))?;
    Ok(owned(py, found.likeness))
}
