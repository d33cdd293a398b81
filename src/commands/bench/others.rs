//! The same tasks by other tools: same scene, same maps, same accuracy, one thread on both sides.

use crate::benchmark::front::{MapConvention, scattered};
use crate::commands::{CommandError, print};
use crate::engine::{Engine, MapRequest, PlanOverrides};
use crate::evaluate::upper_median;
use crate::files::npz::write_npz;
use crate::maps::channels_range_transform;
use crate::radar::Radar;
use crate::signal::judge;
use ndarray::{Array1, Array2};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const JUDGED_ELEMENTS: [usize; 4] = [0, 341, 682, 1023];
/// The tasks: the name for the script, the convention of the maps, and the largest error of a sample.
const TASKS: [(&str, MapConvention, f64); 2] =
    [("thesis", MapConvention::THESIS, 1e-12), ("fixed", MapConvention::FIXED_RANGE, 1e-6)];

/// The times of both tasks by all tools.
#[derive(Debug, Serialize)]
pub struct Equal {
    tasks: Vec<EqualTask>,
}

#[derive(Debug, Serialize)]
struct EqualTask {
    task: &'static str,
    #[serde(flatten)]
    convention: MapConvention,
    tolerance: f64,
    rows: Vec<Row>,
    missing: Vec<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Row {
    tool: String,
    reflectors: usize,
    median_ms: f64,
    signal_error: f64,
}

#[derive(Deserialize)]
struct Printed {
    rows: Vec<Row>,
    missing: Vec<String>,
}

/// Refuses a script that can't be read.
pub fn check_script(script: &Path) -> Result<(), CommandError> {
    File::open(script).map(drop).map_err(CommandError::on(script))
}

/// Times this program on one thread and runs `script` beside it, for both tasks and every number of reflectors.
pub fn measure(script: &Path, counts: &[usize], repeats: usize) -> Result<Equal, CommandError> {
    let radar = Radar::default();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let folder = tempfile::tempdir()?;
    let mut references = Vec::new();
    for count in counts {
        references.push(Reference::write(&radar, *count, folder.path())?);
    }
    let mut tasks = Vec::new();
    for (task, convention, tolerance) in TASKS {
        let mut rows = Vec::new();
        for reference in &references {
            rows.push(alone.install(|| reference.own(&radar, convention, tolerance, repeats))?);
        }
        let (others, missing) = match run(script, task, folder.path(), counts) {
            Ok(printed) => (printed.rows, printed.missing),
            Err(why) => (Vec::new(), vec![why]),
        };
        rows.extend(others);
        tasks.push(EqualTask { task, convention, tolerance, rows, missing });
    }
    Ok(Equal { tasks })
}

fn run(script: &Path, task: &str, folder: &Path, counts: &[usize]) -> Result<Printed, String> {
    let counts = counts.iter().map(usize::to_string);
    let output = Command::new("python3").arg(script).arg(task).arg(folder).args(counts).output();
    let output = output.map_err(|e| format!("python3 can't be run: {e}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{}: {}", script.display(), said.trim().lines().last().unwrap_or("it failed")));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| format!("{} printed something else: {e}", script.display()))
}

struct Reference {
    count: usize,
    /// Range profiles of the judged elements, `[elements, bins]`.
    profiles: Array2<Complex64>,
}

impl Reference {
    fn write(radar: &Radar, count: usize, folder: &Path) -> Result<Reference, CommandError> {
        use rayon::prelude::*;
        let reflectors = scattered(count).reflectors();
        let judged: Vec<_> =
            JUDGED_ELEMENTS.par_iter().map(|n| judge::element_signal(radar, &reflectors, *n)).collect();
        let samples = Array2::from_shape_fn((JUDGED_ELEMENTS.len(), radar.samples), |(i, n1)| judged[i][n1]);
        let column = |of: &dyn Fn(usize) -> f64, len: usize| Array1::from_shape_fn(len, of);
        write_npz(&folder.join(format!("{count}.npz")), |out| {
            out.add("x", &column(&|i| reflectors[i].x_metres, count))?;
            out.add("y", &column(&|i| reflectors[i].y_metres, count))?;
            out.add("elements", &column(&|i| JUDGED_ELEMENTS[i] as f64, JUDGED_ELEMENTS.len()))?;
            out.add("samples", &samples)
        })?;
        Ok(Reference { count, profiles: channels_range_transform(radar, samples.view()).profiles })
    }

    fn own(
        &self,
        radar: &Radar,
        convention: MapConvention,
        tolerance: f64,
        repeats: usize,
    ) -> Result<Row, CommandError> {
        let scene = scattered(self.count);
        let mut engine = Engine::new(radar.clone());
        engine.force(PlanOverrides { tolerance: Some(tolerance), ..PlanOverrides::default() });
        let mut times = Vec::new();
        for repeat in 0..=repeats {
            let wanted = MapRequest {
                floor: convention.floor,
                normalisation: convention.normalisation,
                // Another seed makes other noise, within the measured time.
                seed: repeat as u64,
                ends: false,
                ..MapRequest::default()
            };
            engine.forget();
            let start = Instant::now();
            engine.update(&scene, &wanted)?;
            if repeat > 0 {
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
        }
        let peak = self.profiles.iter().fold(0.0f64, |m, v| m.max(v.norm()));
        let error = |(n, judged): (usize, ndarray::ArrayView1<'_, Complex64>)| {
            let found = engine.range_profile(n).unwrap_or_default();
            judged.iter().zip(found).fold(0.0f64, |m, (a, b)| m.max((a - b).norm()))
        };
        let worst = JUDGED_ELEMENTS.into_iter().zip(self.profiles.outer_iter()).map(error).fold(0.0, f64::max);
        Ok(Row {
            tool: "apertura".to_owned(),
            reflectors: self.count,
            median_ms: upper_median(times).unwrap_or_default(),
            signal_error: worst / peak,
        })
    }
}

impl Equal {
    pub fn print(&self) -> Result<(), CommandError> {
        for task in &self.tasks {
            print(&format!(
                "equal work: three maps over {}, samples good to {:.0e}, from nothing, one thread each\n\
                 {:26} {:>10} {:>10} {:>12} {:>8}",
                task.convention, task.tolerance, "tool", "reflectors", "median ms", "x apertura", "signal"
            ))?;
            for row in &task.rows {
                let own = task.rows.iter().find(|own| own.reflectors == row.reflectors);
                let ratio = own.map_or(f64::NAN, |own| row.median_ms / own.median_ms);
                print(&format!(
                    "{:26} {:>10} {:>10.1} {ratio:>12.1} {:>8.1e}",
                    row.tool, row.reflectors, row.median_ms, row.signal_error
                ))?;
            }
            for missing in &task.missing {
                print(&format!("left out: {missing}"))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_rows_meet_their_tolerance() {
        let nowhere = Path::new("no-such-script.py");
        let equal = measure(nowhere, &[3], 1).unwrap();
        assert_eq!(equal.tasks.len(), 2);
        for task in &equal.tasks {
            assert_eq!((task.rows.len(), task.missing.len()), (1, 1), "{task:?}");
            let row = &task.rows[0];
            assert!(row.median_ms > 0.0 && row.signal_error < task.tolerance && row.signal_error > 0.0, "{row:?}");
        }
        equal.print().unwrap();
    }
}
