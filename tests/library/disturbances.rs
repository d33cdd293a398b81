//! Effects of an interferer on the maps.

use crate::prelude::*;
use apertura::scene::{Disturbances, Interferer};

fn radar() -> Radar {
    Radar { elements: 128, samples: 256, ..Radar::default() }
}

fn scene(interferer: Interferer) -> Scene {
    let disturbances = Disturbances { interferer: Some(interferer), ..Disturbances::default() };
    Scene { disturbances, ..Scene::default() }
}

#[test]
fn an_interferer_is_heard_where_its_settings_say() {
    let interferer = Interferer { x_metres: 30.0, y_metres: 40.0, crossing: 0.5, duration: 0.25, strength: 0.1 };
    let signal = simulate(&radar(), &scene(interferer), Floor::Exact, 0).unwrap();
    let amplitude = 100.0 * 0.1 / 50.0;
    let heard = |k: usize| signal.samples[[64, k]].norm() / amplitude;
    assert!((heard(128) - 1.0).abs() < 0.01 && (heard(110) - 1.0).abs() < 0.01);
    assert!(heard(70) < 0.01 && heard(190) < 0.01, "{} {}", heard(70), heard(190));
    let map = LogMaps::of_signal(&radar(), &signal).full;
    // The interferer stands at every range alike, in one direction: cos(theta) = 0.6.
    for bin in [20, 60, 110] {
        let row = map.decades().row(bin);
        let strongest = row.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        assert!((radar().cos_of_column(strongest as f64) - 0.6).abs() < 0.03, "bin {bin}: column {strongest}");
    }
}
