//! Orders of real and imaginary parts, and of receivers.

use serde::{Deserialize, Serialize};

/// Order of real and imaginary parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Parts {
    /// I Q, sample by sample.
    Pairs,
    /// I I Q Q, as two lanes send them.
    TwoLanes,
    /// I I I I Q Q Q Q, as four lanes send them.
    FourLanes,
    /// Real samples alone.
    Real,
}

impl Parts {
    /// All of them.
    pub const ALL: [Parts; 4] = [Parts::Pairs, Parts::TwoLanes, Parts::FourLanes, Parts::Real];

    /// Number of real or imaginary parts that stand together.
    pub fn group(self) -> usize {
        match self {
            Parts::Pairs | Parts::Real => 1,
            Parts::TwoLanes => 2,
            Parts::FourLanes => 4,
        }
    }

    /// Bytes of one sample.
    pub fn bytes(self) -> usize {
        if self == Parts::Real { 2 } else { 4 }
    }

    /// The order in a sentence.
    pub fn described(self, q_first: bool) -> &'static str {
        match (self, q_first) {
            (Parts::Pairs, false) => "complex, I Q in pairs",
            (Parts::Pairs, true) => "complex, Q I in pairs",
            (Parts::TwoLanes, false) => "complex, I I Q Q as two lanes send them",
            (Parts::TwoLanes, true) => "complex, Q Q I I as two lanes send them",
            (Parts::FourLanes, false) => "complex, I I I I Q Q Q Q as four lanes send them",
            (Parts::FourLanes, true) => "complex, Q Q Q Q I I I I as four lanes send them",
            (Parts::Real, _) => "real",
        }
    }
}

/// Order of the receivers in a chirp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReceiverOrder {
    /// All samples of one, then all of the next.
    #[default]
    OneAfterAnother,
    /// Sample by sample.
    Interleaved,
}
