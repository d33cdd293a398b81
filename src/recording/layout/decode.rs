//! Samples of receivers from the bytes of a capture.

use super::parts::{Parts, ReceiverOrder};
use super::shape::Layout;
use ndarray::Array2;
use num_complex::Complex64;

impl Layout {
    /// The samples of one chirp, `[receivers, samples]`: real ones where the parts are real. `bytes` begin behind the header; missing bytes are
    /// zeros.
    pub(crate) fn decode(&self, bytes: &[u8], samples: usize, receivers: usize) -> Array2<Complex64> {
        let numbers = numbers(self, bytes, samples * receivers);
        rows(self.receivers, &numbers, samples, receivers)
    }
}

/// The first `count` samples of `bytes` in the file's order; missing ones are zeros.
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
fn rows(order: ReceiverOrder, numbers: &[Complex64], samples: usize, receivers: usize) -> Array2<Complex64> {
    Array2::from_shape_fn((receivers, samples), |(r, s)| match order {
        ReceiverOrder::OneAfterAnother => numbers[r * samples + s],
        ReceiverOrder::Interleaved => numbers[s * receivers + r],
    })
}
