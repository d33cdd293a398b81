//! Numbers of arrays, and their types in files.

use half::f16;
use ndarray::ArrayD;
use num_complex::Complex64;

/// Numbers of an array, in the order of its axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Numbers {
    /// Real numbers or integers.
    Real(ArrayD<f64>),
    /// Complex numbers.
    Complex(ArrayD<Complex64>),
}

/// One number as it stands in a file: 1, 2, 4 or 8 bytes, floating-point numbers of 2 or more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberKind {
    /// Its length.
    pub bytes: usize,
    /// Whether it is a floating-point number (IEEE 754), not an integer.
    pub is_float: bool,
    /// Whether an integer is one of two's complement.
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
            (true, 2) => f16::from_bits(word as u16).to_f64(),
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
