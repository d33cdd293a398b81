//! `apertura bench`: run time against error, for every algorithm, precision and tolerance.

mod chart;
mod methods;
mod mouse;

use super::{CommandError, print};
use crate::benchmark::front::{self, Entrant, Front, FrontRequest};
use crate::files::write_bytes;
use crate::radar::Radar;
use std::path::PathBuf;
use std::process::Command;

/// Measure run time against error of every algorithm
///
/// Times are for three Lambda maps ready, on all threads; the bare two-dimensional transform they are compared with runs on one.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,

    /// Folder for the chart, bench.svg and bench.png, and the figures, bench.json; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Numbers of reflectors
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "1,10,75,300,1000",
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    reflectors: Vec<u32>,

    /// Who takes part: plan, or the name of an algorithm; everybody where nobody is named
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    algorithms: Vec<Entrant>,

    /// Repeats of every measurement
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,

    /// Our NumPy script (benches/numpy_maps.py), run beside; left out where there is no Python with NumPy
    #[arg(long, value_name = "FILE")]
    numpy: Option<PathBuf>,

    /// Measure every reconstruction method instead, run time against squared error, and the hybrid on crowds; draws methods.svg
    /// and methods.png
    #[arg(long, conflicts_with_all = ["reflectors", "repeats", "numpy"])]
    methods: bool,

    /// Test scenes of each set, with --methods
    #[arg(long, value_name = "N", default_value_t = 5, requires = "methods", value_parser = clap::value_parser!(u32).range(1..=1000))]
    count: u32,
}

#[derive(serde::Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    front: &'a Front,
    /// One reflector dragged, from the pointer's move to three maps.
    mouse: Vec<mouse::MouseRow>,
    /// Reflectors to median milliseconds of the NumPy script; none if it could not run.
    numpy_ms: Option<serde_json::Value>,
}

impl Args {
    /// Measures, prints and draws.
    pub fn run(self) -> Result<(), CommandError> {
        if self.methods {
            return methods::run(self.count, self.json, self.output.as_deref());
        }
        let mut request =
            FrontRequest::full(self.reflectors.iter().map(|n| *n as usize).collect(), self.repeats as usize);
        if !self.algorithms.is_empty() {
            request.entrants = self.algorithms.clone();
        }
        let bar = indicatif::ProgressBar::new(1000);
        let front =
            front::measure(&Radar::default(), &request, |part, _| bar.set_position((1e3 * part) as u64), || false)
                .map_err(CommandError::failed)?;
        bar.finish_and_clear();
        let numpy_ms = self.numpy.as_ref().and_then(|script| self.run_numpy(script));
        let report = Report { front: &front, mouse: mouse::measure()?, numpy_ms };
        let json = serde_json::to_string_pretty(&report).map_err(CommandError::failed)?;
        if let Some(folder) = &self.output {
            chart::draw(folder, &front)?;
            let file = folder.join("bench.json");
            write_bytes(&file, json.as_bytes()).map_err(|source| CommandError::File { path: file, source })?;
        }
        if self.json { print(&json) } else { self.print_table(&report) }
    }

    fn print_table(&self, report: &Report<'_>) -> Result<(), CommandError> {
        let front = report.front;
        print(&format!(
            "bare 512 x 1024 c64 transform, one thread: {:.3} ms; maps on {} threads, {:?}; medians of at most {} runs\n\
             signal: largest error of a range cell, relative to the peak; Lambda: largest and rms error of the maps, drawn over no floor\n\
             and 100 dB (exact db=100) and as the thesis does (thesis min-max); * marks the one that was timed\n\
             {:7} {:>10} {:11} {:4} {:>9} {:>9} {:>8} {:>7} {:>8} {:>18} {:>18}",
            front.bare_fft_ms,
            front.threads,
            front.simd,
            self.repeats,
            "task",
            "reflectors",
            "algorithm",
            "",
            "tolerance",
            "median ms",
            "spread",
            "x bare",
            "signal",
            "exact db=100",
            "thesis min-max",
        ))?;
        for r in &front.rows {
            let lambda = r.lambda.iter().map(|l| {
                let mark = if l.convention == r.convention { "*" } else { " " };
                format!(" {:>8.1e} {:>8.1e}{mark}", l.max, l.rms)
            });
            print(&format!(
                "{:7} {:>10} {:11} {:4} {:>9.0e} {:>9.3} {:>8.3} {:>7.2} {:>8.1e}{}",
                r.task.name(),
                r.reflectors,
                r.algorithm,
                r.precision,
                r.tolerance,
                r.median_ms,
                r.spread_ms,
                r.median_ms / front.bare_fft_ms,
                r.signal_error,
                lambda.collect::<String>(),
            ))?;
        }
        for row in &report.mouse {
            print(&row.line(front.bare_fft_ms))?;
        }
        match &report.numpy_ms {
            Some(ms) => print(&format!("NumPy, one exp per reflector, median ms by reflectors: {ms}")),
            None if self.numpy.is_some() => print("NumPy script left out: no Python with NumPy could run it"),
            None => Ok(()),
        }
    }

    fn run_numpy(&self, script: &std::path::Path) -> Option<serde_json::Value> {
        let counts = self.reflectors.iter().map(u32::to_string);
        let output = Command::new("python3").arg(script).args(counts).output().ok()?;
        serde_json::from_slice(&output.stdout).ok().filter(|_| output.status.success())
    }
}
