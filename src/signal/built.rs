//! The signal as a built array hears it, and calibrating such an array on a reflector of known place.

use super::echo::{ArrayEcho, add_echo, add_path_echo};
use super::floor::Floor;
use super::interference::add_interference;
use super::over_floor::simulate_echoes;
use super::phase::EchoModel;
use super::samples::BeatSignal;
use super::unfinished::Unfinished;
use crate::radar::{BuiltArray, Decibels, ElementError, Radar, chirp_window};
use crate::scattering::{Antennas, Echoing, Sources};
use crate::scene::{Reflector, Scene, SceneError};
use crate::task::Task;
use num_complex::Complex64;
use rayon::prelude::*;

/// Beat signal of a scene as `array` hears it, with the ghosts and the interferer of the scene, over the named floor; `seed` picks the
/// floor's noise, which each element's receiver adds whatever its gain: that of an ideal array, except in dead elements, which hear nothing.
///
/// # Errors
/// [`SceneError`] when the scene can't be simulated.
pub fn simulate_built(
    radar: &Radar,
    scene: &Scene,
    array: &BuiltArray,
    floor: Floor,
    seed: u64,
) -> Result<BeatSignal, SceneError> {
    simulate_built_for(&Task::default(), radar, scene, array, floor, seed).map_err(Unfinished::of_scene)
}

/// [`simulate_built`], unless `task` is cancelled before it is done.
pub(super) fn simulate_built_for(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    array: &BuiltArray,
    floor: Floor,
    seed: u64,
) -> Result<BeatSignal, Unfinished> {
    scene.validate(radar)?;
    array.validate(radar).map_err(SceneError::from)?;
    let echoing = Echoing::of(radar, scene);
    let heard = |signal: &mut BeatSignal| hear(task, radar, scene, array, &echoing, signal);
    let mut signal = simulate_echoes(radar, &echoing, floor, seed, heard, task);
    task.check()?;
    for (n, mut samples) in signal.samples.outer_iter_mut().enumerate() {
        if array.element(n).dead {
            samples.fill(Complex64::default());
        }
    }
    Ok(signal)
}

/// Makes of the samples of an ideal array what `array` hears of the same echoes and of the scene's interferer, before its receivers add
/// their noise. Of no meaning once `task` is cancelled.
pub(super) fn hear(
    task: &Task,
    radar: &Radar,
    scene: &Scene,
    array: &BuiltArray,
    echoing: &Echoing,
    signal: &mut BeatSignal,
) {
    let model = EchoModel::new(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut samples)| {
        if array.is_displaced(n) && !task.is_cancelled() {
            samples.fill(Complex64::default());
            let Some(samples) = samples.as_slice_mut() else { return };
            let (pair, forward) = (array.pair(radar, n), array.forward_metres(n));
            for r in &echoing.points {
                let seen = Reflector { y_metres: r.y_metres - forward, ..*r };
                add_echo(&model, pair, &seen, Complex64::from(1.0), samples);
            }
            let mut echoes = Vec::new();
            Sources::from(echoing).scattered(Antennas::forward_of(pair, forward), &mut echoes);
            echoes.iter().filter(|e| e.is_heard()).for_each(|e| add_path_echo(&model, e, samples));
        }
    });
    if let Some(interferer) = &scene.disturbances.interferer {
        add_interference(radar, array, interferer, signal);
    }
    apply_responses(array, signal);
}

/// Multiplies the samples of every element with what it does to them; those of an element that is as it should be keep their bits.
pub fn apply_responses(array: &BuiltArray, signal: &mut BeatSignal) {
    for (mut samples, error) in signal.samples.outer_iter_mut().zip(&array.elements) {
        if error.dead || error.gain.0 != 0.0 || error.phase_degrees != 0.0 {
            let response = error.response();
            samples.iter_mut().for_each(|v| *v *= response);
        }
    }
}

/// What was learned of an array from one reflector.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Gain and phase of each element, relative to the mean of those that hear; elements that hear nothing are dead.
    pub array: BuiltArray,
    /// Part of the samples' energy that the reflector's echo, heard so, leaves unexplained: other reflectors, noise, and errors that
    /// are no gain and no phase.
    pub unexplained: f64,
}

