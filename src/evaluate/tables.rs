//! Tables 4.1 to 4.3: averages over test scenes beside the printed values.

use super::{Metrics, Roc};

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
}

/// What the thesis prints for one test set (tables 4.1 to 4.3); rates as fractions.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Printed {
    /// SE.
    pub squared_error: f64,
    /// P_D.
    pub detection: f64,
    /// P_FA.
    pub false_alarm: f64,
}

impl Printed {
    /// How far the printed rates are rounded: half of the last printed digit, as fractions (P_D, P_FA).
    ///
    /// All are printed with two decimals of a percent, but for the baseline's on set 1 (12.4 % and 0.2 %).
    pub fn rate_rounding(&self) -> f64 {
        if *self == PRINTED_BASELINE[0] { 0.05e-2 } else { 0.005e-2 }
    }
}

impl Estimate {
    /// Standard errors from this estimate to the nearest value that is printed as `printed`, signed; rounding apart it is
    /// `(mean - printed) / standard_error`.
    pub fn deviation_from(&self, printed: f64, rounding: f64) -> f64 {
        let off = self.mean - printed;
        off.signum() * (off.abs() - rounding).max(0.0) / self.standard_error
    }
}

/// The thesis' baseline column, by set.
pub const PRINTED_BASELINE: [Printed; 3] = [
    Printed { squared_error: 20565.30, detection: 0.124, false_alarm: 0.002 },
    Printed { squared_error: 11334.99, detection: 0.0689, false_alarm: 0.0056 },
    Printed { squared_error: 17044.08, detection: 0.6753, false_alarm: 0.0557 },
];

/// The thesis' experiment 1 column, by set.
pub const PRINTED_EXPERIMENT_1: [Printed; 3] = [
    Printed { squared_error: 7657.93, detection: 0.9890, false_alarm: 0.0044 },
    Printed { squared_error: 14264.35, detection: 0.7255, false_alarm: 0.0063 },
    Printed { squared_error: 12936.48, detection: 0.5877, false_alarm: 0.0251 },
];

/// The thesis' experiment 2 column, by set.
pub const PRINTED_EXPERIMENT_2: [Printed; 3] = [
    Printed { squared_error: 1815.03, detection: 0.9898, false_alarm: 0.0037 },
    Printed { squared_error: 1341.22, detection: 0.8244, false_alarm: 0.0056 },
    Printed { squared_error: 1613.29, detection: 0.9197, false_alarm: 0.0102 },
];

/// One method on one test set.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    squared_error: Vec<f64>,
    detection: Vec<f64>,
    false_alarm: Vec<f64>,
    milliseconds: Vec<f64>,
    roc: Roc,
}

impl Tally {
    /// Adds a scene's figures, its ROC and the time its map took.
    pub fn add(&mut self, metrics: &Metrics, roc: impl FnOnce(&mut Roc), milliseconds: f64) {
        self.squared_error.push(metrics.squared_error);
        self.detection.extend(metrics.detection);
        self.false_alarm.push(metrics.false_alarm);
        self.milliseconds.push(milliseconds);
        roc(&mut self.roc);
    }

    /// Number of scenes.
    pub fn scenes(&self) -> usize {
        self.squared_error.len()
    }

    /// SE.
    pub fn squared_error(&self) -> Estimate {
        Estimate::of(&self.squared_error)
    }

    /// P_D, over the scenes that have target cells.
    pub fn detection(&self) -> Estimate {
        Estimate::of(&self.detection)
    }

    /// P_FA.
    pub fn false_alarm(&self) -> Estimate {
        Estimate::of(&self.false_alarm)
    }

    /// Median time of one reconstruction, milliseconds.
    pub fn median_milliseconds(&self) -> f64 {
        let mut t = self.milliseconds.clone();
        t.sort_by(f64::total_cmp);
        t.get(t.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// The averaged ROC.
    pub fn roc(&self) -> &Roc {
        &self.roc
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_allow_for_the_printed_digits() {
        let e = Estimate { mean: 0.0021, standard_error: 0.0001 };
        assert!((e.deviation_from(0.002, 0.0) - 1.0).abs() < 1e-9);
        assert_eq!(e.deviation_from(0.002, PRINTED_BASELINE[0].rate_rounding()), 0.0);
        assert!((e.deviation_from(0.003, 0.0005) + 4.0).abs() < 1e-9);
    }

    #[test]
    fn standard_error_of_known_values() {
        let e = Estimate::of(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(e.mean, 2.5);
        assert!((e.standard_error - (5.0f64 / 3.0 / 4.0).sqrt()).abs() < 1e-12);
    }
}
