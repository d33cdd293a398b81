//! Rates as tables write them.

use crate::evaluate::Estimate;

/// A rate in percent, with its standard error.
pub(super) fn percent_of(rate: &Estimate) -> String {
    match rate.mean.is_nan() {
        true => "-".to_owned(),
        false => format!("{:.2} \u{b1} {:.3}", 100.0 * rate.mean, 100.0 * rate.standard_error),
    }
}
