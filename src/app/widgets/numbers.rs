//! Numbers as text, with the same digits for the same quantity in every panel.

/// A ratio as a percentage with two decimals.
pub fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part)
}

/// A number with its sign, and a minus as wide as the plus.
pub fn signed(value: f64, digits: usize) -> String {
    let text = format!("{value:+.digits$}");
    // Rounding leaves a minus before zero.
    match text.chars().all(|c| !c.is_ascii_digit() || c == '0') {
        true => text.replace(['-', '+'], "±"),
        false => text.replace('-', "−"),
    }
}

/// A number with a minus as wide as a plus, and no minus before zero.
pub fn plain(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.chars().any(|c| c.is_ascii_digit() && c != '0') {
        true => text.replace('-', "−"),
        false => text.replace('-', ""),
    }
}

/// A number with three significant digits.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.digits$}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_kind_look_alike() {
        assert_eq!((percent(0.9935), percent(1.0)), ("99.35 %".into(), "100.00 %".into()));
        assert_eq!([signed(1.25, 1), signed(-0.5, 1), signed(-0.01, 1)], ["+1.2", "−0.5", "±0.0"]);
        assert_eq!([plain(1.25, 1), plain(-0.5, 1), plain(-0.01, 1)], ["1.2", "−0.5", "0.0"]);
        assert_eq!([12345.6, 12.3456, 0.0012345, -0.5].map(significant), ["12346", "12.3", "0.00123", "−0.500"]);
    }
}
