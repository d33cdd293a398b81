//! The two experts and their judge beside each other: squared error of `live`, `nomp` and `hybrid` by kind of scene and floor, and the rates
//! that `live` and `hybrid` have at the thresholds which they read off their answers.
//!
//! On validation scenes its constants are chosen (`src/reconstruct/{judge,own_threshold}.rs`); on test scenes it reports.
//! `cargo run --release --example experts -- --kinds 2,walls,beyond-ring --floors thesis,snr=20 --count 40 --test`

use apertura::evaluate::trial::{TimedAnswer, Trial};
use apertura::maps::Normalisation;
use apertura::methods;
use apertura::radar::{Decibels, Radar, Tolerances};
use apertura::reconstruct::Request;
use apertura::reconstruct::search::CALIBRATION;
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::{Reflector, Scene};
use apertura::signal::{Floor, simulate_built};
use clap::Parser;
use std::error::Error;

/// Squared error and rates of live, nomp and hybrid.
#[derive(Parser)]
struct Arguments {
    /// Kinds of scenes
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,clusters,walls,spacings,corner")]
    kinds: Vec<Kind>,
    /// Floors
    #[arg(long, value_delimiter = ',', default_value = "thesis")]
    floors: Vec<Floor>,
    /// Normalisation: min-max, or db=RANGE
    #[arg(long, default_value = "min-max")]
    normalisation: Normalisation,
    /// Scenes of each kind and floor
    #[arg(long, default_value_t = 10)]
    count: u32,
    /// Number of the first scene
    #[arg(long, default_value_t = 0)]
    first: u32,
    /// Seed of the scenes
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// How far the elements are off: 1 is 0.3 dB and 3 degrees
    #[arg(long, default_value_t = 0.0)]
    elements_off: f64,
    /// Test scenes in place of validation scenes
    #[arg(long)]
    test: bool,
    /// A row for each scene in place of their means
    #[arg(long)]
    scenes: bool,
    /// How many of the reflectors that nomp lists are there, by what it says of them, in place of errors
    #[arg(long)]
    confidence: bool,
}

/// Bounds of the confidences that are counted together.
const DOUBT_EDGES: [f64; 6] = [0.0, 0.5, 0.7, 0.85, 0.95, 1.0];

/// Range bins and columns within which a true reflector makes a listed one right.
const NEAR_CELLS: [f64; 2] = [1.0, 2.0];

const HEADING: &str = "scenes                      live    nomp  hybrid  ratio     +-   live P_D/P_FA          hybrid  largest     time \
                       calibrated";

/// The methods, in the order of the columns.
const METHODS: [&str; 3] = ["live", "nomp", "hybrid"];

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

fn main() -> Outcome {
    let arguments = Arguments::parse();
    if arguments.confidence {
        println!(
            "{:24}{}",
            "said",
            DOUBT_EDGES.windows(2).map(|b| format!("{:>18}", format!("{}-{}", b[0], b[1]))).collect::<String>()
        );
    } else {
        println!("{HEADING}");
    }
    for &kind in &arguments.kinds {
        for &floor in &arguments.floors {
            let answers: Vec<Vec<TimedAnswer>> = (arguments.first..arguments.first + arguments.count)
                .map(|number| arguments.answers(kind, floor, number))
                .collect::<Outcome<_>>()?;
            let name = format!("{kind}, {floor}");
            if arguments.confidence {
                arguments.print_confidence(&name, kind, &answers);
            } else {
                let rows: Vec<&[Vec<TimedAnswer>]> = match arguments.scenes {
                    true => answers.chunks(1).collect(),
                    false => vec![&answers],
                };
                for (first, rows) in (arguments.first..).zip(rows) {
                    print_row(&name, rows, arguments.largest(kind, first, rows));
                }
            }
        }
    }
    Ok(())
}

impl Arguments {
    fn answers(&self, kind: Kind, floor: Floor, number: u32) -> Outcome<Vec<TimedAnswer>> {
        let radar = Radar::default();
        let scene = self.scene(kind, number);
        let mut trial = Trial::new(&radar, &scene, floor, self.normalisation)?;
        if self.elements_off > 0.0 {
            self.put_off(&mut trial, &scene, floor, number)?;
        }
        let request = Request { noise: floor.into(), normalisation: self.normalisation, ..Request::default() };
        let ask = |name: &&str| Ok(trial.ask(methods::by_name(name)?.as_ref(), &request)?);
        METHODS.iter().map(ask).collect()
    }

