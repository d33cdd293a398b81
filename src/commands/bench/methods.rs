//! `apertura bench --methods`: run time against squared error of every reconstruction method.

use crate::commands::CommandError;
use crate::commands::figure::{save, save_numbers};
use crate::commands::line_chart::{ChartAxis, ChartLine, LineChart, span, widened};
use crate::commands::progress::ProgressArg;
use crate::commands::{print, print_json};
use crate::evaluate::Estimate;
use crate::evaluate::campaign::Campaign;
use crate::evaluate::rows::Row;
use crate::evaluate::sets::SceneSet;
use crate::evaluate::tables::Tally;
use crate::methods;
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::Task;
use plotters::prelude::{HSLColor, SeriesLabelPosition};
use serde::Serialize;
use std::path::Path;

#[derive(Debug, Serialize)]
struct Report {
    threads: usize,
    scenes: u32,
    methods: Vec<MethodRow>,
}

#[derive(Debug, Serialize)]
struct MethodRow {
    method: &'static str,
    squared_error: [Estimate; 3],
    median_milliseconds: [f64; 3],
}

impl MethodRow {
    fn mean(&self) -> (f64, f64) {
        let error = self.squared_error.iter().map(|e| e.mean).sum::<f64>() / 3.0;
        (self.median_milliseconds.iter().sum::<f64>() / 3.0, error)
    }
}

/// Measures on `count` test scenes of each set, prints, and draws `methods.svg` and `methods.png` into `output`.
pub fn run(count: u32, told: ProgressArg, json: bool, output: Option<&Path>) -> Result<(), CommandError> {
    let all = methods::all();
    let mut progress = told.of(3 * u64::from(count) * all.len() as u64, "maps");
    let on_row = |row: &Row| progress.step(format_args!("now set {}, {}", row.set, row.method));
    let report = Report {
        threads: rayon::current_num_threads(),
        scenes: count,
        methods: method_rows(count, &all.iter().map(AsRef::as_ref).collect::<Vec<_>>(), on_row)?,
    };
    progress.finish();
    if let Some(folder) = output {
        save(&chart(&report), folder, "methods")?;
        save_numbers(&report, folder, "methods")?;
    }
    if json {
        return print_json(&report);
    }
    let scenes = counted(count, "test scene a set", "test scenes a set");
    print(&format!("{scenes}, {}", counted(report.threads, "thread", "threads")))?;
    print(&format!("{:26} {:>24} {:>24}", "method", "SE, set 1 / 2 / 3", "ms a map, set 1 / 2 / 3"))?;
    for row in &report.methods {
        let [a, b, c] = row.squared_error.map(|e| e.mean);
        let [t, u, v] = row.median_milliseconds;
        let errors = format!("{a:.0} / {b:.0} / {c:.0}");
        print(&format!("{:26} {errors:>24} {:>24}", row.method, format!("{t:.0} / {u:.0} / {v:.0}")))?;
    }
    Ok(())
}

fn method_rows(
    count: u32,
    methods: &[&dyn Reconstructor],
    on_row: impl FnMut(&Row),
) -> Result<Vec<MethodRow>, CommandError> {
    let campaign = Campaign { count, ..Campaign::default() };
    let sets = Kind::TEST_SETS.map(SceneSet::Generated);
    let rows = campaign.run(&sets, methods, &Task::default(), on_row)?;
    let row = |method: &&dyn Reconstructor| {
        let tally = |set: &SceneSet| {
            let set = set.to_string();
            Tally::of(rows.iter().filter(|row| row.method == method.name() && *row.set == *set))
        };
        let tallies = sets.each_ref().map(tally);
        MethodRow {
            method: method.name(),
            squared_error: tallies.each_ref().map(Tally::squared_error),
            median_milliseconds: tallies.each_ref().map(Tally::median_milliseconds),
        }
    };
    Ok(methods.iter().map(row).collect())
}

fn chart(report: &Report) -> LineChart {
    let dots: Vec<(f64, f64)> = report.methods.iter().map(MethodRow::mean).collect();
    let hue = |i: usize| HSLColor(i as f64 / dots.len() as f64, 0.75, 0.4);
    let line = |(i, row): (usize, &MethodRow)| {
        let dot = ChartLine::new(hue(i), std::iter::once(dots[i])).named(row.method);
        ChartLine { is_joined: false, dot: 5, ..dot }
    };
    let time = format!("median time of a map on {}, ms", counted(report.threads, "thread", "threads"));
    let error = format!("SE, mean over the three test sets ({} each)", counted(report.scenes, "scene", "scenes"));
    LineChart {
        caption: "Reconstruction from the two ends: run time against error".to_owned(),
        size: (1000, 640),
        x: ChartAxis::new(time, widened(span(dots.iter().map(|d| d.0)), 1.7)),
        is_x_log: true,
        y: ChartAxis::new(error, widened(span(dots.iter().map(|d| d.1)), 1.7)),
        legend: SeriesLabelPosition::UpperRight,
        lines: report.methods.iter().enumerate().map(line).collect(),
    }
}
