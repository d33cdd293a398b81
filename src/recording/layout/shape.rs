//! Layouts: encodings of numbers, orders of real and imaginary parts and of receivers, and the samples by a layout.

use ndarray::Array2;
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// A file is saturated where more than this many times as many words have the limits of their type as have the values next to the limits.
const SATURATION_RATIO: usize = 8;

/// The encoding of a number in 16 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NumberEncoding {
    /// Two's complement, the low byte first.
    #[default]
    Int16,
    /// Two's complement with bit 15 flipped, the low byte first.
    OffsetBinary,
    /// Two's complement, the high byte first.
    BigEndian,
    /// Two's complement of 12 bits, the upper four zero.
    #[serde(rename = "12-bit")]
    TwelveBits,
}

impl NumberEncoding {
    /// All of them.
    pub const ALL: [NumberEncoding; 4] =
        [NumberEncoding::Int16, NumberEncoding::OffsetBinary, NumberEncoding::BigEndian, NumberEncoding::TwelveBits];

    /// Decodes the two bytes of a number.
    pub fn number(self, bytes: [u8; 2]) -> i16 {
        match self {
            NumberEncoding::Int16 => i16::from_le_bytes(bytes),
            NumberEncoding::OffsetBinary => (u16::from_le_bytes(bytes) ^ 0x8000) as i16,
            NumberEncoding::BigEndian => i16::from_be_bytes(bytes),
            NumberEncoding::TwelveBits => ((u16::from_le_bytes(bytes) << 4) as i16) >> 4,
        }
    }

    /// The largest number of the encoding.
    pub fn max_value(self) -> i16 {
        if self == NumberEncoding::TwelveBits { 2047 } else { i16::MAX }
    }

    /// The encoding by which the numbers have the least variance. By a wrong one they jump between large and small values.
    pub(super) fn likely(bytes: &[u8]) -> NumberEncoding {
        let words = || bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
        // By offset binary, saturated samples would be the smallest numbers. Small numbers come with the values next to them, saturated ones don't.
        let count = |of: [u16; 2]| words().filter(|w| of.contains(w)).count();
        let is_saturated = count([0x7fff, 0x8000]) > SATURATION_RATIO * count([0x7ffe, 0x8001]).max(1);
        let power = |of: NumberEncoding| {
            let counts = move |b: &&[u8]| !is_saturated || ![[0xff, 0x7f], [0x00, 0x80]].contains(&[b[0], b[1]]);
            let numbers = || bytes.chunks_exact(2).filter(counts).map(move |b| f64::from(of.number([b[0], b[1]])));
            let count = numbers().count().max(1) as f64;
            let mean = numbers().sum::<f64>() / count;
            numbers().map(|v| (v - mean).powi(2)).sum::<f64>() / count
        };
        let [plain, offset, swapped, twelve] = NumberEncoding::ALL.map(power);
        if words().all(|w| w < 0x1000) && twelve < 0.5 * plain {
            NumberEncoding::TwelveBits
        } else if offset < 0.5 * plain && offset <= swapped {
            NumberEncoding::OffsetBinary
        } else if swapped < 0.5 * plain {
            NumberEncoding::BigEndian
        } else {
            NumberEncoding::Int16
        }
    }

    /// The encoding, as a part of a sentence.
    pub fn description(self) -> &'static str {
        match self {
            NumberEncoding::Int16 => "16-bit integers, low byte first",
            NumberEncoding::OffsetBinary => "16-bit integers with bit 15 flipped (offset binary)",
            NumberEncoding::BigEndian => "16-bit integers, high byte first",
            NumberEncoding::TwelveBits => "12-bit integers in 16 bits",
        }
    }
}

/// Order of real and imaginary parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PartOrder {
    /// I Q, sample by sample.
    Pairs,
    /// I I Q Q, as two lanes send them.
    TwoLanes,
    /// I I I I Q Q Q Q, as four lanes send them.
    FourLanes,
    /// Real samples alone.
    Real,
}

