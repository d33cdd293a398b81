//! Examples to train on.

use crate::arrays::{self, both_ends, owned};
use crate::errors::named;
use crate::errors::{system, value};
use crate::radar::{Radar, or_default};
use crate::scene::{purpose_of, set_name};
use crate::work::{self, Progress};
use apertura::maps::channels_map;
use apertura::maps::network_input::mag_phase;
use apertura::network::floors::Floors;
use apertura::network::live::arrays::Arrays;
use apertura::network::live::constants::turn_columns;
use apertura::network::live::dataset::{self as files, DatasetError, DatasetRequest, Part};
use apertura::network::live::examples::{self, Example};
use apertura::network::live::features::{FeatureExtractor, LiveInput};
use apertura::network::live::grid::{COARSE, COARSE_CHANNELS, FINE, FINE_CHANNELS, ROW_CHANNELS, ROWS};
use apertura::network::live::radars::Radars;
use apertura::radar::{Decibels, Tolerances};
use apertura::reconstruct::check_ends;
use apertura::scene::generate::Kind;
use apertura::signal::TwoEnds;
use apertura::task::Task;
use ndarray::{Array, Array1, Array3, ArrayD, IxDyn};
use num_complex::Complex32;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::OnceLock;

/// Makes examples for the live network: example `i` is a function of (mixture, seed, i) alone.
///
/// Args:
///     mixture: Kinds of scenes with their shares, as in "3" or "1=4,2=12,walls=8".
///     seed: Seed of the examples.
///     purpose: "training", "validation" or "test": their scenes never meet.
///     floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
///     thermal: (share, lowest dB, highest dB): this share of the scenes lies over thermal noise at a ratio drawn between the two, the
///         others over the thesis' floor. In place of `floor`.
///     elements: (share, gain in decibels, phase in degrees, place in millimetres): this share of the scenes is heard by elements that are off.
///         Each such scene has its own part of these standard deviations, uniform from none to all. `target` stays that of the array as it should be.
///     radar: The `Radar` that sees all scenes, with 1024 elements, ends of 12 and 512 samples; "random" for one drawn for each scene: 20 to
///         100 GHz, 0.1 to 6 GHz of bandwidth, both conventions, all windows, a quarter of them that of table 3.1. That of table 3.1 where none
///         is given.
///
/// Raises:
///     ValueError: A name is unknown or a number can't be used.
#[pyclass(module = "apertura", frozen)]
pub struct Examples(examples::Examples);

/// Tables of the radar of table 3.1.
static EXTRACTOR: OnceLock<FeatureExtractor> = OnceLock::new();

/// Largest tolerance of elements, in decibels, degrees or millimetres.
const MOST_TOLERANCE: f64 = 360.0;

/// Most examples that one call may ask for.
const MOST: usize = 4096;

#[pymethods]
impl Examples {
    #[new]
    #[pyo3(signature = (mixture, seed=0, *, purpose="training", floor="thesis", thermal=None, elements=None, radar=None))]
    fn new(
        mixture: &str,
        seed: u64,
        purpose: &str,
        floor: &str,
        thermal: Option<(f64, f64, f64)>,
        elements: Option<(f64, f64, f64, f64)>,
        radar: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (floors, arrays, radars) = (floors_of(floor, thermal)?, arrays_of(elements)?, radars_of(radar)?);
        examples::Examples::new(named(mixture)?, purpose_of(purpose)?, seed, floors, arrays, radars)
            .map(Examples)
            .map_err(value)
    }

    /// The radars that a network which learns from these examples is trained for, as a weight file's entry `domain` has them.
    #[getter]
    fn domain(&self) -> PyResult<String> {
        self.0.domain().json().map_err(value)
    }

    /// Examples of these numbers, made in parallel.
    ///
    /// Args:
    ///     indices: Numbers of examples, 0 to 2^32 - 1; at most 4096.
    ///     mag_phase: Whether the thesis' networks' input, `mag_phase` float32 `[4, 512, 1024]`, stands in place of the live network's.
    ///
    /// Returns:
    ///     One dict an example: `ends` complex64 `[2, 12, 512]` and `target` float32 `[512, 1024]` (decades of amplitude), both relative to
    ///     the samples' mean power; the network's input `fine` float32 `[4, 512, 256]`, `coarse` float32 `[10, 512, 64]`, `rows` float32
    ///     `[6, 512]`, `scalars` float32 `[2]`, `constants` float32 `[6]`; `gain` (decades that were taken off), `kind`, `floor` and `radar`.
    ///     The columns of input and target run from left to right as cos(theta) rises, in both conventions.
    ///
    /// Raises:
    ///     ValueError: An example can't be made (silence has no input), or there are too many.
    #[pyo3(signature = (indices, *, mag_phase=false))]
    fn batch<'py>(&self, py: Python<'py>, indices: Vec<u32>, mag_phase: bool) -> PyResult<Bound<'py, PyList>> {
        if indices.len() > MOST {
            return Err(value(format!("{} examples are asked for; at most {MOST} at once", indices.len())));
        }
        let examples = &self.0;
        let make = |index: &u32, task: &Task| {
            let example = examples.example(*index, task)?;
            let input = mag_phase.then(|| mag_phase_of(&example.radar, &example.ends));
            Ok::<_, examples::ExampleError>((example, input))
        };
        let made: Result<Vec<_>, _> =
            work::run(py, None, |task| indices.par_iter().map(|index| make(index, task)).collect())?;
        let dicts: PyResult<Vec<_>> = made.map_err(value)?.into_iter().map(|made| dict_of(py, made)).collect();
        PyList::new(py, dicts?)
    }
}

