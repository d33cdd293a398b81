//! Tables 4.1 to 4.3 made of the evaluated rows: every method on every test set.

use crate::evaluate::rows::{Column, Row, Text};
use crate::evaluate::tables::{Estimate, Tally};
use crate::scene::generate::Kind;
use std::collections::BTreeMap;

/// Figures of one method on one test set.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRow {
    /// Test set, 1 to 3.
    pub set: usize,
    /// Name of the method.
    pub method: Text,
    /// The optimisers that trained the method's weights; empty without weights.
    pub optimiser: String,
    /// The threshold of all answers, or the mean of their own thresholds.
    pub eta: f32,
    /// Whether every answer was judged at `eta`.
    pub one_eta: bool,
    /// Scenes of the set.
    pub scenes: usize,
    /// Squared error SE.
    pub squared_error: Estimate,
    /// Detection probability P_D, 0 to 1.
    pub detection: Estimate,
    /// False-alarm probability P_FA, 0 to 1.
    pub false_alarm: Estimate,
    /// P_D where every scene's threshold gives the printed P_FA of experiment 2.
    pub detection_at_printed: Option<Estimate>,
    /// P_D and P_FA by a detector of constant false-alarm rate, where all rows have them.
    pub cfar: Option<[Estimate; 2]>,
    /// Median time of a map.
    pub median_milliseconds: f64,
}

/// Figures of every method on every test set with rows.
pub fn evaluated(rows: &[Row]) -> Vec<EvaluationRow> {
    let sets = Kind::TEST_SETS.map(|kind| kind.to_string());
    let mut found: BTreeMap<(usize, &Text), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        if let Some(set) = sets.iter().position(|set| row.set == *set.as_str()) {
            found.entry((set + 1, &row.method)).or_default().push(row);
        }
    }
    found.into_iter().map(|((set, method), rows)| evaluated_on(set, method, rows)).collect()
}

fn evaluated_on(set: usize, method: &Text, rows: Vec<&Row>) -> EvaluationRow {
    let has_cfar = rows.iter().all(|row| row.cfar_false_alarm.is_some());
    let tally = Tally::of(rows);
    EvaluationRow {
        set,
        method: method.clone(),
        optimiser: tally.optimiser().to_owned(),
        eta: tally.eta(),
        one_eta: tally.has_one_eta(),
        scenes: tally.scenes(),
        squared_error: tally.squared_error(),
        detection: tally.detection(),
        false_alarm: tally.false_alarm(),
        detection_at_printed: Some(tally.estimate(Column::DetectionAtPrinted)).filter(|d| d.mean.is_finite()),
        cfar: has_cfar.then(|| [tally.estimate(Column::CfarDetection), tally.estimate(Column::CfarFalseAlarm)]),
        median_milliseconds: tally.median_milliseconds(),
    }
}

/// A column's name in the CSV, and the text of a row's cell.
type CsvColumn = (&'static str, fn(&EvaluationRow) -> String);

/// The columns of the CSV. The last two are written only where a row has figures by a detector of constant false-alarm rate.
const CSV_COLUMNS: [CsvColumn; 18] = [
    ("set", |r| r.set.to_string()),
    ("method", |r| r.method.to_string()),
    ("eta", |r| r.eta.to_string()),
    ("scenes", |r| r.scenes.to_string()),
    ("squared_error", |r| r.squared_error.mean.to_string()),
    ("squared_error_se", |r| r.squared_error.standard_error.to_string()),
    ("detection", |r| r.detection.mean.to_string()),
    ("detection_se", |r| r.detection.standard_error.to_string()),
    ("false_alarm", |r| r.false_alarm.mean.to_string()),
    ("false_alarm_se", |r| r.false_alarm.standard_error.to_string()),
    ("detection_at_printed_false_alarm", |r| mean_of(r.detection_at_printed)),
    ("median_milliseconds", |r| format!("{:.3}", r.median_milliseconds)),
    ("optimiser", |r| format!("\"{}\"", r.optimiser)),
    ("squared_error_median", |r| r.squared_error.median.to_string()),
    ("detection_median", |r| r.detection.median.to_string()),
    ("false_alarm_median", |r| r.false_alarm.median.to_string()),
    ("cfar_detection", |r| mean_of(r.cfar.map(|rates| rates[0]))),
    ("cfar_false_alarm", |r| mean_of(r.cfar.map(|rates| rates[1]))),
];

fn mean_of(estimate: Option<Estimate>) -> String {
    estimate.map_or_else(String::new, |estimate| estimate.mean.to_string())
}

/// The rows as CSV; rates as fractions.
pub fn to_csv(rows: &[EvaluationRow]) -> String {
    let has_cfar = rows.iter().any(|row| row.cfar.is_some());
    let columns = &CSV_COLUMNS[..CSV_COLUMNS.len() - if has_cfar { 0 } else { 2 }];
    let heading = columns.iter().map(|(name, _)| (*name).to_owned()).collect::<Vec<_>>();
    let lines = rows.iter().map(|row| columns.iter().map(|(_, cell)| cell(row)).collect());
    [heading].into_iter().chain(lines).map(|cells| cells.join(",") + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::super::some_row;
    use super::*;

    #[test]
    fn rows_of_test_sets_become_the_printed_tables() {
        let other = Row { set: "walls".into(), ..some_row(2, "live") };
        let rows = [some_row(0, "live"), some_row(1, "live"), some_row(0, "capon"), other];
        let found = evaluated(&rows);
        let told: Vec<(usize, &str, usize)> = found.iter().map(|row| (row.set, &*row.method, row.scenes)).collect();
        assert_eq!(told, [(1, "capon", 1), (1, "live", 2)]);
        let csv = to_csv(&found);
        assert!(csv.starts_with("set,method,") && csv.lines().count() == 3 && !csv.contains("cfar"), "{csv}");
    }
}
