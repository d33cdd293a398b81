//! Samples of several chirps while objects move.
//!
//! Within a chirp the range of every echo is linear in time, from its value at the beginning of the chirp to that at the beginning of the next:
//! `R + D n / N` at sample `n` of `N` in equation 3.3. The neglected curvature of the range is at most `v^2 Tc^2 / (8 R)` metres for a speed `v` at
//! range `R` and an interval `Tc`: 3e-9 m for 20 m/s at 10 m and 25.6 microseconds. Amplitudes are those at the beginning of the chirp. Echoes of a
//! body that appear or vanish between two chirps have a constant range.
//!
//! Objects at rest are evaluated once, by the algorithms of a single chirp. Without moving objects the first chirp has the bits of
//! [`simulate_ends_for`](super::simulate_ends_for). Each chirp has its own noise. An interferer is the same in every chirp.

use super::built::{disturb, tolerance};
use super::path::Path;
use super::phase::{Echo, EchoModel};
use super::plan::amplitude_bound;
use super::run::samples_of;
use super::{BeatSignal, Floor, SimulationResult, SynthesisPlan, floor};
use crate::radar::{BuiltArray, Radar};
use crate::scattering::{EchoSources, ObjectWithOccluders, PathEcho, Sources};
use crate::scene::{Object, Scene, SceneError};
use crate::task::Task;
use ndarray::{Array2, Array3, Axis, concatenate, s};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Most elements of each end, the outermost, whose chirps are evaluated.
pub const MAX_END_ELEMENTS: usize = 4;

/// Samples between exact evaluations of a running phasor.
const RESTART_SAMPLES: usize = 128;

/// Number of independent phasor recurrences, which hide the latency of a multiplication.
const PHASOR_LANES: usize = 8;

/// Noise streams of one chirp: the largest number of elements of a radar.
const STREAMS_PER_CHIRP: usize = 65536;

/// Samples of all chirps at the outer elements of both ends.
#[derive(Debug, Clone, PartialEq)]
pub struct ChirpSamples {
    /// `[chirps, elements, samples]`.
    pub samples: Array3<Complex64>,
}

impl ChirpSamples {
    /// Removes static clutter: subtracts the mean over all chirps from each element and sample.
    pub fn remove_static(&mut self) {
        if let Some(mean) = self.samples.mean_axis(Axis(0)) {
            self.samples.outer_iter_mut().for_each(|mut chirp| chirp -= &mean);
        }
    }
}

/// The elements that are evaluated: the [`MAX_END_ELEMENTS`] outermost of each end.
pub fn chirp_elements(radar: &Radar) -> [Range<usize>; 2] {
    let count = radar.end_elements.min(MAX_END_ELEMENTS);
    [0..count, radar.elements - count..radar.elements]
}

/// Samples of every chirp of `radar` over `floor`, with noise by `seed`.
/// # Errors
/// [`SimulationError`](super::SimulationError) when the scene can't be simulated, at the first chirp or at the last, and after a cancellation of `task`.
pub fn simulate_chirps_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    floor: Floor,
    seed: u64,
) -> SimulationResult<ChirpSamples> {
    scene.validate(radar)?;
    let array = &*scene.disturbances.elements_of(radar);
    array.validate(radar).map_err(SceneError::Elements)?;
    let moving = Moving::of(scene);
    if moving != Moving::Nothing {
        scene.at(radar.chirps as f64 * radar.chirp_interval_seconds).validate(radar)?;
    }
    let ranges = chirp_elements(radar);
    let base = rest_samples(task, radar, scene, &moving.rest(radar, scene), floor, &ranges);
    let variance = floor::noise_variance(radar, &EchoSources::of(radar, scene), floor);
    let mut samples = Array3::zeros((radar.chirps, base.nrows(), radar.samples));
    let elements: Vec<usize> = ranges.iter().cloned().flatten().collect();
    let motion = Motion { radar, scene, array, moving: &moving, elements: &elements, model: EchoModel::new(radar) };
    samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(chirp, mut samples)| {
        if task.is_cancelled() {
            return;
        }
        samples.assign(&base);
        motion.add(chirp, &mut samples);
        for (row, n) in elements.iter().enumerate() {
            let mut samples = samples.row_mut(row);
            if let Some(variance) = &variance {
                let deviation = variance[*n].sqrt();
                let noise = floor::unit_noise(seed, chirp * STREAMS_PER_CHIRP + n);
                samples.iter_mut().zip(noise).for_each(|(sample, noise)| *sample += noise * deviation);
            }
            if array.element(*n).dead {
                samples.fill(Complex64::default());
            }
        }
    });
    task.check()?;
    Ok(ChirpSamples { samples })
}

