//! Transmitters and receivers on a bent bumper: samples compared with sums of their own, focused maps, methods, and mirrored captures.

use super::pairs::with_gaps;
use crate::prelude::*;
use apertura::evaluate::squared_error;
use apertura::radar::BuiltArray;
use apertura::scattering::EchoSources;
use ndarray::{Axis, s};

const C: f64 = 299_792_458.0;

pub fn straight(transmitters: usize, receivers: usize) -> Radar {
    let usual = Radar { bandwidth_hz: 1e9, samples: 96, ..Radar::default() };
    usual.of_pairs(transmitters, receivers).unwrap()
}

/// The radar on a bumper whose ends stand back by `back_metres`: each antenna stands on one parabola.
fn bent(radar: &Radar, back_metres: f64) -> Radar {
    let antennas = radar.antennas.clone().unwrap();
    let [low, high] = antennas.span_metres();
    let half = low.abs().max(high.abs());
    let y = |places: &[f64]| places.iter().map(|x| -back_metres * (x / half).powi(2)).collect::<Vec<_>>();
    let (transmitters, receivers) = (y(antennas.transmitter_x_metres()), y(antennas.receiver_x_metres()));
    radar.clone().with_antennas(antennas.off_line(&transmitters, &receivers).unwrap())
}

fn places(antennas: &Antennas, n: usize) -> [[f64; 2]; 2] {
    let [t, r] = antennas.pairs()[n].unwrap();
    [
        [antennas.transmitter_x_metres()[t], antennas.transmitter_y_metres()[t]],
        [antennas.receiver_x_metres()[r], antennas.receiver_y_metres()[r]],
    ]
}

/// The sum of the physical formula for one pair, for each watt. Places of antennas are (x, y) in metres.
pub fn sample(radar: &Radar, [transmitter, receiver]: [[f64; 2]; 2], points: &[(f64, f64)], n: usize) -> Complex64 {
    let hz = radar.carrier_hz + radar.bandwidth_hz * n as f64 / radar.samples as f64;
    let echo = |(x, y): &(f64, f64)| {
        let [there, back] = [transmitter, receiver].map(|[ax, ay]| ((x - ax).powi(2) + (y - ay).powi(2)).sqrt());
        Complex64::from_polar(1.0 / (there * back), TAU * (hz * (there + back) / C).fract())
    };
    points.iter().map(echo).sum()
}

pub fn largest_difference(a: &BeatSignal, b: &BeatSignal) -> f64 {
    let off = a.samples.iter().zip(&b.samples).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    off / a.peak()
}

fn bodies() -> Scene {
    let objects = vec![
        Object::Wall(Wall::new(-1.0, 3.0, 2.0, 10.0)),
        Object::Box(Block::new([0.8, 2.0], [0.5, 0.4], 80.0)),
        Object::Point(Point::new(0.2, 4.0)),
    ];
    Scene { objects, ..Scene::default() }
}

#[test]
fn samples_are_a_direct_sum_for_where_the_antennas_stand() {
    let points = [(0.6, 1.4), (-2.0, 5.0), (1.0, 9.0), (0.1, 3.0), (-4.0, 7.0)];
    let on_line = [straight(3, 4), straight(12, 16), straight(2, 31), with_gaps()];
    let off_line = [bent(&straight(3, 4), 0.04), bent(&straight(12, 16), 0.012), bent(&straight(2, 31), -0.3)];
    for radar in on_line.into_iter().chain(off_line) {
        let antennas = radar.antennas.clone().unwrap();
        let scene = Scene::of_points(points);
        let signal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
        let over_floor = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        for n in 0..radar.elements {
            if radar.is_gap(n) {
                assert!(signal.samples.row(n).iter().all(|v| v.norm_sqr() == 0.0), "element {n} is a gap");
                continue;
            }
            for at in [0, 1, 50, 95] {
                let direct = sample(&radar, places(&antennas, n), &points, at) * radar.transmit_power_watts;
                for signal in [&signal, &over_floor] {
                    let off = (signal.samples[[n, at]] - direct).norm() / signal.peak();
                    assert!(off < 1e-10, "element {n}, sample {at}: {off:e}");
                }
            }
        }
        let chirps = Radar { chirps: 2, ..radar.clone() };
        let rows = simulate_chirps_for(&Task::default(), &chirps, &scene, Floor::Exact, 0).unwrap().samples;
        for (row, n) in chirp_elements(&chirps).into_iter().flatten().enumerate() {
            let off = (rows[[1, row, 50]] - signal.samples[[n, 50]]).norm() / signal.peak();
            assert!(off < 1e-10, "chirp 1 of element {n}: {off:e}");
        }
    }
}

