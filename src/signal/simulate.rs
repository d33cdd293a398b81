//! Samples of a scene over a floor.

use super::built::{simulate_built_for, tolerance};
use super::plan::amplitude_bound;
use super::run::samples_of;
use super::{BeatSignal, Floor, SimulationError, SimulationResult, SynthesisPlan, TwoEnds, floor};
use crate::radar::{BuiltArray, End, Radar};
use crate::scattering::EchoSources;
use crate::scene::{Scene, SceneError};
use crate::task::Task;

/// Beat signal of a scene over `floor`, with noise by `seed`.
///
/// The algorithm is the fastest with an error far below the floor. [`Floor::Thesis`] has exact phases and noise with the power of the rounding errors
/// in the thesis' program, which [`super::direct::beat_signal`] repeats. The same arguments give the same bits on the same instruction set, on any
/// number of threads.
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn simulate(radar: &Radar, scene: &Scene, floor: Floor, seed: u64) -> Result<BeatSignal, SceneError> {
    simulate_for(&Task::default(), radar, scene, floor, seed).map_err(SimulationError::of_scene)
}

/// As [`simulate`].
/// # Errors
/// [`SimulationError`] when the scene can't be simulated, and after a cancellation of `task`.
pub fn simulate_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    floor: Floor,
    seed: u64,
) -> SimulationResult<BeatSignal> {
    simulate_built_for(task, radar, scene, &scene.disturbances.elements_of(radar), floor, seed)
}

/// The two ends of [`simulate`]'s signal, bit for bit, without the elements between them.
/// # Errors
/// [`SimulationError`] when the scene can't be simulated, and after a cancellation of `task`.
pub fn simulate_ends_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    floor: Floor,
    seed: u64,
) -> SimulationResult<TwoEnds> {
    if !scene.disturbances.is_none_to(radar) {
        return Ok(simulate_for(task, radar, scene, floor, seed)?.two_ends(radar));
    }
    scene.validate(radar)?;
    let echoing = EchoSources::of(radar, scene);
    let plan = SynthesisPlan::cheapest(echoing.len(), amplitude_bound(radar, &echoing), tolerance(floor));
    let variance = floor::noise_variance(radar, &echoing, floor);
    let [first, last] = End::BOTH.map(|end| {
        let elements = radar.end_range(end);
        let mut samples = samples_of(radar, &BuiltArray::default(), (&echoing).into(), &plan, elements.clone(), task);
        if let Some(variance) = &variance {
            floor::add_noise_from(&mut samples, elements.start, &variance[elements], seed);
        }
        samples
    });
    task.check()?;
    Ok(TwoEnds { first, last })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::scene::{Block, Object, Point, Wall};

    #[test]
    fn the_ends_alone_are_those_of_the_whole_array_bit_for_bit() {
        let objects = vec![
            Object::Wall(Wall::new(-1.0, 3.0, 2.0, 10.0)),
            Object::Box(Block::new([0.3, 2.0], [0.5, 0.4], 80.0)),
            Object::Point(Point::new(0.2, 4.0)),
        ];
        let odd = Radar { elements: 90, samples: 60, end_elements: 7, ..Radar::default() };
        let mut cases = vec![(odd.clone(), Scene { objects, ..Scene::default() })];
        for radar in [Radar::default(), odd] {
            let max = radar.max_range_metres();
            for count in [1, 3, 30] {
                let place = |i: usize| (0.7 * i as f64 - 3.0, 1.0 + (0.31 * i as f64 * max) % (1.2 * max));
                cases.push((radar.clone(), Scene::of_points((0..count).map(place))));
            }
        }
        for (radar, scene) in cases {
            for floor in [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(20.0)), Floor::Snr(Decibels(60.0))] {
                let whole = simulate(&radar, &scene, floor, 3).unwrap().two_ends(&radar);
                let ends = simulate_ends_for(&Task::default(), &radar, &scene, floor, 3).unwrap();
                assert_eq!(ends, whole, "{scene:?} over {floor}");
            }
        }
    }
}
