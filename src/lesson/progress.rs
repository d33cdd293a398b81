//! Progress of several learners, kept on this machine.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A learner's record of one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StepRecord {
    /// Whether the first prediction was right; `None` before it is made.
    pub first_guess_right: Option<bool>,
    pub challenge_met: bool,
}

/// Progress of several learners through the lessons.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    learner: String,
    /// Learner, then lesson and step.
    records: BTreeMap<String, BTreeMap<String, StepRecord>>,
}

fn key(lesson: &str, step: usize) -> String {
    format!("{lesson}/{}", step + 1)
}

impl Progress {
    /// Name of today's learner; empty where no name was given.
    pub fn learner(&self) -> &str {
        &self.learner
    }

    /// Switches to another learner; the records of others are kept.
    pub fn set_learner(&mut self, name: &str) {
        self.learner = name.trim().to_owned();
    }

    /// The learner's record of step `step` (from 0) of a lesson.
    pub fn record(&self, lesson: &str, step: usize) -> StepRecord {
        self.records.get(&self.learner).and_then(|r| r.get(&key(lesson, step))).copied().unwrap_or_default()
    }

    /// Notes a prediction; the first one counts.
    pub fn note_guess(&mut self, lesson: &str, step: usize, is_right: bool) {
        self.entry(lesson, step).first_guess_right.get_or_insert(is_right);
    }

    /// Notes that a challenge was met.
    pub fn note_challenge(&mut self, lesson: &str, step: usize) {
        self.entry(lesson, step).challenge_met = true;
    }

    fn entry(&mut self, lesson: &str, step: usize) -> &mut StepRecord {
        self.records.entry(self.learner.clone()).or_default().entry(key(lesson, step)).or_default()
    }

    /// Predictions made and right ones, over all lessons.
    pub fn score(&self) -> (usize, usize) {
        let guesses =
            self.records.get(&self.learner).into_iter().flat_map(|r| r.values()).filter_map(|r| r.first_guess_right);
        guesses.fold((0, 0), |(made, right), guess| (made + 1, right + usize::from(guess)))
    }

    /// Deletes the learner's records.
    pub fn reset(&mut self) {
        self.records.remove(&self.learner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_guess_counts() {
        let mut p = Progress::default();
        p.set_learner(" Ada ");
        p.note_guess("range", 0, false);
        p.note_guess("range", 0, true);
        p.note_guess("range", 1, true);
        p.note_challenge("range", 0);
        assert_eq!((p.score(), p.record("range", 0).challenge_met), ((2, 1), true));
        p.set_learner("Ben");
        assert_eq!((p.score(), p.record("range", 0)), ((0, 0), StepRecord::default()));
        p.note_guess("range", 0, true);
        p.reset();
        p.set_learner("Ada");
        assert!(p.records.keys().eq(["Ada"]));
        p.reset();
        assert_eq!(p.score(), (0, 0));
    }
}
