//! How the methods' thresholds were chosen: `cargo test --release --test choose_eta -- --ignored --nocapture`.

use apertura::evaluate::{Roc, squared_error};
use apertura::maps::LogMaps;
use apertura::methods;
use apertura::radar::Radar;
use apertura::reconstruct::Request;
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::signal::{Floor, simulate};
use std::time::Instant;

/// Mean of the thesis' own false-alarm rates over its three sets (experiment 2: 0.37, 0.56 and 1.02 %).
const FALSE_ALARM: f64 = 0.0065;

/// Scenes of each set.
const SCENES: u32 = 8;

/// Prints, for every method (or those in `METHODS`, comma-separated), the threshold at which its false-alarm rate over validation
/// scenes of all three sets is the thesis' own.
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
        let point = roc.at_false_alarm(FALSE_ALARM).unwrap();
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
