//! Methods over many scenes.

use crate::arrays::layout_of;
use crate::errors::{argument, named, system, value, whole};
use crate::methods::{self, caused, methods_of};
use crate::objects;
use crate::radar::{Radar, or_default};
use crate::rows::{dict_of, list_of};
use crate::scene::{Scene, purpose_of, reading_of, set_name};
use crate::work::{self, Progress};
use apertura::evaluate::campaign::{Campaign, CampaignError, Elements};
use apertura::evaluate::rows::{RowFileError, Row, RowFile, RunRows};
use apertura::evaluate::sets::{SceneCase, SceneList, SceneSet};
use apertura::radar::{Decibels, Tolerances};
use apertura::reconstruct::Reconstructor;
use apertura::scene::file::SceneFile;
use apertura::scene::generate::{Kind, Purpose};
use apertura::task::Task;
use pyo3::prelude::*;
use pyo3::types::PyList;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Tries methods on scenes: the rows of `apertura evaluate --rows`.
///
/// Args:
///     methods: Names, `Method`s, functions as `Method.of_function` takes them, and files of weights of the live network, in a list.
///     scenes: Names of kinds (`kinds()`), or `Scene`s, in a list. All `Scene`s are one set called "scenes", before their own radars where `radar` names
///         none.
///     count: Scenes of each kind.
///     seed: Seed of the kinds' scenes.
///     floor: What lies beneath the reflectors.
///     normalisation: How every map is normalised.
///     purpose: "test", "validation" or "training".
///     reading: "program" or "text".
///     radar: The radar; that of table 3.1 where none is given.
///     elements: The elements that hear the scenes: an `Elements`, or standard deviations (gain in decibels, phase in degrees, place in millimetres)
///         with which each scene's are drawn. Those of the scenes where nothing is given.
///     target: The map that outputs are held against: "measured" (what the whole array heard), "ideal" (of the array as it should be, without noise)
///         or "calibrated" (as it should be, over the noise).
///     layout: Name or numbers of the elements that methods hear in place of the two ends (`layout`). Functions then get `heard`, complex128
///         `[elements of the layout, samples]`; "matched-filter", "iaa", "sbl", "omp" and "fista" make maps of it. The other methods hear two ends
///         and refuse.
///     on_row: Called with each row as it is found.
///     progress: Called with the part that is done, 0 to 1.
///     cfar: A detector as `cfar` takes it, which is tried on every output beside the threshold; rows say it in `cfar_detection`,
///         `cfar_false_alarm` and `cfar`.
///     path: A CSV file in the program's format. Each row is appended as it is found, and the same call goes on where a stopped one ended. A file that
///         holds anything else is refused. The first row of a function without weights is made again; a file where it differs is refused, too.
///     overwrite: Whether `path` begins anew, over any content.
///     only: The rows to find, as (set, number of the scene, method), in place of all rows of the run.
///
/// Returns:
///     One dict a row, sorted by set, scene and method: the columns of the program's CSV and what made the row, those that `path` held included.
///     `echoes` and `echoes_found` are texts of six numbers, one for every 10 dB below the strongest echo; None for scenes without bodies. `doubt` is
///     the squared error if every cell were off by `Reconstruction.doubt`, and `within_doubt` the part of the cells that are off by at most it; None for
///     methods that say no doubt.
///
/// Raises:
///     ValueError: A name is unknown or given twice, `count` is 0, a kind finds no room before the radar, a method can't work on a scene, or `path` holds
///         other rows. What a function raised is its cause.
///     OSError: `path` can't be read or written.
#[pyfunction]
#[pyo3(signature = (methods, scenes, *, count=100, seed=0, floor="thesis", normalisation="min-max", purpose="test", reading="program",
                    radar=None, elements=None, target="measured", layout=None, on_row=None, progress=None, path=None, overwrite=false, only=None,
                    cfar=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn evaluate<'py>(
    py: Python<'py>,
    methods: &Bound<'py, PyAny>,
    scenes: &Bound<'py, PyAny>,
    count: i128,
    seed: i128,
    floor: &str,
    normalisation: &str,
    purpose: &str,
    reading: &str,
    radar: Option<&Radar>,
    elements: Option<&Bound<'py, PyAny>>,
    target: &str,
    layout: Option<&Bound<'py, PyAny>>,
    on_row: Option<&Bound<'py, PyAny>>,
    progress: Progress<'_, 'py>,
    path: Option<PathBuf>,
    overwrite: bool,
    only: Option<Vec<Key>>,
    cfar: Option<&str>,
) -> PyResult<Bound<'py, PyList>> {
    let (count, seed) = (whole("count", count)?, whole("seed", seed)?);
    if count == 0 {
        return Err(value("count is 0; expected at least 1"));
    }
    let (purpose, reading) = (purpose_of(purpose)?, reading_of(reading)?);
    let (floor, normalisation) = (named(floor)?, named(normalisation)?);
    let campaign = Campaign {
        layout: layout_of(layout, &or_default(radar))?,
        radar: or_default(radar),
        reading,
        purpose,
        seed,
        count,
        floor,
        normalisation,
        cfar: cfar.map(named).transpose()?,
        elements: elements.map_or(Ok(Elements::OfScenes), elements_of)?,
        target: named(target)?,
        ..Campaign::default()
    };
    let sets = sets_of(scenes, radar, purpose)?;
    let methods = methods_of(methods)?;
    let run = Run::new(campaign, sets, methods, only.map(|only| only.into_iter().collect()))?;
    let mut file = path.as_deref().map(|path| run.open(py, path, overwrite)).transpose()?;
    let mut done = file.as_ref().map_or(0.0, |file| file.present.len() as f64);
    let all = run.rows();
    let rows = work::run_watched(
        py,
        None,
        |task, finder| run.rest(task, file.as_mut(), |row| finder.found(row.clone())),
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
    )?;
    let failure = file.as_mut().and_then(RowFile::failure);
    if let Some(failure) = failure {
        return Err(kept(failure));
    }
    let rows = rows.map_err(|error: CampaignError| caused(py, value(error), &run.methods))?;
    let rows = file.map_or(Ok(rows), |file| file.finish().map_err(kept))?;
    list_of(py, &rows)
}

