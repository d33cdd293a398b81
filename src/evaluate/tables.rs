//! Tables 4.1 to 4.3: averages over test scenes beside the printed values.

pub use super::estimate::Estimate;

use super::echoes::EchoTally;
use super::estimate::upper_median;
use super::rows::{Column, Row, estimate};

/// The thesis' printed values for one test set (tables 4.1 to 4.3); rates as fractions.
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
    /// Half of the last printed digit of the rates, as fractions (P_D, P_FA).
    /// All rates are printed with two decimals of a percent, except the baseline's on set 1 (12.4 % and 0.2 %).
    pub fn rate_rounding(&self) -> f64 {
        if *self == PRINTED_BASELINE[0] { 0.05e-2 } else { 0.005e-2 }
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

/// Largest ratio to the least SE that counts as near the best in [`part_near_best`].
pub const MAX_NEAR_BEST_RATIO: f64 = 1.2;

/// Part of one set's scenes where the SE of `method` is at most [`MAX_NEAR_BEST_RATIO`] times the others' least; `None` without other rows.
pub fn part_near_best(rows: &[&Row], method: &str) -> Option<f64> {
    let is_near = |row: &&&Row| {
        let others = rows.iter().filter(|r| (r.seed, r.index) == (row.seed, row.index) && r.method != method);
        let least = others.map(|r| r.squared_error).reduce(f64::min)?;
        Some(row.squared_error <= MAX_NEAR_BEST_RATIO * least)
    };
    let near: Vec<bool> = rows.iter().filter(|row| row.method == method).filter_map(|row| is_near(&row)).collect();
    (!near.is_empty()).then(|| near.iter().filter(|n| **n).count() as f64 / near.len() as f64)
}

/// One method on one set: means of its rows.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    rows: Vec<Row>,
}

impl Tally {
    /// The tally of the rows of one method on one set.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Tally {
        Tally { rows: rows.into_iter().cloned().collect() }
    }

    /// Mean of a column over the rows that have a number there; NaN where none has.
    pub fn estimate(&self, column: Column) -> Estimate {
        estimate(&self.rows, column)
    }

    /// Number of scenes.
    pub fn scenes(&self) -> usize {
        self.rows.len()
    }

    /// Threshold of the method, with all its digits; the mean over its answers where each has its own ([`Tally::has_one_eta`]).
    pub fn eta(&self) -> f32 {
        if let Some(first) = self.rows.first().filter(|_| self.has_one_eta()) {
            return first.eta;
        }
        let sum: f64 = self.rows.iter().map(|row| f64::from(row.eta)).sum();
        (sum / self.rows.len() as f64) as f32
    }

    /// Whether every answer was judged at the same threshold.
    pub fn has_one_eta(&self) -> bool {
        self.rows.array_windows().all(|[a, b]| a.eta == b.eta)
    }

    /// The optimisers that trained the method's weights; empty where rows don't record them, and for methods that learn nothing.
    pub fn optimiser(&self) -> &str {
        self.rows.first().map_or("", |row| &row.optimiser)
    }

    /// The fingerprint of the method's weights; `None` for a method that learns nothing.
    pub fn weights(&self) -> Option<&str> {
        self.rows.first().map(|row| &*row.weights).filter(|weights| !weights.is_empty())
    }

    /// SE.
    pub fn squared_error(&self) -> Estimate {
        self.estimate(Column::SquaredError)
    }

    /// P_D at the method's threshold, over the scenes that have target cells.
    pub fn detection(&self) -> Estimate {
        self.estimate(Column::Detection)
    }

    /// P_FA at the method's threshold.
    pub fn false_alarm(&self) -> Estimate {
        self.estimate(Column::FalseAlarm)
    }

    /// Echoes of all scenes with bodies, and those that the method shows; `None` where no row has counted them.
    pub fn echoes(&self) -> Option<EchoTally> {
        let add = |mut all: EchoTally, one: EchoTally| {
            all.add(&one);
            all
        };
        self.rows.iter().filter_map(Row::echo_tally).reduce(add)
    }

    /// Median time of one reconstruction, milliseconds; NaN without scenes.
    pub fn median_milliseconds(&self) -> f64 {
        upper_median(self.rows.iter().map(|row| row.milliseconds)).unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::rows::tests::row;

    #[test]
    fn near_the_best_is_judged_scene_by_scene() {
        let all = [(0, "a", 119.0), (0, "b", 100.0), (0, "c", 130.0), (1, "a", 121.0), (1, "b", 100.0), (2, "a", 1.0)];
        let rows = all.map(|(index, method, squared_error)| Row { squared_error, ..row("1", index, method) });
        let rows: Vec<&Row> = rows.iter().collect();
        assert_eq!(["a", "b", "c", "d"].map(|m| part_near_best(&rows, m)), [Some(0.5), Some(1.0), Some(0.0), None]);
        assert_eq!(part_near_best(&rows[5..], "a"), None);
    }

    #[test]
    fn deviations_allow_for_the_printed_digits() {
        let e = Estimate { mean: 0.0021, standard_error: 0.0001, median: 0.002 };
        assert!((e.deviation_from(0.002, 0.0) - 1.0).abs() < 1e-9);
        assert_eq!(e.deviation_from(0.002, PRINTED_BASELINE[0].rate_rounding()), 0.0);
        assert!((e.deviation_from(0.003, 0.0005) + 4.0).abs() < 1e-9);
    }
}
