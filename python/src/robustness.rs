//! The cost of element errors.

use crate::arrays::layout_of;
use crate::errors::{named, value, whole};
use crate::methods::{caused, methods_of};
use crate::radar::{Radar, or_default};
use crate::scene::set_name;
use crate::work::{self, Progress};
use apertura::evaluate::{Estimate, Robustness};
use apertura::radar::{Decibels, Tolerances};
use apertura::reconstruct::Reconstructor;
use apertura::scene::generate::Kind;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Most scenes, and the largest tolerance or scale.
const MAX_SCENES: u32 = 10_000;
const MAX_TOLERANCE: f64 = 180.0;

/// Factors on the tolerances where none are given.
const USUAL_SCALES: [f64; 5] = [0.0, 0.5, 1.0, 2.0, 4.0];

/// Tries methods on arrays with element errors: gain, phase and place drawn for each antenna. `apertura robustness` prints the same but for `calibrate`.
///
/// Maps are held against that of the array without errors over the same noise. Every scale has the same scenes, and the same draw of errors times the
/// scale.
///
/// Args:
///     methods: As `evaluate` takes them.
///     set: Kind of the scenes.
///     gain_db: Standard deviation of the elements' gain at scale 1, decibels.
///     phase_degrees: Of their phase, degrees.
///     position_millimetres: Of their places, millimetres.
///     scales: Factors on all three; 0, 0.5, 1, 2 and 4 where none are given.
///     count: Scenes; each meets an array of its own.
///     seed: Seed of scenes and errors.
///     floor: What lies beneath the reflectors.
///     radar: The radar; that of table 3.1 where none is given.
///     layout: Name or numbers of the elements that methods hear in place of the two ends (`layout`).
///     calibrate: Whether each array is first calibrated on its scene's strongest reflector.
///     progress: Called with the part that is done, 0 to 1.
///
/// Returns:
///     One dict a method and scale: `method`, `scale`, `gain_decibels`, `phase_degrees`, `position_millimetres`, and `squared_error`, `detection`
///     and `false_alarm`, each a pair of mean and standard error. Rates are fractions.
///
/// Raises:
///     ValueError: A name is unknown, a number can't be used, the kind finds no room before the radar, or a method can't work on a scene.
#[pyfunction]
#[pyo3(signature = (methods, set, *, gain_db=0.5, phase_degrees=10.0, position_millimetres=0.0, scales=None, count=5, seed=0,
                    floor="thesis", radar=None, layout=None, calibrate=false, progress=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn robustness<'py>(
    py: Python<'py>,
    methods: &Bound<'py, PyAny>,
    set: &Bound<'py, PyAny>,
    gain_db: f64,
    phase_degrees: f64,
    position_millimetres: f64,
    scales: Option<Vec<f64>>,
    count: i128,
    seed: i128,
    floor: &str,
    radar: Option<&Radar>,
    layout: Option<&Bound<'py, PyAny>>,
    calibrate: bool,
    progress: Progress<'_, 'py>,
) -> PyResult<Bound<'py, PyList>> {
    let (count, seed): (u32, u64) = (whole("count", count)?, whole("seed", seed)?);
    if !(1..=MAX_SCENES).contains(&count) {
        return Err(value(format!("count is {count}; expected 1 to {MAX_SCENES}")));
    }
    let scales = scales.unwrap_or_else(|| USUAL_SCALES.to_vec());
    let numbers =
        [("gain_db", gain_db), ("phase_degrees", phase_degrees), ("position_millimetres", position_millimetres)];
    let all = numbers.into_iter().chain(scales.iter().map(|scale| ("scales", *scale)));
    if let Some((name, number)) = all.into_iter().find(|(_, v)| !(0.0..=MAX_TOLERANCE).contains(v)) {
        return Err(value(format!("{name}: {number}; expected numbers from 0 to {MAX_TOLERANCE}")));
    }
    let methods = methods_of(methods)?;
    let robustness = Robustness {
        layout: layout_of(layout, &or_default(radar))?,
        radar: or_default(radar),
        kind: named::<Kind>(&set_name(set)?)?,
        seed,
        count,
        floor: named(floor)?,
        tolerances: Tolerances { gain: Decibels(gain_db), phase_degrees, position_millimetres },
        scales,
        calibrated: calibrate,
    };
    let borrowed: Vec<&dyn Reconstructor> = methods.iter().map(AsRef::as_ref).collect();
    let maps = f64::from(count) * (borrowed.len() * robustness.scales.len()) as f64;
    let mut done = 0.0;
    let rows = work::run(py, progress, |task| {
        robustness.run(&borrowed, &task.quiet(), || {
            done += 1.0;
            task.set_progress((done / maps) as f32);
        })
    })?
    .map_err(|error| caused(py, value(error), &methods))?;
    let pair = |estimate: &Estimate| (estimate.mean, estimate.standard_error);
    let dict = |row: &apertura::evaluate::RobustnessRow| -> PyResult<_> {
        let dict = PyDict::new(py);
        dict.set_item("method", row.method)?;
        dict.set_item("scale", row.scale)?;
        dict.set_item("gain_decibels", row.gain_decibels)?;
        dict.set_item("phase_degrees", row.phase_degrees)?;
        dict.set_item("position_millimetres", row.position_millimetres)?;
        dict.set_item("squared_error", pair(&row.squared_error))?;
        dict.set_item("detection", pair(&row.detection))?;
        dict.set_item("false_alarm", pair(&row.false_alarm))?;
        Ok(dict)
    };
    PyList::new(py, rows.iter().map(dict).collect::<PyResult<Vec<_>>>()?)
}
