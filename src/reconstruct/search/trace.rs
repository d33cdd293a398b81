//! What a search tried: every attempt with the rung that made it, what it gained, and whether it was kept.

use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Most attempts that are kept, the first ones: a crowded scene makes thousands.
pub const MOST_ATTEMPTS: usize = 400;

/// One attempt to explain the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Attempt {
    /// Name of the rung of the ladder ([`LADDER`](super::LADDER)) that made it, or [`FOLLOWING`] where it began with the last answer.
    pub rung: &'static str,
    /// What was tried.
    pub tried: Tried,
    /// Decades by which the energy that is left falls where it is kept, or would have fallen.
    pub gain_decades: f64,
    /// What became of it.
    pub verdict: Verdict,
    /// Work since the attempt before: about ten microseconds a unit.
    pub work: usize,
}

/// The name that stands for a rung where the search began with the last answer.
pub const FOLLOWING: &str = "last answer";

/// What an attempt would explain samples by. Places are (x, y), metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tried {
    /// Nothing was proposed.
    Nothing,
    /// One reflector.
    Point {
        /// Where it stands.
        at_metres: [f64; 2],
    },
    /// Reflectors at equal steps.
    Line {
        /// Where the first stands.
        from_metres: [f64; 2],
        /// Where the last stands.
        to_metres: [f64; 2],
        /// How many they are.
        count: usize,
    },
    /// Several objects that are kept or refused together.
    Together {
        /// How many they are.
        count: usize,
    },
}

impl Tried {
    /// Where it stands, a line by its first reflector; metres.
    pub fn place_metres(&self) -> Option<[f64; 2]> {
        match *self {
            Tried::Point { at_metres } => Some(at_metres),
            Tried::Line { from_metres, .. } => Some(from_metres),
            Tried::Nothing | Tried::Together { .. } => None,
        }
    }
}

/// What became of an attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Part of the answer when its rung was done.
    Kept,
    /// Not part of it, and why.
    Refused(Refusal),
}

/// Why an attempt was refused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// No candidate was found, or none that was worth an attempt.
    NothingFound,
    /// The rung was skipped.
    Skipped(&'static str),
    /// An end hears more tones than can be paired in the time.
    TooManyTones,
    /// Something else is left, so that other explanations are tried first.
    LeavesSomething,
    /// It explains this part, 0 to 1, of the energy in its range bins, which is too little.
    ExplainsTooLittle(f64),
    /// The two ends hear it with different strength: one reflector has one reflectivity.
    EndsDisagree,
    /// What is left falls too little.
    GainsTooLittle,
    /// The other objects explain the samples as well without it.
    RestDoesWithout,
    /// It was exchanged for another explanation, or moved far away.
    Exchanged,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Kept => write!(f, "kept"),
            Verdict::Refused(reason) => reason.fmt(f),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::NothingFound => write!(f, "found nothing"),
            Refusal::Skipped(why) => write!(f, "skipped: {why}"),
            Refusal::TooManyTones => write!(f, "refused: an end hears too many tones"),
            Refusal::LeavesSomething => write!(f, "refused: something else is left"),
            Refusal::ExplainsTooLittle(part) => {
                write!(f, "refused: explains {:.0} % of the energy in its range bins", 100.0 * part)
            }
            Refusal::EndsDisagree => write!(f, "refused: the ends disagree on its strength"),
            Refusal::GainsTooLittle => write!(f, "refused: gains too little"),
            Refusal::RestDoesWithout => write!(f, "refused: the others do without it"),
            Refusal::Exchanged => write!(f, "exchanged for another explanation"),
        }
    }
}

impl fmt::Display for Tried {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Tried::Nothing => write!(f, "nothing"),
            Tried::Point { .. } => write!(f, "point"),
            Tried::Line { count, .. } => write!(f, "line of {count}"),
            Tried::Together { count: 1 } => write!(f, "1 object"),
            Tried::Together { count } => write!(f, "{count} objects"),
        }
    }
}

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
    /// From here on attempts are made by this rung.
    pub fn enter(&self, rung: &'static str) {
        self.kept().rung = rung;
    }

    /// Adds an attempt, made when this much work was done in all.
    pub fn add(&self, tried: Tried, gain_decades: f64, verdict: Verdict, done: usize) {
        let mut kept = self.kept();
        let work = done.saturating_sub(kept.done);
        kept.done = done;
        if kept.attempts.len() < MOST_ATTEMPTS {
            let rung = kept.rung;
            kept.attempts.push(Attempt { rung, tried, gain_decades, verdict, work });
        }
    }

    /// How many attempts are kept.
    pub fn count(&self) -> usize {
        self.kept().attempts.len()
    }

    /// All attempts, the first first.
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
        for i in 0..MOST_ATTEMPTS + 5 {
            trace.add(Tried::Together { count: i }, 0.0, Verdict::Kept, 3 * i);
        }
        let attempts = trace.into_attempts();
        assert_eq!(attempts.len(), MOST_ATTEMPTS);
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
