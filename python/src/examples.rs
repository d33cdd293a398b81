//! Examples to train on.

use crate::arrays::{self, both_ends, owned};
use crate::errors::{named, value, whole};
use crate::radar::{Radar, or_default};
use crate::scene::{Scene, purpose_of};
use crate::work;
use apertura::evaluate::Target;
use apertura::maps::channels_map;
use apertura::maps::network_input::mag_phase;
use apertura::network::floors::Floors;
use apertura::network::live::arrays::Arrays;
use apertura::network::live::constants::reverse_rows;
use apertura::network::live::examples::{self, EndSamples, Example, ExamplesRequest, Features};
use apertura::network::live::features::{FeatureExtractor, LiveInput};
use apertura::network::live::grid::{COARSE_CHANNELS, COARSE_COLUMNS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS};
use apertura::network::live::radars::Radars;
use apertura::radar::{Decibels, Tolerances};
use apertura::reconstruct::check_ends;
use apertura::signal::TwoEnds;
use apertura::task::Task;
use ndarray::{Array, Array1, Array3, ArrayD, IxDyn};
use num_complex::{Complex32, Complex64};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Makes examples to train on: example `i` is a function of (mixture, seed, i) alone.
///
/// Args:
///     mixture: Kinds of scenes (`kinds()`) with their shares, as in "3" or "1=4,2=12,walls=8".
///     seed: Seed of the examples.
///     purpose: "training", "validation" or "test": their scenes never meet.
///     floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
///     thermal: (share, lowest dB, highest dB): this share of the scenes lies over thermal noise at a ratio drawn between the two, the
///         others over the thesis' floor. In place of `floor`.
///     elements: (share, gain in decibels, phase in degrees, place in millimetres): this share of the scenes is heard by elements that are off.
///         Each such scene has its own part of these standard deviations, uniform from none to all.
///     radar: The `Radar` that sees all scenes; "random" for one drawn for each scene: 1024 elements, ends of 12, 512 samples, 20 to
///         100 GHz, 0.1 to 6 GHz of bandwidth, both conventions, all windows, a quarter of them that of table 3.1. That of table 3.1 where none
///         is given.
///     targets: The maps to learn: "ideal" (of the array as it should be, without noise), "measured" (what the whole array heard: with noise and
///         errors of elements), "calibrated" (with the noise alone).
///     features: Whether the live network's input is made. Where nothing is said, it is before radars of the shape that the shipped one is for (1024
///         elements, ends of 12, 512 samples).
///     layout: Name or numbers of the elements that are heard (`layout`), in place of the two ends.
///
/// Raises:
///     ValueError: A name is unknown, a number can't be used, or a kind finds no room before the radar.
#[pyclass(module = "apertura", frozen)]
pub struct Examples {
    inner: examples::Examples,
    /// The arguments, for pickle.
    fields: Py<PyDict>,
}

/// Tables of the radar of table 3.1.
static EXTRACTOR: OnceLock<FeatureExtractor> = OnceLock::new();

/// Largest tolerance of elements, in decibels, degrees or millimetres.
const MAX_TOLERANCE: f64 = 360.0;

const MAX_EXAMPLES: usize = 4096;

