//! Certainty of the choice of a layout, and its reasons in sentences.

use super::evidence::LEVEL_LOG_ODDS;
use super::{Candidate, Counts, EvidenceKind, Found, PartOrder, ReceiverOrder};
use crate::radar::capitalised;
use serde::Serialize;

/// Certainty of the choice of a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Certainty {
    /// Every other layout is unlikely.
    Sure,
    /// The layout is likely, but the next is possible.
    Likely,
    /// The best two are about as likely.
    Open,
}

/// Least log-odds above the next layout of a sure and of a likely choice.
const MIN_SURE_LOG_ODDS: f64 = 5.0;
const MIN_LIKELY_LOG_ODDS: f64 = 1.0;

impl Certainty {
    /// Certainty by the `margin`, the log-odds above those of the next layout; `None` where there is no next.
    pub fn of(margin: Option<f64>) -> Certainty {
        match margin {
            Some(margin) if margin < MIN_LIKELY_LOG_ODDS => Certainty::Open,
            Some(margin) if margin < MIN_SURE_LOG_ODDS => Certainty::Likely,
            _ => Certainty::Sure,
        }
    }

    /// Words on a choice that is not sure, and words before the next: "open" and "As likely is".
    pub(in crate::recording) fn doubt(self) -> Option<[&'static str; 2]> {
        match self {
            Certainty::Sure => None,
            Certainty::Likely => Some(["likely, not sure", "It may also be"]),
            Certainty::Open => Some(["open", "As likely is"]),
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

    /// The next candidate, and the likeliest with other counts where the choice against it is not sure.
    pub fn rivals(&self) -> Vec<&Candidate> {
        let (best, next) = (self.best(), self.candidates.get(1));
        let is_near = |other: &&Candidate| best.log_odds() - other.log_odds() < MIN_SURE_LOG_ODDS;
        let other = self.candidates.iter().filter(is_near).find(|other| other.counts != best.counts);
        next.into_iter().chain(other.filter(|other| Some(*other) != next)).collect()
    }

    /// Certainty of the choice, at most likely where `hides_counts`.
    pub fn certainty(&self) -> Certainty {
        match Certainty::of(self.margin()) {
            Certainty::Sure if self.hides_counts => Certainty::Likely,
            certainty => certainty,
        }
    }

    /// The kind of evidence with the largest difference in log-odds between the best candidate and the next.
    pub fn decided_by(&self) -> EvidenceKind {
        let (best, next) = (self.best(), self.candidates.get(1));
        let more = |kind: EvidenceKind| best.of_kind(kind) - next.map_or(0.0, |next| next.of_kind(kind));
        let kinds = best.evidence.iter().chain(next.map_or(&[][..], |next| &next.evidence)).map(|e| e.kind);
        kinds.max_by(|a, b| more(*a).total_cmp(&more(*b))).unwrap_or(EvidenceKind::Usual)
    }

    /// The layout and the evidence for it, a sentence each.
    pub fn sentences(&self) -> Vec<String> {
        let best = self.best();
        let mut all = vec![format!("{}.", capitalised(&best.description()))];
        let findings = best
            .evidence
            .iter()
            .filter(|e| !(e.sentence.is_empty() || e.kind == EvidenceKind::Config && e.log_odds < 0.0));
        all.extend(findings.map(|e| format!("{}.", capitalised(&e.sentence))));
        all.push(self.decision());
        all.extend(self.notes.iter().cloned());
        all
    }

    /// The sentence on the deciding evidence and the certainty.
    fn decision(&self) -> String {
        let Some(next) = self.candidates.get(1) else { return "No other layout fits.".to_owned() };
        let decided = match self.decided_by() {
            EvidenceKind::Spectrum => {
                let lower = (self.best().of_kind(EvidenceKind::Spectrum) - next.of_kind(EvidenceKind::Spectrum))
                    / LEVEL_LOG_ODDS;
                format!("the spectrum, whose level is {:.1} dB lower", 10.0 * lower / std::f64::consts::LN_10)
            }
            EvidenceKind::Receivers => "the receivers, which see the same echoes".to_owned(),
            EvidenceKind::Rows => "the rows, which are the same again after a loop of it".to_owned(),
            EvidenceKind::Counts => "the count of frames that fill the file".to_owned(),
            EvidenceKind::Half => "the empty half of the range axis".to_owned(),
            EvidenceKind::Images => "the images of its echoes".to_owned(),
            EvidenceKind::Config => "the .cfg".to_owned(),
            EvidenceKind::Usual => "no more than what is usual".to_owned(),
        };
        let margin = self.margin().unwrap_or_default();
        let sure = match self.certainty() {
            Certainty::Sure => "sure",
            Certainty::Likely => "likely",
            Certainty::Open => "open: look at both",
        };
        format!(
            "Decisive against the next ({}) is {decided}; the choice is {sure} (log-odds {margin:.1}).",
            next.description()
        )
    }
}

impl Candidate {
    /// The layout and its counts, as a part of a sentence.
    pub fn description(&self) -> String {
        let Counts { samples, receivers, chirps, .. } = self.counts;
        let part_order = self.layout.part_order.description(self.layout.q_first);
        let order = match (receivers, self.layout.receivers) {
            (1, _) => "1 receiver".to_owned(),
            (_, ReceiverOrder::OneAfterAnother) => format!("{receivers} receivers one after another"),
            (_, ReceiverOrder::Interleaved) => format!("{receivers} receivers sample by sample"),
        };
        let real = if self.layout.part_order == PartOrder::Real { "real " } else { "" };
        let chirps = if chirps == 1 { String::new() } else { format!(", {chirps} chirps a loop") };
        format!(
            "{}, {part_order}, {order}, {samples} {real}samples a chirp{chirps}",
            self.layout.encoding.description()
        )
    }
}
