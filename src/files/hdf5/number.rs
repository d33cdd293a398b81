//! Types of an array's numbers.

/// One number as it stands in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NumberKind {
    pub bytes: usize,
    pub is_float: bool,
    pub is_signed: bool,
    /// High byte first.
    pub is_big: bool,
}

impl NumberKind {
    /// The number in `bytes`, of as many bytes as the type has.
    pub fn value(&self, bytes: &[u8]) -> f64 {
        let word = match self.is_big {
            false => bytes.iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b)),
            true => bytes.iter().fold(0u64, |n, b| n << 8 | u64::from(*b)),
        };
        match (self.is_float, self.bytes) {
            (true, 2) => half_value(word as u16),
            (true, 4) => f64::from(f32::from_bits(word as u32)),
            (true, _) => f64::from_bits(word),
            (false, bytes) if self.is_signed => {
                let left = 64 - 8 * bytes as u32;
                ((word << left) as i64 >> left) as f64
            }
            (false, _) => word as f64,
        }
    }
}

/// A floating-point number of 16 bits (IEEE 754).
pub fn half_value(word: u16) -> f64 {
    let sign = if word & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (i32::from(word >> 10 & 31), f64::from(word & 1023) / 1024.0);
    match exponent {
        0 => sign * fraction * 2f64.powi(-14),
        31 if fraction == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        exponent => sign * (1.0 + fraction) * 2f64.powi(exponent - 15),
    }
}

/// The type of an array's numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    pub bytes: usize,
    /// Offset and type of the number; of a compound those of real and imaginary part.
    pub parts: Vec<(usize, NumberKind)>,
}
