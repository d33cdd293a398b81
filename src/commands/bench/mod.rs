//! `apertura bench`: run time against error, for every algorithm, precision and tolerance.

mod chart;
mod measure;

use super::{CommandError, print};
use measure::{Bench, Row};
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

    /// Folder for the chart, bench.svg and bench.png; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Numbers of reflectors
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "1,10,75,300,1000",
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    reflectors: Vec<u32>,

    /// Repeats of every measurement
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,

    /// Our NumPy script (benches/numpy_maps.py), run beside; left out where there is no Python with NumPy
    #[arg(long, value_name = "FILE")]
    numpy: Option<PathBuf>,
}

#[derive(serde::Serialize)]
struct Report<'a> {
    /// Median of the bare 512 x 1024 c64 transform on one thread.
    bare_fft_ms: f64,
    threads: usize,
    simd: crate::signal::simd::Simd,
    rows: &'a [Row],
    /// Reflectors to median milliseconds of the NumPy script; none if it could not run.
    numpy_ms: Option<serde_json::Value>,
}

impl Args {
    /// Measures, prints and draws.
    pub fn run(self) -> Result<(), CommandError> {
        let bench = Bench::new(self.repeats as usize);
        let bar = indicatif::ProgressBar::new(self.reflectors.len() as u64);
        let mut rows = Vec::new();
        for count in &self.reflectors {
            rows.extend(bench.rows(*count as usize).map_err(CommandError::failed)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
        let numpy_ms = self.numpy.as_ref().and_then(|script| self.run_numpy(script));
        let report = Report {
            bare_fft_ms: bench.bare_fft_ms,
            threads: rayon::current_num_threads(),
            simd: crate::signal::simd::Simd::best(),
            rows: &rows,
            numpy_ms,
        };
        if let Some(folder) = &self.output {
            chart::draw(folder, &rows, bench.bare_fft_ms)?;
        }
        if self.json {
            return print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?);
        }
        print(&format!(
            "bare 512 x 1024 c64 transform, one thread: {:.3} ms; maps on {} threads, {:?}\n\
             {:7} {:>10} {:9} {:4} {:>9} {:>9} {:>8} {:>7} {:>9} {:>12}",
            report.bare_fft_ms,
            report.threads,
            report.simd,
            "task",
            "reflectors",
            "algorithm",
            "",
            "tolerance",
            "median ms",
            "spread",
            "x bare",
            "signal",
            "Lambda",
        ))?;
        for r in &rows {
            print(&format!(
                "{:7} {:>10} {:9} {:4} {:>9.0e} {:>9.3} {:>8.3} {:>7.2} {:>9.1e} {:>12.1e}",
                r.task,
                r.reflectors,
                r.algorithm,
                r.precision,
                r.tolerance,
                r.median_ms,
                r.spread_ms,
                r.median_ms / report.bare_fft_ms,
                r.signal_error,
                r.lambda_error,
            ))?;
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
