//! How the methods' thresholds and settings were chosen, on validation scenes: prints the figures, and fails where a method's own setting is
//! not the best of those tried.
//!
//! `cargo run --release --example choose_eta -- thresholds|penalty|unexplained`; minutes each.

use apertura::evaluate::trial::Trial;
use apertura::evaluate::{Roc, squared_error};
use apertura::methods;
use apertura::radar::Radar;
use apertura::reconstruct::nomp::{Settings, find};
use apertura::reconstruct::{Fista, Hybrid, Reconstructor, Request};
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::{GaussianCluster, Object, Scene};
use apertura::signal::Floor;
use clap::Parser;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

/// The false-alarm rate at which the methods that draw exact maps are thresholded: they need no more.
const EXACT_FALSE_ALARM: f64 = 0.0005;

/// Mean of the thesis' own false-alarm rates over its three sets (experiment 2: 0.37, 0.56 and 1.02 %).
const FALSE_ALARM: f64 = 0.0065;

/// Scenes of each set for the thresholds.
const SCENES: u32 = 8;

/// Choose thresholds and settings on validation scenes.
#[derive(Parser)]
enum Choice {
    /// For every method, the threshold at which its false-alarm rate over all three sets is the thesis' own; for the methods that draw
    /// exact maps, 0.05 %
    Thresholds {
        /// Methods; all where none is named
        methods: Vec<String>,
    },
    /// Squared error of FISTA over its penalty
    Penalty,
    /// Squared error of the hybrid over the part of the energy that may be unexplained before its fallback is asked: on validation scenes, and
    /// on clouds of reflectors that are neither a few points nor lines
    Unexplained,
}

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

fn main() -> Outcome {
    match Choice::parse() {
        Choice::Thresholds { methods } => thresholds(&methods),
        Choice::Penalty => penalty(),
        Choice::Unexplained => unexplained(),
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
    println!("{:<28}{:>8}{:>9}{:>9}{:>9}{:>9}{:>10}", "method", "eta", "P_D %", "SE 1", "SE 2", "SE 3", "ms");
    for f in &mut all {
        let exact = matches!(f.method.name(), "nomp" | "hybrid");
        let limit = if exact { EXACT_FALSE_ALARM } else { FALSE_ALARM };
        let point = f.roc.at_false_alarm(limit).ok_or("no threshold keeps the false-alarm rate")?;
        f.milliseconds.sort_by(f64::total_cmp);
        println!(
            "{:<28}{:>8.3}{:>9.2}{:>9.0}{:>9.0}{:>9.0}{:>10.0}",
            f.method.name(),
            point.eta,
            point.detection * 100.0,
            f.squared_error[0],
            f.squared_error[1],
            f.squared_error[2],
            f.milliseconds[f.milliseconds.len() / 2]
        );
    }
    Ok(())
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

/// A cloud of 10 to 150 reflectors, from 5 cm to 4 m wide.
fn cloud(i: u32) -> Scene {
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
}

/// What the hybrid would do to one scene.
struct Choosing {
    /// Part of the energy unexplained, 0 where explained to the floor.
    unexplained: f64,
    /// SE without the fallback.
    alone: f64,
    /// SE with it.
    filled: f64,
}

impl Choosing {
    fn of(radar: &Radar, trial: &Trial, fallback: &dyn Reconstructor) -> Outcome<Choosing> {
        let request = Request::default();
        let found = find(radar, &trial.ends, &request, &Settings::default())?;
        let drawn = found.reconstruction(radar, &request).lambda;
        let alone = squared_error(&trial.target, &drawn);
        if found.complete {
            return Ok(Choosing { unexplained: 0.0, alone, filled: alone });
        }
        let mut filled = fallback.reconstruct(radar, &trial.ends, &request)?.lambda;
        filled.lambda.zip_mut_with(&drawn.lambda, |f, d| *f = f.max(*d));
        let filled = squared_error(&trial.target, &filled);
        println!("unexplained {:.2e}: SE {alone:.0} alone, {filled:.0} filled in", found.unexplained);
        Ok(Choosing { unexplained: found.unexplained, alone, filled })
    }
}

fn unexplained() -> Outcome {
    let radar = Radar::default();
    let fallback = methods::by_name("live").or_else(|_| methods::by_name("matched-filter-incoherent"))?;
    let sets = Kind::TEST_SETS.into_iter().flat_map(|kind| validation(&radar, kind, 6));
    let clouds = (0..15).map(|i| trial(&radar, &Scene { noise_seed: u64::from(i), ..cloud(i) }));
    let rows: Vec<Choosing> =
        sets.chain(clouds).map(|trial| Choosing::of(&radar, &trial?, &*fallback)).collect::<Outcome<_>>()?;
    let error = |limit: f64| {
        let of = |row: &Choosing| if row.unexplained > limit { row.filled } else { row.alone };
        rows.iter().map(of).sum::<f64>() / rows.len() as f64
    };
    let mut best = (f64::INFINITY, 0.0);
    for limit in [1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3] {
        println!("limit {limit}: SE {:.0}", error(limit));
        if error(limit) < best.0 {
            best = (error(limit), limit);
        }
    }
    let own = error(Hybrid::MOST_UNEXPLAINED);
    if own <= 1.01 * best.0 { Ok(()) } else { Err(format!("{} would be better", best.1).into()) }
}
