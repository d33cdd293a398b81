//! Whole reconstructions of known scenes.

use super::*;
use crate::maps::{LogMaps, Normalisation, RangeAngleMap};
use crate::radar::Decibels;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::{Line, Object, Point, Scene};
use crate::signal::{Floor, simulate};
use ndarray::Array2;
use num_complex::Complex64;

fn ends_of(radar: &Radar, scene: &Scene) -> TwoEnds {
    simulate(radar, scene, Floor::Thesis, 0).unwrap().two_ends(radar)
}

fn target_of(radar: &Radar, scene: &Scene, seed: u64) -> RangeAngleMap {
    let signal = simulate(radar, scene, Floor::Thesis, seed).unwrap();
    LogMaps::of_signal(radar, &signal).full.normalise(Normalisation::MinMax)
}

/// Largest distance from a reflector of `scene` to the nearest one found, y and -y being the same.
fn worst_error_metres(scene: &Scene, found: &Reconstruction) -> f64 {
    let nearest = |r: &crate::scene::Reflector| {
        let distances = found.reflectors.iter().map(|f| (f.x_metres - r.x_metres).hypot(f.y_metres - r.y_metres.abs()));
        distances.fold(f64::INFINITY, f64::min)
    };
    scene.reflectors().iter().map(nearest).fold(0.0, f64::max)
}

pub(super) fn squared_error(target: &RangeAngleMap, output: &RangeAngleMap) -> f64 {
    target.lambda.iter().zip(&output.lambda).map(|(t, o)| f64::from(t - o).powi(2)).sum()
}

#[test]
fn scenes_of_points_are_reconstructed_to_the_floor() {
    let radar = Radar::default();
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 7);
    for kind in [Kind::Set1, Kind::Set2] {
        let scene = generator.scene(kind, 1);
        let target = target_of(&radar, &scene, 0);
        let found = Nomp::default().reconstruct(&radar, &ends_of(&radar, &scene), &Request::default()).unwrap();
        assert_eq!(found.reflectors.len(), scene.reflector_count(), "{kind:?}");
        assert!(worst_error_metres(&scene, &found) < 1e-8, "{kind:?}: {:e}", worst_error_metres(&scene, &found));
        let cells = || target.lambda.iter().zip(&found.lambda.lambda).map(|(t, o)| (*t, *o));
        // The expected map is nearer to draws of the rounding noise than these are to each other.
        let draws: Vec<RangeAngleMap> = (0..5).map(|seed| target_of(&radar, &scene, seed)).collect();
        let mean = |errors: Vec<f64>| errors.iter().sum::<f64>() / errors.len() as f64;
        let error = mean(draws.iter().map(|draw| squared_error(draw, &found.lambda)).collect());
        let others = |i: usize| draws[i + 1..].iter().map(|other| squared_error(&draws[i], other)).collect::<Vec<_>>();
        let apart = mean((0..draws.len()).flat_map(others).collect());
        assert!(error < apart, "{kind:?}: SE {error}, of draws to each other {apart}");
        let eta = Nomp::default().eta();
        let part = |bright: bool| {
            let (all, above) = cells()
                .filter(|(t, _)| (*t > 0.9) == bright)
                .fold((0.0, 0.0), |(all, above), (_, o)| (all + 1.0, above + f64::from(u8::from(o > eta))));
            above / all
        };
        let (detection, alarms): (f64, f64) = (part(true), part(false));
        assert!(detection > 0.97 && alarms < 5e-4, "{kind:?}: {detection:?} {alarms}");
    }
}

#[test]
fn gain_changes_neither_positions_nor_map() {
    let radar = Radar::default();
    let scene = Scene::of_points([(4.0, 9.0), (-12.0, 15.0)]);
    let ends = ends_of(&radar, &scene);
    let plain = Nomp::default().reconstruct(&radar, &ends, &Request::default()).unwrap();
    for gain in [Complex64::from(1e-20), Complex64::new(0.0, 1e20)] {
        let scaled = TwoEnds { first: ends.first.mapv(|v| v * gain), last: ends.last.mapv(|v| v * gain) };
        let found = Nomp::default().reconstruct(&radar, &scaled, &Request::default()).unwrap();
        assert!(worst_error_metres(&scene, &found) < 1e-8);
        assert_eq!(found.reflectors.len(), plain.reflectors.len());
        for (a, b) in found.reflectors.iter().zip(&plain.reflectors) {
            assert!((a.reflectivity / gain.norm() / b.reflectivity - 1.0).abs() < 1e-9);
        }
        let worst =
            found.lambda.lambda.iter().zip(&plain.lambda.lambda).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3, "{worst}");
    }
}

#[test]
fn noise_alone_is_not_a_scene() {
    let radar = Radar::default();
    let mut noise = crate::signal::BeatSignal::silence(&radar);
    crate::signal::floor::add_noise(&mut noise, &vec![1.0; radar.elements], 3);
    let found = Nomp::default().reconstruct(&radar, &noise.two_ends(&radar), &Request::default()).unwrap();
    assert!(found.reflectors.is_empty(), "{:?}", found.reflectors);
}

