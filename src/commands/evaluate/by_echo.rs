//! Detection by echo, for scenes with bodies: P_D counts cells near the strongest echo only.

use crate::evaluate::echoes::{CLASSES, EchoTally};
use serde::Serialize;
use std::fmt::Write;

#[derive(Debug, Serialize)]
pub struct EchoReport {
    /// Level at which each class begins, dB below the scene's strongest echo; the last class has no end.
    below_db: [usize; CLASSES],
    #[serde(flatten)]
    tally: EchoTally,
    /// Part of all echoes that were found; `None` without echoes.
    detection: Option<f64>,
}

impl EchoReport {
    pub fn of(tally: EchoTally) -> EchoReport {
        EchoReport { below_db: std::array::from_fn(|class| 10 * class), tally, detection: tally.part() }
    }
}

/// Adds the echoes that each method found to a set's table; no effect without methods. `width` is that of the names.
pub fn write(methods: &[(&str, &EchoReport)], width: usize, text: &mut String) {
    let Some((_, first)) = methods.first() else { return };
    let title = "echoes found, by dB below the";
    let _ = write!(text, "{title:<width$} {:>9}", "all");
    for (i, from) in first.below_db.iter().enumerate() {
        let class = first.below_db.get(i + 1).map_or(format!("{from}+"), |to| format!("{from}-{to}"));
        let _ = write!(text, "{class:>14}");
    }
    let _ = writeln!(text, "\n  strongest of the scene");
    for (method, echoes) in methods {
        let all = echoes.detection.map_or("-".to_owned(), |part| format!("{:.1} %", 100.0 * part));
        let _ = write!(text, "{method:<width$} {all:>9}");
        for (found, there) in echoes.tally.found.iter().zip(&echoes.tally.there) {
            let _ = write!(text, "{:>14}", format!("{found} of {there}"));
        }
        text.push('\n');
    }
}
