//! Transmitters apart from receivers, compared with sums of their own: samples, maps, bounds, recordings, methods.

use super::off_line::{imported, largest_difference, sample, straight as small};
use crate::prelude::*;
use rand::seq::SliceRandom;

fn monostatic(radar: &Radar) -> Radar {
    Radar { antennas: None, ..radar.clone() }
}

/// Three by eight pairs of which some stand at the place of another, and whose last transmitter leaves gaps.
pub fn with_gaps() -> Radar {
    let radar = small(3, 8);
    let antennas = radar.antennas.clone().unwrap();
    let step = 2.0 * radar.element_spacing_metres;
    let mut transmitters = antennas.transmitter_x_metres().to_vec();
    transmitters[1] -= 2.0 * step;
    transmitters[2] += 3.0 * step;
    let radar = radar.with_antennas(Antennas::new(&transmitters, antennas.receiver_x_metres()).unwrap());
    assert_eq!((radar.gaps(), radar.antennas.as_ref().unwrap().left_out(), radar.elements), (5, 2, 27));
    radar
}

#[test]
fn gaps_are_alike_in_every_computation() {
    let radar = with_gaps();
    let scene = Scene::of_points([(0.6, 4.4), (-2.0, 6.0)]);
    let mut engine = Engine::new(radar.clone());
    let wanted = MapRequest { floor: Floor::Exact, ..MapRequest::default() };
    let [followed, settled] = [engine.update(&scene, &wanted).unwrap(), engine.settle(&scene, &wanted).unwrap()];
    assert_eq!(followed.full.unwrap().lambda.lambda, settled.full.unwrap().lambda.lambda);
    assert_eq!(Layout::uniform(&radar).len(), 22);
}

#[test]
fn the_search_finds_points_beside_gaps() {
    let radar = Radar { end_elements: 13, ..with_gaps() };
    let scene = Scene::of_points([(0.6, 4.4), (-2.0, 6.0)]);
    let signal = simulate(&radar, &scene, Floor::Snr(Decibels(30.0)), 0).unwrap();
    let found = found_by("nomp", &radar, &signal.two_ends(&radar));
    assert!(found.len() >= 2, "{found:?}");
    for (point, found) in scene.reflectors().iter().zip(&found) {
        let polar = radar.polar_of(point.x_metres, point.y_metres);
        assert!((found.range_metres - polar.range_metres).abs() < 0.03, "{point:?}: {found:?}");
        assert!((found.cos_theta - polar.cos_theta).abs() < 0.02, "{point:?}: {found:?}");
    }
}

#[test]
fn bounds_of_far_points_are_those_of_the_midpoints() {
    let radar = small(12, 16);
    let bound = |radar: &Radar, range: f64| {
        let reflector = Reflector { x_metres: 0.6 * range, y_metres: 0.8 * range, reflectivity: range * range };
        cramer_rao(radar, &Layout::two_ends(radar), &[reflector], 1.0).unwrap()[0]
    };
    let ratio = |range: f64| bound(&radar, range).cos_theta / bound(&monostatic(&radar), range).cos_theta;
    assert!((ratio(1e5) - 1.0).abs() < 1e-3, "{}", ratio(1e5));
    assert!((ratio(0.5) - 1.0).abs() > 1e-3, "near by the pairs' own ranges count: {}", ratio(0.5));
}

/// A capture of `points` of amplitude 1 by a physical formula of its own, its antennas in any order and anywhere along x.
fn captured(radar: &Radar, points: &[(f64, f64)], sigma: f64, rng: &mut ChaCha8Rng) -> Recording {
    let antennas = radar.antennas.clone().unwrap();
    let mut transmitters = antennas.transmitter_x_metres().to_vec();
    let mut receivers = antennas.receiver_x_metres().to_vec();
    transmitters.shuffle(rng);
    receivers.shuffle(rng);
    let noise = |rng: &mut ChaCha8Rng| rng.sample::<f64, _>(StandardNormal) * sigma / 2f64.sqrt();
    let shape = (transmitters.len(), receivers.len(), radar.samples);
    let cube = Array3::from_shape_fn(shape, |(t, r, n)| {
        let echoes = points.iter().map(|p| {
            sample(radar, [transmitters[t], receivers[r]].map(|x| [x, 0.0]), &[*p], n) * (p.0 * p.0 + p.1 * p.1)
        });
        echoes.sum::<Complex64>() + Complex64::new(noise(rng), noise(rng))
    });
    // The file counts x from its own zero.
    let [t, r] = [&transmitters, &receivers].map(|places| places.iter().map(|x| x + 0.25).collect::<Vec<_>>());
    imported(&cube, &Radar { transmit_power_watts: 1.0, ..radar.clone() }, [&t, &r], "")
}

