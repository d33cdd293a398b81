//! Run time against error on this machine, measured in the background.

use super::derived::Failure;
use super::rows::{Plan, Teller};
use crate::benchmark::front::{FrontRequest, FrontRow, measure};
use crate::radar::Radar;

pub struct RunTimePlan {
    pub radar: Radar,
    /// Whether many reflectors and repetitions are measured.
    pub thorough: bool,
}

impl Plan for RunTimePlan {
    type Row = FrontRow;
    /// Time of one bare transform, milliseconds.
    type End = f64;
    const WHAT: &'static str = "The measurement";
    const ADVICE: &'static str = "Measure again.";

    fn run(&self, teller: &Teller<'_, FrontRow>) -> Result<f64, Failure> {
        let front = if self.thorough { FrontRequest::full(vec![1, 10, 75, 300], 5) } else { FrontRequest::short() };
        let on_row = |part: f32, row: &FrontRow| {
            teller.part(part);
            teller.row(row.clone());
        };
        let front = measure(&self.radar, &front, on_row, || teller.task.is_cancelled());
        Ok(front.map_err(|e| e.to_string())?.bare_fft_ms)
    }
}
