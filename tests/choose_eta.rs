//! How the methods' thresholds and settings were chosen, on validation scenes:
//! `cargo test --release --test choose_eta -- --ignored --nocapture`, or with the name of one test.

use apertura::evaluate::{Roc, squared_error};
use apertura::maps::{LogMaps, RangeAngleMap};
use apertura::methods;
use apertura::radar::Radar;
use apertura::reconstruct::nomp::{Settings, find};
use apertura::reconstruct::{Fista, Hybrid, Reconstructor, Request};
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::{GaussianCluster, Object, Scene};
use apertura::signal::{Floor, TwoEnds, simulate};
use std::time::Instant;

/// The false-alarm rate at which the methods that draw exact maps are thresholded: they need no more.
const EXACT_FALSE_ALARM: f64 = 0.0005;

/// Mean of the thesis' own false-alarm rates over its three sets (experiment 2: 0.37, 0.56 and 1.02 %).
const FALSE_ALARM: f64 = 0.0065;

/// Scenes of each set.
const SCENES: u32 = 8;

/// Prints, for every method (or those in `METHODS`, comma-separated), the threshold at which its false-alarm rate over validation
/// scenes of all three sets is the thesis' own; for the methods that draw exact maps, [`EXACT_FALSE_ALARM`].
#[test]
#[ignore = "minutes; prints the thresholds written into the methods"]
fn choose() {
    let radar = Radar::default();
    let wanted = std::env::var("METHODS").unwrap_or_default();
    let methods: Vec<_> =
        methods::all().into_iter().filter(|m| wanted.is_empty() || wanted.split(',').any(|w| w == m.name())).collect();
    assert!(!methods.is_empty(), "no method is called {wanted}");
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 0);
    let mut tallies: Vec<_> = methods.iter().map(|_| (Roc::default(), [0.0; 3], Vec::new())).collect();
    for (set, kind) in Kind::TEST_SETS.into_iter().enumerate() {
        for number in 0..SCENES {
            let signal = simulate(&radar, &generator.scene(kind, number), Floor::Thesis, 0).unwrap();
            let request = Request::default();
            let target = LogMaps::of_signal(&radar, &signal).full.normalise(request.normalisation);
            let ends = signal.two_ends(&radar);
            for (method, (roc, error, times)) in methods.iter().zip(&mut tallies) {
                let start = Instant::now();
                let output = method.reconstruct(&radar, &ends, &request).unwrap();
                times.push(start.elapsed().as_secs_f64() * 1e3);
                roc.add(&target, &output.lambda);
                error[set] += squared_error(&target, &output.lambda) / f64::from(SCENES);
            }
        }
    }
    println!("{:<28}{:>8}{:>9}{:>9}{:>9}{:>9}{:>10}", "method", "eta", "P_D %", "SE 1", "SE 2", "SE 3", "ms");
    for (method, (roc, error, times)) in methods.iter().zip(&mut tallies) {
        let exact = matches!(method.name(), "nomp" | "hybrid");
        let point = roc.at_false_alarm(if exact { EXACT_FALSE_ALARM } else { FALSE_ALARM }).unwrap();
        times.sort_by(f64::total_cmp);
        println!(
            "{:<28}{:>8.3}{:>9.2}{:>9.0}{:>9.0}{:>9.0}{:>10.0}",
            method.name(),
            point.eta,
            point.detection * 100.0,
            error[0],
            error[1],
            error[2],
            times[times.len() / 2]
        );
    }
}

/// A scene as a method meets it, and what it is compared with.
fn trial(radar: &Radar, scene: &Scene) -> (TwoEnds, RangeAngleMap) {
    let signal = simulate(radar, scene, Floor::Thesis, 0).unwrap();
    let target = LogMaps::of_signal(radar, &signal).full.normalise(Request::default().normalisation);
    (signal.two_ends(radar), target)
}

