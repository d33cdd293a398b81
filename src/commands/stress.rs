//! `apertura stress`: scenes built to break numerics, and many random edits.

use super::arguments::{seed, whole};
use super::{CommandError, print};
use crate::benchmark::stress::{self, StressReport, StressRequest};
use crate::radar::Radar;

/// Try scenes built to break numerics by every algorithm, and many random edits
///
/// Exit status 0 means that every number is finite, every algorithm keeps its tolerance, edits give the same maps as a fresh start, and
/// memory does not grow. Takes a few minutes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,

    /// Random edits through the incremental engine
    #[arg(long, value_name = "N", default_value_t = StressRequest::default().edits as u32,
          value_parser = whole(1..=1_000_000u32))]
    edits: u32,

    /// Seed of the edits
    #[arg(long, value_name = "SEED", default_value_t = StressRequest::default().seed, value_parser = seed)]
    seed: u64,

    /// A radar of 64 elements and 64 samples, and fewer coincident points: seconds instead of minutes
    #[arg(long)]
    quick: bool,
}

impl Args {
    /// Runs, prints, and fails if anything did not hold.
    pub fn run(self) -> Result<(), CommandError> {
        let small = Radar { elements: 64, samples: 64, end_elements: 8, ..Radar::default() };
        let (radar, coincident) =
            if self.quick { (small.clone(), 500) } else { (Radar::default(), StressRequest::default().coincident) };
        let request = StressRequest { coincident, edits: self.edits as usize, seed: self.seed };
        let bar = indicatif::ProgressBar::new(1000);
        let report = stress::run(&radar, &small, &request, |part| bar.set_position((1e3 * part) as u64));
        bar.finish_and_clear();
        let report = report.map_err(CommandError::failed)?;
        if self.json {
            print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?)?;
        } else {
            print_table(&report)?;
        }
        report.verdict().map_err(CommandError::failed)
    }
}

fn print_table(report: &StressReport) -> Result<(), CommandError> {
    let conventions = report.cases.first().map(|c| c.ulp_change.iter().map(|u| u.convention.to_string()));
    print(&format!(
        "error: largest error of a range cell against the judge, relative to what the amplitudes could add up to\n\
         ulp: largest change of Lambda when every reflector moves by the last bit of its x; {}\n\
         {:40} {:>10} {:11} {:4} {:>8} {:>9} {:>10}  ulp",
        conventions.map(|c| c.collect::<Vec<_>>().join(" / ")).unwrap_or_default(),
        "scene",
        "reflectors",
        "algorithm",
        "",
        "error",
        "promised",
        "not finite",
    ))?;
    for c in &report.cases {
        let ulp: Vec<String> = c.ulp_change.iter().map(|u| format!("{:.1e}", u.max)).collect();
        let promised = c.tolerance.map_or("-".to_owned(), |t| format!("{t:.0e}"));
        print(&format!(
            "{:40} {:>10} {:11} {:4} {:>8.1e} {:>9} {:>10}  {}{}",
            c.scene,
            c.reflectors,
            c.algorithm,
            c.precision,
            c.signal_error,
            promised,
            c.not_finite,
            ulp.join(" / "),
            if c.holds() { "" } else { "  FAILS" },
        ))?;
    }
    for (scene, why) in &report.refused {
        print(&format!("{scene}: refused, as it must be: {why}"))?;
    }
    let e = &report.edits;
    let mib = |bytes: u64| format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20));
    let resident = |bytes: Option<u64>| bytes.map_or("unknown".to_owned(), mib);
    print(&format!(
        "{} random edits, f64: at most {:.1e} from a fresh build, {:.1e} allowed; caches {} early, {} in the end; process {} early, {} in the end",
        e.edits,
        e.worst_difference,
        e.most_difference,
        mib(e.cache_bytes_early as u64),
        mib(e.cache_bytes as u64),
        resident(e.resident_bytes_early),
        resident(e.resident_bytes),
    ))
}
