//! `apertura robustness`: each method's error over how far the array's elements are off.

use super::arguments::FloorArgs;
use super::figure::{Drawn, Figure, save};
use super::{CommandError, print};
use crate::evaluate::{Robustness, RobustnessRow};
use crate::files::write_bytes;
use crate::methods;
use crate::radar::{Decibels, Radar, Tolerances};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::Task;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Measure methods on arrays whose elements are not as they should be: gain, phase and place drawn for each element
///
/// Prints CSV, one line a method and scale: method, scale, gain_decibels, phase_degrees, position_millimetres (standard deviations),
/// squared_error, squared_error_standard_error, detection, false_alarm. Maps are compared with that of the array as it should be;
/// every scale meets the same scenes and the same errors but for their size.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Methods, separated by commas
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "matched-filter,capon,omp,iaa,sbl")]
    method: Vec<String>,

    /// Standard deviation of the elements' gain at scale 1, decibels
    #[arg(long, value_name = "DB", default_value_t = 0.5, value_parser = tolerance)]
    gain_db: f64,

    /// Standard deviation of the elements' phase at scale 1, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 10.0, value_parser = tolerance)]
    phase_degrees: f64,

    /// Standard deviation of the elements' places at scale 1, millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.0, value_parser = tolerance)]
    position_millimetres: f64,

    /// What these are multiplied with
    #[arg(long, value_name = "FACTOR,..", value_delimiter = ',', default_value = "0,0.5,1,2,4", value_parser = tolerance)]
    scale: Vec<f64>,

    /// Calibrate each array on its scene's strongest reflector first
    #[arg(long)]
    calibrate: bool,

    /// Test set: 1, 2 or 3
    #[arg(long, value_name = "SET", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=3))]
    set: u8,

    /// Scenes
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,

    /// Seed of scenes and errors
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    #[command(flatten)]
    floor: FloorArgs,

    /// Folder for robustness.csv, robustness.svg and robustness.png; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Largest tolerance or scale that is taken.
const MOST: f64 = 180.0;

fn tolerance(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.0..=MOST).contains(v));
    value.ok_or_else(|| format!("expected a number from 0 to {MOST}"))
}

impl Args {
    /// Measures, prints and draws.
    pub fn run(self) -> Result<(), CommandError> {
        let methods: Vec<Arc<dyn Reconstructor>> = self
            .method
            .iter()
            .map(|name| methods::by_name(name.trim()).map_err(CommandError::failed))
            .collect::<Result<_, _>>()?;
        let robustness = Robustness {
            radar: Radar::default(),
            kind: Kind::TEST_SETS[usize::from(self.set) - 1],
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
        let rows = robustness.run(&borrowed, &Task::default(), || bar.inc(1)).map_err(CommandError::failed)?;
        bar.finish_and_clear();
        let csv = csv(&rows);
        if let Some(folder) = &self.output {
            save(&RobustnessFigure { rows: &rows, methods: &methods }, folder, "robustness")?;
            let path = folder.join("robustness.csv");
            write_bytes(&path, csv.as_bytes()).map_err(|source| CommandError::File { path, source })?;
        }
        print(csv.trim_end())
    }
}

fn csv(rows: &[RobustnessRow]) -> String {
    let mut out =
        "method,scale,gain_decibels,phase_degrees,position_millimetres,squared_error,squared_error_standard_error,\
                   detection,false_alarm\n"
            .to_owned();
    for r in rows {
        let errors = (r.squared_error.mean, r.squared_error.standard_error);
        // Writing to a string can't fail.
        let _ = writeln!(
            out,
            "{},{},{},{},{},{:.2},{:.2},{:.4},{:.5}",
            r.method,
            r.scale,
            r.gain_decibels,
            r.phase_degrees,
            r.position_millimetres,
            errors.0,
            errors.1,
            r.detection.mean,
            r.false_alarm.mean
        );
    }
    out
}

/// Squared error over the scale of the elements' errors, a line a method.
struct RobustnessFigure<'a> {
    rows: &'a [RobustnessRow],
    methods: &'a [Arc<dyn Reconstructor>],
}

impl Figure for RobustnessFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (900, 540)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B> {
        let errors = || self.rows.iter().map(|r| r.squared_error.mean);
        let (low, high) = errors().fold((f64::INFINITY, 1.0f64), |(a, b), v| (a.min(v.max(1.0)), b.max(v)));
        let furthest = self.rows.iter().map(|r| r.scale).fold(0.0, f64::max).max(1e-3);
        let one = self.rows.iter().find(|r| r.scale > 0.0);
        let unit = one.map_or_else(String::new, |r| {
            format!(
                "{:.2} dB, {:.1} degrees, {:.2} mm",
                r.gain_decibels / r.scale,
                r.phase_degrees / r.scale,
                r.position_millimetres / r.scale
            )
        });
        let mut chart = ChartBuilder::on(area)
            .caption("What elements that are off cost each method", ("sans-serif", 22))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(80)
            .build_cartesian_2d(0.0..furthest * 1.02, (low / 1.3..high * 1.3).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(format!("errors of the elements, times {unit} (standard deviations)"))
            .y_desc("squared error of the map")
            .y_label_formatter(&|v| format!("{v:.0}"))
            .draw()?;
        for (i, method) in self.methods.iter().enumerate() {
            let colour = Palette99::pick(i).to_rgba();
            let points = || {
                self.rows.iter().filter(|r| r.method == method.name()).map(|r| (r.scale, r.squared_error.mean.max(1.0)))
            };
            chart
                .draw_series(LineSeries::new(points(), colour.stroke_width(2)).point_size(4))?
                .label(method.name())
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()
    }
}
