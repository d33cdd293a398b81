//! The signal at an array with element errors.

use super::plan::{BEST_TOLERANCE, FLOOR_TOLERANCE, amplitude_bound};
use super::run::samples_of;
use super::{BeatSignal, Floor, SimulationError, SimulationResult, SynthesisPlan, floor};
use crate::radar::{BuiltArray, Radar};
use crate::scattering::EchoSources;
use crate::scene::{Interferer, Scene, SceneError};
use crate::task::Task;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Beat signal of a scene at `array`, with the scene's ghosts and interferer, over `floor` with noise by `seed`. The noise does not depend on an
/// element's gain. The samples of dead elements are zeros.
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn simulate_built(
    radar: &Radar,
    scene: &Scene,
    array: &BuiltArray,
    floor: Floor,
    seed: u64,
) -> Result<BeatSignal, SceneError> {
    simulate_built_for(&Task::default(), radar, scene, array, floor, seed).map_err(SimulationError::of_scene)
}

/// As [`simulate_built`], with an error after a cancellation of `task`. Noise is added after interference, gains and phases.
pub(super) fn simulate_built_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    array: &BuiltArray,
    floor: Floor,
    seed: u64,
) -> SimulationResult<BeatSignal> {
    scene.validate(radar)?;
    array.validate(radar).map_err(SceneError::Elements)?;
    let echoing = EchoSources::of(radar, scene);
    let plan = SynthesisPlan::cheapest(echoing.len(), amplitude_bound(radar, &echoing), tolerance(floor));
    let mut signal =
        BeatSignal { samples: samples_of(radar, array, (&echoing).into(), &plan, 0..radar.elements, task) };
    disturb(radar, scene, array, &mut signal);
    task.check()?;
    if let Some(variance) = floor::noise_variance(radar, &echoing, floor) {
        floor::add_noise(&mut signal, &variance, seed);
    }
    for (n, mut samples) in signal.samples.outer_iter_mut().enumerate() {
        if array.element(n).dead {
            samples.fill(Complex64::default());
        }
    }
    Ok(signal)
}

/// Tolerance of the samples over `floor`: errors must be invisible in maps of any normalisation.
pub(super) fn tolerance(floor: Floor) -> f64 {
    match floor {
        Floor::Exact => BEST_TOLERANCE,
        Floor::Snr(snr) if snr.0 <= 40.0 => 1e-12,
        Floor::Thesis | Floor::Snr(_) | Floor::Level(_) | Floor::Thermal => FLOOR_TOLERANCE,
    }
}

/// Adds the scene's interferer at the elements of `array`, then applies gain and phase of each element.
pub(super) fn disturb(radar: &Radar, scene: &Scene, array: &BuiltArray, signal: &mut BeatSignal) {
    if let Some(interferer) = &scene.disturbances.interferer {
        add_interference(radar, array, interferer, signal);
    }
    apply_responses(array, signal);
}

/// Multiplies by gain and phase of each element; the samples of an element without errors keep their bits.
pub fn apply_responses(array: &BuiltArray, signal: &mut BeatSignal) {
    for (mut samples, error) in signal.samples.outer_iter_mut().zip(&array.elements) {
        if error.dead || error.gain.0 != 0.0 || error.phase_degrees != 0.0 {
            let response = error.response();
            samples.iter_mut().for_each(|v| *v *= response);
        }
    }
}

/// Order of the receiver's low-pass filter: gain `1 / sqrt(1 + (2f)^(2 n))` at f turns a sample.
const FILTER_ORDER: i32 = 8;