/// Relative difference up to which two errors of one function on one scene are the same: sums of a network may run in another order.
const SAME_PART: f64 = 0.01;

/// Set, number of the scene, method.
type Key = (String, u32, String);

/// The scenes, methods and rows of an evaluation.
struct Run {
    campaign: Campaign,
    sets: Vec<SceneSet>,
    methods: Vec<Arc<dyn Reconstructor>>,
    only: Option<HashSet<Key>>,
    /// Rows without figures.
    empty: Vec<Vec<Row>>,
}

impl Run {
    fn new(
        campaign: Campaign,
        sets: Vec<SceneSet>,
        methods: Vec<Arc<dyn Reconstructor>>,
        only: Option<HashSet<Key>>,
    ) -> PyResult<Self> {
        let borrowed: Vec<&dyn Reconstructor> = methods.iter().map(AsRef::as_ref).collect();
        let empty = campaign.empty_rows(&sets, &borrowed).map_err(value)?;
        check_only(only.as_ref(), &sets, &borrowed, campaign.count)?;
        Ok(Run { campaign, sets, methods, only, empty })
    }

    fn rows(&self) -> f64 {
        let scenes: f64 = self.sets.iter().map(|set| f64::from(self.campaign.scenes(set))).sum();
        self.only.as_ref().map_or(scenes * self.methods.len() as f64, |only| only.len() as f64)
    }

    fn open(&self, py: Python<'_>, path: &Path, overwrite: bool) -> PyResult<RowFile> {
        let file = RowFile::open(path, &RunRows::new(&self.empty), overwrite).map_err(kept)?;
        for method in self.methods.iter().filter(|method| methods::is_function_without_weights(method.name())) {
            if let Some(row) = file.present.iter().find(|row| *row.method == *method.name()) {
                self.check_function(py, path, row)?;
            }
        }
        Ok(file)
    }

    /// Refuses a file whose row a function of the same name did not make: without weights nothing else tells functions apart.
    fn check_function(&self, py: Python<'_>, path: &Path, row: &Row) -> PyResult<()> {
        let is_other =
            |set: &str, index: u32, method: &str| set != &*row.set || index != row.index || method != &*row.method;
        let methods: Vec<&dyn Reconstructor> = self.methods.iter().map(AsRef::as_ref).collect();
        let again = work::run(py, None, |task| {
            self.campaign.run_rest(&self.sets, &methods, &self.empty, &is_other, task, |_, _, _| {})
        })?;
        let again = again.map_err(|error| caused(py, value(error), &self.methods))?;
        let Some(now) = again.first() else { return Ok(()) };
        let is_near = |a: f64, b: f64| (a - b).abs() <= SAME_PART * a.abs().max(b.abs());
        if is_near(row.squared_error, now.squared_error) && is_near(row.eta.into(), now.eta.into()) {
            return Ok(());
        }
        let Row { set, index, method, .. } = row;
        Err(value(format!(
            "{}: {method} has SE {:.1} and eta {:.4} there on scene {index} of set {set}, and {:.1} and {:.4} now: another function made \
             the file; name another file, or write over this one with overwrite=True (Method.of_function(weights=...) tells networks apart)",
            path.display(),
            row.squared_error,
            row.eta,
            now.squared_error,
            now.eta
        )))
    }