fn floors_of(floor: &str, thermal: Option<(f64, f64, f64)>) -> PyResult<Floors> {
    let Some((share, from, to)) = thermal else { return Ok(Floors::Fixed(named(floor)?)) };
    let usable = (0.0..=1.0).contains(&share) && from < to && from >= -100.0 && to <= 300.0;
    if !usable {
        let found = format!("thermal is ({share}, {from}, {to})");
        return Err(value(format!(
            "{found}; expected a share of 0 to 1 and two ratios in rising order, -100 to 300 dB"
        )));
    }
    Ok(Floors::Thermal { share, from: Decibels(from), to: Decibels(to) })
}

fn arrays_of(elements: Option<(f64, f64, f64, f64)>) -> PyResult<Arrays> {
    let Some((share, gain, phase_degrees, position_millimetres)) = elements else { return Ok(Arrays::IDEAL) };
    let tolerances = Tolerances { gain: Decibels(gain), phase_degrees, position_millimetres };
    let usable = [gain, phase_degrees, position_millimetres].iter().all(|v| (0.0..=MOST_TOLERANCE).contains(v));
    if !usable || !(0.0..=1.0).contains(&share) {
        let found = format!("elements is ({share}, {gain}, {phase_degrees}, {position_millimetres})");
        return Err(value(format!(
            "{found}; expected a share of 0 to 1 and three tolerances of 0 to {MOST_TOLERANCE}"
        )));
    }
    Ok(Arrays { share, tolerances })
}

fn radars_of(radar: Option<&Bound<'_, PyAny>>) -> PyResult<Radars> {
    let Some(radar) = radar else { return Ok(Radars::default()) };
    if let Ok(radar) = radar.extract::<PyRef<'_, Radar>>() {
        return Ok(Radars::Fixed(Box::new(radar.0.clone())));
    }
    match radar.extract::<String>().as_deref() {
        Ok("random") => Ok(Radars::Random),
        _ => Err(value(format!("radar is {}; expected a Radar, \"random\" or None", radar.repr()?))),
    }
}

/// Writes examples as files: `apertura dataset`. `docs/data.md` says what is in them; `apertura.data.Files` reads them.
///
/// Args:
///     folder: A new folder or an empty one.
///     sets: Names of sets as `Scene.random` takes them for training.
///     count: Scenes of each set for training.
///     validation: For validation; a tenth of `count` where none is given.
///     test: For the test; likewise, but none where "world" is among the sets.
///     seed: Seed of the scenes.
///     floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
///     thermal: (share, lowest dB, highest dB), in place of `floor`, as for `Examples`.
///     dtype: "f16" or "f32", the precision of features and target.
///     arrays: Which of "ends", "features" and "target" to write.
///     shard: Examples of a shard; as many are in memory at once.
///     progress: Called with the part that is done, 0 to 1.
///
/// Raises:
///     ValueError: A name is unknown, a number can't be used, or the folder is not empty.
///     OSError: A file can't be written.
#[pyfunction]
#[pyo3(signature = (folder, sets, *, count, validation=None, test=None, seed=0, floor="thesis", thermal=None, dtype="f16", arrays=None,
                    shard=64, progress=None))]
#[expect(clippy::too_many_arguments, reason = "named in Python")]
pub fn dataset(
    py: Python<'_>,
    folder: PathBuf,
    sets: Vec<Bound<'_, PyAny>>,
    count: u32,
    validation: Option<u32>,
    test: Option<u32>,
    seed: u64,
    floor: &str,
    thermal: Option<(f64, f64, f64)>,
    dtype: &str,
    arrays: Option<Vec<String>>,
    shard: u32,
    progress: Progress<'_, '_>,
) -> PyResult<()> {
    let kinds: PyResult<Vec<Kind>> =
        sets.iter().map(|set| Kind::for_training(&set_name(set)?).map_err(value)).collect();
    let kinds = kinds?;
    let parts: Result<Vec<Part>, _> = match arrays {
        None => Ok(Part::ALL.to_vec()),
        Some(names) => names.iter().map(|name| name.parse()).collect(),
    };
    let request = DatasetRequest {
        counts: DatasetRequest::counts(&kinds, count, validation, test),
        kinds,
        seed,
        floors: floors_of(floor, thermal)?,
        precision: dtype.parse().map_err(value)?,
        parts: parts.map_err(value)?,
        shard,
    };
    work::run(py, progress, |task| files::write(&folder, &request, task))?.map(|_| ()).map_err(|error| match error {
        DatasetError::File { path, source } => system(&source, format!("{}: {source}", path.display())),
        other => value(other),
    })
}

