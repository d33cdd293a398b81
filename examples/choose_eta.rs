//! Choice of the methods' thresholds and settings, on validation scenes: prints the figures, and fails where a method's own setting is not the one
//! chosen.
//!
//! One rule for the thresholds of all methods: the threshold at which the mean false-alarm rate over the validation scenes of the three
//! sets is the mean of the thesis' own rates, 0.65 %; or the highest threshold that detects 99.9 % on average, where that one is higher.
//! A method that detects so much needs no more false alarms. Not by this rule are the thresholds that a method brings along: `baseline`
//! and the thesis' networks keep the thesis' own, and `live` and `hybrid` read theirs off each answer (`examples/experts.rs`).
//!
//! `cargo run --release --example choose_eta -- thresholds|penalty`; minutes each.

use apertura::evaluate::trial::Trial;
use apertura::evaluate::{Roc, RocPoint, squared_error, upper_median};
use apertura::methods;
use apertura::radar::Radar;
use apertura::reconstruct::{Fista, Reconstructor, Request};
use apertura::scene::Scene;
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::signal::Floor;
use clap::Parser;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

/// Mean of the thesis' own false-alarm rates over its three sets (experiment 2: 0.37, 0.56 and 1.02 %).
const FALSE_ALARM: f64 = 0.0065;

/// Mean P_D at which a method needs no more false alarms.
const DETECTION: f64 = 0.999;

/// Largest difference of a method's own threshold from the one chosen: Lambda that a percent or two of one of the rates is worth.
const TOLERANCE: f32 = 0.005;

const THE_THESIS_OWN: [&str; 3] = ["baseline", "thesis", "unet"];

const SCENES: u32 = 8;

/// Choose thresholds and settings on validation scenes.
#[derive(Parser)]
enum Choice {
    /// For every method, the threshold at which its mean false-alarm rate over all three sets is the thesis' own, 0.65 %, or the highest one
    /// with a mean P_D of 99.9 %; fails where a method's own threshold is another
    Thresholds {
        /// Methods; all where none is named
        methods: Vec<String>,
    },
    /// Squared error of FISTA over its penalty
    Penalty,
}

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

fn main() -> Outcome {
    match Choice::parse() {
        Choice::Thresholds { methods } => thresholds(&methods),
        Choice::Penalty => penalty(),
    }
}

fn trial(radar: &Radar, scene: &Scene) -> Outcome<Trial> {
    Ok(Trial::new(radar, scene, Floor::Thesis, Request::default().normalisation)?)
}

fn validation(radar: &Radar, kind: Kind, count: u32) -> impl Iterator<Item = Outcome<Trial>> {
    let generator = Generator::new(radar, Reading::Program, Purpose::Validation, 0);
    (0..count).map(move |number| trial(radar, &generator.scene(kind, number)))
}

struct Figures {
    method: Arc<dyn Reconstructor>,
    roc: Roc,
    squared_error: [f64; 3],
    milliseconds: Vec<f64>,
}

fn chosen(roc: &Roc) -> Option<RocPoint> {
    let by_alarms = roc.at_false_alarm(FALSE_ALARM)?;
    Some(roc.at_detection(DETECTION).filter(|p| p.eta > by_alarms.eta).unwrap_or(by_alarms))
}

fn thresholds(names: &[String]) -> Outcome {
    let radar = Radar::default();
    let methods = if names.is_empty() {
        methods::all()
    } else {
        names.iter().map(|n| methods::by_name(n)).collect::<Result<_, _>>()?
    };
    let figures = |method| Figures { method, roc: Roc::default(), squared_error: [0.0; 3], milliseconds: Vec::new() };
    let mut all: Vec<Figures> = methods.into_iter().map(figures).collect();
    let request = Request::default();
    for (set, kind) in Kind::TEST_SETS.into_iter().enumerate() {
        for trial in validation(&radar, kind, SCENES) {
            let Trial { ends, target, .. } = trial?;
            for f in &mut all {
                let start = Instant::now();
                let output = f.method.reconstruct(&radar, &ends, &request)?;
                f.milliseconds.push(start.elapsed().as_secs_f64() * 1e3);
                f.roc.add(&target, &output.lambda);
                f.squared_error[set] += squared_error(&target, &output.lambda) / f64::from(SCENES);
            }
        }
    }
    let heading = ["own eta", "eta", "P_D %", "P_FA %", "SE 1", "SE 2", "SE 3", "ms"];
    println!("{:<28}{}", "method", heading.map(|h| format!("{h:>9}")).concat());
    let mut others = Vec::new();
    for f in &all {
        let point = chosen(&f.roc).ok_or("no threshold keeps the false-alarm rate")?;
        let (name, own) = (f.method.name(), f.method.eta());
        let brings_its_own = f.method.reads_eta() || THE_THESIS_OWN.iter().any(|n| name.starts_with(n));
        if !brings_its_own && (own - point.eta).abs() > TOLERANCE {
            others.push(format!("{name} {:.3}, not {own:.3}", point.eta));
        }
        let (eta, detection, false_alarm) = (point.eta, 100.0 * point.detection, 100.0 * point.false_alarm);
        let errors = f.squared_error.map(|error| format!("{error:>9.0}")).concat();
        let middle = upper_median(f.milliseconds.iter().copied()).unwrap_or_default();
        println!("{name:<28}{own:>9.3}{eta:>9.3}{detection:>9.2}{false_alarm:>9.2}{errors}{middle:>9.0}");
    }
    if others.is_empty() { Ok(()) } else { Err(format!("thresholds chosen: {}", others.join("; ")).into()) }
}

fn penalty() -> Outcome {
    let radar = Radar::default();
    let trials =
        Kind::TEST_SETS.into_iter().flat_map(|kind| validation(&radar, kind, 4)).collect::<Outcome<Vec<Trial>>>()?;
    let mut best = (f64::INFINITY, 0.0);
    for penalty in [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2] {
        let fista = Fista { penalty, ..Fista::default() };
        let mut error = 0.0;
        for Trial { ends, target, .. } in &trials {
            let found = fista.reconstruct(&radar, ends, &Request::default())?;
            error += squared_error(target, &found.lambda) / trials.len() as f64;
        }
        println!("penalty {penalty}: SE {error:.0}");
        if error < best.0 {
            best = (error, penalty);
        }
    }
    if Fista::default().penalty == best.1 { Ok(()) } else { Err(format!("{} would be better", best.1).into()) }
}
