//! The attempts of a search, recorded as they are made.

use crate::reconstruct::attempt::{Attempt, Tried, Verdict};
use std::sync::{Mutex, PoisonError};

/// Most attempts that are kept, the first ones: a crowded scene makes thousands.
pub const MAX_ATTEMPTS: usize = 400;

/// Name in place of a rung's where the search began with the last answer.
pub const FOLLOWING: &str = "last answer";

/// Name in place of a rung's where echoes that noise hides from each other are counted anew.
pub const ORDERING: &str = "count in noise";

/// Name in place of a rung's where gains of the elements are estimated.
pub const CALIBRATION: &str = "calibration";

/// Decades from `before` to `after`; 0 where there is nothing to compare.
pub fn decades(before: f64, after: f64) -> f64 {
    let decades = (before / after).log10();
    if decades.is_finite() { decades } else { 0.0 }
}

/// Attempts as they are made, by one thread at a time.
#[derive(Debug, Default)]
pub struct Trace(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    rung: &'static str,
    done: usize,
    attempts: Vec<Attempt>,
}

impl Trace {
    /// Sets the rung of the attempts from here on.
    pub fn enter(&self, rung: &'static str) {
        self.kept().rung = rung;
    }

    /// Adds an attempt; `done` is the total work until then.
    pub fn add(&self, tried: Tried, gain_decades: f64, verdict: Verdict, done: usize) {
        let mut kept = self.kept();
        let work = done.saturating_sub(kept.done);
        kept.done = done;
        if kept.attempts.len() < MAX_ATTEMPTS {
            let rung = kept.rung;
            kept.attempts.push(Attempt { rung, tried, gain_decades, verdict, work });
        }
    }

    /// Number of attempts in the record.
    pub fn count(&self) -> usize {
        self.kept().attempts.len()
    }

    pub fn into_attempts(self) -> Vec<Attempt> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).attempts
    }

    fn kept(&self) -> std::sync::MutexGuard<'_, Kept> {
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
            trace.add(Tried::Together { count: i }, 0.0, Verdict::Kept, 3 * i);
        }
        let attempts = trace.into_attempts();
        assert_eq!(attempts.len(), MAX_ATTEMPTS);
        assert_eq!(
            (attempts[1].rung, attempts[1].tried, attempts[1].work),
            ("first rung", Tried::Together { count: 1 }, 3)
        );
    }

    #[test]
    fn a_gain_over_nothing_is_no_number_of_decades() {
        assert_eq!(decades(0.0, 0.0), 0.0);
        assert_eq!(decades(1.0, 0.0), 0.0);
        assert_eq!(decades(100.0, 1.0), 2.0);
    }
}
