//! Examples to train on.

use crate::arrays::{both_ends, owned};
use crate::errors::value;
use crate::scene::{named, purpose_of};
use crate::work;
use apertura::network::floors::Floors;
use apertura::network::live::examples::{self, Example};
use apertura::network::live::grid::{COARSE, COARSE_CHANNELS, FINE, FINE_CHANNELS, ROW_CHANNELS, ROWS};
use apertura::radar::Decibels;
use ndarray::{Array, Array1, ArrayD, IxDyn};
use num_complex::Complex32;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;

/// Makes examples for the live network: example `i` is a function of (mixture, seed, i) alone.
///
/// Args:
///     mixture: Kinds of scenes with their shares, as in "3" or "1=4,2=12,walls=8".
///     seed: Seed of the examples.
///     purpose: "training", "validation" or "test": their scenes never meet.
///     floor: What lies beneath all scenes: "thesis", "exact", "snr=DB" or "dbm=LEVEL".
///     thermal: (share, lowest dB, highest dB): this share of the scenes lies over thermal noise at a ratio drawn between the two, the
///         others over the thesis' floor. In place of `floor`.
///
/// Raises:
///     ValueError: A name is unknown or a number can't be used.
#[pyclass(module = "apertura", frozen)]
pub struct Examples(examples::Examples);

/// Most examples that one call may ask for.
const MOST: usize = 4096;

#[pymethods]
impl Examples {
    #[new]
    #[pyo3(signature = (mixture, seed=0, *, purpose="training", floor="thesis", thermal=None))]
    fn new(mixture: &str, seed: u64, purpose: &str, floor: &str, thermal: Option<(f64, f64, f64)>) -> PyResult<Self> {
        let floors = match thermal {
            None => Floors::Fixed(named(floor)?),
            Some((share, from, to)) => {
                let usable = (0.0..=1.0).contains(&share) && from < to && from >= -100.0 && to <= 300.0;
                if !usable {
                    let found = format!("thermal is ({share}, {from}, {to})");
                    return Err(value(format!(
                        "{found}; expected a share of 0 to 1 and two ratios in rising order, -100 to 300 dB"
                    )));
                }
                Floors::Thermal { share, from: Decibels(from), to: Decibels(to) }
            }
        };
        examples::Examples::new(named(mixture)?, purpose_of(purpose)?, seed, floors).map(Examples).map_err(value)
    }

    /// Examples of these numbers, made in parallel.
    ///
    /// Args:
    ///     indices: Numbers of examples, 0 to 2^32 - 1; at most 4096.
    ///
    /// Returns:
    ///     One dict an example: `ends` complex64 `[2, 12, 512]` and `target` float32 `[512, 1024]` (decades of amplitude), both relative to
    ///     the samples' mean power; the network's input `fine` float32 `[4, 512, 256]`, `coarse` float32 `[10, 512, 64]`, `rows` float32
    ///     `[6, 512]`, `scalars` float32 `[2]`; `gain` (decades that were taken off), `kind` and `floor`.
    ///
    /// Raises:
    ///     ValueError: An example can't be made (silence has no input), or there are too many.
    fn batch<'py>(&self, py: Python<'py>, indices: Vec<u32>) -> PyResult<Bound<'py, PyList>> {
        if indices.len() > MOST {
            return Err(value(format!("{} examples are asked for; at most {MOST} at once", indices.len())));
        }
        let examples = &self.0;
        let made: Result<Vec<Example>, _> =
            work::run(py, None, |task| indices.par_iter().map(|index| examples.example(*index, task)).collect())?;
        let dicts: PyResult<Vec<_>> = made.map_err(value)?.into_iter().map(|example| dict_of(py, example)).collect();
        PyList::new(py, dicts?)
    }
}

fn shaped(values: Vec<f32>, shape: &[usize]) -> PyResult<ArrayD<f32>> {
    Array::from_shape_vec(IxDyn(shape), values).map_err(value)
}

fn dict_of(py: Python<'_>, example: Example) -> PyResult<Bound<'_, PyDict>> {
    let Example { kind, floor, ends, input, decades } = example;
    let scale = 10f64.powf(-input.gain);
    let ends = both_ends(&ends).mapv(|v| Complex32::new((v.re * scale) as f32, (v.im * scale) as f32));
    let dict = PyDict::new(py);
    dict.set_item("ends", owned(py, ends))?;
    dict.set_item("fine", owned(py, shaped(input.fine, &[FINE_CHANNELS, ROWS, FINE])?))?;
    dict.set_item("coarse", owned(py, shaped(input.coarse, &[COARSE_CHANNELS, ROWS, COARSE])?))?;
    dict.set_item("rows", owned(py, shaped(input.rows, &[ROW_CHANNELS, ROWS])?))?;
    dict.set_item("scalars", owned(py, Array1::from(input.scalars.to_vec())))?;
    dict.set_item("target", owned(py, decades))?;
    dict.set_item("gain", input.gain)?;
    dict.set_item("kind", kind.to_string())?;
    dict.set_item("floor", floor.to_string())?;
    Ok(dict)
}
