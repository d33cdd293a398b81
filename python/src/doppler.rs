//! Range-Doppler maps of scenes whose objects move.

use crate::arrays::owned;
use crate::errors::{named, value, whole};
use crate::radar::Radar;
use crate::scene::Scene;
use crate::work;
use apertura::maps::doppler;
use apertura::signal::{Floor, SimulationError, simulate_chirps_for};
use num_complex::Complex64;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;

/// Scene, radar and noise of a simulation of chirps.
struct Chirps {
    scene: apertura::scene::Scene,
    radar: apertura::radar::Radar,
    floor: Floor,
    seed: u64,
}

impl Chirps {
    /// The scene as it stands after `seconds`; arguments that are not given are the scene's own.
    fn of(scene: &Scene, radar: Option<&Radar>, floor: &str, seed: Option<i128>, seconds: f64) -> PyResult<Self> {
        if !seconds.is_finite() {
            return Err(value(format!("seconds is {seconds}; expected a finite number")));
        }
        Ok(Chirps {
            scene: scene.0.scene.at(seconds),
            radar: radar.map_or_else(|| scene.0.radar.clone(), |r| r.0.clone()),
            floor: named(floor)?,
            seed: seed.map_or(Ok(scene.0.scene.noise_seed), |seed| whole("seed", seed))?,
        })
    }
}

/// Power over range and radial velocity, float64 `[samples, chirps]`, mean over up to 4 elements of each end. Row k is range
/// `radar.range_metres[k]`, column k velocity `radar.velocity_metres_per_second[k]`.
///
/// Args:
///     scene: The scene; its objects move by their velocities.
///     radar: The radar; that of the scene where none is given. It sends `radar.chirps` chirps.
///     floor: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL"; every chirp has noise of its own.
///     seed: Picks the noise; that of the scene where none is given.
///     seconds: Time at which the scene is looked at.
///     progress: Called with the part that is done, 0 to 1.
///
/// Raises:
///     ValueError: A name is unknown, or the radar can't see the scene.
#[pyfunction]
#[pyo3(signature = (scene, radar=None, *, floor="thesis", seed=None, seconds=0.0, progress=None))]
pub fn range_doppler<'py>(
    py: Python<'py>,
    scene: &Scene,
    radar: Option<&Radar>,
    floor: &str,
    seed: Option<i128>,
    seconds: f64,
    progress: work::Progress<'_, '_>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let Chirps { scene, radar, floor, seed } = Chirps::of(scene, radar, floor, seed, seconds)?;
    let map = work::run(py, progress, |task| doppler::range_doppler_for(task, &radar, &scene, floor, seed))?;
    Ok(owned(py, map.map_err(|error: SimulationError| value(error))?.power))
}

/// Samples of every chirp while objects move: what `range_doppler` is made of.
///
/// Args:
///     scene: The scene; its objects move by their velocities.
///     radar: The radar; that of the scene where none is given. It sends `radar.chirps` chirps.
///     floor: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL"; every chirp has noise of its own.
///     seed: Picks the noise; that of the scene where none is given.
///     seconds: Time at which the first chirp is sent.
///     progress: Called with the part that is done, 0 to 1.
///
/// Returns:
///     complex128 `[chirps, elements, samples]` of up to 4 elements of each end, those farthest out: elements 0 to 3 and the last 4.
///
/// Raises:
///     ValueError: A name is unknown, or the radar can't see the scene.
#[pyfunction]
#[pyo3(signature = (scene, radar=None, *, floor="thesis", seed=None, seconds=0.0, progress=None))]
pub fn chirp_samples<'py>(
    py: Python<'py>,
    scene: &Scene,
    radar: Option<&Radar>,
    floor: &str,
    seed: Option<i128>,
    seconds: f64,
    progress: work::Progress<'_, '_>,
) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
    let Chirps { scene, radar, floor, seed } = Chirps::of(scene, radar, floor, seed, seconds)?;
    let found = work::run(py, progress, |task| simulate_chirps_for(task, &radar, &scene, floor, seed))?;
    Ok(owned(py, found.map_err(|error: SimulationError| value(error))?.samples))
}
