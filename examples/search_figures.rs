//! How well methods do on validation scenes of every kind, scene by scene: what the limits of the search were chosen by.
//!
//! `cargo run --release --example search_figures -- --method nomp,hybrid,live --set clusters,walls --count 6`; `--snr-db 40` lays noise
//! beneath the samples.

use apertura::evaluate::Roc;
use apertura::evaluate::trial::Trial;
use apertura::methods;
use apertura::radar::{Decibels, Radar};
use apertura::reconstruct::Request;
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::signal::Floor;
use clap::Parser;
use std::error::Error;

/// The false-alarm rate that P_D is taken at.
const FALSE_ALARM: f64 = 0.01;

/// Squared error, P_D at a P_FA of 1 % and time of methods on validation scenes, scene by scene.
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
}

/// What one method did on all scenes of a kind.
#[derive(Default)]
struct Sum {
    squared_errors: Vec<f64>,
    milliseconds: Vec<f64>,
    detections: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let radar = Radar::default();
    let floor = args.snr_db.map_or(Floor::Thesis, |db| Floor::Snr(Decibels(db)));
    let request = Request { noise: floor.into(), ..Request::default() };
    let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 0);
    let methods = args.method.iter().map(|name| methods::by_name(name)).collect::<Result<Vec<_>, _>>()?;
    for kind in &args.set {
        let mut sums: Vec<Sum> = methods.iter().map(|_| Sum::default()).collect();
        for number in args.first..args.first + args.count {
            let scene = generator.scene(*kind, number);
            let trial = Trial::new(&radar, &scene, floor, request.normalisation)?;
            print!("{kind:<9}{number:>3}{:>5}", scene.reflector_count());
            for (method, sum) in methods.iter().zip(&mut sums) {
                let answer = trial.ask(&**method, &request)?;
                let roc = Roc::of(&trial.target, &answer.found.lambda);
                let detection = roc.at_false_alarm(FALSE_ALARM).map_or(0.0, |p| 100.0 * p.detection);
                let error = answer.metrics.squared_error;
                print!(
                    " | {} SE {error:>6.0} P_D {detection:>5.1} {:>4} found {:>6.0} ms",
                    method.name(),
                    answer.found.reflectors.len(),
                    answer.milliseconds
                );
                sum.squared_errors.push(error);
                sum.milliseconds.push(answer.milliseconds);
                sum.detections.push(detection);
            }
            println!();
        }
        for (method, sum) in methods.iter().zip(&mut sums) {
            let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
            sum.milliseconds.sort_by(f64::total_cmp);
            println!(
                "== {kind:<9} {:<8} SE {:>6.0} P_D {:>6.2} median {:>6.0} ms worst {:>6.0} ms",
                method.name(),
                mean(&sum.squared_errors),
                mean(&sum.detections),
                sum.milliseconds[sum.milliseconds.len() / 2],
                sum.milliseconds[sum.milliseconds.len() - 1]
            );
        }
    }
    Ok(())
}