/// The echoes that change from chirp to chirp.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Moving {
    Nothing,
    /// Those of moving objects, which don't influence the others.
    Objects,
    Everything,
}

impl Moving {
    fn of(scene: &Scene) -> Moving {
        let body_moves = scene.shadows && scene.objects.iter().any(|o| o.body().is_some() && o.is_moving());
        match scene.is_moving() {
            false => Moving::Nothing,
            true if body_moves || (scene.has_bodies() && scene.disturbances.mirror.is_some()) => Moving::Everything,
            true => Moving::Objects,
        }
    }

    fn rest(self, radar: &Radar, scene: &Scene) -> EchoSources {
        match self {
            Moving::Nothing => EchoSources::of(radar, scene),
            Moving::Objects => echoing_of(radar, scene, |object| !object.is_moving()),
            Moving::Everything => EchoSources::default(),
        }
    }

    fn at(self, radar: &Radar, scene: &Scene, seconds: f64) -> EchoSources {
        match self {
            Moving::Nothing => EchoSources::default(),
            Moving::Objects => echoing_of(radar, &scene.at(seconds), Object::is_moving),
            Moving::Everything => EchoSources::of(radar, &scene.at(seconds)),
        }
    }
}

fn echoing_of(radar: &Radar, scene: &Scene, keep: impl Fn(&Object) -> bool) -> EchoSources {
    if !scene.has_bodies() {
        let objects = scene.objects.iter().filter(|o| keep(o)).cloned().collect();
        let disturbances = scene.disturbances.clone();
        return EchoSources::of(radar, &Scene { objects, disturbances, ..Scene::default() });
    }
    let seen = ObjectWithOccluders::all(radar, scene);
    let kept: Vec<ObjectWithOccluders> = seen.into_iter().filter(|seen| keep(&seen.object)).collect();
    EchoSources::of_objects(radar, &kept)
}

fn rest_samples(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    rest: &EchoSources,
    floor: Floor,
    ranges: &[Range<usize>; 2],
) -> Array2<Complex64> {
    let plan = SynthesisPlan::cheapest(rest.len(), amplitude_bound(radar, rest), tolerance(floor));
    let array = &*scene.disturbances.elements_of(radar);
    let of = |range: Range<usize>| samples_of(radar, array, rest.into(), &plan, range, task);
    let [first, last] = if scene.disturbances.is_none_to(radar) {
        ranges.clone().map(of)
    } else {
        let mut signal = BeatSignal { samples: of(0..radar.elements) };
        disturb(radar, scene, array, &mut signal);
        ranges.clone().map(|range| signal.samples.slice(s![range, ..]).to_owned())
    };
    let empty = || Array2::zeros((first.nrows() + last.nrows(), radar.samples));
    concatenate(Axis(0), &[first.view(), last.view()]).unwrap_or_else(|_| empty())
}

struct Motion<'a> {
    radar: &'a Radar,
    scene: &'a Scene,
    array: &'a BuiltArray,
    moving: &'a Moving,
    elements: &'a [usize],
    model: EchoModel,
}

