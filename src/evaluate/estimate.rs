//! Means over scenes, and how sure they are.

/// A mean over scenes with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Mean over the scenes.
    pub mean: f64,
    /// Standard deviation of the mean; 0 for fewer than two scenes.
    pub standard_error: f64,
}

impl Estimate {
    /// Mean and standard error of `values`; NaN for none.
    pub fn of(values: &[f64]) -> Estimate {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Estimate { mean, standard_error: if values.len() > 1 { (variance / n).sqrt() } else { 0.0 } }
    }

    /// Standard errors from this estimate to the nearest value that is printed as `printed`, signed; rounding apart it is
    /// `(mean - printed) / standard_error`.
    pub fn deviation_from(&self, printed: f64, rounding: f64) -> f64 {
        let off = self.mean - printed;
        off.signum() * (off.abs() - rounding).max(0.0) / self.standard_error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_error_of_known_values() {
        let e = Estimate::of(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(e.mean, 2.5);
        assert!((e.standard_error - (5.0f64 / 3.0 / 4.0).sqrt()).abs() < 1e-12);
    }
}
