//! How the methods' thresholds and settings were chosen, on validation scenes: prints the figures, and fails where a method's own setting
//! is not the one chosen.
//!
//! One rule for the thresholds of all methods: the threshold at which the mean false-alarm rate over the validation scenes of the three
//! sets is the mean of the thesis' own rates, 0.65 %; or the highest threshold that detects 99.9 % on average, where that one is higher.
//! A method that detects so much needs no more false alarms. Not by this rule are the thresholds that a method brings along: `baseline`
//! and the thesis' networks keep the thesis' own, and `live` reads its off each scene (`live` below).
//!
//! `cargo run --release --example choose_eta -- thresholds|live|penalty|weights|takeover`; minutes each.

use apertura::evaluate::trial::Trial;
use apertura::evaluate::{Roc, RocPoint, detection_rates, squared_error};
use apertura::methods;
use apertura::radar::{Decibels, Radar};
use apertura::reconstruct::search::{Settings, find};
use apertura::reconstruct::{Fista, Hybrid, Reconstructor, Request, Unexplained};
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

/// How far a method's own threshold may lie from the one chosen: Lambda that a percent or two of one of the rates is worth.
const TOLERANCE: f32 = 0.005;

/// Methods with the thesis' own thresholds.
const THE_THESIS_OWN: [&str; 3] = ["baseline", "thesis", "unet"];

/// Scenes of each set for the thresholds.
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
    /// For live, P_D and P_FA over how far below the peak its threshold lies, on validation scenes of every kind and over all floors
    Live,
    /// Squared error of FISTA over its penalty
    Penalty,
    /// Weight of the hybrid's fallback over the parts of a cell's power and of a scene's energy that are unexplained, on validation scenes
    /// of every kind: figures to judge by, which fail nowhere
    Weights {
        /// Kinds of scenes; all where none is named
        kinds: Vec<Kind>,
    },
    /// Squared error of the hybrid over the parts of a map's unexplained cells between which its fallback takes the whole map over, on
    /// validation scenes of every kind; fails where other parts have a squared error that is less by 2 % or more in the mean of all kinds
    Takeover {
        /// Kinds of scenes; all where none is named
        kinds: Vec<Kind>,
    },
}

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

fn main() -> Outcome {
    match Choice::parse() {
        Choice::Thresholds { methods } => thresholds(&methods),
        Choice::Live => live(),
        Choice::Penalty => penalty(),
        Choice::Weights { kinds } => weights(kinds),
        Choice::Takeover { kinds } => takeover(kinds),
    }
}

/// A scene as a method meets it.
fn trial(radar: &Radar, scene: &Scene) -> Outcome<Trial> {
    Ok(Trial::new(radar, scene, Floor::Thesis, Request::default().normalisation)?)
}

/// The first `count` validation scenes of a kind.
fn validation(radar: &Radar, kind: Kind, count: u32) -> impl Iterator<Item = Outcome<Trial>> {
    let generator = Generator::new(radar, Reading::Program, Purpose::Validation, 0);
    (0..count).map(move |number| trial(radar, &generator.scene(kind, number)))
}

/// Figures of one method.
struct Figures {
    method: Arc<dyn Reconstructor>,
    roc: Roc,
    squared_error: [f64; 3],
    milliseconds: Vec<f64>,
}

/// The threshold by the rule above.
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
    for f in &mut all {
        let point = chosen(&f.roc).ok_or("no threshold keeps the false-alarm rate")?;
        let (name, own) = (f.method.name(), f.method.eta());
        let brings_its_own = f.method.reads_eta() || THE_THESIS_OWN.iter().any(|n| name.starts_with(n));
        if !brings_its_own && (own - point.eta).abs() > TOLERANCE {
            others.push(format!("{name} {:.3}, not {own:.3}", point.eta));
        }
        f.milliseconds.sort_by(f64::total_cmp);
        println!(
            "{name:<28}{own:>9.3}{:>9.3}{:>9.2}{:>9.2}{:>9.0}{:>9.0}{:>9.0}{:>9.0}",
            point.eta,
            point.detection * 100.0,
            point.false_alarm * 100.0,
            f.squared_error[0],
            f.squared_error[1],
            f.squared_error[2],
            f.milliseconds[f.milliseconds.len() / 2]
        );
    }
    if others.is_empty() { Ok(()) } else { Err(format!("thresholds chosen: {}", others.join("; ")).into()) }
}

