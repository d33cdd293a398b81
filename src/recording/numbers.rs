//! Arrays of a file before their axes are named.

use ndarray::ArrayD;
use num_complex::Complex64;

/// Most numbers that an array of a recording may hold: half a gigabyte of complex ones.
pub const MAX_NUMBERS: usize = 1 << 25;

/// An array of either kind.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Numbers {
    /// Real numbers or integers.
    Real(ArrayD<f64>),
    /// Complex numbers.
    Complex(ArrayD<Complex64>),
}

impl Numbers {
    /// Its shape.
    pub fn shape(&self) -> &[usize] {
        match self {
            Numbers::Real(values) => values.shape(),
            Numbers::Complex(values) => values.shape(),
        }
    }
}

/// How many numbers an array of `shape` holds; `None` where they are more than [`MAX_NUMBERS`].
pub(super) fn bounded_count(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |n, len| n.checked_mul(*len)).filter(|n| *n <= MAX_NUMBERS)
}
