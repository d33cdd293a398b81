//! `apertura robustness`: each method's error over the size of the elements' errors.

use super::arguments::{FloorArgs, real, seed, whole};
use super::figure::tick;
use super::layout_arg::LayoutArg;
use super::own_method::OwnMethodArgs;
use super::radar_arg::RadarArg;
use super::{CommandError, print, print_json};
use crate::evaluate::{Estimate, Robustness, RobustnessRow};
use crate::methods;
use crate::radar::{Decibels, LayoutKind, Tolerances};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::Task;
use serde::Serialize;
use std::sync::Arc;

/// Measure methods on arrays with element errors: gain, phase and place drawn for each antenna
///
/// Prints a table. Its rows are methods and scales, with the standard deviations of the errors and means over the scenes. Maps are compared with
/// that of the array without errors. Every scale has the same scenes, and the same draw of errors times the scale.
///
/// With --json one object is printed: set, count, seed, floor, layout (null for the two ends), and rows with method, scale, gain_decibels,
/// phase_degrees, position_millimetres, squared_error, detection and false_alarm; the last three are objects of mean, standard_error and median.
/// Rates are fractions, not percent.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Methods, separated by commas
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "matched-filter,capon,omp,iaa,sbl")]
    method: Vec<String>,

    #[command(flatten)]
    own: OwnMethodArgs,

    /// Standard deviation of the elements' gain at scale 1, decibels
    #[arg(long, value_name = "DB", default_value_t = 0.5, value_parser = real(0.0..=MAX_TOLERANCE))]
    gain_db: f64,

    /// Standard deviation of the elements' phase at scale 1, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 10.0, value_parser = real(0.0..=MAX_TOLERANCE))]
    phase_degrees: f64,

    /// Standard deviation of the elements' places at scale 1, millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.0, value_parser = real(0.0..=MAX_TOLERANCE))]
    position_millimetres: f64,

    /// Factors on all three
    #[arg(long, value_name = "FACTOR,..", value_delimiter = ',', default_value = "0,0.5,1,2,4", value_parser = real(0.0..=MAX_TOLERANCE))]
    scale: Vec<f64>,

    #[arg(long, value_name = "KIND", default_value = "2", help = format!("Kind of the scenes: {}", Kind::names()))]
    set: Kind,

    /// Scenes
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = whole(1..=10_000u32))]
    count: u32,

    /// Seed of scenes and errors
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    #[command(flatten)]
    floor: FloorArgs,

    #[command(flatten)]
    radar: RadarArg,

    #[command(flatten)]
    layout: LayoutArg,

    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

const MAX_TOLERANCE: f64 = 180.0;

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        self.own.start()?;
        let methods: Vec<Arc<dyn Reconstructor>> =
            self.method.iter().map(|name| methods::by_name(name.trim())).collect::<Result<_, _>>()?;
        let (radar, _) = self.radar.load()?;
        let robustness = Robustness {
            layout: self.layout.numbers(&radar)?,
            radar,
            kind: self.set,
            seed: self.seed,
            count: self.count,
            floor: self.floor.floor(),
            tolerances: Tolerances {
                gain: Decibels(self.gain_db),
                phase_degrees: self.phase_degrees,
                position_millimetres: self.position_millimetres,
            },
            scales: self.scale.clone(),
            calibrated: false,
        };
        let bar = indicatif::ProgressBar::new(u64::from(self.count) * (methods.len() * self.scale.len()) as u64);
        let borrowed: Vec<&dyn Reconstructor> = methods.iter().map(|m| &**m).collect();
        let rows = robustness.run(&borrowed, &Task::default(), || bar.inc(1))?;
        bar.finish_and_clear();
        if !self.json {
            return print(&table(&rows));
        }
        print_json(&Report {
            set: self.set.to_string(),
            count: self.count,
            seed: self.seed,
            floor: self.floor.floor().to_string(),
            layout: self.layout.other().map(LayoutKind::to_string),
            rows: &rows,
        })
    }
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    set: String,
    count: u32,
    seed: u64,
    floor: String,
    layout: Option<String>,
    rows: &'a [RobustnessRow],
}

fn table(rows: &[RobustnessRow]) -> String {
    let line = |[method, scale, gain, phase, place, error, detection, false_alarm]: [&str; 8]| {
        format!("{method:26} {scale:>6} {gain:>8} {phase:>8} {place:>8} {error:>18} {detection:>7} {false_alarm:>7}")
    };
    let head = line(["", "scale", "dB", "degrees", "mm", "SE", "P_D %", "P_FA %"]);
    let row = |r: &RobustnessRow| {
        let [scale, gain, phase, place] =
            [r.scale, r.gain_decibels, r.phase_degrees, r.position_millimetres].map(|v| tick(&v));
        let Estimate { mean, standard_error, .. } = r.squared_error;
        let error = format!("{mean:.1} ± {standard_error:.1}");
        let [detection, false_alarm] = [r.detection, r.false_alarm].map(|rate| format!("{:.2}", 100.0 * rate.mean));
        line([r.method, &scale, &gain, &phase, &place, &error, &detection, &false_alarm])
    };
    std::iter::once(head).chain(rows.iter().map(row)).collect::<Vec<_>>().join("\n")
}