#[pymethods]
impl Examples {
    #[new]
    #[pyo3(signature = (mixture, seed=0, *, purpose="training", floor="thesis", thermal=None, elements=None, radar=None, targets=None,
                        features=None, layout=None))]
    #[expect(clippy::too_many_arguments, reason = "named in Python")]
    fn new(
        py: Python<'_>,
        mixture: &str,
        seed: i128,
        purpose: &str,
        floor: &str,
        thermal: Option<(f64, f64, f64)>,
        elements: Option<(f64, f64, f64, f64)>,
        radar: Option<&Bound<'_, PyAny>>,
        targets: Option<Vec<String>>,
        features: Option<bool>,
        layout: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let radars = radars_of(radar)?;
        let layout = arrays::layout_of(layout, &radars.shape())?;
        let fields = PyDict::new(py);
        fields.set_item("mixture", mixture)?;
        fields.set_item("seed", seed)?;
        fields.set_item("purpose", purpose)?;
        fields.set_item("floor", floor)?;
        fields.set_item("thermal", thermal)?;
        fields.set_item("elements", elements)?;
        fields.set_item("radar", radar)?;
        fields.set_item("targets", &targets)?;
        fields.set_item("features", features)?;
        fields.set_item("layout", &layout)?;
        let request = ExamplesRequest {
            mixture: named(mixture)?,
            purpose: purpose_of(purpose)?,
            seed: whole("seed", seed)?,
            floors: floors_of(floor, thermal)?,
            arrays: arrays_of(elements)?,
            radars,
            targets: targets.map_or(Ok(Target::USUAL.to_vec()), targets_of)?,
            features: match features {
                None => Features::WherePossible,
                Some(true) => Features::Needed,
                Some(false) => Features::No,
            },
            layout,
        };
        let inner = examples::Examples::new(request).map_err(value)?;
        Ok(Examples { inner, fields: fields.unbind() })
    }

    /// The radars that a network which learns from these examples is trained for, as a weight file's entry `domain` has them.
    #[getter]
    fn domain(&self) -> PyResult<String> {
        self.inner.domain().json().map_err(value)
    }

    /// Whether the examples have the live network's input.
    #[getter]
    fn has_features(&self) -> bool {
        self.inner.has_features()
    }

    /// The radar that sees the scene of an example.
    ///
    /// Args:
    ///     index: Number of the example, 0 to 2^32 - 1.
    fn radar(&self, index: i128) -> PyResult<Radar> {
        Ok(Radar(self.inner.radar(whole("index", index)?)))
    }

    /// Examples of these numbers, made in parallel.
    ///
    /// Args:
    ///     indices: Numbers of examples, 0 to 2^32 - 1; at most 4096.
    ///     mag_phase: Whether the thesis' networks' input, `mag_phase` float32 `[4, samples, elements]`, stands in place of the live network's.
    ///     scenes: A `Scene` for each number in place of a generated one, before the example's radar. Noise is that of seed and number.
    ///
    /// Returns:
    ///     One dict an example: `ends` complex64 `[2, end_elements, samples]`, or `heard` complex64 `[elements of the layout, samples]`, and the
    ///     targets `target_ideal`, `target_measured` and `target_calibrated` that were asked for, float32 `[samples, elements]` (decades of
    ///     amplitude), all relative to the samples' mean power; the live network's input `fine` float32 `[4, samples, 256]`, `coarse` float32
    ///     `[10, samples, 64]`, `rows` float32 `[6, samples]`, `scalars` float32 `[2]`, `constants` float32 `[6]`; `gain` (decades that were taken off),
    ///     `kind`, `floor` and `radar`. The columns of input and targets run from left to right as cos(theta) rises, in both conventions
    ///     (`Radar.rising_columns`).
    ///
    /// Raises:
    ///     ValueError: An example can't be made (silence has no input), or there are too many.
    #[pyo3(signature = (indices, *, mag_phase=false, scenes=None))]
    fn batch<'py>(
        &self,
        py: Python<'py>,
        indices: Vec<i128>,
        mag_phase: bool,
        scenes: Option<Vec<PyRef<'py, Scene>>>,
    ) -> PyResult<Bound<'py, PyList>> {
        if indices.len() > MAX_EXAMPLES {
            return Err(value(format!("{} examples are asked for; at most {MAX_EXAMPLES} at once", indices.len())));
        }
        let indices: Vec<u32> = indices.into_iter().map(|index| whole("indices", index)).collect::<PyResult<_>>()?;
        let layout = self.fields.bind(py).get_item("layout")?;
        if mag_phase && layout.is_some_and(|layout| !layout.is_none()) {
            return Err(value("mag_phase is of the two ends; expected no layout beside it"));
        }
        let scenes: Option<Vec<_>> = scenes.map(|scenes| scenes.iter().map(|scene| scene.0.scene.clone()).collect());
        if let Some(scenes) = scenes.as_ref().filter(|scenes| scenes.len() != indices.len()) {
            return Err(value(format!("there are {} scenes; expected {}, one a number", scenes.len(), indices.len())));
        }
        let examples = &self.inner;
        let make = |(place, index): (usize, &u32), task: &Task| {
            let example = match &scenes {
                None => examples.example(*index, task)?,
                Some(scenes) => examples.example_of(scenes[place].clone(), *index, task)?,
            };
            let input = example.ends().filter(|_| mag_phase).map(|ends| mag_phase_of(&example.radar, ends));
            Ok::<_, examples::ExampleError>((example, input))
        };
        let made: Result<Vec<_>, _> =
            work::run(py, None, |task| indices.par_iter().enumerate().map(|numbered| make(numbered, task)).collect())?;
        let dicts: PyResult<Vec<_>> = made.map_err(value)?.into_iter().map(|made| dict_of(py, made)).collect();
        PyList::new(py, dicts?)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Py<PyDict>,))> {
        Ok((py.import("apertura._pickle")?.getattr("examples")?, (self.fields.clone_ref(py),)))
    }
}