/// Thresholds that are tried for live, as parts of its own distance below the peak.
const PARTS: [f64; 13] = [0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.25, 1.3];

/// The mean false-alarm rate of live over all kinds and floors.
const LIVE_FALSE_ALARM: f64 = 0.01;

fn live() -> Outcome {
    let radar = Radar::default();
    let method = methods::by_name("live")?;
    let thermal = [40.0, 20.0].map(|db| Floor::Snr(Decibels(db)));
    let over_thesis = Kind::with_echoes().map(|kind| (kind, Floor::Thesis));
    let over_thermal = Kind::TEST_SETS.into_iter().flat_map(|kind| thermal.map(|floor| (kind, floor)));
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 0);
    let mut means = [[0.0; 2]; PARTS.len()];
    let mut rows = 0.0;
    println!(
        "P_D / P_FA in %, its own threshold in the middle\n{:24}{}",
        "",
        PARTS.map(|p| format!("{p:>14}")).concat()
    );
    for (kind, floor) in over_thesis.chain(over_thermal) {
        let mut rates = [[0.0; 2]; PARTS.len()];
        for number in 0..SCENES {
            let trial = Trial::new(&radar, &generator.scene(kind, number), floor, Request::default().normalisation)?;
            let answer = trial.ask(method.as_ref(), &Request { noise: floor.into(), ..Request::default() })?;
            for (rates, part) in rates.iter_mut().zip(PARTS) {
                let eta = 1.0 - part as f32 * (1.0 - answer.eta);
                let (detection, false_alarm) = detection_rates(&trial.target, &answer.found.lambda, eta);
                for (rate, own) in rates.iter_mut().zip([detection.unwrap_or(1.0), false_alarm]) {
                    *rate += own / f64::from(SCENES);
                }
            }
        }
        rows += 1.0;
        let cells = rates.map(|[d, f]| format!("{:>8.2} /{:>4.2}", 100.0 * d, 100.0 * f));
        println!("{:24}{}", format!("{kind}, {floor}"), cells.concat());
        means.iter_mut().flatten().zip(rates.iter().flatten()).for_each(|(mean, rate)| *mean += rate);
    }
    let best = (0..PARTS.len()).rev().find(|i| means[*i][1] / rows <= LIVE_FALSE_ALARM).ok_or("all alarm too often")?;
    println!("P_FA {:.2} % on average at {} of its own", 100.0 * means[best][1] / rows, PARTS[best]);
    if (PARTS[best] - 1.0).abs() < 0.06 { Ok(()) } else { Err(format!("{} of it would be better", PARTS[best]).into()) }
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

/// Decades of the unexplained part of a cell's power that share one weight.
const DECADES: f64 = 0.25;

/// Weights that are told apart, from everything unexplained downwards.
const BINS: usize = 14;

/// Parts of a scene's energy that are left which part the scenes.
const LEFT: [f64; 2] = [1e-3, 0.03];

/// What is known of all cells in which about the same part of the power is unexplained.
#[derive(Default, Clone, Copy)]
struct Cells {
    count: f64,
    /// Squared error of the drawn map and of the fallback's.
    drawn: f64,
    filled: f64,
    /// Products of (target - drawn) and of (filled - drawn) with (filled - drawn).
    wanted: f64,
    square: f64,
}

