//! Figures on a method's doubt: its ratio to the errors, and the failures that it finds.

use super::percent::percent_of;
use crate::evaluate::Estimate;
use crate::evaluate::rows::Row;
use crate::evaluate::statistics::DoubtArea;
use crate::radar::counted;
use serde::Serialize;
use std::fmt::Write;

#[derive(Debug, Serialize)]
pub struct DoubtReport {
    method: String,
    #[serde(flatten)]
    found: DoubtArea,
}

impl DoubtReport {
    /// The figures of the rows of `method`; `None` where they have no doubt or are too few. `limit` is the least squared error of a failure; without
    /// it the worst tenth of these rows are failures.
    pub fn of(method: &str, rows: &[&Row], limit: Option<f64>) -> Option<DoubtReport> {
        let own = rows.iter().copied().filter(|row| row.method == method);
        Some(DoubtReport { method: method.to_owned(), found: DoubtArea::of(own, limit)? })
    }
}

/// Adds a line a method to a table: the part of the cells whose error is at most their doubt.
pub fn write_within<'a>(methods: impl IntoIterator<Item = (&'a String, &'a Estimate)>, text: &mut String) {
    for (method, part) in methods {
        let _ = writeln!(
            text,
            "doubt of {method}: the error of {} % of the cells is at most their doubt; 90 % is the aim over noise that it was trained on",
            percent_of(part)
        );
    }
}

pub fn write<'a>(reports: impl IntoIterator<Item = &'a DoubtReport>, text: &mut String) {
    for DoubtReport { method, found } in reports {
        let DoubtArea { rows, failures, least_squared_error, area, standard_error } = found;
        let area = area.map_or("-".to_owned(), |area| format!("{area:.3}"));
        let error = standard_error.map_or_else(String::new, |error| format!(" \u{b1} {error:.3}"));
        let failures = counted(*failures, "failure", "failures");
        let _ = writeln!(
            text,
            "doubt of {method} against failures: area under the ROC curve {area}{error} ({failures} in {rows} rows, SE from \
             {least_squared_error:.1} on)"
        );
    }
}