/// Estimates gain and phase of every element from the echo of `reflector` in `signal`: what each element's samples hold of the echo
/// that an ideal element would hear, by least squares under a Hann window. Other reflectors disturb little where they are two range bins
/// away or more.
///
/// `None` where no element hears the reflector.
pub fn calibrate(radar: &Radar, signal: &BeatSignal, reflector: &Reflector) -> Option<Calibration> {
    let polar = radar.polar_of(reflector.x_metres, reflector.y_metres);
    let (mut energy, mut left) = (0.0, 0.0);
    let window = chirp_window(radar.samples);
    let mean_weight = window.iter().sum::<f64>() / radar.samples as f64;
    let responses: Vec<Complex64> = signal
        .samples
        .outer_iter()
        .enumerate()
        .map(|(n, samples)| {
            let echo = ArrayEcho::heard_by(radar, &[radar.pair(n)], polar.range_metres, polar.cos_theta);
            let samples: Vec<Complex64> = samples.iter().copied().collect();
            let weighted: Vec<Complex64> = samples.iter().zip(&window).map(|(v, w)| v * w).collect();
            let share = echo.correlate(&weighted) / mean_weight;
            let all: f64 = samples.iter().map(Complex64::norm_sqr).sum();
            energy += all;
            let explained = 2.0 * (share.conj() * echo.correlate(&samples)).re - share.norm_sqr();
            left += (all - explained).max(0.0);
            share / echo.norm()
        })
        .collect();
    let heard: Vec<&Complex64> = responses.iter().filter(|r| r.norm_sqr() > 0.0 && r.is_finite()).collect();
    // Gains are compared as decibels; phases with that of the sum, which no single element can turn far.
    let mean_decades = heard.iter().map(|r| r.norm().log10()).sum::<f64>() / heard.len() as f64;
    let mean_phase = heard.iter().map(|r| *r / r.norm()).sum::<Complex64>().arg();
    let element = |r: &Complex64| {
        if !(r.norm_sqr() > 0.0 && r.is_finite()) {
            return ElementError { dead: true, ..ElementError::default() };
        }
        ElementError {
            gain: Decibels(20.0 * (r.norm().log10() - mean_decades)),
            phase_degrees: (r * Complex64::cis(-mean_phase)).arg().to_degrees(),
            ..ElementError::default()
        }
    };
    (!heard.is_empty()).then(|| Calibration {
        array: BuiltArray { elements: responses.iter().map(element).collect() },
        unexplained: left / energy,
    })
}

impl Calibration {
    /// Takes the gains and phases off `signal`; dead elements stay silent.
    pub fn take_off(&self, signal: &mut BeatSignal) {
        for (n, mut samples) in signal.samples.outer_iter_mut().enumerate() {
            let response = self.array.element(n).response();
            if response.norm_sqr() > 0.0 {
                samples.iter_mut().for_each(|v| *v /= response);
            }
        }
    }