#[test]
fn points_with_bodies_are_what_double_double_arithmetic_gives() {
    let bent_back = [bent(&straight(3, 4), 0.04), bent(&straight(4, 5), -0.02)];
    for radar in [straight(3, 4), straight(4, 5)].into_iter().chain(bent_back) {
        for scene in [bodies(), Scene::of_points((0..9).map(|i| (f64::from(i) - 4.0, 1.5 + 0.7 * f64::from(i))))] {
            let judged = judge::beat_signal(&radar, &EchoSources::of(&radar, &scene));
            for floor in [Floor::Exact, Floor::Thesis] {
                let off = largest_difference(&judged, &simulate(&radar, &scene, floor, 0).unwrap());
                assert!(off < 1e-10, "over {floor}: {off:e}");
            }
        }
    }
}

fn far_points() -> Scene {
    Scene::of_points([(0.0, 12.0), (3.0, 9.0), (-6.0, 8.0), (10.0, 13.0), (-12.0, 15.0)])
}

fn target(radar: &Radar, scene: &Scene) -> RangeAngleMap {
    let signal = simulate(radar, scene, Floor::Exact, 0).unwrap();
    let maps = LogMaps::of_elements(radar, &scene.disturbances.elements, &signal);
    maps.full.normalise(Normalisation::DynamicRange(Decibels(40.0)))
}

#[test]
fn focusing_a_bent_array_gives_a_straight_arrays_map() {
    let radar = straight(12, 16);
    let reference = target(&radar, &far_points());
    println!("12 x 16 pairs, five points at 10 to 20 m: SE of the map against that of the straight array");
    for back_millimetres in [0.5, 1.0, 2.0, 5.0, 10.0, 20.0] {
        let bent = bent(&radar, back_millimetres * 1e-3);
        let focused = Radar { focus_off_line: true, ..bent.clone() };
        let [nearest, focused] = [&bent, &focused].map(|r| squared_error(&reference, &target(r, &far_points())));
        println!("ends {back_millimetres} mm back: {nearest:.2} by the nearest place, {focused:.3} focused");
        assert!(focused < 0.05 * nearest, "{back_millimetres} mm: {focused} of {nearest}");
    }
}

#[test]
fn elements_that_send_and_hear_by_themselves_are_focused_too() {
    let radar = Radar { elements: 128, samples: 96, bandwidth_hz: 1e9, ..Radar::default() };
    let straight = far_points();
    let mut scene = straight.clone();
    scene.disturbances.elements = BuiltArray::default().bent(&radar, 4.0);
    let focusing = Radar { focus_off_line: true, ..radar.clone() };
    let reference = target(&radar, &straight);
    let [nearest, focused] = [&radar, &focusing].map(|r| squared_error(&reference, &target(r, &scene)));
    println!("128 elements, ends 4 mm back: SE {nearest:.2} by the nearest place, {focused:.3} focused");
    assert!(focused < 0.05 * nearest, "{focused} of {nearest}");
}

#[test]
fn the_engine_shows_the_focused_map() {
    let radar = Radar { focus_off_line: true, ..bent(&straight(4, 12), 0.004) };
    let (mut engine, scene) = (Engine::new(radar.clone()), far_points());
    let wanted = MapRequest { floor: Floor::Exact, ..MapRequest::default() };
    let expected = LogMaps::of_signal(&radar, &simulate(&radar, &scene, Floor::Exact, 0).unwrap());
    let expected = expected.full.normalise(wanted.normalisation).lambda;
    for frame in [engine.update(&scene, &wanted).unwrap(), engine.settle(&scene, &wanted).unwrap()] {
        assert_eq!(frame.full.unwrap().lambda.lambda, expected);
    }
    let unfocused = Radar { focus_off_line: false, ..radar };
    let plain = Engine::new(unfocused).settle(&scene, &wanted).unwrap().full.unwrap();
    assert_ne!(plain.lambda.lambda, expected);
}