/// Adds the signal of `interferer` at each element. The difference between its frequency and the radar's is a chirp, zero at `crossing`, which passes
/// the receiver's filter below half a turn a sample. Propagation is one-way for both carriers.
pub fn add_interference(radar: &Radar, array: &BuiltArray, interferer: &Interferer, signal: &mut BeatSignal) {
    let samples = radar.samples as f64;
    let sweep = 1.0 / (interferer.duration * samples);
    let beat = |k: usize| {
        let since = k as f64 - interferer.crossing * samples;
        let gain = 1.0 / (1.0 + (2.0 * (sweep * since)).powi(2 * FILTER_ORDER)).sqrt();
        Complex64::from_polar(gain, TAU * (0.5 * sweep * since * since).fract())
    };
    let chirp: Vec<Complex64> = (0..radar.samples).map(beat).collect();
    let sign = radar.carrier_turns_per_metre().signum();
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut samples)| {
        let [_, [receiver_x, receiver_y]] = array.pair(radar, n).places_metres();
        let across = interferer.x_metres - receiver_x;
        let ahead = interferer.y_metres - receiver_y;
        let distance = across.hypot(ahead);
        let gain = radar.pattern().map_or(1.0, |pattern| pattern.amplitude(ahead / distance));
        let amplitude = gain * radar.transmit_power_watts * interferer.strength / distance;
        let turns = (sign * distance / radar.wavelength_metres()).fract();
        let factor = Complex64::from_polar(amplitude, TAU * turns);
        samples.iter_mut().zip(&chirp).for_each(|(v, c)| *v += factor * c);
    });
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::radar::{Decibels, ElementError, LinkBudget};
    use crate::scene::{Mirror, Object, Point, Post, Reflector, Wall};
    use crate::signal::simulate;

    pub fn small() -> Radar {
        Radar { elements: 64, ..Radar::default() }
    }

    pub fn two_points() -> Scene {
        Scene::of_points([(2.0, 11.0), (-6.0, 19.0)])
    }

    #[test]
    fn a_dead_element_has_zeros() {
        let (radar, scene) = (small(), two_points());
        let ideal = simulate(&radar, &scene, Floor::Thesis, 3).unwrap();
        let same = simulate_built(&radar, &scene, &BuiltArray::default(), Floor::Thesis, 3).unwrap();
        assert_eq!(ideal, same);
        let mut array = BuiltArray { elements: vec![ElementError::default(); 64] };
        array.elements[5].dead = true;
        array.elements[6].gain = Decibels(20.0);
        let built = simulate_built(&radar, &scene, &array, Floor::Exact, 3).unwrap();
        let exact = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        assert!(built.samples.row(5).iter().all(|v| v.norm() == 0.0));
        assert!((built.samples[[6, 9]] / exact.samples[[6, 9]] - 10.0).norm() < 1e-9);
        assert_eq!(built.samples.row(8), exact.samples.row(8));
    }

    #[test]
    fn an_undisturbed_scene_keeps_its_bits() {
        let (radar, plain) = (small(), two_points());
        let mut scene = plain.clone();
        scene.disturbances.elements = BuiltArray { elements: vec![ElementError::default(); 64] };
        for floor in [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(30.0))] {
            let ideal = simulate(&radar, &plain, floor, 3).unwrap();
            assert_eq!(simulate(&radar, &scene, floor, 3).unwrap(), ideal, "a list of ideal elements disturbs nothing");
        }
        scene.disturbances.mirror = Some(Mirror::default());
        let mirrored = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        let ghosts = Scene::of_points([]);
        assert_eq!(simulate(&radar, &ghosts, Floor::Exact, 3).unwrap().peak(), 0.0);
        let point =
            |r: Reflector| Object::Point(Point { reflectivity: r.reflectivity, ..Point::new(r.x_metres, r.y_metres) });
        let objects = scene.echoing(&radar).into_iter().map(point).collect();
        let explicit = Scene { objects, ..Scene::default() };
        assert_eq!(explicit.objects.len(), 5, "three ghosts of the point before the wall, none of that behind it");
        assert_eq!(simulate(&radar, &explicit, Floor::Exact, 3).unwrap(), mirrored);
        scene.disturbances.elements.elements[5].dead = true;
        let ends = crate::signal::simulate_ends_for(&Task::default(), &radar, &scene, Floor::Thesis, 3).unwrap();
        assert_eq!(ends, simulate(&radar, &scene, Floor::Thesis, 3).unwrap().two_ends(&radar));
        assert_eq!(ends.first.row(5).iter().map(|v| v.norm()).sum::<f64>(), 0.0);
    }

    #[test]
    fn an_element_off_the_line_has_the_phase_of_its_distance() {
        let radar = small();
        let array = BuiltArray::default().bent(&radar, 3.0);
        let forward = array.forward_metres(7);
        assert!(forward < -1e-4, "{forward}");
        let turned = |scene: &Scene| {
            let heard = |array| simulate_built(&radar, scene, array, Floor::Exact, 0).unwrap().samples[[7, 0]];
            heard(&array) / heard(&BuiltArray::default())
        };
        let of_metres = |metres: f64| std::f64::consts::TAU * radar.carrier_turns_per_metre() * metres;
        let off = |ratio: Complex64, metres: f64| (ratio * Complex64::cis(-of_metres(metres))).arg().abs();
        let x = radar.element_x_metres(7);
        let nearer = (2.0 - x).hypot(11.0 - forward) - (2.0 - x).hypot(11.0);
        let point = turned(&Scene::of_points([(2.0, 11.0)]));
        assert!(off(point, nearer) < 1e-6, "{point}");
        // The glint of a wall that faces the array lies straight ahead of every element.
        let wall = Scene { objects: vec![Object::Wall(Wall::new(0.0, 11.0, 6.0, 0.0))], ..Scene::default() };
        let glint = turned(&wall);
        assert!(off(glint, -forward) < 0.02, "{glint}");
    }

    #[test]
    fn a_pattern_weakens_a_post_as_a_point() {
        let budget = LinkBudget { half_power_width_degrees: Some(60.0), ..LinkBudget::default() };
        let (isotropic, narrow) = (small(), Radar { budget: Some(budget), ..small() });
        let pattern = narrow.pattern().unwrap();
        let x = isotropic.element_x_metres(7);
        // The nearest part of a post lies towards its centre.
        let post = Object::Post(Post::new(6.0, 8.0, 0.2));
        let mirror = Mirror { x_metres: -4.0, ..Default::default() };
        let mut scene = Scene { objects: vec![post], ..Scene::default() };
        let kept = |scene: &Scene| {
            let heard = |radar| simulate(radar, scene, Floor::Exact, 0).unwrap().samples[[7, 0]];
            (heard(&narrow), heard(&isotropic))
        };
        let (own, all) = kept(&scene);
        let expected = pattern.amplitude(8.0 / (6.0 - x).hypot(8.0)).powi(2);
        assert!((own / all - expected).norm() < 1e-9, "{}: {expected}", own / all);
        // The mirror's image stands at x = -14. A weak mirror's echoes go there one way and come back the other.
        let mut ghosts = |reflection| {
            scene.disturbances.mirror = Some(Mirror { reflection, ..mirror });
            kept(&scene)
        };
        let (with, without) = (ghosts(1e-3), ghosts(0.0));
        let part = (with.0 - without.0).norm() / (with.1 - without.1).norm();
        let towards_image = pattern.amplitude(8.0 / (14.0 + x).hypot(8.0));
        assert!((part / (towards_image * expected.sqrt()) - 1.0).abs() < 0.05, "{part}: {towards_image}, {expected}");
    }

    /// Elements displaced along the line and off it, in groups that end within a vector and with gaps between them.
    fn displaced(radar: &Radar) -> BuiltArray {
        let element = |n: usize| ElementError {
            position_millimetres: if n % 5 < 3 { 0.02 * (n % 7) as f64 - 0.05 } else { 0.0 },
            forward_millimetres: if n % 11 == 2 { -0.3 } else { 0.0 },
            ..ElementError::default()
        };
        BuiltArray { elements: (0..radar.elements).map(element).collect() }
    }

    #[test]
    fn displaced_elements_hear_what_the_judge_hears_there() {
        let radar = small();
        let array = displaced(&radar);
        for count in [2, 40] {
            let place = |i: usize| (f64::from(i as u32 * 37 % 61) / 4.0 - 7.0, 3.0 + f64::from(i as u32 * 53 % 33));
            let scene = Scene::of_points((0..count).map(place));
            let built = simulate_built(&radar, &scene, &array, Floor::Exact, 0).unwrap();
            let ideal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
            let scale = crate::signal::plan::amplitude_bound(&radar, &scene.reflectors());
            for n in 0..radar.elements {
                let judged = crate::signal::judge::pair_signal(&radar, &scene.reflectors(), array.pair(&radar, n));
                let worst = built.samples.row(n).iter().zip(&judged).fold(0.0f64, |m, (a, b)| m.max((a - b).norm()));
                assert!(worst < 1e-14 * scale, "{count} reflectors, element {n}: {:e}", worst / scale);
                if !array.is_displaced(n) {
                    assert_eq!(built.samples.row(n), ideal.samples.row(n), "element {n} keeps its bits");
                }
            }
        }
    }
}