/// For cells in which about the same part of the power is unexplained, the part of the way from the drawn map to the fallback's that leaves
/// the least squared error; apart for scenes of which little, some and much of the energy is left.
fn weights(kinds: Vec<Kind>) -> Outcome {
    let kinds = all_where_none(kinds);
    let radar = Radar::default();
    let request = Request::default();
    let fallback = methods::by_name("live").or_else(|_| methods::by_name("matched-filter-incoherent"))?;
    let mut all = [[Cells::default(); BINS]; LEFT.len() + 1];
    for kind in kinds {
        for trial in validation(&radar, kind, SCENES) {
            let trial = trial?;
            let found = find(&radar, &trial.ends, &request, &Settings::default())?;
            if found.complete {
                continue;
            }
            let expected = found.expected(&radar, &request);
            let unexplained = Unexplained::by(&found, &radar, &trial.ends, &expected);
            let drawn = expected.map;
            let filled = fallback.reconstruct(&radar, &trial.ends, &request)?.lambda;
            let filled = unexplained.on_one_scale(&drawn, filled);
            let group = &mut all[LEFT.partition_point(|left| *left < found.energy_left())];
            let cells =
                unexplained.cells().iter().zip(&trial.target.lambda).zip(drawn.lambda.iter().zip(&filled.lambda));
            for ((part, target), (drawn, filled)) in cells {
                let bin = (-f64::from(part.max(1e-9)).log10() / DECADES) as usize;
                let [target, drawn, filled] = [target, drawn, filled].map(|v| f64::from(*v));
                let cell = &mut group[bin.min(BINS - 1)];
                cell.count += 1.0;
                cell.drawn += (target - drawn).powi(2);
                cell.filled += (target - filled).powi(2);
                cell.wanted += (target - drawn) * (filled - drawn);
                cell.square += (filled - drawn).powi(2);
            }
        }
    }
    for (group, cells) in all.iter().enumerate() {
        let from = if group == 0 { 0.0 } else { LEFT[group - 1] };
        println!(
            "scenes of which {from} of the energy or more is left, and less than {}",
            LEFT.get(group).unwrap_or(&1.0)
        );
        println!("{:>8}{:>12}{:>10}{:>10}{:>8}", "decades", "cells", "SE drawn", "SE filled", "weight");
        for (i, c) in cells.iter().enumerate() {
            let weight = c.wanted / c.square.max(f64::MIN_POSITIVE);
            let decades = -DECADES * (i as f64 + 0.5);
            println!("{decades:>8.2}{:>12.0}{:>10.0}{:>10.0}{weight:>8.2}", c.count, c.drawn, c.filled);
        }
    }
    Ok(())
}

/// These kinds of scenes; every kind with echoes where none is named.
fn all_where_none(kinds: Vec<Kind>) -> Vec<Kind> {
    if !kinds.is_empty() {
        return kinds;
    }
    Kind::with_echoes().chain(Kind::IRREGULAR).chain(Kind::THINGS).collect()
}

/// Parts of a map's cells between which the fallback may take over; the last are never reached. The hybrid's own are the third.
const TAKEOVERS: [[f32; 2]; 6] = [[0.3, 0.5], [0.5, 0.7], [0.7, 0.9], [0.8, 1.0], [0.9, 1.1], [2.0, 3.0]];

/// The hybrid's own among [`TAKEOVERS`].
const OWN_TAKEOVER: usize = 2;

fn takeover(kinds: Vec<Kind>) -> Outcome {
    let radar = Radar::default();
    let request = Request::default();
    let fallback = methods::by_name("live")?;
    let hybrids = TAKEOVERS.map(|parts| Hybrid::new(fallback.clone()).with_map_parts(parts));
    println!("{:12}{}", "SE", TAKEOVERS.map(|[low, high]| format!("{:>10}", format!("{low}-{high}"))).concat());
    let kinds = all_where_none(kinds);
    let mut ratios = [0.0; TAKEOVERS.len()];
    for kind in &kinds {
        let mut errors = [0.0; TAKEOVERS.len()];
        for trial in validation(&radar, *kind, SCENES) {
            let trial = trial?;
            for (error, hybrid) in errors.iter_mut().zip(&hybrids) {
                *error += trial.ask(hybrid, &request)?.metrics.squared_error / f64::from(SCENES);
            }
        }
        println!("{:12}{}", kind.to_string(), errors.map(|error| format!("{error:>10.0}")).concat());
        for (ratio, error) in ratios.iter_mut().zip(errors) {
            *ratio += error / errors[OWN_TAKEOVER] / kinds.len() as f64;
        }
    }
    println!("{:12}{}", "over its own", ratios.map(|ratio| format!("{ratio:>10.3}")).concat());
    let better = TAKEOVERS.iter().zip(ratios).filter(|(_, ratio)| *ratio < 0.98);
    match better.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((parts, ratio)) => Err(format!("{parts:?} would be better: {ratio:.3} of the squared error").into()),
        None => Ok(()),
    }
}
