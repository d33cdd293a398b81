//! `apertura evaluate`: tables 4.1 to 4.3 for any method, beside the printed values.

use super::arguments::{self, FloorArgs};
use super::network_args::NetworkArgs;
use super::{CommandError, print};
use crate::evaluate::campaign::Campaign;
use crate::evaluate::tables::{Estimate, PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally};
use crate::radar::{Carrier, Radar};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::{Kind, Reading};
use crate::task::Task;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fmt::Write;

/// Fill tables 4.1 to 4.3: squared error, detection and false-alarm rates of reconstruction methods on random test scenes
///
/// With --json one object is printed: count, seed, floor, carrier, and sets, each with its name (set), what the thesis prints
/// where it does (printed: baseline, experiment_1, experiment_2), the false_alarm rate of the comparison and methods, each with name, eta, squared_error, detection and false_alarm (mean and
/// standard_error), detection_at_false_alarm (false_alarm, detection, eta) and
/// median_milliseconds. Rates are fractions, not percent.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Methods, separated by commas
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "baseline")]
    method: Vec<String>,

    /// Test sets 1 to 3 or other kinds of scenes (clusters, walls, spacings, corner, crowd, dynamic, near), separated by commas
    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', default_value = "1,2,3")]
    set: Vec<Kind>,

    /// Scenes of each set
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    count: u32,

    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,

    /// How the carrier's phase is read
    #[arg(long, value_parser = arguments::carrier(), value_name = "one-way|two-way", default_value = "one-way")]
    carrier: Carrier,

    /// Make scenes as the thesis' text describes them, not as its author's program does
    #[arg(long)]
    thesis_text: bool,

    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

/// What the command found; its JSON is documented in the command's help.
#[derive(Debug, Serialize)]
struct Report {
    count: u32,
    seed: u64,
    floor: String,
    carrier: Carrier,
    sets: Vec<SetReport>,
}

#[derive(Debug, Serialize)]
struct SetReport {
    set: String,
    #[serde(skip)]
    kind: Kind,
    /// Of the thesis, for its own sets.
    printed: Option<PrintedColumns>,
    /// The false-alarm rate at which methods are compared: experiment 2's where the thesis prints it, 1 % elsewhere.
    false_alarm: f64,
    methods: Vec<MethodReport>,
}

#[derive(Debug, Serialize)]
struct PrintedColumns {
    baseline: Printed,
    experiment_1: Printed,
    experiment_2: Printed,
}

#[derive(Debug, Serialize)]
struct MethodReport {
    name: &'static str,
    eta: f32,
    squared_error: Estimate,
    detection: Estimate,
    false_alarm: Estimate,
    detection_at_false_alarm: Option<OperatingPoint>,
    median_milliseconds: f64,
}

/// False-alarm rate of the comparison for scenes that the thesis has no table of.
const ELSEWHERE_FALSE_ALARM: f64 = 0.01;

/// A point of the ROC.
#[derive(Debug, Serialize)]
struct OperatingPoint {
    /// The false-alarm rate that may not be exceeded.
    false_alarm: f64,
    detection: f64,
    eta: f32,
}

impl Args {
    /// Runs every method over every set and prints the tables.
    pub fn run(self) -> Result<(), CommandError> {
        let methods = self.network.methods(&self.method)?;
        let methods: Vec<&dyn Reconstructor> = methods.iter().map(AsRef::as_ref).collect();
        let campaign = Campaign {
            radar: Radar { carrier: self.carrier, ..Radar::default() },
            reading: if self.thesis_text { Reading::Text } else { Reading::Program },
            seed: self.seed,
            count: self.count,
            floor: self.floor.floor,
            ..Campaign::default()
        };
        let maps = u64::from(self.count) * (self.set.len() * methods.len()) as u64;
        // Drawn on a terminal only: indicatif hides itself where standard error is a file or a pipe.
        let bar = ProgressBar::new(maps).with_style(bar_style());
        let mut sets = Vec::new();
        for set in &self.set {
            bar.set_message(format!("set {set}"));
            let tallies =
                campaign.run(*set, &methods, &Task::default(), || bar.inc(1)).map_err(CommandError::failed)?;
            sets.push(SetReport::of(*set, methods.iter().zip(&tallies)));
        }
        bar.finish_and_clear();
        let report = Report {
            count: self.count,
            seed: self.seed,
            floor: self.floor.floor.to_string(),
            carrier: self.carrier,
            sets,
        };
        if self.json {
            print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?)
        } else {
            print(&report.to_text())
        }
    }
}

