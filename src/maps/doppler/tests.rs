use super::*;
use crate::radar::{Carrier, Convention, Decibels, SPEED_OF_LIGHT};
use crate::scene::{Block, Object, Point, Wall};
use crate::signal::{simulate_chirps_for, simulate_ends_for};
use std::f64::consts::TAU;

fn radar() -> Radar {
    Radar { elements: 64, samples: 128, bandwidth_hz: 4e8, chirps: 64, ..Radar::default() }
}

fn moving(x_metres: f64, y_metres: f64, [vx, vy]: [f64; 2]) -> Object {
    Object::Point(Point {
        velocity_x_metres_per_second: vx,
        velocity_y_metres_per_second: vy,
        ..Point::new(x_metres, y_metres)
    })
}

fn scene(objects: Vec<Object>) -> Scene {
    Scene { objects, ..Scene::default() }
}

fn map(radar: &Radar, scene: &Scene, floor: Floor) -> RangeDopplerMap {
    range_doppler(radar, scene, floor, 3).unwrap()
}

/// Sample by sample: the range at the very time of each sample put into equation 3.3.
fn reference(radar: &Radar, element: usize, [x, y, vx, vy]: [f64; 4], chirp: usize, sample: usize) -> Complex64 {
    let part = sample as f64 / radar.samples as f64;
    let seconds = chirp as f64 * radar.chirp_interval_seconds + part * radar.chirp_seconds;
    let range = (x + vx * seconds - radar.element_x_metres(element)).hypot(y + vy * seconds);
    let turns = match radar.carrier {
        Carrier::OneWay => -radar.carrier_hz * range / SPEED_OF_LIGHT,
        Carrier::TwoWay => radar.carrier_hz * 2.0 * range / SPEED_OF_LIGHT,
    };
    let beat = part * radar.bandwidth_hz * 2.0 * range / SPEED_OF_LIGHT;
    Complex64::from_polar(radar.transmit_power_watts / (range * range), TAU * (turns + beat))
}

#[test]
fn samples_are_those_of_the_range_at_their_own_time() {
    let place = [2.0, 11.0, 17.0, -23.0];
    let scene = scene(vec![moving(2.0, 11.0, [17.0, -23.0])]);
    for convention in Convention::ALL {
        let radar = Radar { chirp_interval_seconds: 30e-6, ..radar() }.in_convention(convention);
        let samples = simulate_chirps_for(&Task::default(), &radar, &scene, Floor::Exact, 0).unwrap().samples;
        for (row, element) in [(0, 0), (3, 3), (4, 60), (7, 63)] {
            for (chirp, sample) in [(0, 0), (0, 127), (1, 64), (40, 3), (63, 127)] {
                let (found, expected) =
                    (samples[[chirp, row, sample]], reference(&radar, element, place, chirp, sample));
                // The amplitude is that of the beginning of the chirp: 2 v Tc / R of it is 1.3e-4.
                assert!((found - expected).norm() < 2e-4 * expected.norm(), "{convention:?} {chirp} {sample}");
                // Curvature within a chirp: 3e-9 m.
                let turned = (found * expected.conj()).arg();
                assert!(turned.abs() < 2e-5, "{convention:?} {chirp} {sample}: {turned:e}");
            }
        }
    }
}

