//! The record of a search's attempts.

use crate::reconstruct::attempt::{Attempt, AttemptVerdict, Proposal};
use std::sync::{Mutex, PoisonError};

/// Largest number of attempts in a record; later ones are not recorded.
pub const MAX_ATTEMPTS: usize = 400;

/// Name of the rung where the search begins with the last answer.
pub const FOLLOWING: &str = "last answer";

/// Name of the rung where the number of echoes that noise hides from each other is found.
pub const ORDERING: &str = "count in noise";

/// Name of the rung where gains of the elements are estimated.
pub const CALIBRATION: &str = "calibration";

/// Decades by which `before` exceeds `after`; 0 where the ratio is 0 or not finite.
pub fn decades(before: f64, after: f64) -> f64 {
    let decades = (before / after).log10();
    if decades.is_finite() { decades } else { 0.0 }
}

/// The record, to which any thread may add.
#[derive(Debug, Default)]
pub struct Trace(Mutex<Record>);

#[derive(Debug, Default)]
struct Record {
    rung: &'static str,
    /// Work at the last attempt.
    done: usize,
    attempts: Vec<Attempt>,
}

impl Trace {
    /// Sets the rung of the attempts from here on.
    pub fn enter(&self, rung: &'static str) {
        self.record().rung = rung;
    }

    /// Adds an attempt; `done` is the work of the search until then.
    pub fn add(&self, tried: Proposal, gain_decades: f64, verdict: AttemptVerdict, done: usize) {
        let mut record = self.record();
        let work = done.saturating_sub(record.done);
        record.done = done;
        if record.attempts.len() < MAX_ATTEMPTS {
            let rung = record.rung;
            record.attempts.push(Attempt { rung, tried, gain_decades, verdict, work });
        }
    }

    pub fn count(&self) -> usize {
        self.record().attempts.len()
    }

    pub fn into_attempts(self) -> Vec<Attempt> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).attempts
    }

    fn record(&self) -> std::sync::MutexGuard<'_, Record> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trace_keeps_the_first_attempts_of_many() {
        let trace = Trace::default();
        trace.enter("first rung");
        for i in 0..MAX_ATTEMPTS + 5 {
            trace.add(Proposal::Together { count: i }, 0.0, AttemptVerdict::Kept, 3 * i);
        }
        let attempts = trace.into_attempts();
        assert_eq!(attempts.len(), MAX_ATTEMPTS);
        let second = &attempts[1];
        assert_eq!((second.rung, second.tried, second.work), ("first rung", Proposal::Together { count: 1 }, 3));
    }

    #[test]
    fn a_gain_over_nothing_is_no_number_of_decades() {
        assert_eq!([decades(0.0, 0.0), decades(1.0, 0.0), decades(100.0, 1.0)], [0.0, 0.0, 2.0]);
    }
}
