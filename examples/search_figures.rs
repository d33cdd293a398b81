//! How well methods do on validation scenes of every kind.
//!
//! `cargo run --release --example search_figures -- --method nomp,hybrid,live --set clusters,walls --count 6`; `--snr-db 40` lays noise beneath the
//! samples.

use apertura::evaluate::Roc;
use apertura::evaluate::trial::Trial;
use apertura::methods;
use apertura::radar::{Decibels, Radar};
use apertura::reconstruct::{Reconstructor, Request};
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::{Reflector, Scene};
use apertura::signal::Floor;
use clap::Parser;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::error::Error;
use std::sync::Arc;

/// The false-alarm rate that P_D is taken at.
const FALSE_ALARM: f64 = 0.01;

/// Squared error, P_D at a P_FA of 1 % and time of methods on validation scenes.
#[derive(Parser)]
struct Args {
    /// Methods, separated by commas
    #[arg(long, value_delimiter = ',', default_value = "nomp,hybrid,live")]
    method: Vec<String>,
    /// Kinds of scenes, separated by commas
    #[arg(long, value_delimiter = ',', default_value = "1,2,3")]
    set: Vec<Kind>,
    /// Scenes of each kind
    #[arg(long, default_value_t = 6)]
    count: u32,
    /// The first of them
    #[arg(long, default_value_t = 0)]
    first: u32,
    /// White noise this far beneath the samples in place of the thesis' floor
    #[arg(long)]
    snr_db: Option<f64>,
    /// In place of each kind's scenes, as many points as this within one range bin
    #[arg(long)]
    points_at_one_range: Option<u32>,
    /// Test scenes of this seed, in place of validation scenes
    #[arg(long)]
    test_seed: Option<u64>,
    /// Print every scene, not only the mean of each kind
    #[arg(long)]
    scenes: bool,
}

/// Scene `number` of `points` reflectors of 1 whose ranges from the array's centre differ by less than a range bin.
fn at_one_range(radar: &Radar, number: u32, points: u32) -> Scene {
    let mut random = ChaCha8Rng::seed_from_u64(u64::from(number));
    let range = random.random_range(5.0..25.0);
    let place = |_| {
        let (cos, bins): (f64, f64) = (random.random_range(-0.8..0.8), random.random_range(-0.5..0.5));
        let range = range + bins * radar.range_resolution_metres();
        (range * cos, range * (1.0 - cos * cos).sqrt())
    };
    let places: Vec<(f64, f64)> = (0..points).map(place).collect();
    Scene { noise_seed: u64::from(number), ..Scene::of_points(places) }
}

/// What one method did on all scenes of a kind.
struct Column {
    name: String,
    method: Arc<dyn Reconstructor>,
    squared_errors: Vec<f64>,
    milliseconds: Vec<f64>,
    detections: Vec<f64>,
}

/// The methods that are named.
fn columns(args: &Args) -> Result<Vec<Column>, Box<dyn Error>> {
    let column = |name: &String| {
        let method = methods::by_name(name)?;
        let (squared_errors, milliseconds, detections) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Column { name: name.clone(), method, squared_errors, milliseconds, detections })
    };
    args.method.iter().map(column).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard error of the mean.
fn standard_error(values: &[f64]) -> f64 {
    let middle = mean(values);
    let square = values.iter().map(|v| (v - middle).powi(2)).sum::<f64>();
    (square / (values.len().max(2) - 1) as f64 / values.len() as f64).sqrt()
}

/// How far `values` are from those of the first column, scene by scene: mean and standard error.
fn change(values: &[f64], first: &[f64]) -> String {
    let differences: Vec<f64> = values.iter().zip(first).map(|(a, b)| a - b).collect();
    format!("{:>+8.2} ± {:<7.2}", mean(&differences), standard_error(&differences))
}

fn print(kind: Kind, columns: &mut [Column]) {
    let (errors, detections) = (columns[0].squared_errors.clone(), columns[0].detections.clone());
    for column in columns {
        let mut sorted = column.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        println!(
            "{:<9} {:<26} SE {:>7.1} ± {:<5.1} ({}) P_D {:>6.2} ({}) mean {:>5.0} median {:>5.0} worst {:>5.0} ms",
            kind.to_string(),
            column.name,
            mean(&column.squared_errors),
            standard_error(&column.squared_errors),
            change(&column.squared_errors, &errors),
            mean(&column.detections),
            change(&column.detections, &detections),
            mean(&sorted),
            sorted[sorted.len() / 2],
            sorted[sorted.len() - 1]
        );
        column.squared_errors.clear();
        column.milliseconds.clear();
        column.detections.clear();
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let radar = Radar::default();
    let floor = args.snr_db.map_or(Floor::Thesis, |db| Floor::Snr(Decibels(db)));
    let request = Request { noise: floor.into(), ..Request::default() };
    let purpose = if args.test_seed.is_some() { Purpose::Test } else { Purpose::Validation };
    let generator = Generator::new(&radar, Reading::Program, purpose, args.test_seed.unwrap_or(0));
    let mut columns = columns(&args)?;
    for kind in &args.set {
        for number in args.first..args.first + args.count {
            let scene = match args.points_at_one_range {
                Some(points) => at_one_range(&radar, number, points),
                None => generator.scene(*kind, number),
            };
            let strongest =
                |reflectors: &[Reflector]| reflectors.iter().map(|r| r.reflectivity.abs()).fold(0.0, f64::max);
            let trial = Trial::new(&radar, &scene, floor, request.normalisation)?;
            for column in &mut columns {
                let answer = trial.ask(&*column.method, &request)?;
                let roc = Roc::of(&trial.target, &answer.found.lambda);
                let detection = roc.at_false_alarm(FALSE_ALARM).map_or(0.0, |p| 100.0 * p.detection);
                let error = answer.metrics.squared_error;
                if args.scenes {
                    let found = answer.found.reflectors.len();
                    let times = strongest(&answer.found.reflectors) / strongest(&scene.reflectors());
                    println!(
                        "{kind:<9}{number:>3} {:>5} reflectors: {:<26} SE {error:>7.1} P_D {detection:>6.2} found {found:>4}, strongest {times:>6.2} times the true one, {:>6.0} ms",
                        scene.reflector_count(),
                        column.name,
                        answer.milliseconds
                    );
                }
                column.squared_errors.push(error);
                column.milliseconds.push(answer.milliseconds);
                column.detections.push(detection);
            }
        }
        print(*kind, &mut columns);
    }
    Ok(())
}