/// Distance of the strongest echo that each method finds from the point, in metres of range and in cos(theta).
fn off_by(radar: &Radar, (x, y): (f64, f64)) -> Vec<(&'static str, [f64; 2])> {
    let signal = simulate(radar, &Scene::of_points([(x, y)]), Floor::Snr(Decibels(25.0)), 0).unwrap();
    let of = |name: &'static str| {
        let found = found_by(name, radar, &signal.two_ends(radar));
        let first = found.first().unwrap_or_else(|| panic!("{name} found nothing"));
        (name, [first.range_metres - x.hypot(y), first.cos_theta - x / x.hypot(y)])
    };
    ["matched-filter", "omp", "iaa", "sbl", "nomp", "hybrid"].map(of).to_vec()
}

#[test]
fn methods_that_know_pairs_place_a_point_before_a_bent_array() {
    let radar = Radar { end_elements: 16, ..straight(6, 16) };
    for back_metres in [0.0, 0.0005, 0.001, 0.002, 0.005, 0.01] {
        for (name, [range, cos]) in off_by(&bent(&radar, back_metres), (0.5, 1.9)) {
            println!("{back_metres} m back, {name}: off by {range:.4} m, {cos:.4}");
            let is_near = range.abs() < 0.05 && cos.abs() < 0.02;
            assert!(is_near, "{back_metres} m back, {name}: {range} m, {cos}");
        }
    }
}

/// The recording of a capture of pairs whose antennas stand there, and whose text has `more` at its end.
pub fn imported(cube: &Array3<Complex64>, radar: &Radar, [t, r]: [&[f64]; 2], more: &str) -> Recording {
    let folder = tempfile::tempdir().unwrap();
    write_npz(&folder.path().join("c.npz"), |out| out.add("cube", cube)).unwrap();
    let Radar { carrier_hz, bandwidth_hz, end_elements, samples, transmit_power_watts, .. } = radar;
    let text = format!(
        "format = 2\n[radar]\nconvention = \"physical\"\ncarrier_hz = {carrier_hz:?}\nbandwidth_hz = {bandwidth_hz:?}\n\
         end_elements = {end_elements}\nsamples = {samples}\ntransmit_power_watts = {transmit_power_watts:?}\n\
         transmitter_x_metres = {t:?}\nreceiver_x_metres = {r:?}\n[recording]\nfile = \"c.npz\"\narray = \"cube\"\n\
         axes = [\"transmitter\", \"receiver\", \"sample\"]\ncarrier_at = \"first-sample\"\nbeat_sign = \"+\"\n{more}",
    );
    fs::write(folder.path().join("c.toml"), text).unwrap();
    recording::file::load(&folder.path().join("c.toml")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_capture_whose_axis_runs_the_other_way_is_turned_round() {
    let radar = straight(3, 4);
    let antennas = radar.antennas.clone().unwrap();
    let points = [(1.2, 3.0), (-0.4, 5.0)];
    let [t, r] = [antennas.transmitter_x_metres().to_vec(), antennas.receiver_x_metres().to_vec()];
    let cube = Array3::from_shape_fn((3, 4, radar.samples), |(i, j, n)| {
        sample(&radar, [[t[i], 0.0], [r[j], 0.0]], &points, n)
    });
    let right = imported(&cube, &radar, [&t, &r], "");
    // The author of this text counted x to the other side.
    let [left_t, left_r] = [&t, &r].map(|places| places.iter().map(|x| -x).collect::<Vec<_>>());
    let wrong = imported(&cube, &radar, [&left_t, &left_r], "");
    let turned = imported(&cube, &radar, [&left_t, &left_r], "reverse_elements = true\n");
    let samples = |recording: &Recording| recording.signal().unwrap().samples.clone();
    assert_eq!((samples(&turned), &turned.radar), (samples(&right), &right.radar));
    assert_eq!(samples(&wrong).slice(s![..;-1, ..]), samples(&right), "the phases stay as they are");
    let strongest = |recording: &Recording| {
        let full = LogMaps::of_signal(&recording.radar, recording.signal().unwrap()).full;
        let columns = full.decades().map_axis(Axis(0), |column| column.iter().fold(f64::MIN, |m: f64, v| m.max(*v)));
        let best = columns.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        recording.radar.cos_of_column(best as f64)
    };
    assert!(strongest(&turned) > 0.2 && strongest(&wrong) < -0.2, "{} {}", strongest(&turned), strongest(&wrong));
}
