//! What is left of the error under thermal noise, beside what the noise alone leaves.

use super::draw::{Noise, Weighted, expected_lambda};
use super::tests::squared_error;
use super::*;
use crate::maps::LogMaps;
use crate::radar::Decibels;
use crate::scene::Reflector;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::floor::snr_noise_variance;
use crate::signal::{Floor, simulate};

/// Most error of the search, over that of who is told the scene and the noise's variance.
const MOST: f64 = 1.1;

/// The error of the search on `count` scenes of each set is hardly more than that of the expected map of the true scene.
fn costs_hardly_more_than_the_noise(purpose: Purpose, count: u32) {
    let radar = Radar::default();
    let generator = Generator::new(&radar, Reading::Program, purpose, 0);
    for snr_db in [40.0, 20.0] {
        let floor = Floor::Snr(Decibels(snr_db));
        let request = Request { noise: floor.into(), ..Request::default() };
        for kind in Kind::TEST_SETS {
            let [mut told, mut searched] = [0.0; 2];
            for number in 0..count {
                let scene = generator.scene(kind, number);
                let signal = simulate(&radar, &scene, floor, scene.noise_seed).unwrap();
                let target = LogMaps::of_signal(&radar, &signal).full.normalise(request.normalisation);
                let ends = signal.two_ends(&radar);
                let reflectors = scene.reflectors();
                let noise = Noise::Variance(snr_noise_variance(&radar, &reflectors, Decibels(snr_db))[0]);
                // The radar can't tell y from -y.
                let ahead = |r: &Reflector| Atom::Point { x_metres: r.x_metres, y_metres: r.y_metres.abs() };
                let weighted = |r: &Reflector| Weighted { atom: ahead(r), reflectivity: r.reflectivity };
                let objects: Vec<Weighted> = reflectors.iter().map(weighted).collect();
                let known = expected_lambda(&radar, &objects, noise, &request).map;
                let found = find(&radar, &ends, &request, &Settings::default()).unwrap();
                told += squared_error(&target, &known);
                searched += squared_error(&target, &found.expected(&radar, &request).map);
            }
            let [told, searched] = [told, searched].map(|sum| sum / f64::from(count));
            println!(
                "{kind}, {snr_db} dB: SE {searched:.0}, of the noise alone {told:.0}, ratio {:.3}",
                searched / told
            );
            assert!(searched < MOST * told, "{kind}, {snr_db} dB: {searched} for {told}");
        }
    }
}

#[test]
fn under_thermal_noise_the_error_is_hardly_more_than_the_noise_leaves() {
    costs_hardly_more_than_the_noise(Purpose::Validation, 2);
}

#[test]
#[ignore = "prints README's figures; half a minute"]
fn under_thermal_noise_on_twenty_test_scenes_a_set() {
    costs_hardly_more_than_the_noise(Purpose::Test, 20);
}