#[test]
fn at_rest_the_first_chirp_has_the_bits_of_a_single_one() {
    let radar = radar();
    let objects = vec![Object::Point(Point::new(2.0, 11.0)), Object::Wall(Wall::new(0.0, 20.0, 3.0, 10.0))];
    let mut scene = scene(objects);
    for floor in [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(20.0))] {
        let ends = simulate_ends_for(&Task::default(), &radar, &scene, floor, 7).unwrap();
        let chirps = simulate_chirps_for(&Task::default(), &radar, &scene, floor, 7).unwrap().samples;
        let first = chirps.index_axis(Axis(0), 0);
        assert_eq!(first.slice(s![..4, ..]), ends.first.slice(s![..4, ..]));
        assert_eq!(first.slice(s![4.., ..]), ends.last.slice(s![-4.., ..]));
        let second = chirps.index_axis(Axis(0), 1);
        assert_eq!(first == second, floor == Floor::Exact, "each chirp has noise of its own over {floor}");
    }
    scene.disturbances.elements.elements = vec![crate::radar::ElementError::default(); 64];
    scene.disturbances.elements.elements[3].dead = true;
    scene.disturbances.elements.elements[2].gain = Decibels(3.0);
    scene.disturbances.elements.elements[60].forward_millimetres = 0.7;
    let ends = simulate_ends_for(&Task::default(), &radar, &scene, Floor::Thesis, 7).unwrap();
    let chirps = simulate_chirps_for(&Task::default(), &radar, &scene, Floor::Thesis, 7).unwrap().samples;
    assert_eq!(chirps.slice(s![0, 4.., ..]), ends.last.slice(s![-4.., ..]));
    assert_eq!(chirps.slice(s![0, ..4, ..]), ends.first.slice(s![..4, ..]));
}

#[test]
fn moving_objects_are_disturbed_as_those_at_rest() {
    let radar = radar();
    let of = |slow: f64| {
        let mut scene = scene(vec![moving(2.0, 11.0, [0.0, slow]), Object::Point(Point::new(-3.0, 9.0))]);
        scene.disturbances.elements.elements = vec![crate::radar::ElementError::default(); 64];
        scene.disturbances.elements.elements[3].dead = true;
        scene.disturbances.elements.elements[2].phase_degrees = 40.0;
        scene.disturbances.elements.elements[60].position_millimetres = 0.7;
        scene.disturbances.mirror = Some(crate::scene::Mirror::default());
        simulate_chirps_for(&Task::default(), &radar, &scene, Floor::Exact, 0).unwrap().samples
    };
    let (rests, creeps) = (of(0.0), of(1e-9));
    let peak = rests.iter().fold(0.0f64, |m, v| m.max(v.norm()));
    assert!((&rests - &creeps).iter().all(|v| v.norm() < 1e-6 * peak));
    assert!(creeps.slice(s![.., 3, ..]).iter().all(|v| *v == Complex64::default()));
}

#[test]
fn a_moving_box_is_heard_as_boxes_at_rest_where_it_is() {
    let radar = Radar { chirps: 3, chirp_interval_seconds: 1e-3, ..radar() };
    let mut object = Object::Box(Block::new([1.0, 11.0], [4.0, 1.8], 80.0));
    *object.velocity_mut()[1] = 1e-3;
    let scene = scene(vec![object, Object::Point(Point::new(1.5, 20.0))]);
    let samples = simulate_chirps_for(&Task::default(), &radar, &scene, Floor::Exact, 0).unwrap().samples;
    for chirp in 0..3 {
        let mut then = scene.at(chirp as f64 * 1e-3);
        *then.objects[0].velocity_mut()[1] = 0.0;
        let ends = simulate_ends_for(&Task::default(), &radar, &then, Floor::Exact, 0).unwrap();
        let peak = ends.first.iter().fold(0.0f64, |m, v| m.max(v.norm()));
        let found = samples.slice(s![chirp, ..4, ..]);
        // The way of 1 micrometre during the chirp turns the phase by 2e-3 at most.
        let off = (&found - &ends.first.slice(s![..4, ..])).iter().fold(0.0f64, |m, v| m.max(v.norm()));
        assert!(off < 4e-3 * peak, "{chirp}: {off} of {peak}");
    }
}

