//! Tests of the search's error under thermal noise, relative to the error of the noise alone.

use super::draw::{Noise, expected_lambda};
use super::tests::squared_error;
use super::*;
use crate::maps::LogMaps;
use crate::radar::Decibels;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::{Reflector, Scene};
use crate::signal::floor::snr_noise_variance;
use crate::signal::{Floor, simulate};

/// Largest error of the search, over that of a map drawn from the true scene and the noise's true variance.
const MAX_ERROR_RATIO: f64 = 1.1;

/// The error of the search on `count` scenes each of sets 1 and 2 is hardly more than that of the expected map of the true scene.
fn costs_hardly_more_than_the_noise(purpose: Purpose, count: u32) {
    let radar = Radar::default();
    let generator = Generator::new(&radar, Reading::Program, purpose, 0);
    for snr_db in [40.0, 20.0] {
        let floor = Floor::Snr(Decibels(snr_db));
        let request = Request { noise: floor.into(), ..Request::default() };
        for kind in [Kind::Set1, Kind::Set2] {
            let [mut told, mut searched] = [0.0; 2];
            for number in 0..count {
                let scene = generator.scene(kind, number);
                let signal = simulate(&radar, &scene, floor, scene.noise_seed).unwrap();
                let target = LogMaps::of_signal(&radar, &signal).full.normalise(request.normalisation);
                let ends = signal.two_ends(&radar);
                let reflectors = scene.reflectors();
                let noise = Noise::Variance(snr_noise_variance(&radar, &reflectors, Decibels(snr_db))[0]);
                // The radar can't tell y from -y.
                let ahead = reflectors.iter().map(|r| Reflector { y_metres: r.y_metres.abs(), ..*r });
                let known = expected_lambda(&radar, ahead, noise, &request).map;
                let found = find(&radar, &ends, &request, &Settings::default()).unwrap();
                told += squared_error(&target, &known);
                searched += squared_error(&target, &found.expected(&radar, &request).map);
            }
            let [told, searched] = [told, searched].map(|sum| sum / f64::from(count));
            let ratio = searched / told;
            println!("{kind}, {snr_db} dB: SE {searched:.0}, of the noise alone {told:.0}, ratio {ratio:.3}");
            assert!(searched < MAX_ERROR_RATIO * told, "{kind}, {snr_db} dB: {searched} for {told}");
        }
    }
}

/// The reflectors found in `scene` over noise this far beneath its echoes.
fn found_in(scene: &Scene, snr_db: f64) -> Vec<Reflector> {
    let (radar, floor) = (Radar::default(), Floor::Snr(Decibels(snr_db)));
    let ends = simulate(&radar, scene, floor, scene.noise_seed).unwrap().two_ends(&radar);
    let request = Request { noise: floor.into(), ..Request::default() };
    Nomp::default().reconstruct(&radar, &ends, &request).unwrap().reflectors
}

#[test]
fn four_points_at_one_range_are_four_over_noise() {
    let place = |cos: f64, range: f64| (range * cos, range * (1.0 - cos * cos).sqrt());
    let scene = Scene::of_points([(-0.6, 14.0), (-0.1, 14.01), (0.2, 13.98), (0.55, 14.02)].map(|(c, r)| place(c, r)));
    let found = found_in(&scene, 40.0);
    assert_eq!(found.len(), 4, "{found:?}");
    for r in scene.reflectors() {
        let near = |f: &Reflector| (f.x_metres - r.x_metres).hypot(f.y_metres - r.y_metres) < 0.1;
        assert!(found.iter().any(near), "{r:?} in {found:?}");
    }
}

#[test]
fn over_noise_nothing_is_three_times_louder_than_the_loudest() {
    let generator = Generator::new(&Radar::default(), Reading::Program, Purpose::Validation, 11);
    for number in 0..4 {
        let scene = generator.scene(Kind::Set2, number);
        let loudest = |of: &[Reflector]| of.iter().map(|r| r.reflectivity.abs()).fold(0.0, f64::max);
        let [found, there] = [loudest(&found_in(&scene, 40.0)), loudest(&scene.reflectors())];
        assert!(found <= 3.0 * there, "{number}: {found} where {there} is");
    }
}

#[test]
fn under_thermal_noise_the_error_is_about_that_of_the_noise() {
    costs_hardly_more_than_the_noise(Purpose::Validation, 2);
}

#[test]
#[ignore = "prints figures of docs/results.md; half a minute"]
fn points_under_thermal_noise_on_twenty_test_scenes_a_set() {
    costs_hardly_more_than_the_noise(Purpose::Test, 20);
}
