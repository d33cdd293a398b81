//! Tables 4.1 to 4.3 of the rows there are: every method on every test set.

use crate::evaluate::rows::{Column, Row, Text};
use crate::evaluate::tables::{Estimate, Tally};
use crate::scene::generate::Kind;
use std::collections::BTreeMap;

/// One method on one test set.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRow {
    /// Test set, 1 to 3.
    pub set: usize,
    /// Name of the method.
    pub method: Text,
    /// The optimisers that trained the method's weights; empty without weights.
    pub optimiser: String,
    /// The threshold it was judged at; the mean where each answer has its own.
    pub eta: f32,
    /// Whether every answer was judged at `eta`.
    pub one_eta: bool,
    /// Scenes of the set.
    pub scenes: usize,
    /// SE.
    pub squared_error: Estimate,
    /// P_D.
    pub detection: Estimate,
    /// P_FA.
    pub false_alarm: Estimate,
    /// P_D where every scene's P_FA is held to the printed one of experiment 2.
    pub detection_at_printed: Option<Estimate>,
    /// P_D and P_FA by a detector of constant false-alarm rate, where one was in use.
    pub cfar: Option<[Estimate; 2]>,
    /// Time of a map.
    pub median_milliseconds: f64,
}

/// Every method on every test set of which there are rows.
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

/// Name of a column of the CSV, and what a row has there.
type CsvColumn = (&'static str, fn(&EvaluationRow) -> String);

/// The columns; the last two stand there where a detector of constant false-alarm rate was in use.
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