fn shaped(values: Vec<f32>, shape: &[usize]) -> PyResult<ArrayD<f32>> {
    Array::from_shape_vec(IxDyn(shape), values).map_err(value)
}

fn mag_phase_of(radar: &apertura::radar::Radar, ends: &TwoEnds) -> Array3<f32> {
    let [first, last] = [&ends.first, &ends.last].map(|end| channels_map(radar, end.view()));
    let mut maps = mag_phase(&first, &last).mapv(|v| v as f32);
    if let Some(cells) = maps.as_slice_mut() {
        turn_columns(radar, cells);
    }
    maps
}

fn dict_of(py: Python<'_>, made: (Example, Option<Array3<f32>>)) -> PyResult<Bound<'_, PyDict>> {
    let (Example { kind, floor, radar, ends, input, decades }, mag_phase) = made;
    let scale = 10f64.powf(-input.gain);
    let ends = both_ends(&ends).mapv(|v| Complex32::new((v.re * scale) as f32, (v.im * scale) as f32));
    let dict = PyDict::new(py);
    dict.set_item("ends", owned(py, ends))?;
    dict.set_item("gain", input.gain)?;
    match mag_phase {
        Some(mag_phase) => dict.set_item("mag_phase", owned(py, mag_phase))?,
        None => set_input(&dict, input)?,
    }
    dict.set_item("target", owned(py, decades))?;
    dict.set_item("kind", kind.to_string())?;
    dict.set_item("floor", floor.to_string())?;
    dict.set_item("radar", Radar(radar))?;
    Ok(dict)
}

/// The live network's input for the samples of two ends, as in an example of `Examples`: what to feed a network that was trained on these.
///
/// Args:
///     ends: Complex numbers `[2, end_elements, samples]`, of any gain.
///     radar: The radar that sampled them; that of table 3.1 where none is given.
///
/// Returns:
///     `fine` float32 `[4, 512, 256]`, `coarse` float32 `[10, 512, 64]`, `rows` float32 `[6, 512]`, `scalars` float32 `[2]`, `constants`
///     float32 `[6]`, and `gain`: the decades by which `decades` of a map exceed the network's.
///
/// Raises:
///     ValueError: The shape is not the radar's, a sample is not finite, or the radar has not 1024 elements, ends of 12 and 512 samples.
#[pyfunction]
#[pyo3(signature = (ends, radar=None))]
pub fn live_input<'py>(
    py: Python<'py>,
    ends: &Bound<'py, PyAny>,
    radar: Option<&Radar>,
) -> PyResult<Bound<'py, PyDict>> {
    let radar = or_default(radar);
    let ends = arrays::ends(ends, &radar)?;
    let input = work::run(py, None, |_| {
        check_ends(&radar, &ends)?;
        // The usual radar's tables are made once.
        match EXTRACTOR.get() {
            Some(extractor) if radar.of_one_chirp() == apertura::radar::Radar::default() => extractor.extract(&ends),
            _ => {
                let made = FeatureExtractor::new(&radar)?;
                let input = made.extract(&ends);
                if radar.of_one_chirp() == apertura::radar::Radar::default() {
                    let _first = EXTRACTOR.set(made);
                }
                input
            }
        }
    })?;
    let dict = PyDict::new(py);
    set_input(&dict, input.map_err(value)?)?;
    Ok(dict)
}

fn set_input(dict: &Bound<'_, PyDict>, input: LiveInput) -> PyResult<()> {
    let py = dict.py();
    dict.set_item("fine", owned(py, shaped(input.fine, &[FINE_CHANNELS, ROWS, FINE])?))?;
    dict.set_item("coarse", owned(py, shaped(input.coarse, &[COARSE_CHANNELS, ROWS, COARSE])?))?;
    dict.set_item("rows", owned(py, shaped(input.rows, &[ROW_CHANNELS, ROWS])?))?;
    dict.set_item("scalars", owned(py, Array1::from(input.scalars.to_vec())))?;
    dict.set_item("constants", owned(py, Array1::from(input.constants.to_vec())))?;
    dict.set_item("gain", input.gain)
}