/// Names of targets, each once.
fn targets_of(names: Vec<String>) -> PyResult<Vec<Target>> {
    let mut targets = Vec::new();
    for name in names {
        let target: Target = name.parse().map_err(value)?;
        if targets.contains(&target) {
            return Err(value(format!("targets has \"{target}\" twice; expected each once")));
        }
        targets.push(target);
    }
    Ok(targets)
}

pub fn floors_of(floor: &str, thermal: Option<(f64, f64, f64)>) -> PyResult<Floors> {
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

pub fn arrays_of(elements: Option<(f64, f64, f64, f64)>) -> PyResult<Arrays> {
    let Some((share, gain, phase_degrees, position_millimetres)) = elements else { return Ok(Arrays::IDEAL) };
    let tolerances = Tolerances { gain: Decibels(gain), phase_degrees, position_millimetres };
    let usable = [gain, phase_degrees, position_millimetres].iter().all(|v| (0.0..=MAX_TOLERANCE).contains(v));
    if !usable || !(0.0..=1.0).contains(&share) {
        let found = format!("elements is ({share}, {gain}, {phase_degrees}, {position_millimetres})");
        return Err(value(format!("{found}; expected a share of 0 to 1 and three tolerances of 0 to {MAX_TOLERANCE}")));
    }
    Ok(Arrays { share, tolerances })
}

pub fn radars_of(radar: Option<&Bound<'_, PyAny>>) -> PyResult<Radars> {
    let Some(radar) = radar else { return Ok(Radars::default()) };
    if let Ok(radar) = radar.extract::<PyRef<'_, Radar>>() {
        return Ok(Radars::Fixed(Box::new(radar.0.clone())));
    }
    match radar.extract::<String>().as_deref() {
        Ok("random") => Ok(Radars::Random),
        _ => Err(value(format!("radar is {}; expected a Radar, \"random\" or None", radar.repr()?))),
    }
}

fn shaped(values: Vec<f32>, shape: &[usize]) -> PyResult<ArrayD<f32>> {
    Array::from_shape_vec(IxDyn(shape), values).map_err(value)
}

fn mag_phase_of(radar: &apertura::radar::Radar, ends: &TwoEnds) -> Array3<f32> {
    let [first, last] = [&ends.first, &ends.last].map(|end| channels_map(radar, end.view()));
    let mut maps = mag_phase(&first, &last).mapv(|v| v as f32);
    maps.outer_iter_mut().for_each(|mut map| reverse_rows(radar, &mut map));
    maps
}

fn dict_of(py: Python<'_>, made: (Example, Option<Array3<f32>>)) -> PyResult<Bound<'_, PyDict>> {
    let (Example { kind, floor, radar, end_samples, input, gain, targets }, mag_phase) = made;
    let scale = 10f64.powf(-gain);
    let single = |v: &Complex64| Complex32::new((v.re * scale) as f32, (v.im * scale) as f32);
    let dict = PyDict::new(py);
    match end_samples {
        EndSamples::Ends(ends) => dict.set_item("ends", owned(py, both_ends(&ends).map(single)))?,
        EndSamples::Elements(samples) => dict.set_item("heard", owned(py, samples.map(single)))?,
    }
    dict.set_item("gain", gain)?;
    match (mag_phase, input) {
        (Some(mag_phase), _) => dict.set_item("mag_phase", owned(py, mag_phase))?,
        (None, Some(input)) => set_input(&dict, input)?,
        (None, None) => {}
    }
    for (target, map) in targets {
        dict.set_item(target.array(), owned(py, map))?;
    }
    dict.set_item("kind", kind.map_or_else(|| "own".to_owned(), |kind| kind.to_string()))?;
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
///     `fine` float32 `[4, samples, 256]`, `coarse` float32 `[10, samples, 64]`, `rows` float32 `[6, samples]`, `scalars` float32 `[2]`, `constants`
///     float32 `[6]`, and `gain`: the decades by which `decades` of a map exceed the network's.
///
/// Raises:
///     ValueError: The shape is not the radar's, a sample is not finite, or the radar has ends of one element or fewer than 8 samples.
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
    let rows = input.rows.len() / ROW_CHANNELS;
    dict.set_item("fine", owned(py, shaped(input.fine, &[FINE_CHANNELS, rows, FINE_COLUMNS])?))?;
    dict.set_item("coarse", owned(py, shaped(input.coarse, &[COARSE_CHANNELS, rows, COARSE_COLUMNS])?))?;
    dict.set_item("rows", owned(py, shaped(input.rows, &[ROW_CHANNELS, rows])?))?;
    dict.set_item("scalars", owned(py, Array1::from(input.scalars.to_vec())))?;
    dict.set_item("constants", owned(py, Array1::from(input.constants.to_vec())))?;
    dict.set_item("gain", input.gain)
}