impl PartOrder {
    /// All of them.
    pub const ALL: [PartOrder; 4] = [PartOrder::Pairs, PartOrder::TwoLanes, PartOrder::FourLanes, PartOrder::Real];

    /// Number of real or imaginary parts in a row.
    pub fn group(self) -> usize {
        match self {
            PartOrder::Pairs | PartOrder::Real => 1,
            PartOrder::TwoLanes => 2,
            PartOrder::FourLanes => 4,
        }
    }

    /// Bytes of one sample.
    pub fn bytes(self) -> usize {
        if self == PartOrder::Real { 2 } else { 4 }
    }

    /// The order, as a part of a sentence.
    pub fn description(self, q_first: bool) -> &'static str {
        match (self, q_first) {
            (PartOrder::Pairs, false) => "complex, I Q in pairs",
            (PartOrder::Pairs, true) => "complex, Q I in pairs",
            (PartOrder::TwoLanes, false) => "complex, I I Q Q as two lanes send them",
            (PartOrder::TwoLanes, true) => "complex, Q Q I I as two lanes send them",
            (PartOrder::FourLanes, false) => "complex, I I I I Q Q Q Q as four lanes send them",
            (PartOrder::FourLanes, true) => "complex, Q Q Q Q I I I I as four lanes send them",
            (PartOrder::Real, _) => "real",
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

/// The layout of a chirp's bytes as samples of its receivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Layout {
    /// Encoding of numbers in 16 bits.
    pub encoding: NumberEncoding,
    /// Order of real and imaginary parts.
    pub part_order: PartOrder,
    /// Imaginary parts come first.
    pub q_first: bool,
    /// Order of the receivers.
    pub receivers: ReceiverOrder,
    /// Bytes of the header before each chirp.
    pub header_bytes: usize,
    /// Whether the file holds network packets, each of [`PACKET_BYTES`](super::stream::PACKET_BYTES).
    pub packets: bool,
}

/// Counts of samples, receivers, chirps and loops of a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Counts {
    /// Samples of a chirp at each receiver, real or complex.
    pub samples: usize,
    /// Receivers.
    pub receivers: usize,
    /// Chirps of a loop.
    pub chirps: usize,
    /// Loops of a frame.
    pub loops: usize,
}

impl Layout {
    /// Bytes of one chirp of all receivers, with its header.
    pub fn chirp_bytes(&self, samples: usize, receivers: usize) -> usize {
        self.header_bytes + samples * receivers * self.part_order.bytes()
    }

    /// The samples of one chirp, `[receivers, samples]`. `bytes` begin after the header; missing bytes are zeros.
    pub(crate) fn decode(&self, bytes: &[u8], samples: usize, receivers: usize) -> Array2<Complex64> {
        let numbers = self.numbers(bytes, samples * receivers);
        Array2::from_shape_fn((receivers, samples), |(r, s)| match self.receivers {
            ReceiverOrder::OneAfterAnother => numbers[r * samples + s],
            ReceiverOrder::Interleaved => numbers[s * receivers + r],
        })
    }

    /// The first `count` samples of `bytes` in the file's order; missing ones are zeros.
    pub(super) fn numbers(&self, bytes: &[u8], count: usize) -> Vec<Complex64> {
        let word = |at: usize| {
            let bytes = bytes.get(2 * at..2 * at + 2).map_or([0; 2], |b| [b[0], b[1]]);
            f64::from(self.encoding.number(bytes))
        };
        if self.part_order == PartOrder::Real {
            return (0..count).map(|n| Complex64::new(word(n), 0.0)).collect();
        }
        let group = self.part_order.group();
        let sample = |n: usize| {
            let at = 2 * group * (n / group) + n % group;
            let (first, second) = (word(at), word(at + group));
            if self.q_first { Complex64::new(second, first) } else { Complex64::new(first, second) }
        };
        (0..count).map(sample).collect()
    }
}