fn bar_style() -> ProgressStyle {
    ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} maps, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl PrintedColumns {
    fn of_set(set: usize) -> Self {
        PrintedColumns {
            baseline: PRINTED_BASELINE[set - 1],
            experiment_1: PRINTED_EXPERIMENT_1[set - 1],
            experiment_2: PRINTED_EXPERIMENT_2[set - 1],
        }
    }
}

impl MethodReport {
    fn of(method: &dyn Reconstructor, tally: &Tally, false_alarm: f64) -> Self {
        let operating_point = tally.roc().at_false_alarm(false_alarm).map(|point| OperatingPoint {
            false_alarm,
            detection: point.detection,
            eta: point.eta,
        });
        MethodReport {
            name: method.name(),
            eta: method.eta(),
            squared_error: tally.squared_error(),
            detection: tally.detection(),
            false_alarm: tally.false_alarm(),
            detection_at_false_alarm: operating_point,
            median_milliseconds: tally.median_milliseconds(),
        }
    }
}

impl Report {
    fn to_text(&self) -> String {
        let carrier = match self.carrier {
            Carrier::OneWay => "one-way",
            Carrier::TwoWay => "two-way",
        };
        let mut text = format!(
            "{} scenes a set, seed {}, floor {}, carrier {carrier}; mean \u{b1} standard error\n",
            self.count, self.seed, self.floor
        );
        for set in &self.sets {
            set.write(&mut text);
        }
        text.truncate(text.trim_end().len());
        text
    }
}

impl SetReport {
    fn of<'a>(kind: Kind, found: impl Iterator<Item = (&'a &'a dyn Reconstructor, &'a Tally)>) -> Self {
        let printed = kind.test_set().map(PrintedColumns::of_set);
        let false_alarm = printed.as_ref().map_or(ELSEWHERE_FALSE_ALARM, |p| p.experiment_2.false_alarm);
        let methods = found.map(|(method, tally)| MethodReport::of(*method, tally, false_alarm)).collect();
        SetReport { set: kind.to_string(), kind, printed, false_alarm, methods }
    }

    /// Writes table 4.1, 4.2 or 4.3, or one like them. Writing to a string can't fail.
    fn write(&self, text: &mut String) {
        let what = self.kind.description();
        let rate = format!("P_D % at P_FA {:.2} %", 100.0 * self.false_alarm);
        let _ = match self.kind.test_set() {
            Some(set) => writeln!(text, "\nTable 4.{set}: test set {set}, {what}"),
            None => writeln!(text, "\n{}: {what}", self.set),
        };
        let _ =
            writeln!(text, "{:<26} {:>20} {:>16} {:>16} {:>22} {:>9}", "", "SE", "P_D %", "P_FA %", rate, "ms a map");
        let columns = self.printed.iter().flat_map(|p| {
            [
                ("printed: baseline", &p.baseline),
                ("printed: experiment 1", &p.experiment_1),
                ("printed: experiment 2", &p.experiment_2),
            ]
        });
        for (name, printed) in columns {
            let _ = writeln!(
                text,
                "{name:<26} {:>20.2} {:>16.2} {:>16.2}",
                printed.squared_error,
                100.0 * printed.detection,
                100.0 * printed.false_alarm
            );
        }
        for method in &self.methods {
            let percent = |e: Estimate| format!("{:.2} \u{b1} {:.3}", 100.0 * e.mean, 100.0 * e.standard_error);
            let at = method
                .detection_at_false_alarm
                .as_ref()
                .map_or_else(|| "-".to_owned(), |p| format!("{:.2} (eta {:.3})", 100.0 * p.detection, p.eta));
            let _ = writeln!(
                text,
                "{:<26} {:>20} {:>16} {:>16} {at:>22} {:>9.1}",
                format!("{} (eta {})", method.name, method.eta),
                format!("{:.1} \u{b1} {:.1}", method.squared_error.mean, method.squared_error.standard_error),
                percent(method.detection),
                percent(method.false_alarm),
                method.median_milliseconds
            );
            if let ("baseline", Some(PrintedColumns { baseline: printed, .. })) = (method.name, &self.printed) {
                let off = |e: Estimate, printed: f64, rounding: f64| match e.standard_error {
                    0.0 => "-".to_owned(),
                    _ => format!("{:+.2} s.e.", e.deviation_from(printed, rounding)),
                };
                let rounding = printed.rate_rounding();
                let _ = writeln!(
                    text,
                    "{:<26} {:>20} {:>16} {:>16}",
                    "  off the printed by",
                    off(method.squared_error, printed.squared_error, 0.005),
                    off(method.detection, printed.detection, rounding),
                    off(method.false_alarm, printed.false_alarm, rounding)
                );
            }
        }
    }
}
