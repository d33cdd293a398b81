//! Encodings of a capture's numbers in 16 bits.

use serde::{Deserialize, Serialize};

/// The encoding of a number in 16 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Words {
    /// Two's complement, the low byte first.
    #[default]
    #[serde(rename = "int16")]
    Int16,
    /// Two's complement with bit 15 flipped, the low byte first.
    #[serde(rename = "offset-binary")]
    OffsetBinary,
    /// Two's complement, the high byte first.
    #[serde(rename = "big-endian")]
    BigEndian,
    /// Two's complement of 12 bits, the upper four zero.
    #[serde(rename = "12-bit")]
    TwelveBits,
}

impl Words {
    /// All of them.
    pub const ALL: [Words; 4] = [Words::Int16, Words::OffsetBinary, Words::BigEndian, Words::TwelveBits];

    /// The number that two bytes stand for.
    pub fn number(self, bytes: [u8; 2]) -> i16 {
        match self {
            Words::Int16 => i16::from_le_bytes(bytes),
            Words::OffsetBinary => (u16::from_le_bytes(bytes) ^ 0x8000) as i16,
            Words::BigEndian => i16::from_be_bytes(bytes),
            Words::TwelveBits => ((u16::from_le_bytes(bytes) << 4) as i16) >> 4,
        }
    }

    /// The largest number, where converters end.
    pub fn most(self) -> i16 {
        if self == Words::TwelveBits { 2047 } else { i16::MAX }
    }

    /// The encoding in a sentence's words.
    pub fn described(self) -> &'static str {
        match self {
            Words::Int16 => "16-bit integers, low byte first",
            Words::OffsetBinary => "16-bit integers with bit 15 flipped (offset binary)",
            Words::BigEndian => "16-bit integers, high byte first",
            Words::TwelveBits => "12-bit integers in 16 bits",
        }
    }
}
