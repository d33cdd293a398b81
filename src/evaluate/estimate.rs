//! Means over scenes, with standard errors.

/// A mean over scenes with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Mean over the scenes.
    pub mean: f64,
    /// Standard deviation of the mean; 0 for fewer than two scenes.
    pub standard_error: f64,
    /// Median over the scenes: beside it a mean shows whether few scenes decide it.
    pub median: f64,
}

impl Estimate {
    /// Mean, standard error and median of `values`; NaN for none.
    pub fn of(values: &[f64]) -> Estimate {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let standard_error = if values.len() > 1 { (variance / n).sqrt() } else { 0.0 };
        Estimate { mean, standard_error, median: median(values) }
    }

    /// Standard errors from this estimate to the nearest value printed as `printed`: `(mean - printed) / standard_error`, rounding apart.
    pub fn deviation_from(&self, printed: f64, rounding: f64) -> f64 {
        let off = self.mean - printed;
        off.signum() * (off.abs() - rounding).max(0.0) / self.standard_error
    }
}

/// The middle of `values`, of an even number the upper one of both; `None` for none.
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = (sorted.get(sorted.len().saturating_sub(1) / 2), sorted.get(sorted.len() / 2));
    low.zip(high).map_or(f64::NAN, |(low, high)| (low + high) / 2.0)
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

    #[test]
    fn one_bad_scene_moves_the_mean_alone() {
        let e = Estimate::of(&[5.0, 1.0, 3.0, 1000.0]);
        assert_eq!((e.median, Estimate::of(&[9.0, 1.0, 3.0]).median), (4.0, 3.0));
        assert!(e.mean > 250.0 && Estimate::of(&[]).median.is_nan());
    }
}
