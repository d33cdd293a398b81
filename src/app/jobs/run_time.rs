//! Run time against error on this machine, measured in the background.

use super::rows::{Plan, Stopped, Teller};
use crate::benchmark::front::{FrontRequest, FrontRow, measure};
use crate::radar::Radar;

/// A measurement of run times and errors.
pub struct RunTimePlan {
    /// Radar of the measured maps.
    pub radar: Radar,
    /// Whether many reflectors and repetitions are measured.
    pub thorough: bool,
}

impl Plan for RunTimePlan {
    type Row = FrontRow;
    /// Time of one bare transform, milliseconds.
    type End = f64;
    const THREAD: &'static str = "run time";
    const WHAT: &'static str = "The measurement";
    const ADVICE: &'static str = "Measure again.";

    fn run(&self, teller: &Teller<'_, FrontRow>) -> Result<f64, Stopped> {
        let front = if self.thorough { FrontRequest::full(vec![1, 10, 75, 300], 5) } else { FrontRequest::short() };
        let on_row = |part: f32, row: &FrontRow| {
            teller.part(part);
            teller.row(row.clone());
        };
        let front = measure(&self.radar, &front, on_row, || teller.task.is_cancelled());
        let front = front.map_err(|e| Stopped::Failed(e.to_string()))?;
        if teller.task.is_cancelled() { Err(Stopped::Cancelled) } else { Ok(front.bare_fft_ms) }
    }
}
