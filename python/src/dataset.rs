//! Examples as files.

use crate::arrays;
use crate::errors::{at, value, whole};
use crate::examples::{arrays_of, floors_of, radars_of};
use crate::scene::set_name;
use crate::work::{self, Progress};
use apertura::network::live::dataset::{self as files, DatasetError, DatasetRequest, ExamplePart};
use apertura::scene::generate::Kind;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Writes examples as files: `apertura dataset`. `docs/data.md` says what is in them; `apertura.data.Files` reads them.
///
/// Args:
///     folder: A new folder or an empty one.
///     sets: Names of kinds (`kinds(training=True)`).
///     count: Scenes of each set for training.
///     validation: For validation; a tenth of `count` where none is given.
///     test: For the test; likewise, but none where "world" is among the sets.
///     seed: Seed of the scenes.
///     floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
///     thermal: (share, lowest dB, highest dB), in place of `floor`, as for `Examples`.
///     elements: Elements that are off, as for `Examples`.
///     radar: The `Radar` that sees all scenes, or "random", as for `Examples`; that of table 3.1 where none is given.
///     layout: Numbers of the elements that are heard, in place of the two ends: the array "heard" then stands in place of "ends".
///     dtype: "f16" or "f32", the precision of features and targets.
///     arrays: Which of "ends", "features", "target_ideal", "target_measured" and "target_calibrated" to write; all but the last where nothing is
///         said, and features only before radars that have the live network's.
///     shard: Examples of a shard; as many are in memory at once.
///     progress: Called with the part that is done, 0 to 1.
///
/// Raises:
///     ValueError: A name is unknown, a number can't be used, or the folder is not empty.
///     OSError: A file can't be written.
#[pyfunction]
#[pyo3(signature = (folder, sets, *, count, validation=None, test=None, seed=0, floor="thesis", thermal=None, elements=None, radar=None,
                    layout=None, dtype="f16", arrays=None, shard=64, progress=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn dataset(
    py: Python<'_>,
    folder: PathBuf,
    sets: Vec<Bound<'_, PyAny>>,
    count: i128,
    validation: Option<i128>,
    test: Option<i128>,
    seed: i128,
    floor: &str,
    thermal: Option<(f64, f64, f64)>,
    elements: Option<(f64, f64, f64, f64)>,
    radar: Option<&Bound<'_, PyAny>>,
    layout: Option<&Bound<'_, PyAny>>,
    dtype: &str,
    arrays: Option<Vec<String>>,
    shard: i128,
    progress: Progress<'_, '_>,
) -> PyResult<()> {
    let kinds: PyResult<Vec<Kind>> =
        sets.iter().map(|set| Kind::for_training(&set_name(set)?).map_err(value)).collect();
    let kinds = kinds?;
    let radars = radars_of(radar)?;
    let layout = arrays::layout_of(layout, &radars.shape())?;
    let parts: Result<Vec<ExamplePart>, _> = match arrays {
        None => Ok(ExamplePart::usual(&radars, layout.as_deref())),
        Some(names) => names.iter().map(|name| name.parse()).collect(),
    };
    let further = |name: &str, count: Option<i128>| count.map(|count| whole(name, count)).transpose();
    let (validation, test) = (further("validation", validation)?, further("test", test)?);
    let request = DatasetRequest {
        counts: DatasetRequest::counts(&kinds, whole("count", count)?, validation, test),
        kinds,
        seed: whole("seed", seed)?,
        floors: floors_of(floor, thermal)?,
        arrays: arrays_of(elements)?,
        radars,
        layout,
        precision: dtype.parse().map_err(value)?,
        parts: parts.map_err(value)?,
        shard: whole("shard", shard)?,
    };
    work::run(py, progress, |task| files::write(&folder, &request, task))?.map(|_| ()).map_err(|error| match error {
        DatasetError::File { path, source } => at(&path)(source),
        other => value(other),
    })
}
