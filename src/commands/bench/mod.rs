//! `apertura bench`: run time against error, for every algorithm, precision and tolerance.

mod bodies;
mod chart;
#[cfg(feature = "network")]
mod live;
mod methods;
mod others;

use super::arguments::whole;
use super::own_method::OwnMethodArgs;
use super::progress::ProgressArg;
use super::{CommandError, print, print_json};
use crate::benchmark::front::{self, Entrant, Front, FrontRequest, FrontRow};
use crate::benchmark::one_thread::measure;
use crate::commands::figure::{save, save_numbers};
use crate::radar::{Radar, counted};
use others::Equal;
use std::path::PathBuf;

/// Measure run time against error of every algorithm
///
/// Times end when three Lambda maps are ready. All threads are used. The bare two-dimensional transform that they are compared with runs on one.
///
/// methods.json, and --methods --json, are one object: threads, scenes (of each set), and methods, each with method (its name), squared_error
/// (mean and standard_error) and median_milliseconds, both by set.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    progress: ProgressArg,

    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,

    /// Folder for the chart, bench.svg and bench.png, and the figures, bench.json; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Numbers of reflectors
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "1,10,75,300,1000",
          value_parser = whole(1..=10_000u32))]
    reflectors: Vec<u32>,

    /// Algorithms to measure: plan, or an algorithm's name [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    algorithms: Vec<Entrant>,

    /// Repeats of every measurement
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = whole(1..=1000u32))]
    repeats: u32,

    /// Script that runs other tools on the same tasks (comparisons/maps.py), one thread each; tools that are not installed are
    /// named
    #[arg(long, value_name = "FILE")]
    others: Option<PathBuf>,

    /// Measure scenes of walls, boxes, posts and polygons instead: a street, and crowds of up to 1000, from scratch and while one is dragged;
    /// draws bodies.svg and bodies.png
    #[arg(long, conflicts_with_all = ["reflectors", "algorithms", "others", "methods"])]
    bodies: bool,

    /// Measure every reconstruction method instead, run time against squared error; -o draws methods.svg and methods.png and writes methods.json
    #[arg(long, conflicts_with_all = ["reflectors", "repeats", "others"])]
    methods: bool,

    /// Measure what the window computes most instead: three maps, and the live network; with RAYON_NUM_THREADS=1 on one thread, as a page
    /// does by ?measure. With --json a list of name and milliseconds (median)
    #[arg(long, conflicts_with_all = ["reflectors", "repeats", "others", "algorithms", "methods", "bodies", "output"])]
    one_thread: bool,

    #[command(flatten)]
    own: OwnMethodArgs,

    /// Measure the live network instead: its features, its forward pass as it ships, and the same with nothing left out. With --json one
    /// object: threads, scenes, features_milliseconds, forward_milliseconds, dense_forward_milliseconds (medians)
    #[cfg(feature = "network")]
    #[arg(long, conflicts_with_all = ["reflectors", "repeats", "others", "algorithms", "methods", "bodies", "output"])]
    live: bool,

    /// Test scenes of each set, with --methods
    #[arg(long, value_name = "N", default_value_t = 5, requires = "methods", value_parser = whole(1..=1000u32))]
    count: u32,
}

#[derive(serde::Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    front: &'a Front,
    others: Option<Equal>,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let repeats = self.repeats as usize;
        if self.methods {
            self.own.start()?;
            return methods::run(self.count, self.progress, self.json, self.output.as_deref());
        }
        #[cfg(feature = "network")]
        if self.live {
            return live::run(self.json);
        }
        if self.one_thread {
            return one_thread(self.json);
        }
        if self.bodies {
            return bodies::run(repeats, self.progress, self.json, self.output.as_deref());
        }
        let mut request = FrontRequest::full(self.reflectors.iter().map(|n| *n as usize).collect(), repeats);
        if !self.algorithms.is_empty() {
            request.entrants = self.algorithms.clone();
        }
        if let Some(script) = &self.others {
            others::check_script(script)?;
        }
        let front = measured(&request, self.progress)?;
        let others = self.others.as_ref().map(|script| others::measure(script, &request.reflectors, repeats));
        let report = Report { front: &front, others: others.transpose()? };
        if let Some(folder) = &self.output {
            save(&chart::front(&front), folder, "bench")?;
            save_numbers(&report, folder, "bench")?;
        }
        if self.json { print_json(&report) } else { self.print_table(&report) }
    }

    fn print_table(&self, report: &Report<'_>) -> Result<(), CommandError> {
        print(&heading(report.front, self.repeats))?;
        for r in &report.front.rows {
            print(&line(r, report.front.bare_fft_ms))?;
        }
        report.others.as_ref().map_or(Ok(()), Equal::print)
    }
}

fn measured(request: &FrontRequest, told: ProgressArg) -> Result<Front, CommandError> {
    let mut progress = told.of(100, "percent");
    let on_row = |part: f32, row: &FrontRow| {
        let reflectors = counted(row.reflectors, "reflector", "reflectors");
        progress.reach((1e2 * part) as u64, format_args!("the last {} of {reflectors}", row.algorithm));
    };
    let front = front::measure(&Radar::default(), request, on_row, || false)?;
    progress.finish();
    Ok(front)
}

fn one_thread(json: bool) -> Result<(), CommandError> {
    let timed = measure().map_err(CommandError)?;
    if json {
        return print_json(&timed);
    }
    timed.iter().try_for_each(|t| print(&format!("{:40} {:>9.3} ms", t.name, t.milliseconds)))
}

fn heading(front: &Front, repeats: u32) -> String {
    let (threads, runs) = (counted(front.threads, "thread", "threads"), counted(repeats, "run", "runs"));
    format!(
        "bare 512 x 1024 c64 transform, one thread: {:.3} ms; maps on {threads}, {}; medians of at most {runs}\n\
         from scratch: nothing of the scene is known, the floor's noise is made beforehand and scaled inside the time, by all algorithms\n\
         signal: largest error of a range cell, relative to the peak; Lambda: largest and rms error of the maps, drawn over no floor\n\
         and 100 dB (exact db=100) and as the thesis does (thesis min-max); * marks the one that was timed\n\
         task    reflectors algorithm        tolerance median ms   spread  x bare   signal       exact db=100     thesis min-max",
        front.bare_fft_ms, front.simd
    )
}

fn line(r: &FrontRow, bare_fft_ms: f64) -> String {
    let lambda = r.lambda.iter().map(|l| {
        let mark = if l.convention == r.convention { "*" } else { " " };
        format!(" {:>8.1e} {:>8.1e}{mark}", l.max, l.rms)
    });
    let FrontRow { reflectors, algorithm, precision, tolerance, median_ms, spread_ms, signal_error, .. } = r;
    let (task, times_bare, lambda) = (r.task.name(), median_ms / bare_fft_ms, lambda.collect::<String>());
    format!(
        "{task:7} {reflectors:>10} {algorithm:11} {precision:4} {tolerance:>9.0e} {median_ms:>9.3} {spread_ms:>8.3} {times_bare:>7.2} \
         {signal_error:>8.1e}{lambda}"
    )
}
