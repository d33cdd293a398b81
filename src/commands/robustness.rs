//! `apertura robustness`: each method's error over the size of the elements' errors.

use super::arguments::{FloorArgs, real, seed, whole};
use super::figure::{save, save_numbers};
use super::layout_arg::LayoutArg;
use super::line_chart::{ChartAxis, ChartLine, LineChart, span, widened};
use super::own_method::OwnMethodArgs;
use super::radar_arg::RadarArg;
use super::{CommandError, print, print_json, write_file};
use crate::evaluate::{Estimate, Robustness, RobustnessRow};
use crate::methods;
use crate::radar::{Decibels, LayoutKind, Tolerances, counted};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::Task;
use plotters::prelude::{Color, Palette, Palette99, SeriesLabelPosition};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Measure methods on arrays with element errors: gain, phase and place drawn for each antenna
///
/// Prints CSV, one line a method and scale: method, scale, gain_decibels, phase_degrees, position_millimetres (standard deviations),
/// squared_error, squared_error_standard_error, detection, false_alarm. Maps are compared with that of the array without errors.
/// Every scale has the same scenes, and the same draw of errors times the scale.
///
/// With --json one object is printed: set, count, seed, floor, layout (null for the two ends), calibrated, and rows with the columns of the CSV, where squared_error,
/// detection and false_alarm are objects of mean and standard_error. Rates are fractions, not percent.
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

    /// Calibrate each array on its scene's strongest reflector first
    #[arg(long)]
    calibrate: bool,

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

    /// Print one JSON object instead of CSV
    #[arg(long)]
    json: bool,

    /// Folder for robustness.csv, robustness.json, robustness.svg and robustness.png; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
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
            floor: self.floor.floor,
            tolerances: Tolerances {
                gain: Decibels(self.gain_db),
                phase_degrees: self.phase_degrees,
                position_millimetres: self.position_millimetres,
            },
            scales: self.scale.clone(),
            calibrated: self.calibrate,
        };
        let bar = indicatif::ProgressBar::new(u64::from(self.count) * (methods.len() * self.scale.len()) as u64);
        let borrowed: Vec<&dyn Reconstructor> = methods.iter().map(|m| &**m).collect();
        let rows = robustness.run(&borrowed, &Task::default(), || bar.inc(1))?;
        bar.finish_and_clear();
        let csv = csv(&rows);
        let report = Report {
            set: self.set.to_string(),
            count: self.count,
            seed: self.seed,
            floor: self.floor.floor.to_string(),
            layout: self.layout.other().map(LayoutKind::to_string),
            calibrated: self.calibrate,
            rows: &rows,
        };
        if let Some(folder) = &self.output {
            save(&chart(self.count, &rows, &methods), folder, "robustness")?;
            save_numbers(&report, folder, "robustness")?;
            write_file(&folder.join("robustness.csv"), csv.as_bytes())?;
        }
        if self.json {
            return print_json(&report);
        }
        print(csv.trim_end())
    }
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    set: String,
    count: u32,
    seed: u64,
    floor: String,
    layout: Option<String>,
    calibrated: bool,
    rows: &'a [RobustnessRow],
}

fn csv(rows: &[RobustnessRow]) -> String {
    let mut out =
        "method,scale,gain_decibels,phase_degrees,position_millimetres,squared_error,squared_error_standard_error,\
                   detection,false_alarm\n"
            .to_owned();
    for r in rows {
        let RobustnessRow { method, scale, gain_decibels, phase_degrees, position_millimetres, .. } = r;
        let _ = write!(out, "{method},{scale},{gain_decibels},{phase_degrees},{position_millimetres},");
        let Estimate { mean, standard_error, .. } = r.squared_error;
        let _ = writeln!(out, "{mean:.2},{standard_error:.2},{:.4},{:.5}", r.detection.mean, r.false_alarm.mean);
    }
    out
}

const MIN_DRAWN_ERROR: f64 = 1.0;

/// Mean less and plus its standard error, with the mean between them; never below [`MIN_DRAWN_ERROR`].
fn bar_of(row: &RobustnessRow) -> [f64; 3] {
    let Estimate { mean, standard_error, .. } = row.squared_error;
    [mean - standard_error, mean, mean + standard_error].map(|v| v.max(MIN_DRAWN_ERROR))
}

/// The errors at scale 1; "" where no scale is above 0.
fn unit(rows: &[RobustnessRow]) -> String {
    rows.iter().find(|r| r.scale > 0.0).map_or_else(String::new, |r| {
        let [gain, phase, position] =
            [r.gain_decibels, r.phase_degrees, r.position_millimetres].map(|error| error / r.scale);
        format!("{gain:.2} dB, {phase:.1} degrees, {position:.2} mm")
    })
}

fn chart(scenes: u32, rows: &[RobustnessRow], methods: &[Arc<dyn Reconstructor>]) -> LineChart {
    let ends = rows.iter().flat_map(|r| {
        let [low, mean, high] = bar_of(r);
        // The bar of a very uncertain mean is cut, since the axis would have to be as long.
        [low.max(mean / 3.0), high]
    });
    let error = widened(span(ends), 1.3);
    let furthest = rows.iter().map(|r| r.scale).fold(0.0, f64::max).max(1e-3);
    // Bars of several methods at one scale stand side by side.
    let step = furthest / 150.0;
    let mut lines = Vec::new();
    for (i, method) in methods.iter().enumerate() {
        let colour = Palette99::pick(i).to_rgba();
        let aside = step * (i as f64 - (methods.len() - 1) as f64 / 2.0);
        let own = rows.iter().filter(|r| r.method == method.name());
        let bars: Vec<(f64, [f64; 3])> =
            own.map(|r| (r.scale + aside, bar_of(r).map(|v| v.max(error.start)))).collect();
        for &(x, [low, _, high]) in &bars {
            let cap = |y| [(x - step, y), (x + step, y)];
            lines.extend([[(x, low), (x, high)], cap(low), cap(high)].map(|l| ChartLine::new(colour, l.into_iter())));
        }
        let means = ChartLine::new(colour, bars.into_iter().map(|(x, [_, mean, _])| (x, mean)));
        lines.push(ChartLine { dot: 4, ..means.named(method.name()) });
    }
    LineChart {
        caption: "Cost of element errors to each method".to_owned(),
        size: (900, 540),
        x: ChartAxis::new(
            format!("errors of the elements, times {} (standard deviations)", unit(rows)),
            -0.02 * furthest..furthest * 1.03,
        ),
        is_x_log: false,
        y: ChartAxis::new(
            format!("squared error of the map, mean ± standard error over {}", counted(scenes, "scene", "scenes")),
            error,
        ),
        legend: SeriesLabelPosition::LowerRight,
        lines,
    }
}
