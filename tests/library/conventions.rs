//! Signs and sides: mirrored directions, and maps of strange scenes.

use crate::prelude::*;
use apertura::scene::{Disturbances, Interferer};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// x -> -x reverses the elements, so it swaps the ends and mirrors every map about cos(theta) = 0.
    #[test]
    fn mirroring_swaps_the_ends(
        points in prop::collection::vec((-30.0f64..30.0, 2.0f64..30.0), 1..4),
    ) {
        let radar = Radar { samples: 64, elements: 128, ..Radar::default() };
        let scene = Scene::of_points(points.iter().copied());
        let mirrored = Scene::of_points(points.iter().map(|(x, y)| (-x, *y)));
        let [signal, mirror] = [scene, mirrored].map(|scene| simulate(&radar, &scene, Floor::Exact, 0).unwrap());
        let peak = signal.peak();
        for n in 0..radar.elements {
            for (a, b) in signal.samples.row(n).iter().zip(mirror.samples.row(radar.elements - 1 - n)) {
                prop_assert!((a - b).norm() < 1e-11 * peak);
            }
        }
        let (maps, mirror) = (LogMaps::of_signal(&radar, &signal), LogMaps::of_signal(&radar, &mirror));
        let lambda = |map: &LogMap| map.normalise(Normalisation::DynamicRange(Decibels(100.0))).lambda;
        for (a, b) in [(&maps.first, &mirror.last), (&maps.last, &mirror.first), (&maps.full, &mirror.full)] {
            let (a, b) = (lambda(a), lambda(b));
            for ((bin, column), v) in a.indexed_iter() {
                let other = b[[bin, (radar.elements - column) % radar.elements]];
                prop_assert!((v - other).abs() < 1e-4, "[{bin}, {column}]: {v} and {other}");
            }
        }
    }
}

#[test]
fn a_faint_scene_has_the_map_of_a_bright_one() {
    let radar = Radar::default();
    let bright = Scene::of_points([(1.0, 6.0), (-2.0, 19.5)]);
    let mut faint = bright.clone();
    // A power of two, so that the rounding is the same: 9e-13.
    faint.objects.iter_mut().for_each(|o| o.set_reflectivity(2f64.powi(-40)));
    for floor in [Floor::Thesis, Floor::Snr(Decibels(20.0))] {
        let [bright, faint] = [&bright, &faint].map(|scene| {
            let signal = simulate(&radar, scene, floor, 0).unwrap();
            LogMaps::of_signal(&radar, &signal).full.normalise(Normalisation::MinMax).lambda
        });
        let worst = bright.iter().zip(&faint).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 5e-5, "{floor}: Lambda differs by {worst}");
    }
}

#[test]
fn behind_the_array_looks_like_ahead_of_it() {
    let radar = Radar { samples: 64, elements: 128, ..Radar::default() };
    let of = |y: f64| simulate(&radar, &Scene::of_points([(3.0, y)]), Floor::Thesis, 0).unwrap();
    assert_eq!(of(4.0), of(-4.0));
}

#[test]
fn a_reflector_a_million_kilometres_away_is_faint_but_there() {
    let radar = Radar::default();
    let signal = simulate(&radar, &Scene::of_points([(0.0, 1e9)]), Floor::Exact, 0).unwrap();
    let maps = LogMaps::of_signal(&radar, &signal);
    let finite = |m: &RangeAngleMap| m.lambda.iter().all(|v| v.is_finite() && (0.0..=1.0).contains(v));
    assert!([&maps.first, &maps.last, &maps.full].iter().all(|m| finite(&m.normalise(Normalisation::MinMax))));
    // Amplitude 100 / R^2, times the windows' means and the orthonormal scale: 1e-16 * 512 * 1024 / 4 / sqrt(512 * 1024).
    let expected = (1e-16 * (512.0f64 * 1024.0).sqrt() / 4.0).log10();
    assert!((maps.full.max() - expected).abs() < 0.1, "{} for {expected}", maps.full.max());
}

#[test]
fn an_interferer_is_heard_where_its_settings_say() {
    let radar = Radar { elements: 128, samples: 256, ..Radar::default() };
    let interferer = Interferer { x_metres: 30.0, y_metres: 40.0, crossing: 0.5, duration: 0.25, strength: 0.1 };
    let disturbances = Disturbances { interferer: Some(interferer), ..Disturbances::default() };
    let scene = Scene { disturbances, ..Scene::default() };
    let signal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
    let heard = |k: usize| signal.samples[[64, k]].norm() / (100.0 * 0.1 / 50.0);
    assert!((heard(128) - 1.0).abs() < 0.01 && (heard(110) - 1.0).abs() < 0.01);
    assert!(heard(70) < 0.01 && heard(190) < 0.01, "{} {}", heard(70), heard(190));
    let map = LogMaps::of_signal(&radar, &signal).full;
    // The interferer stands at every range alike, in one direction: cos(theta) = 0.6.
    for bin in [20, 60, 110] {
        let row = map.decades().row(bin);
        let strongest = row.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        assert!((radar.cos_of_column(strongest as f64) - 0.6).abs() < 0.03, "bin {bin}: column {strongest}");
    }
}
