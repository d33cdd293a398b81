//! Real and imaginary parts of samples, and whose samples they are.

use super::Layout;
use ndarray::Array2;
use num_complex::Complex64;
use serde::Deserialize;

/// In which order real and imaginary parts stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
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

    /// How many parts of one kind stand together.
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

    /// Its name in a recording's TOML.
    pub fn name(self) -> &'static str {
        match self {
            Parts::Pairs => "pairs",
            Parts::TwoLanes => "two-lanes",
            Parts::FourLanes => "four-lanes",
            Parts::Real => "real",
        }
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

/// How the receivers of a chirp follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReceiverOrder {
    /// All samples of one, then all of the next.
    #[default]
    OneAfterAnother,
    /// Sample by sample.
    Interleaved,
}

impl ReceiverOrder {
    /// Its name in a recording's TOML.
    pub fn name(self) -> &'static str {
        match self {
            ReceiverOrder::OneAfterAnother => "one-after-another",
            ReceiverOrder::Interleaved => "interleaved",
        }
    }
}

/// The first `count` samples of `bytes` in the file's order; what is missing is zero.
pub(super) fn numbers(layout: &Layout, bytes: &[u8], count: usize) -> Vec<Complex64> {
    let word = |at: usize| {
        let bytes = bytes.get(2 * at..2 * at + 2).map_or([0; 2], |b| [b[0], b[1]]);
        f64::from(layout.words.number(bytes))
    };
    if layout.parts == Parts::Real {
        return (0..count).map(|n| Complex64::new(word(n), 0.0)).collect();
    }
    let group = layout.parts.group();
    let sample = |n: usize| {
        let at = 2 * group * (n / group) + n % group;
        let (first, second) = (word(at), word(at + group));
        if layout.q_first { Complex64::new(second, first) } else { Complex64::new(first, second) }
    };
    (0..count).map(sample).collect()
}

/// Samples in the file's order as `[receivers, samples]`.
pub(super) fn rows(order: ReceiverOrder, numbers: &[Complex64], samples: usize, receivers: usize) -> Array2<Complex64> {
    Array2::from_shape_fn((receivers, samples), |(r, s)| match order {
        ReceiverOrder::OneAfterAnother => numbers[r * samples + s],
        ReceiverOrder::Interleaved => numbers[s * receivers + r],
    })
}
