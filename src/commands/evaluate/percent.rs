//! Rates as tables write them.

use crate::evaluate::Estimate;

pub(super) fn percent_of(rate: &Estimate) -> String {
    percent(rate.mean, rate.standard_error)
}

pub(super) fn percent(mean: f64, standard_error: f64) -> String {
    match mean.is_nan() {
        true => "-".to_owned(),
        false => format!("{:.2} \u{b1} {:.3}", 100.0 * mean, 100.0 * standard_error),
    }
}
