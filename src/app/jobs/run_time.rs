//! Run time against error on this machine, measured in the background.

use super::rows::{RowJob, Stopped, Teller};
use crate::benchmark::front::{FrontRequest, FrontRow, measure};
use crate::radar::Radar;

/// What is to be measured.
struct Plan {
    radar: Radar,
    front: FrontRequest,
}

/// The worker, and what it has measured so far.
pub struct RunTime {
    job: RowJob<Plan, FrontRow, f64>,
    radar: Option<Radar>,
}

impl RunTime {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> std::io::Result<Self> {
        Ok(RunTime { job: RowJob::start("run time", run, wake)?, radar: None })
    }

    /// Measures afresh.
    pub fn begin(&mut self, radar: Radar, thorough: bool) {
        let front = if thorough { FrontRequest::full(vec![1, 10, 75, 300], 5) } else { FrontRequest::short() };
        self.radar = Some(radar.clone());
        self.job.begin(Plan { radar, front });
    }

    /// Stops after the row that is being measured.
    pub fn cancel(&mut self) {
        self.job.cancel();
    }

    /// The part that is done, while it measures.
    pub fn progress(&self) -> Option<f32> {
        self.job.progress()
    }

    /// Rows measured so far.
    pub fn rows(&self) -> &[FrontRow] {
        self.job.rows()
    }

    /// Time of one bare transform, milliseconds; known at the end.
    pub fn bare_fft_ms(&self) -> Option<f64> {
        self.job.end().copied()
    }

    /// How the last run ended, if not well.
    pub fn note(&self) -> Option<&str> {
        self.job.note()
    }

    /// The radar of the last run.
    pub fn radar(&self) -> Option<&Radar> {
        self.radar.as_ref()
    }

    /// Takes in what was measured. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let said = self.job.poll()?;
        Some(format!("The measurement failed ({said}). Measure again."))
    }
}

fn run(plan: &Plan, teller: &Teller<'_, FrontRow>) -> Result<f64, Stopped> {
    let on_row = |part: f32, row: &FrontRow| {
        teller.part(part);
        teller.row(row.clone());
    };
    let front = measure(&plan.radar, &plan.front, on_row, || teller.task.is_cancelled());
    let front = front.map_err(|e| Stopped::Failed(e.to_string()))?;
    if teller.task.is_cancelled() { Err(Stopped::Cancelled) } else { Ok(front.bare_fft_ms) }
}
