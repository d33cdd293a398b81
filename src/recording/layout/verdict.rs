//! The sentences on the choice of a layout and its reasons.

use super::evidence::OF_LEVEL;
use super::{Candidate, Counts, Found, Kind, Parts, ReceiverOrder};
use crate::radar::capitalised;
use serde::Serialize;

/// Certainty of the choice of a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Certainty {
    /// No other layout comes near.
    Sure,
    /// The layout is likely, but the next might be right.
    Likely,
    /// The two best are as good as each other.
    Open,
}

/// Log-odds to the next from which a choice is sure, and likely.
const SURE: f64 = 5.0;
const LIKELY: f64 = 1.0;

impl Certainty {
    /// The certainty of a choice by its margin: its log-odds above those of the next; `None` where there is no next.
    pub fn of(margin: Option<f64>) -> Certainty {
        match margin {
            Some(margin) if margin < LIKELY => Certainty::Open,
            Some(margin) if margin < SURE => Certainty::Likely,
            _ => Certainty::Sure,
        }
    }
}

impl Found {
    /// The best candidate.
    pub fn best(&self) -> &Candidate {
        &self.candidates[0]
    }

    /// Log-odds of the best above those of the next; `None` where there is no next.
    pub fn margin(&self) -> Option<f64> {
        Some(self.best().log_odds() - self.candidates.get(1)?.log_odds())
    }

    /// The next, and the likeliest of other counts where that is not far below the best.
    pub fn rivals(&self) -> Vec<&Candidate> {
        let (best, next) = (self.best(), self.candidates.get(1));
        let is_near = |other: &&Candidate| best.log_odds() - other.log_odds() < SURE;
        let other = self.candidates.iter().filter(is_near).find(|other| other.counts != best.counts);
        next.into_iter().chain(other.filter(|other| Some(*other) != next)).collect()
    }

    /// Certainty of the choice: at most likely where the samples hide their counts.
    pub fn certainty(&self) -> Certainty {
        match Certainty::of(self.margin()) {
            Certainty::Sure if self.hides_counts => Certainty::Likely,
            certainty => certainty,
        }
    }

    /// The kind of evidence that parts the best from the next.
    pub fn decided_by(&self) -> Kind {
        let (best, next) = (self.best(), self.candidates.get(1));
        let more = |kind: Kind| best.of_kind(kind) - next.map_or(0.0, |next| next.of_kind(kind));
        let kinds = best.evidence.iter().chain(next.map_or(&[][..], |next| &next.evidence)).map(|e| e.kind);
        kinds.max_by(|a, b| more(*a).total_cmp(&more(*b))).unwrap_or(Kind::Usual)
    }

    /// The layout and the evidence for it, a sentence each.
    pub fn sentences(&self) -> Vec<String> {
        let best = self.best();
        let mut all = vec![format!("{}.", capitalised(&best.described()))];
        let told =
            best.evidence.iter().filter(|e| !(e.sentence.is_empty() || e.kind == Kind::Config && e.log_odds < 0.0));
        all.extend(told.map(|e| format!("{}.", capitalised(&e.sentence))));
        all.push(self.decision());
        all.extend(self.notes.iter().cloned());
        all
    }

    /// The sentence on the deciding evidence and the certainty.
    fn decision(&self) -> String {
        let Some(next) = self.candidates.get(1) else { return "No other layout fits.".to_owned() };
        let decided = match self.decided_by() {
            Kind::Sharp => {
                let lower = (self.best().of_kind(Kind::Sharp) - next.of_kind(Kind::Sharp)) / OF_LEVEL;
                format!("the spectrum, whose level is {:.1} dB lower", 10.0 * lower / std::f64::consts::LN_10)
            }
            Kind::Receivers => "the receivers, which see the same echoes".to_owned(),
            Kind::Rows => "the rows, which are the same again after a loop of it".to_owned(),
            Kind::Counts => "the count of frames that fill the file".to_owned(),
            Kind::Half => "the empty half of the range axis".to_owned(),
            Kind::Images => "the images of its echoes".to_owned(),
            Kind::Config => "the .cfg".to_owned(),
            Kind::Usual => "no more than what is usual".to_owned(),
        };
        let margin = self.margin().unwrap_or_default();
        let sure = match self.certainty() {
            Certainty::Sure => "sure",
            Certainty::Likely => "likely",
            Certainty::Open => "open: look at both",
        };
        format!(
            "Decisive against the next ({}) is {decided}; the choice is {sure} (log-odds {margin:.1}).",
            next.described()
        )
    }
}

impl Candidate {
    /// The layout and its counts in a sentence's words.
    pub fn described(&self) -> String {
        let Counts { samples, receivers, chirps, .. } = self.counts;
        let parts = self.layout.parts.described(self.layout.q_first);
        let order = match (receivers, self.layout.receivers) {
            (1, _) => "1 receiver".to_owned(),
            (_, ReceiverOrder::OneAfterAnother) => format!("{receivers} receivers one after another"),
            (_, ReceiverOrder::Interleaved) => format!("{receivers} receivers sample by sample"),
        };
        let real = if self.layout.parts == Parts::Real { "real " } else { "" };
        let chirps = if chirps == 1 { String::new() } else { format!(", {chirps} chirps a loop") };
        format!("{}, {parts}, {order}, {samples} {real}samples a chirp{chirps}", self.layout.words.described())
    }
}