/// The textbook's column and range bin of one point straight ahead, at the middle of the frame.
fn expected(radar: &Radar, range_metres: f64, velocity: f64) -> (f64, f64) {
    // Signed turns a chirp in the middle of the sweep: there the wave is that of f - B (thesis) or f + B / 2, which counts twice.
    let (ways, hertz) = match radar.carrier {
        Carrier::OneWay => (-1.0, radar.carrier_hz - radar.bandwidth_hz),
        Carrier::TwoWay => (2.0, radar.carrier_hz + radar.bandwidth_hz / 2.0),
    };
    let doppler_hz = ways * hertz * velocity / SPEED_OF_LIGHT;
    let sign = f64::signum(ways);
    let column = (sign * doppler_hz * radar.chirp_interval_seconds * radar.chirps as f64 + (radar.chirps / 2) as f64)
        .rem_euclid(radar.chirps as f64);
    let middle = range_metres + velocity * radar.chirps as f64 * radar.chirp_interval_seconds / 2.0;
    (middle * 2.0 * radar.bandwidth_hz / SPEED_OF_LIGHT + doppler_hz * radar.chirp_seconds, column)
}

#[test]
fn a_point_stands_in_the_column_of_its_velocity_or_folds() {
    for convention in Convention::ALL {
        // Chirps of 35 microseconds, one every 40.
        let radar = Radar { chirp_interval_seconds: 40e-6, chirp_seconds: 35e-6, ..radar() }.in_convention(convention);
        let most = radar.unambiguous_velocity_metres_per_second();
        for velocity in [0.0, 0.31 * most, -0.77 * most, 1.4 * most, -2.2 * most] {
            let scene = scene(vec![moving(0.0, 14.0, [0.0, velocity])]);
            let (bin, column) = map(&radar, &scene, Floor::Exact).peak();
            let (expected_bin, expected_column) = expected(&radar, 14.0, velocity);
            let off = (column as f64 - expected_column).abs();
            assert!(off.min(64.0 - off) < 0.51, "{convention:?} {velocity}: column {column}, {expected_column}");
            assert!((bin as f64 - expected_bin).abs() < 0.55, "{convention:?} {velocity}: {bin}, {expected_bin}");
            let apparent = radar.apparent_velocity_metres_per_second(velocity);
            let read = radar.velocity_of_column_metres_per_second(column as f64);
            let fold = (read - apparent).abs();
            assert!(fold.min(2.0 * most - fold) < 0.51 * radar.velocity_resolution_metres_per_second());
        }
    }
}

#[test]
fn one_chirp_is_one_column() {
    let radar = Radar { chirps: 1, ..radar() };
    let map = map(&radar, &scene(vec![moving(0.0, 14.0, [0.0, 5.0])]), Floor::Thesis);
    assert_eq!((map.power.dim(), map.peak().1), ((128, 1), 0));
    let bin = radar.bin_of_range(14.0);
    assert!((map.peak().0 as f64 - bin).abs() < 0.6);
}

#[test]
fn noise_spreads_over_all_cells_alike() {
    let radar = radar();
    let floor = Floor::Level(crate::radar::DecibelMilliwatts(-30.0));
    let map = map(&radar, &Scene::default(), floor);
    // Both windows are Hann's, whose mean square is 3/8; 1 microwatt a sample.
    let mean = map.power.mean().unwrap();
    assert!((mean / (1e-6 * 0.375f64.powi(2)) - 1.0).abs() < 0.05, "{mean:e}");
}

#[test]
fn a_scene_that_can_not_be_simulated_is_told() {
    let radar = radar();
    let run = |scene: &Scene| range_doppler(&radar, scene, Floor::Exact, 0).map(|_| ());
    let nan = run(&scene(vec![moving(0.0, 9.0, [f64::NAN, 0.0])])).unwrap_err().to_string();
    assert!(nan.contains("velocity_x_metres_per_second is NaN"), "{nan}");
    let task = Task::default();
    task.cancel();
    let still = scene(vec![moving(0.0, 9.0, [1.0, 0.0])]);
    assert!(range_doppler_for(&task, &radar, &still, Floor::Exact, 0).is_err());
}