    /// Finds the rows that `file` doesn't hold, and appends them to it.
    fn rest(
        &self,
        task: &Task,
        mut file: Option<&mut RowFile>,
        on_row: impl Fn(&Row),
    ) -> Result<Vec<Row>, CampaignError> {
        let key = |row: &Row| (row.set.to_string(), row.index, row.method.to_string());
        let there: HashSet<Key> = file.iter().flat_map(|file| file.present.iter().map(key)).collect();
        // Most scenes of a long run are left out by their number alone.
        let numbers = self.only.iter().flatten().map(|(_, index, _)| *index);
        let between = numbers.clone().min().unwrap_or(1)..=numbers.max().unwrap_or(0);
        let is_left_out = |set: &str, index: u32, method: &str| {
            let key = || (set.to_owned(), index, method.to_owned());
            let is_asked = self.only.as_ref().is_none_or(|only| between.contains(&index) && only.contains(&key()));
            !is_asked || (!there.is_empty() && there.contains(&key()))
        };
        let methods: Vec<&dyn Reconstructor> = self.methods.iter().map(AsRef::as_ref).collect();
        self.campaign.run_rest(&self.sets, &methods, &self.empty, &is_left_out, task, |row, _, _| {
            on_row(row);
            if file.as_mut().is_some_and(|file| !file.append(row)) {
                task.cancel();
            }
        })
    }
}

/// Kinds and `Scene`s as sets; all `Scene`s are one. A radar that is named sees them in place of their own.
fn sets_of(scenes: &Bound<'_, PyAny>, radar: Option<&Radar>, purpose: Purpose) -> PyResult<Vec<SceneSet>> {
    let single = scenes.extract::<String>().is_ok() || scenes.cast::<Scene>().is_ok();
    let items = if single { None } else { scenes.try_iter().ok() };
    let Some(items) = items else {
        let shown = scenes.repr()?;
        let message = format!("scenes is {shown}; expected a list of kinds or of Scenes, as in [{shown}]");
        return Err(argument(scenes.py(), message));
    };
    let (mut sets, mut cases) = (Vec::new(), Vec::new());
    for item in items {
        let item = item?;
        if let Ok(scene) = item.cast::<Scene>() {
            let SceneFile { scene, radar: own } = scene.get().0.clone();
            let radar = radar.map_or(own, |radar| radar.0.clone());
            scene.validate(&radar).map_err(|e| value(format!("scenes: {e}")))?;
            cases.push(SceneCase { radar, scene });
            continue;
        }
        let name = set_name(&item)?;
        let kind = if purpose == Purpose::Test { named(&name)? } else { Kind::for_training(&name).map_err(value)? };
        sets.push(SceneSet::Generated(kind));
    }
    if !cases.is_empty() {
        sets.push(SceneSet::Listed(SceneList::new("scenes".to_owned(), cases).map_err(value)?));
    }
    if sets.is_empty() {
        return Err(value("scenes is empty; expected at least one kind or Scene"));
    }
    Ok(sets)
}

/// `Elements`, or standard deviations of gain, phase and place.
fn elements_of(any: &Bound<'_, PyAny>) -> PyResult<Elements> {
    if let Ok((gain, phase_degrees, position_millimetres)) = any.extract::<(f64, f64, f64)>() {
        let are_usable = [gain, phase_degrees, position_millimetres].iter().all(|v| (0.0..=360.0).contains(v));
        if !are_usable {
            let found = format!("elements is ({gain}, {phase_degrees}, {position_millimetres})");
            return Err(value(format!("{found}; expected three standard deviations of 0 to 360")));
        }
        return Ok(Elements::Drawn(Tolerances { gain: Decibels(gain), phase_degrees, position_millimetres }));
    }
    if any.hasattr("gain_db")? {
        return Ok(Elements::Built(objects::elements(any)?));
    }
    let message = format!("elements is {}; expected an Elements, or three standard deviations", any.repr()?);
    Err(argument(any.py(), message))
}

fn kept(error: RowFileError) -> PyErr {
    match &error {
        RowFileError::File { source, .. } => system(source, &error),
        RowFileError::Other { .. } => {
            value(format!("{error}; name another file, or write over this one with overwrite=True"))
        }
        RowFileError::Busy(_) | RowFileError::Merge(_) => value(error),
    }
}

/// Refuses rows that are asked for and that the run doesn't have.
fn check_only(
    only: Option<&HashSet<Key>>,
    sets: &[SceneSet],
    methods: &[&dyn Reconstructor],
    count: u32,
) -> PyResult<()> {
    for (set, index, method) in only.into_iter().flatten() {
        let known = sets.iter().any(|s| s.to_string() == *set) && methods.iter().any(|m| m.name() == method);
        let count = sets.iter().find(|s| s.to_string() == *set).and_then(SceneSet::len).unwrap_or(count);
        if !known || *index >= count {
            return Err(value(format!("only: scene {index} of set {set} by {method} is no row of this run")));
        }
    }
    Ok(())
}