#[test]
fn under_thermal_noise_it_finds_little_but_what_is_there() {
    let radar = Radar::default();
    let scene = Scene::of_points([(4.0, 9.0), (-6.0, 13.0), (1.0, 16.0)]);
    for snr in [0.0, 20.0, 40.0, 60.0] {
        let floor = Floor::Snr(Decibels(snr));
        let ends = simulate(&radar, &scene, floor, 3).unwrap().two_ends(&radar);
        let request = Request { noise: floor.into(), ..Request::default() };
        let found = Nomp::default().reconstruct(&radar, &ends, &request).unwrap();
        assert_eq!(found.reflectors.len(), 3, "{snr} dB: {:?}", found.reflectors);
        // A tooth of the comb is 4 cm wide; the bound lies far below.
        let worst = worst_error_metres(&scene, &found);
        assert!(worst < 0.02, "{snr} dB: {worst} m");
        assert!(found.lambda.lambda.iter().all(|v| (0.0..=1.0).contains(v)));
    }
}

#[test]
fn lines_and_crowds_are_found_with_every_reflector() {
    let radar = Radar::default();
    let pair = |line, point| Scene { objects: vec![Object::Line(line), Object::Point(point)], ..Scene::default() };
    let short = Line::vertical(7.0, 6.0, 1.5 * radar.range_resolution_metres(), 40);
    let slanted = Line { direction_degrees: 70.0, ..Line::vertical(-2.0, 6.0, 0.14, 45) };
    let crowd = Generator::new(&radar, Reading::Program, Purpose::Validation, 7).scene(Kind::Crowd, 1);
    for (what, scene, metres) in [
        ("a short line", pair(short, Point::new(-4.0, 15.0)), 1e-6),
        ("a slanted wall", pair(slanted, Point::new(7.0, 22.0)), 1e-5),
        ("a crowd", crowd, 1e-7),
    ] {
        let found = Nomp::default().reconstruct(&radar, &ends_of(&radar, &scene), &Request::default()).unwrap();
        assert_eq!(found.reflectors.len(), scene.reflector_count(), "{what}");
        let worst = worst_error_metres(&scene, &found);
        assert!(worst < metres, "{what}: {worst:e}");
    }
}

#[test]
fn what_takes_too_long_ends_where_its_work_is_spent() {
    let radar = Radar::default();
    let scene = Generator::new(&radar, Reading::Program, Purpose::Validation, 7).scene(Kind::Clusters, 0);
    let ends = ends_of(&radar, &scene);
    let little = Settings { max_work: 2_000, ..Settings::default() };
    let first = find(&radar, &ends, &Request::default(), &little).unwrap();
    assert!(!first.is_complete);
    // Counted, not timed: the same every time.
    assert_eq!(first, find(&radar, &ends, &Request::default(), &little).unwrap());
}

#[test]
fn a_small_array_puts_nothing_beyond_the_maximum_range() {
    let radar = Radar {
        carrier_hz: 24.125e9,
        bandwidth_hz: 250e6,
        element_spacing_metres: 0.00622,
        elements: 16,
        end_elements: 5,
        samples: 256,
        ..Radar::default()
    };
    let scene = Scene::of_points([(0.0, 20.0), (17.75, 30.74)]);
    for seed in 0..6 {
        let floor = Floor::Snr(Decibels(30.0));
        let ends = simulate(&radar, &scene, floor, seed).unwrap().two_ends(&radar);
        let found =
            Nomp::default().reconstruct(&radar, &ends, &Request { noise: floor.into(), ..Request::default() }).unwrap();
        let ranges: Vec<f64> = found.reflectors.iter().map(|r| r.x_metres.hypot(r.y_metres)).collect();
        assert!(ranges.iter().all(|range| *range < radar.max_range_metres()), "{seed}: {ranges:?}");
        // Two directions that the ends' fringes don't tell apart lie metres from each other.
        assert!(worst_error_metres(&scene, &found) < 0.05, "{seed}: {:?}", found.reflectors);
    }
}

#[test]
fn a_wide_array_finds_what_stands_beyond_the_maximum_range() {
    let radar = Radar::default();
    let scene = Scene::of_points([(4.8, 47.8), (-46.8, 22.7), (8.0, 18.3), (50.0, 12.0)]);
    let found = Nomp::default().reconstruct(&radar, &ends_of(&radar, &scene), &Request::default()).unwrap();
    assert!(worst_error_metres(&scene, &found) < 1e-6, "{:?}", found.reflectors);
}

#[test]
fn a_doubtful_giant_is_not_listed_among_doubtful_objects() {
    let radar = Radar::default();
    let point = |x_metres, y_metres| Atom::Point { x_metres, y_metres };
    let found = Found {
        atoms: vec![point(47.5, 23.5), point(12.6, 6.4), point(12.7, 7.1)],
        reflectivities: vec![33.0, 1.2, 0.8],
        scale: 1.0,
        needed_decades: vec![0.5; 3],
        ..Found::default()
    };
    let listed = found.as_drawn(&radar, RangeAngleMap { lambda: Array2::zeros((1, 1)) }, None).reflectors;
    assert_eq!(listed.iter().map(|r| r.reflectivity).collect::<Vec<_>>(), [1.2, 0.8]);
}
