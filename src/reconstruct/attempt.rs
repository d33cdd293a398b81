//! One attempt of a search to explain the samples: its step, its gain, and its verdict.

use std::fmt;

/// One attempt to explain the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Attempt {
    /// Name of the rung of the ladder ([`LADDER`](super::search::LADDER)) that made it, [`FOLLOWING`](super::search::FOLLOWING) where the search
    /// began with the last answer, or [`CALIBRATION`](super::search::CALIBRATION) where elements were off.
    pub rung: &'static str,
    pub tried: Proposal,
    /// Decades by which the remaining energy falls where the attempt is kept, or would have fallen.
    pub gain_decades: f64,
    pub verdict: AttemptVerdict,
    /// Work since the attempt before, in units of about ten microseconds.
    pub work: usize,
}

/// The proposal of an attempt. Places are (x, y), metres. Gains of the ends' elements are told by roots of mean squares: of their differences
/// from their mean, and of their phases. Several objects together are kept or refused together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Proposal {
    Nothing,
    Point { at_metres: [f64; 2] },
    Line { from_metres: [f64; 2], to_metres: [f64; 2], count: usize },
    Gains { decibels: f64, degrees: f64 },
    Together { count: usize },
}

impl Proposal {
    /// Place of the object, that of a line's first reflector; metres.
    pub fn place_metres(&self) -> Option<[f64; 2]> {
        match *self {
            Proposal::Point { at_metres } => Some(at_metres),
            Proposal::Line { from_metres, .. } => Some(from_metres),
            Proposal::Nothing | Proposal::Gains { .. } | Proposal::Together { .. } => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AttemptVerdict {
    /// The attempt is part of the answer when its rung is done.
    Kept,
    Refused(Refusal),
}

/// The reason why an attempt was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No candidate was found, or none was worth an attempt.
    #[error("found nothing")]
    NothingFound,
    /// An end has more tones than can be paired in the time.
    #[error("refused: an end hears too many tones")]
    TooManyTones,
    /// Other energy remains, so that other explanations are tried first.
    #[error("refused: something else is left")]
    LeavesSomething,
    /// The object explains this part, 0 to 1, of the energy in its range bins, which is too little.
    #[error("refused: explains {:.0} % of the energy in its range bins", 100.0 * .0)]
    ExplainsTooLittle(f64),
    /// The object has different strengths at the two ends: one reflector has one reflectivity.
    #[error("refused: the ends disagree on its strength")]
    EndsDisagree,
    /// The remaining energy falls too little.
    #[error("refused: gains too little")]
    GainsTooLittle,
    /// The other objects explain the samples as well without the object.
    #[error("refused: the others do without it")]
    RestDoesWithout,
    /// The object was exchanged for another explanation, or moved far away.
    #[error("exchanged for another explanation")]
    Exchanged,
}

impl fmt::Display for AttemptVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AttemptVerdict::Kept => write!(f, "kept"),
            AttemptVerdict::Refused(reason) => reason.fmt(f),
        }
    }
}

impl fmt::Display for Proposal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Proposal::Nothing => write!(f, "nothing"),
            Proposal::Point { .. } => write!(f, "point"),
            Proposal::Line { count, .. } => write!(f, "line of {count}"),
            Proposal::Gains { decibels, degrees } => {
                write!(f, "gains of elements off by {decibels:.2} dB and {degrees:.1}°")
            }
            Proposal::Together { count: 1 } => write!(f, "1 object"),
            Proposal::Together { count } => write!(f, "{count} objects"),
        }
    }
}
