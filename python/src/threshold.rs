//! The threshold at which a method keeps a rate of false alarms.

use crate::arrays::layout_of;
use crate::errors::{named, value, whole};
use crate::methods;
use crate::radar::{Radar, or_default};
use crate::scene::set_name;
use crate::work::{self, Progress};
use apertura::evaluate::threshold::{KeptThreshold, ThresholdSearch};
use apertura::scene::generate::Kind;
use pyo3::prelude::*;

/// Finds the threshold at which a method's false alarms stay below a rate on further scenes like those that it is tried on.
///
/// The method is tried on random validation scenes. The threshold is the lowest with (n P_FA + 1) / (n + 1) at most the rate, P_FA being the
/// mean over the n scenes (conformal risk control; Angelopoulos et al., ICLR 2024, theorem 1). On a further scene that is exchangeable with
/// these, P_FA is then at most the rate on average. This holds for no other kinds of scenes, floors or radars, and not for each single scene.
///
/// Args:
///     method: A method, as `evaluate` takes it; "live" where none is given.
///     false_alarm_percent: Part of the cells that are dark in the target which may exceed the threshold, percent. 1 % takes 99 scenes or more.
///     sets: Names of kinds of scenes with echoes (`kinds()`), each once; 1, 2 and 3 where none are given.
///     count: Scenes of each kind.
///     seed: Seed of the scenes.
///     floor: What lies beneath the reflectors.
///     normalisation: How every map is normalised.
///     radar: The radar; that of table 3.1 where none is given.
///     layout: Numbers of the elements that the method hears in place of the two ends (`layout`).
///     progress: Called with the part that is done, 0 to 1.
///
/// Returns:
///     `eta`, the threshold of Lambda, and what it does on the scenes that chose it: `scenes`, and the means `false_alarm` and `detection`,
///     fractions. `left_to_scenes` is the most that `false_alarm` may be with so many scenes, `((n + 1) rate - 1) / n`: the rest of the rate is
///     the price of few scenes. It is a tenth or less from `scenes_within_a_tenth` scenes on.
///
/// Raises:
///     ValueError: A name is unknown or given twice, the scenes are too few for the rate, or the method can't work on a scene.
#[pyfunction]
#[pyo3(signature = (method=None, *, false_alarm_percent=1.0, sets=None, count=100, seed=0, floor="thesis", normalisation="min-max",
                    radar=None, layout=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn threshold<'py>(
    py: Python<'py>,
    method: Option<&Bound<'py, PyAny>>,
    false_alarm_percent: f64,
    sets: Option<Vec<Bound<'py, PyAny>>>,
    count: i128,
    seed: i128,
    floor: &str,
    normalisation: &str,
    radar: Option<&Radar>,
    layout: Option<&Bound<'py, PyAny>>,
    progress: Progress<'_, 'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let usual = ThresholdSearch::default();
    let kinds = match sets {
        Some(sets) => sets.iter().map(|set| named::<Kind>(&set_name(set)?)).collect::<PyResult<_>>()?,
        None => usual.kinds,
    };
    let search = ThresholdSearch {
        layout: layout_of(layout, &or_default(radar))?,
        radar: or_default(radar),
        floor: named(floor)?,
        normalisation: named(normalisation)?,
        kinds,
        count: whole("count", count)?,
        seed: whole("seed", seed)?,
        false_alarm_percent,
    };
    let method = match method {
        Some(method) => methods::method_of(method, "method")?,
        None => apertura::methods::by_name("live").map_err(value)?,
    };
    let found = work::run(py, progress, |task| search.run(&*method, task, |part| task.set_progress(part)))?;
    let found = found.map_err(|error| methods::caused(py, value(error), std::slice::from_ref(&method)));
    let KeptThreshold { eta, tried } = found?;
    let price = (search.left_to_scenes(tried.scenes), search.scenes_within_a_tenth());
    let figures = (eta, tried.scenes, tried.false_alarm, tried.detection, price.0, price.1);
    py.import("apertura.objects")?.getattr("Threshold")?.call1(figures)
}