/// Prints the squared error of FISTA over its penalty.
#[test]
#[ignore = "minutes; prints the figures behind Fista's default penalty"]
fn choose_penalty() {
    let radar = Radar::default();
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 0);
    let trials: Vec<_> = Kind::TEST_SETS
        .into_iter()
        .flat_map(|kind| (0..4).map(move |number| (kind, number)))
        .map(|(kind, number)| trial(&radar, &generator.scene(kind, number)))
        .collect();
    let error = |penalty: f64| {
        let fista = Fista { penalty, ..Fista::default() };
        let of = |(ends, target): &(TwoEnds, RangeAngleMap)| {
            squared_error(target, &fista.reconstruct(&radar, ends, &Request::default()).unwrap().lambda)
        };
        trials.iter().map(of).sum::<f64>() / trials.len() as f64
    };
    let penalties = [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2];
    let errors = penalties.map(error);
    for (penalty, error) in penalties.iter().zip(&errors) {
        println!("penalty {penalty}: SE {error:.0}");
    }
    let best = (0..penalties.len()).min_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap();
    assert_eq!(Fista::default().penalty, penalties[best], "the default is not the best of these");
}

/// Prints the squared error of the hybrid over the part of the energy that may be unexplained before its fallback is asked: on
/// validation scenes, and on clouds of reflectors that are neither a few points nor lines.
#[test]
#[ignore = "minutes; prints the figures behind the hybrid's limit"]
fn choose_most_unexplained() {
    let radar = Radar::default();
    let request = Request::default();
    let fallback = methods::by_name("live").or_else(|_| methods::by_name("matched-filter-incoherent")).unwrap();
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 0);
    let cloud = |i: u32| {
        let spread = 0.05 * 3f64.powf(f64::from(i % 5));
        let cluster = GaussianCluster {
            x_metres: f64::from(i % 7) * 3.0 - 9.0,
            y_metres: 8.0 + f64::from(i % 3) * 5.0,
            x_std_metres: spread,
            y_std_metres: spread,
            count: 10 + 10 * i as usize,
            seed: u64::from(i),
            reflectivity: 1.0,
        };
        Scene { objects: vec![Object::Gaussian(cluster)], ..Scene::default() }
    };
    let sets = Kind::TEST_SETS.into_iter().flat_map(|kind| (0..6).map(move |number| (kind, number)));
    let scenes = sets.map(|(kind, number)| generator.scene(kind, number)).chain((0..15).map(cloud));
    // Part unexplained (0 where explained to the floor), SE without and with the fallback.
    let rows: Vec<(f64, f64, f64)> = scenes
        .map(|scene| {
            let (ends, target) = trial(&radar, &scene);
            let found = find(&radar, &ends, &request, &Settings::default()).unwrap();
            let drawn = found.reconstruction(&radar, &request).lambda;
            let alone = squared_error(&target, &drawn);
            if found.complete {
                return (0.0, alone, alone);
            }
            let mut filled = fallback.reconstruct(&radar, &ends, &request).unwrap().lambda;
            filled.lambda.zip_mut_with(&drawn.lambda, |f, d| *f = f.max(*d));
            let filled = squared_error(&target, &filled);
            println!("unexplained {:.2e}: SE {alone:.0} alone, {filled:.0} filled in", found.unexplained);
            (found.unexplained, alone, filled)
        })
        .collect();
    let limits = [1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3];
    let errors = limits.map(|limit| {
        rows.iter().map(|(part, alone, filled)| if *part > limit { filled } else { alone }).sum::<f64>()
            / rows.len() as f64
    });
    for (limit, error) in limits.iter().zip(&errors) {
        println!("limit {limit}: SE {error:.0}");
    }
    let best = (0..limits.len()).min_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap();
    let own = limits.iter().position(|l| *l == Hybrid::MOST_UNEXPLAINED).unwrap();
    assert!(errors[own] <= 1.01 * errors[best], "{} would be better", limits[best]);
}