    /// Root mean squares of what the living elements are off by: decibels of gain, degrees of phase.
    pub fn spread(&self) -> (Decibels, f64) {
        let living = || self.array.elements.iter().filter(|e| !e.dead);
        let count = living().count().max(1) as f64;
        let rms = |of: fn(&ElementError) -> f64| (living().map(|e| of(e).powi(2)).sum::<f64>() / count).sqrt();
        (Decibels(rms(|e| e.gain.0)), rms(|e| e.phase_degrees))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{LinkBudget, Tolerances};
    use crate::scene::{Object, Wall};
    use crate::signal::simulate;

    fn small() -> Radar {
        Radar { elements: 64, ..Radar::default() }
    }

    fn two_points() -> Scene {
        Scene::of_points([(2.0, 11.0), (-6.0, 19.0)])
    }

    #[test]
    fn a_dead_element_hears_nothing() {
        let (radar, scene) = (small(), two_points());
        let ideal = simulate(&radar, &scene, Floor::Thesis, 3).unwrap();
        let same = simulate_built(&radar, &scene, &BuiltArray::default(), Floor::Thesis, 3).unwrap();
        assert_eq!(ideal, same);
        let mut array = BuiltArray { elements: vec![ElementError::default(); 64] };
        array.elements[5].dead = true;
        array.elements[6].gain = Decibels(20.0);
        array.elements[7].position_millimetres = 0.5;
        let built = simulate_built(&radar, &scene, &array, Floor::Exact, 3).unwrap();
        let exact = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        assert!(built.samples.row(5).iter().all(|v| v.norm() == 0.0));
        assert!((built.samples[[6, 9]] / exact.samples[[6, 9]] - 10.0).norm() < 1e-9);
        assert_eq!(built.samples.row(8), exact.samples.row(8));
        // Half a millimetre nearer to the first reflector's side turns its echo by what geometry says.
        let one = Scene::of_points([(2.0, 11.0)]);
        let moved = simulate_built(&radar, &one, &array, Floor::Exact, 0).unwrap().samples[[7, 0]];
        let still = simulate(&radar, &one, Floor::Exact, 0).unwrap().samples[[7, 0]];
        let x = radar.element_x_metres(7);
        let metres = (2.0 - x - 5e-4f64).hypot(11.0) - (2.0 - x).hypot(11.0);
        let turned = (moved / still).arg() - std::f64::consts::TAU * -metres / radar.wavelength_metres();
        assert!(turned.abs() < 1e-6, "{turned}");
    }

    #[test]
    fn calibration_takes_off_what_it_finds() {
        let (radar, scene) = (small(), two_points());
        let tolerances = Tolerances { gain: Decibels(1.5), phase_degrees: 20.0, position_millimetres: 0.0 };
        let array = tolerances.build(&radar, 2);
        let floor = Floor::Snr(Decibels(30.0));
        let mut signal = simulate_built(&radar, &scene, &array, floor, 1).unwrap();
        let reflector = scene.reflectors()[0];
        let found = calibrate(&radar, &signal, &reflector).unwrap();
        // The other reflector is a hundred bins away: its side lobes are all that disturbs.
        let (first_gain, first_phase) = (array.elements[0].gain.0, array.elements[0].phase_degrees);
        for (f, e) in found.array.elements.iter().zip(&array.elements) {
            let gain = f.gain.0 - found.array.elements[0].gain.0 - (e.gain.0 - first_gain);
            let phase = f.phase_degrees - found.array.elements[0].phase_degrees - (e.phase_degrees - first_phase);
            assert!(gain.abs() < 0.3 && phase.abs() < 2.0, "{f:?} {e:?}");
        }
        let (gain, phase) = found.spread();
        assert!(gain.0 > 1.0 && phase > 14.0);
        assert!(found.unexplained > 0.01 && found.unexplained < 0.5, "the other reflector: {}", found.unexplained);
        found.take_off(&mut signal);
        let (gain, phase) = calibrate(&radar, &signal, &reflector).unwrap().spread();
        assert!(gain.0 < 1e-6 && phase < 1e-6, "{gain} {phase}");
    }

    #[test]
    fn reflectors_a_few_bins_away_hardly_disturb_a_calibration() {
        let radar = small();
        let tolerances = Tolerances { gain: Decibels(1.5), phase_degrees: 20.0, position_millimetres: 0.0 };
        let array = tolerances.build(&radar, 2);
        // Eight bins further out, a little stronger.
        let scene = Scene::of_points([(0.0, 11.0), (1.0, 11.6)]);
        let signal = simulate_built(&radar, &scene, &array, Floor::Exact, 1).unwrap();
        let mut left = signal.clone();
        calibrate(&radar, &signal, &scene.reflectors()[0]).unwrap().take_off(&mut left);
        let ideal = simulate(&radar, &scene, Floor::Exact, 1).unwrap();
        let ratio = |n: usize| left.samples[[n, 9]] / ideal.samples[[n, 9]];
        for n in 0..radar.elements {
            let off = ratio(n) / ratio(0);
            assert!((off - 1.0).norm() < 0.02, "element {n}: {off}");
        }
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
        scene.disturbances.mirror = Some(crate::scene::Mirror::default());
        let mirrored = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        let ghosts = Scene::of_points([]);
        assert_eq!(simulate(&radar, &ghosts, Floor::Exact, 3).unwrap().peak(), 0.0);
        let explicit = Scene {
            objects: scene
                .echoing(&radar)
                .into_iter()
                .map(|r| {
                    let Reflector { x_metres, y_metres, reflectivity } = r;
                    crate::scene::Object::Point(crate::scene::Point {
                        reflectivity,
                        ..crate::scene::Point::new(x_metres, y_metres)
                    })
                })
                .collect(),
            ..Scene::default()
        };
        assert_eq!(explicit.objects.len(), 5, "three ghosts of the point before the wall, none of that behind it");
        assert_eq!(simulate(&radar, &explicit, Floor::Exact, 3).unwrap(), mirrored);
        scene.disturbances.elements.elements[5].dead = true;
        let ends = crate::signal::simulate_ends(&radar, &scene, Floor::Thesis, 3).unwrap();
        assert_eq!(ends, simulate(&radar, &scene, Floor::Thesis, 3).unwrap().two_ends(&radar));
        assert_eq!(ends.first.row(5).iter().map(|v| v.norm()).sum::<f64>(), 0.0);
    }

    #[test]
    fn an_element_off_the_line_hears_what_stands_that_much_nearer() {
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
    fn a_pattern_takes_from_a_post_what_it_takes_from_a_point() {
        let budget = LinkBudget { half_power_width_degrees: Some(60.0), ..LinkBudget::default() };
        let (isotropic, narrow) = (small(), Radar { budget: Some(budget), ..small() });
        let pattern = narrow.pattern().unwrap();
        let x = isotropic.element_x_metres(7);
        // The nearest part of a post lies towards its centre.
        let post = Object::Post(crate::scene::Post::new(6.0, 8.0, 0.2));
        let mirror = crate::scene::Mirror { x_metres: -4.0, ..Default::default() };
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
            scene.disturbances.mirror = Some(crate::scene::Mirror { reflection, ..mirror });
            kept(&scene)
        };
        let (with, without) = (ghosts(1e-3), ghosts(0.0));
        let part = (with.0 - without.0).norm() / (with.1 - without.1).norm();
        let towards_image = pattern.amplitude(8.0 / (14.0 + x).hypot(8.0));
        assert!((part / (towards_image * expected.sqrt()) - 1.0).abs() < 0.05, "{part}: {towards_image}, {expected}");
    }

    #[test]
    fn disturbances_act_on_bodies_as_on_points() {
        let radar = small();
        let wall = Object::Wall(Wall::new(0.5, 11.0, 6.0, 0.0));
        let mut scene = Scene { objects: vec![wall], ..Scene::default() };
        let ideal = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        scene.disturbances.elements = BuiltArray { elements: vec![ElementError::default(); 64] };
        scene.disturbances.elements.elements[5].dead = true;
        scene.disturbances.elements.elements[7].position_millimetres = 0.5;
        let built = simulate(&radar, &scene, Floor::Exact, 3).unwrap();
        assert!(built.samples.row(5).iter().all(|v| v.norm() == 0.0));
        assert!((&built.samples.row(8) - &ideal.samples.row(8)).iter().all(|v| v.norm() < 1e-12));
        assert!((&built.samples.row(7) - &ideal.samples.row(7)).iter().any(|v| v.norm() > 1e-6));
        // A mirror beside a body adds what its image echoes.
        let mut mirrored = Scene { disturbances: crate::scene::Disturbances::default(), ..scene.clone() };
        mirrored.disturbances.mirror = Some(crate::scene::Mirror::default());
        let with = simulate(&radar, &mirrored, Floor::Exact, 3).unwrap();
        mirrored.disturbances.mirror = Some(crate::scene::Mirror { reflection: 0.0, ..Default::default() });
        let without = simulate(&radar, &mirrored, Floor::Exact, 3).unwrap();
        let differs =
            |other: &BeatSignal| (&other.samples - &ideal.samples).iter().fold(0.0f64, |m, v| m.max(v.norm()));
        assert!(differs(&without) < 1e-12 && differs(&with) > 1e-3, "{} {}", differs(&without), differs(&with));
    }

    #[test]
    fn silence_calibrates_nothing() {
        let radar = small();
        let reflector = two_points().reflectors()[0];
        assert_eq!(calibrate(&radar, &BeatSignal::silence(&radar), &reflector), None);
    }
}