#[test]
fn a_capture_of_pairs_has_its_rows_in_the_order_of_elements() {
    let radar = Radar { transmit_power_watts: 1.0, ..small(3, 4) };
    let points = [(0.5, 2.0), (-1.0, 6.0)];
    let recording = captured(&radar, &points, 0.0, &mut ChaCha8Rng::seed_from_u64(1));
    let objects = points.map(|(x, y)| Object::Point(Point { reflectivity: x * x + y * y, ..Point::new(x, y) }));
    let scene = Scene { objects: objects.to_vec(), ..Scene::default() };
    let expected = simulate(&recording.radar, &scene, Floor::Exact, 0).unwrap();
    let off = largest_difference(&expected, recording.signal().unwrap());
    assert!(off < 1e-9, "{off:e}");
    assert!((recording.radar.element_spacing_metres / radar.element_spacing_metres - 1.0).abs() < 1e-9);
}

const KNOW_PAIRS: [&str; 9] =
    ["baseline", "matched-filter", "matched-filter-incoherent", "fista", "omp", "iaa", "sbl", "nomp", "hybrid"];

fn near_radar() -> Radar {
    Radar { end_elements: 16, ..small(6, 16) }
}

#[test]
fn methods_that_know_no_pairs_say_so() {
    let radar = near_radar();
    let ends =
        simulate(&radar, &Scene::of_points([(0.5, 1.9)]), Floor::Snr(Decibels(30.0)), 0).unwrap().two_ends(&radar);
    for method in methods::all().iter().filter(|m| !KNOW_PAIRS.contains(&m.name())) {
        // One of live's networks was trained for pairs, those of another radar.
        assert!(!method.knows_pairs() || method.name() == "live", "{}", method.name());
        let error = method.reconstruct(&radar, &ends, &Request::default()).unwrap_err();
        assert!(matches!(error, ReconstructError::Unusable { .. }), "{}: {error}", method.name());
        let told = error.to_string();
        assert!(told.contains(method.name()) && told.contains("apart from"), "{told}");
    }
}

fn random_points(rng: &mut ChaCha8Rng) -> Vec<(f64, f64)> {
    let point = |i: usize, rng: &mut ChaCha8Rng| {
        let range = 2.0 + 2.5 * i as f64 + rng.random_range(0.0..1.5);
        let cos: f64 = rng.random_range(-0.7..0.7);
        (range * cos, range * (1.0 - cos * cos).sqrt())
    };
    (0..3).map(|i| point(i, rng)).collect()
}

#[test]
fn random_captures_are_placed_within_the_bound() {
    let geometries =
        [("6 x 16", near_radar()), ("12 x 16", Radar { end_elements: 16, ..small(12, 16) }), ("4 x 12", small(4, 12))];
    for (name, radar) in geometries {
        let mut rng = ChaCha8Rng::seed_from_u64(17);
        let mut squares = Vec::new();
        for capture in 0..6 {
            let points = random_points(&mut rng);
            let sigma = 0.03;
            let recording = captured(&radar, &points, sigma, &mut rng);
            let reflectors: Vec<Reflector> = points
                .iter()
                .map(|(x, y)| Reflector { x_metres: *x, y_metres: *y, reflectivity: x * x + y * y })
                .collect();
            let known = Radar { transmit_power_watts: 1.0, ..radar.clone() };
            let bounds = cramer_rao(&known, &Layout::two_ends(&known), &reflectors, sigma * sigma).unwrap();
            for method in ["nomp", "hybrid"] {
                let found = found_by(method, &recording.radar, &recording.two_ends());
                for (bound, (x, y)) in bounds.iter().zip(&points) {
                    let (range, cos) = (x.hypot(*y), x / x.hypot(*y));
                    let off = |d: &Detection| {
                        let range = (d.range_metres - range) / bound.range_metres;
                        range.hypot((d.cos_theta - cos) / bound.cos_theta)
                    };
                    let off = found.iter().map(off).fold(f64::INFINITY, f64::min);
                    let holds = off < 5.0;
                    assert!(holds, "{name}, capture {capture}, {method}: {off} bounds off ({x}, {y}); found {found:?}");
                    squares.push(off * off);
                }
                assert!(found.len() <= points.len() + 1, "{name}, capture {capture}, {method}: {found:?}");
            }
        }
        // Two errors of one bound each add up to 2 on average.
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((0.5..4.0).contains(&mean), "{name}: mean square {mean} of two errors in bounds; expected about 2");
    }
}
