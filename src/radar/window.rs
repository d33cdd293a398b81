//! The window of both transforms.

use std::f64::consts::TAU;

/// Symmetric Hann window of `len` points, `0.5 - 0.5 cos(2 pi n / (len - 1))`: zero at both ends (thesis section 3.1).
///
/// One point or none gives ones, as NumPy's `hanning` does.
pub fn hann(len: usize) -> Vec<f64> {
    if len < 2 {
        return vec![1.0; len];
    }
    (0..len).map(|n| 0.5 - 0.5 * (TAU * n as f64 / (len - 1) as f64).cos()).collect()
}

#[cfg(test)]
mod tests {
    use super::hann;

    #[test]
    fn is_symmetric_and_zero_at_both_ends() {
        let w = hann(12);
        assert_eq!(w[0], 0.0);
        assert!(w[11].abs() < 1e-15);
        for n in 0..12 {
            assert!((w[n] - w[11 - n]).abs() < 1e-15);
        }
        assert!((w.iter().sum::<f64>() - 5.5).abs() < 1e-12, "sum of a symmetric Hann window is (N-1)/2");
        assert_eq!(hann(1), [1.0]);
    }
}
