//! Signs and sides: the place of a reflector in the maps, mirrored and folded directions, and maps of strange scenes.

use crate::prelude::*;
use apertura::evaluate::Metrics;
use apertura::scene::{Disturbances, Interferer};
use proptest::prelude::*;

fn maps_of(radar: &Radar, scene: &Scene) -> LogMaps {
    LogMaps::of_signal(radar, &simulate(radar, scene, Floor::Exact, 0).unwrap())
}

/// `[range bin, column]` of the largest cell.
fn peak(map: &LogMap) -> [usize; 2] {
    let (index, _) = map.decades().indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
    [index.0, index.1]
}

fn columns_apart(radar: &Radar, a: f64, b: f64) -> f64 {
    let n = radar.elements as f64;
    let d = (a - b).rem_euclid(n);
    d.min(n - d)
}

/// The whole array smears a reflector over dozens of columns, but evenly: the middle of the blob is off by the squint.
#[test]
fn the_middle_of_a_blob_is_where_the_squint_puts_it() {
    let radar = Radar::default();
    for cos in [-0.832f64, -0.4, 0.0, 0.6, 0.9] {
        let (x, y) = (20.0 * cos, 20.0 * (1.0 - cos * cos).sqrt());
        let maps = maps_of(&radar, &Scene::of_points([(x, y)]));
        let powers = maps.full.decades().indexed_iter().map(|((_, column), d)| (column as f64, 10f64.powf(2.0 * d)));
        let (weighted, power) = powers.fold((0.0, 0.0), |(w, p), (column, power)| (w + column * power, p + power));
        let (middle, blob) = (weighted / power, radar.blob_of(0.0, x, y));
        let expected = radar.column_of_cos(blob.cos_theta);
        assert!((middle - expected).abs() < 2.0, "cos {cos}: column {middle:.1}, expected {expected:.1}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// An end is short enough to see a point as one direction: its peak is at the range and cos(theta) from the end's centre.
    #[test]
    fn an_end_sees_a_reflector_at_its_range_and_angle(range in 4.0f64..36.0, cos in -0.97f64..0.97) {
        let radar = Radar::default();
        let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
        let maps = maps_of(&radar, &Scene::of_points([(x, y)]));
        for (end, map) in [(End::First, &maps.first), (End::Last, &maps.last)] {
            let polar = radar.polar_of(x - radar.end_centre_metres(end), y);
            let [bin, column] = peak(map);
            let expected = radar.bin_of_range(polar.range_metres);
            prop_assert!((bin as f64 - expected).abs() <= 1.0, "{end:?}: bin {bin} for {expected}");
            let expected = radar.column_of_cos(polar.cos_theta * radar.squint());
            prop_assert!(columns_apart(&radar, column as f64, expected) <= 2.5, "{end:?}: column {column} for {expected}");
        }
    }

    /// x -> -x reverses the elements, so it swaps the ends and mirrors every map about cos(theta) = 0.
    #[test]
    fn mirroring_swaps_the_ends(
        points in prop::collection::vec((-30.0f64..30.0, 2.0f64..30.0), 1..4),
    ) {
        let radar = Radar { samples: 64, elements: 128, ..Radar::default() };
        let scene = Scene::of_points(points.iter().copied());
        let mirrored = Scene::of_points(points.iter().map(|(x, y)| (-x, *y)));
        let (signal, mirror) = (
            simulate(&radar, &scene, Floor::Exact, 0).unwrap(),
            simulate(&radar, &mirrored, Floor::Exact, 0).unwrap(),
        );
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

/// Two directions a whole unit of cos(theta) apart (at mid-chirp): one column for the two-way carrier, two for the one-way.
#[test]
fn the_two_way_carrier_folds_the_scene() {
    for (carrier, together) in [(Carrier::TwoWay, true), (Carrier::OneWay, false)] {
        let radar = Radar { carrier, ..Radar::default() };
        let centre = radar.end_centre_metres(End::First);
        let column = |cos: f64| {
            let point = (centre + 20.0 * cos, 20.0 * (1.0 - cos * cos).sqrt());
            peak(&maps_of(&radar, &Scene::of_points([point])).first)[1] as f64
        };
        let two_way = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        let apart = columns_apart(&radar, column(0.3), column(0.3 - 1.0 / two_way.squint()));
        assert_eq!(apart <= 2.0, together, "{carrier:?}: {apart} columns apart");
    }
}

#[test]
fn an_empty_scene_is_dark() {
    let radar = Radar::default();
    let signal = simulate(&radar, &Scene::default(), Floor::Thesis, 0).unwrap();
    let maps = LogMaps::of_signal(&radar, &signal);
    let target = maps.full.normalise(Normalisation::MinMax);
    assert_eq!((maps.full.min(), maps.full.max()), (-20.0, -20.0));
    assert!(target.lambda.iter().all(|v| *v == 0.0));
    let found = Baseline.reconstruct(&radar, &signal.two_ends(&radar), &Request::default()).unwrap();
    let metrics = Metrics::of(&target, &found.lambda, 0.9);
    assert_eq!(metrics, Metrics { squared_error: 0.0, detection: None, false_alarm: 0.0 });
    let noisy = simulate(&radar, &Scene::default(), Floor::Snr(Decibels(20.0)), 0).unwrap();
    assert_eq!(noisy.peak(), 0.0, "there is no signal to be noisy against");
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
fn beyond_the_maximum_range_wraps() {
    let radar = Radar::default();
    let range = radar.max_range_metres() + radar.range_of_bin_metres(100.0);
    let maps = maps_of(&radar, &Scene::of_points([(0.0, range)]));
    assert!(peak(&maps.full)[0].abs_diff(100) <= 1);
}

#[test]
fn a_reflector_a_million_kilometres_away_is_faint_but_there() {
    let radar = Radar::default();
    let maps = maps_of(&radar, &Scene::of_points([(0.0, 1e9)]));
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