impl Motion<'_> {
    fn add(&self, chirp: usize, samples: &mut ndarray::ArrayViewMut2<'_, Complex64>) {
        if *self.moving == Moving::Nothing {
            return;
        }
        let seconds = |chirp: usize| chirp as f64 * self.radar.chirp_interval_seconds;
        let [now, next] = [chirp, chirp + 1].map(|c| self.moving.at(self.radar, self.scene, seconds(c)));
        // Where a point moves into the shadow of a body, the echoes have other indices.
        let is_alike = now.points.len() == next.points.len();
        let fastest = self.scene.objects.iter().map(Object::velocity_metres_per_second);
        let fastest = fastest.fold(0.0, |max: f64, [x, y]| max.max(x.hypot(y)));
        let part = self.radar.chirp_seconds / self.radar.chirp_interval_seconds;
        let max_metres = (1.0 + 1e-6) * fastest * self.radar.chirp_interval_seconds + 1e-12;
        let (mut echoes, mut later, mut scattered) = (Vec::new(), Vec::new(), Vec::new());
        for (row, n) in self.elements.iter().enumerate() {
            let mut row = samples.row_mut(row);
            let Some(samples) = row.as_slice_mut() else { return };
            self.echoes(*n, &now, &mut echoes, &mut scattered);
            self.echoes(*n, &next, &mut later, &mut scattered);
            let response = match self.array.element(*n) {
                error if error.dead || error.gain.0 != 0.0 || error.phase_degrees != 0.0 => error.response(),
                _ => Complex64::from(1.0),
            };
            for (i, echo) in echoes.iter().enumerate().filter(|(_, echo)| echo.amplitude != 0.0) {
                let next = later.get(i).filter(|next| is_alike && next.amplitude != 0.0);
                let change = next.map_or(0.0, |next| next.distance_metres - echo.distance_metres);
                self.add_echo(echo, if change.abs() <= max_metres { change * part } else { 0.0 }, response, samples);
            }
        }
    }

    /// Replaces `out` by the echoes at element `n`, in the same order for all elements; hidden ones have amplitude 0.
    fn echoes(&self, n: usize, echoing: &EchoSources, out: &mut Vec<Echo>, scattered: &mut Vec<PathEcho>) {
        let pair = self.array.pair(self.radar, n);
        out.clear();
        out.extend(echoing.points.iter().map(|r| self.model.echo(pair, r)));
        Sources::from(echoing).scattered(pair, scattered);
        let path = |e: &PathEcho| Path::new([e.range_metres], [e.amplitude]);
        out.extend(scattered.iter().map(|e| self.model.of_path::<1, false>(path(e)).first()));
    }

    fn add_echo(&self, echo: &Echo, change_metres: f64, gain: Complex64, samples: &mut [Complex64]) {
        let per_sample = change_metres / self.radar.samples as f64;
        let carrier = self.radar.carrier_turns_per_metre() * per_sample;
        let beat = self.radar.beat_turns_per_metre(1.0) * per_sample;
        let step = echo.turns_at(1) - echo.turns_at(0) + carrier;
        let lanes = PHASOR_LANES as f64;
        // Growth of the phase's step from one sample, lane or vector to the next.
        let [bend, leap_over_lane, leap_over_vector] =
            [1.0, lanes, lanes * lanes].map(|times| Complex64::cis(TAU * 2.0 * beat * times));
        for (block, samples) in samples.chunks_mut(RESTART_SAMPLES).enumerate() {
            let n = (block * RESTART_SAMPLES) as f64;
            let turns = echo.turns_at(block * RESTART_SAMPLES) + (carrier + beat * n) * n;
            let mut turn = Complex64::cis(TAU * (step + beat * (2.0 * n + 1.0)));
            let mut phasors = [gain * Complex64::from_polar(echo.amplitude, TAU * turns); PHASOR_LANES];
            // From each sample to that of its lane in the next vector.
            let mut leaps = [Complex64::cis(TAU * lanes * (step + beat * (2.0 * n + lanes))); PHASOR_LANES];
            for lane in 1..PHASOR_LANES {
                phasors[lane] = phasors[lane - 1] * turn;
                turn *= bend;
                leaps[lane] = leaps[lane - 1] * leap_over_lane;
            }
            for vector in samples.chunks_mut(PHASOR_LANES) {
                for (lane, sample) in vector.iter_mut().enumerate() {
                    *sample += phasors[lane];
                    phasors[lane] *= leaps[lane];
                    leaps[lane] *= leap_over_vector;
                }
            }
        }
    }
}
