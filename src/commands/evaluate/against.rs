//! The first method of a set against each of the others, scene by scene.

use crate::evaluate::rows::Row;
use crate::evaluate::statistics::Paired;
use serde::Serialize;
use std::fmt::Write;

#[derive(Debug, Serialize)]
pub struct Against {
    first: String,
    second: String,
    scenes: usize,
    squared_error_difference: f64,
    interval_95: [f64; 2],
    first_alone: usize,
    second_alone: usize,
    mcnemar_p: f64,
    #[serde(skip)]
    told: String,
}

impl Against {
    /// The first of `methods` against each of the others, on the scenes that both have.
    pub fn of(methods: &[&str], rows: &[&Row]) -> Vec<Against> {
        let Some((first, others)) = methods.split_first() else { return Vec::new() };
        let against = |second: &&str| {
            let paired = Paired::of(rows.iter().copied(), first, second)?;
            Some(Against {
                first: (*first).to_owned(),
                second: (*second).to_owned(),
                scenes: paired.scenes,
                squared_error_difference: paired.difference,
                interval_95: paired.interval,
                first_alone: paired.first_alone,
                second_alone: paired.second_alone,
                mcnemar_p: paired.p_value,
                told: paired.told(first, second),
            })
        };
        others.iter().filter_map(against).collect()
    }
}

pub fn write(against: &[Against], text: &mut String) {
    for pair in against {
        let _ = writeln!(text, "{}", pair.told);
    }
}
