//! Answers of methods to samples that hold noise alone, or an echo at the edge of the radar's map.

use crate::prelude::*;
use apertura::evaluate::sets::NOISE_LEVEL;

fn trial(scene: &Scene, floor: Floor, normalisation: Normalisation) -> (Trial, Request) {
    let request = Request { noise: floor.into(), normalisation, ..Request::default() };
    (Trial::new(&Radar::default(), scene, floor, normalisation).unwrap(), request)
}

fn generator() -> Generator {
    Generator::new(&Radar::default(), Reading::Program, Purpose::Validation, 0)
}

#[test]
fn no_method_alarms_on_noise_alone() {
    for normalisation in [Normalisation::MinMax, Normalisation::DynamicRange(Decibels(60.0))] {
        let scene = generator().scene(Kind::Noise, 0);
        let (trial, request) = trial(&scene, Floor::Level(NOISE_LEVEL), normalisation);
        for method in methods::all() {
            let answer = trial.ask(method.as_ref(), &request).unwrap();
            let name = method.name();
            assert_eq!(answer.metrics.detection, None, "{name}: nothing is there to be detected");
            assert_eq!(answer.metrics.false_alarm, 0.0, "{name}");
            assert!(trial.verdicts(&answer).ghosts.is_empty(), "{name}");
        }
    }
}

fn of_the_best_constant(target: &RangeAngleMap) -> f64 {
    let cells = target.lambda.len() as f64;
    let mean = target.lambda.iter().map(|v| f64::from(*v)).sum::<f64>() / cells;
    target.lambda.iter().map(|v| (f64::from(*v) - mean).powi(2)).sum()
}

#[test]
fn searches_draw_the_expected_map_of_noise_alone() {
    for normalisation in [Normalisation::MinMax, Normalisation::DynamicRange(Decibels(60.0))] {
        for name in ["nomp", "hybrid"] {
            let method = methods::by_name(name).unwrap();
            let (mut squared_error, mut least) = (0.0, 0.0);
            for number in 0..4 {
                let (trial, request) =
                    trial(&generator().scene(Kind::Noise, number), Floor::Level(NOISE_LEVEL), normalisation);
                let answer = trial.ask(method.as_ref(), &request).unwrap();
                assert!(answer.found.reflectors.is_empty() && answer.metrics.false_alarm == 0.0, "{name}");
                squared_error += answer.metrics.squared_error / 4.0;
                least += of_the_best_constant(&trial.target) / 4.0;
            }
            assert!(squared_error < 1.3 * least, "{name}, {normalisation}: SE {squared_error:.0} for {least:.0}");
        }
    }
}

#[test]
fn live_hardly_alarms_on_noise_that_drowns_the_echoes() {
    let live = methods::by_name("live").unwrap();
    for (snr, at_most) in [(-10.0, 5e-3), (-20.0, 5e-3)] {
        for kind in [Kind::Set1, Kind::Set2] {
            let rates: Vec<f64> = (0..4)
                .map(|number| {
                    let floor = Floor::Snr(Decibels(snr));
                    let (trial, request) = trial(&generator().scene(kind, number), floor, Normalisation::MinMax);
                    trial.ask(live.as_ref(), &request).unwrap().metrics.false_alarm
                })
                .collect();
            let mean = rates.iter().sum::<f64>() / rates.len() as f64;
            assert!(mean <= at_most, "set {kind} at {snr} dB: {rates:?}");
        }
    }
}

/// Most squared error at the maximum range and beneath the first range bin, and most false alarms.
const AT_THE_EDGE: [(&str, [f64; 2], f64); 6] = [
    ("iaa", [600.0, 2_000.0], 0.07),
    ("sbl", [600.0, 2_000.0], 0.07),
    ("omp", [600.0, 2_000.0], 0.07),
    ("nomp", [600.0, 100.0], 2e-3),
    ("hybrid", [600.0, 100.0], 2e-3),
    ("live", [1_100.0, 14_000.0], 0.04),
];

#[test]
fn one_echo_at_the_edge_of_what_is_seen_is_no_map_of_echoes() {
    for (name, most, most_alarms) in AT_THE_EDGE {
        // Range bin 512, which wraps to bin 0; and beneath the first range bin.
        for (y, most) in [38.4, 0.05].into_iter().zip(most) {
            let (trial, request) = trial(&Scene::of_points([(0.0, y)]), Floor::Thesis, Normalisation::MinMax);
            let answer = trial.ask(methods::by_name(name).unwrap().as_ref(), &request).unwrap();
            let (se, alarms) = (answer.metrics.squared_error, answer.metrics.false_alarm);
            assert!(se < most && alarms < most_alarms, "{name}, {y} m: SE {se:.0}, P_FA {alarms}");
            // No training scene of live lies as near as 5 cm.
            let least = if name == "live" && y < 0.1 { 0.6 } else { 0.9 };
            assert!(answer.metrics.detection > Some(least), "{name}, {y} m: P_D {:?}", answer.metrics.detection);
        }
    }
}
