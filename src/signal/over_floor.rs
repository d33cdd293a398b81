//! Echoes over a floor: the core of every simulation of a scene.

use super::floor::{self, Floor};
use super::plan::{BEST_TOLERANCE, FLOOR_TOLERANCE, Plan, amplitude_bound};
use super::run::samples_of;
use super::samples::BeatSignal;
use crate::radar::{BuiltArray, Radar};
use crate::scattering::Echoing;
use crate::task::Task;

/// The scene's echoes at the true positions of `array`, over a floor; `heard` applies the effects of the array before noise is added.
/// Meaningless once `task` is cancelled.
pub(super) fn simulate_echoes(
    radar: &Radar,
    array: &BuiltArray,
    echoing: &Echoing,
    floor: Floor,
    seed: u64,
    heard: impl FnOnce(&mut BeatSignal),
    task: &Task,
) -> BeatSignal {
    let plan = Plan::cheapest(echoing.len(), amplitude_bound(radar, echoing), tolerance(floor));
    let mut signal = BeatSignal { samples: samples_of(radar, array, echoing.into(), &plan, 0..radar.elements, task) };
    heard(&mut signal);
    if task.is_cancelled() {
        return signal;
    }
    if let Some(variance) = floor::noise_variance(radar, echoing, floor) {
        floor::add_noise(&mut signal, &variance, seed);
    }
    signal
}

/// Samples are for any use and kept in f64. Their errors must not show under any normalisation; over a loud floor none may exceed 1e-12.
pub(super) fn tolerance(floor: Floor) -> f64 {
    match floor {
        Floor::Exact => BEST_TOLERANCE,
        Floor::Snr(snr) if snr.0 <= 40.0 => 1e-12,
        Floor::Thesis | Floor::Snr(_) | Floor::Level(_) | Floor::Thermal => FLOOR_TOLERANCE,
    }
}