    fn print_confidence(&self, name: &str, kind: Kind, answers: &[Vec<TimedAnswer>]) {
        let mut bins = [[0.0; 3]; DOUBT_EDGES.len() - 1];
        for (number, answer) in (self.first..).zip(answers) {
            let scene = self.scene(kind, number);
            let truth = scene.reflectors();
            let found = &answer[1].found;
            for (said, reflector) in found.confidences.iter().zip(&found.reflectors) {
                let bin = DOUBT_EDGES[1..DOUBT_EDGES.len() - 1].partition_point(|bound| said >= bound);
                let there = truth.iter().any(|t| is_near(reflector, t));
                bins[bin][0] += said;
                bins[bin][1] += f64::from(u8::from(there));
                bins[bin][2] += 1.0;
            }
        }
        let cells = bins
            .map(|[said, there, all]| format!("{:>6.0} /{:>4.0} ({all:>3})", 100.0 * said / all, 100.0 * there / all));
        println!("{name:24}{}", cells.concat());
    }

    /// The largest reflectivity that nomp lists, over the largest true one of its scene.
    fn largest(&self, kind: Kind, first: u32, answers: &[Vec<TimedAnswer>]) -> f64 {
        let most = |reflectors: &[Reflector]| reflectors.iter().map(|r| r.reflectivity.abs()).fold(0.0, f64::max);
        let of_scene = |(number, answer): (u32, &Vec<TimedAnswer>)| {
            most(&answer[1].found.reflectors) / most(&self.scene(kind, number).reflectors())
        };
        (first..).zip(answers).map(of_scene).fold(0.0, f64::max)
    }

    fn scene(&self, kind: Kind, number: u32) -> Scene {
        let purpose = if self.test { Purpose::Test } else { Purpose::Validation };
        Generator::new(&Radar::default(), Reading::Program, purpose, self.seed).scene(kind, number)
    }

    fn put_off(&self, trial: &mut Trial, scene: &Scene, floor: Floor, number: u32) -> Outcome {
        let tolerances = Tolerances { gain: Decibels(0.3), phase_degrees: 3.0, position_millimetres: 0.0 };
        let array = tolerances.times(self.elements_off).build(&trial.radar, self.seed.wrapping_add(number.into()));
        trial.ends = simulate_built(&trial.radar, scene, &array, floor, scene.noise_seed)?.two_ends(&trial.radar);
        Ok(())
    }
}

fn is_near(listed: &Reflector, truth: &Reflector) -> bool {
    let radar = Radar::default();
    let [a, b] = [listed, truth].map(|r| radar.polar_of(r.x_metres, r.y_metres));
    let columns = radar.column_of_cos(a.cos_theta) - radar.column_of_cos(b.cos_theta);
    let bins = (a.range_metres - b.range_metres) / radar.range_resolution_metres();
    bins.abs() <= NEAR_CELLS[0] && columns.abs() <= NEAR_CELLS[1]
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count().max(1) as f64
}

/// Means of all scenes, the largest reflector, hybrid's time over live's, and the scenes in which gains of elements were found; the ratio is that of
/// hybrid to the better of both experts, with the standard error of their paired difference.
fn print_row(name: &str, answers: &[Vec<TimedAnswer>], largest: f64) {
    let error = |method: usize| answers.iter().map(move |a| a[method].metrics.squared_error);
    let [live, nomp, hybrid] = [0, 1, 2].map(|method| mean(error(method)));
    let better = usize::from(nomp < live);
    let differences: Vec<f64> = error(2).zip(error(better)).map(|(h, b)| h - b).collect();
    let middle = mean(differences.iter().copied());
    let variance = differences.iter().map(|d| (d - middle).powi(2)).sum::<f64>();
    let count = answers.len() as f64;
    let standard_error = (variance / (count - 1.0).max(1.0) / count).sqrt();
    let rates = |method: usize| {
        let detected = mean(answers.iter().filter_map(|a| a[method].metrics.detection));
        let alarms = mean(answers.iter().map(|a| a[method].metrics.false_alarm));
        format!("{:>9.2} /{:>5.2}", 100.0 * detected, 100.0 * alarms)
    };
    let (ratio, deviation) = (hybrid / live.min(nomp), standard_error / live.min(nomp));
    let [live_time, time] = [0, 2].map(|method: usize| mean(answers.iter().map(|a| a[method].milliseconds)));
    let is_calibrated = |a: &&Vec<TimedAnswer>| a[1].found.trace.iter().any(|attempt| attempt.rung == CALIBRATION);
    let calibrated = answers.iter().filter(is_calibrated).count();
    let (of_live, of_hybrid, time) = (rates(0), rates(2), time / live_time);
    println!(
        "{name:24}{live:>8.0}{nomp:>8.0}{hybrid:>8.0}{ratio:>7.2}{deviation:>7.2}{of_live}{of_hybrid}{largest:>9.2}{time:>9.2}\
         {calibrated:>11}"
    );
}
