//! Numbers as text, with the same digits for the same quantity in every panel: levels in decibels, and directions.
//!
//! θ is the angle to the array's axis, so cos θ is the sine of the angle from straight ahead.

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

/// A number with a power of ten, like "1.2e−7".
pub fn scientific(value: f64, digits: usize) -> String {
    format!("{value:.digits$e}").replace('-', "−")
}

/// A sentence of the library, whose negative numbers have a hyphen, with a minus in its place. Hyphens within words and ranges stay.
pub fn with_minuses(sentence: &str) -> String {
    let mut before = ' ';
    let mut following = sentence.chars().skip(1);
    let sign = |letter: char| {
        let is_number = following.next().is_some_and(|c| c.is_ascii_digit());
        let is_sign = letter == '-' && is_number && !before.is_alphanumeric();
        before = letter;
        if is_sign { '−' } else { letter }
    };
    sentence.chars().map(sign).collect()
}

/// Lowest level that is shown, decibels relative to the peak. Samples of 24 bits reach 144 dB, and the transforms of 512 x 1024 samples add 57 dB. Lower
/// values of a map are rounding, not echoes.
pub const LOWEST_DB: f64 = -200.0;

/// The lowest level that is shown of a map whose Λ spans `range_db`.
pub fn lowest_db(range_db: f64) -> f64 {
    LOWEST_DB.max(-range_db)
}

/// A level relative to the map's peak, for a map whose Λ spans `range_db`: "−23.4", "≤ −200" at or below the lowest level shown, "no echo" for a silent map.
/// The caller adds "dB" with [`with_unit`].
pub fn level(db: f64, range_db: f64) -> String {
    let lowest = lowest_db(range_db);
    match () {
        () if range_db <= 0.0 => "no echo".to_owned(),
        // Λ is f32.
        () if db <= lowest + 1e-5 * range_db => format!("≤ −{:.0}", -lowest),
        () if db > -0.05 => "0.0".to_owned(),
        () => signed(db, 1),
    }
}

/// A difference of two levels: "+25.0", "≥ +200" beyond the largest shown.
pub fn difference(db: f64) -> String {
    match () {
        () if db <= LOWEST_DB => format!("≤ −{:.0}", -LOWEST_DB),
        () if db >= -LOWEST_DB => format!("≥ +{:.0}", -LOWEST_DB),
        () => signed(db, 1),
    }
}

/// A text of [`level`] with its unit.
pub fn with_unit(level: &str) -> String {
    if level == "no echo" { level.to_owned() } else { format!("{level} dB") }
}

/// Zero and sign of the degrees, for tooltips.
pub const CONVENTION: &str = "0° is straight ahead, positive to the right";

/// Degrees from straight ahead, -90 to 90, of a direction with this cosine to the array's axis.
pub fn angle_degrees(cos_theta: f64) -> f64 {
    cos_theta.clamp(-1.0, 1.0).asin().to_degrees()
}

/// Degrees from straight ahead of a place: beyond -90 and 90 behind the array.
pub fn angle_of_place_degrees(x_metres: f64, y_metres: f64) -> f64 {
    x_metres.atan2(y_metres).to_degrees()
}

/// A direction like "+6.9° · cos θ +0.120": the angle has `digits` decimals, the cosine two more.
pub fn direction(cos_theta: f64, digits: usize) -> String {
    format!("{}° · cos θ {}", signed(angle_degrees(cos_theta), digits), signed(cos_theta, digits + 2))
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
        assert_eq!([scientific(1.234e-7, 1), scientific(-52.0, 2)], ["1.2e−7", "−5.20e1"]);
    }

    #[test]
    fn a_sign_of_a_number_is_a_minus_and_a_hyphen_stays() {
        let told = with_minuses("A well-known net-2 shows it at -18.2 m/s (-3 dB) - by 10-20 cells, -x");
        assert_eq!(told, "A well-known net-2 shows it at −18.2 m/s (−3 dB) - by 10-20 cells, -x");
    }

    #[test]
    fn no_level_below_200_decibels_or_the_floor_is_told() {
        assert_eq!([-281.5, -200.0, -199.9].map(|db| level(db, 330.0)), ["≤ −200", "≤ −200", "−199.9"]);
        assert_eq!([-281.5, 281.5, -3.0].map(difference), ["≤ −200", "≥ +200", "−3.0"]);
        assert_eq!([-100.0, -99.9, -0.01].map(|db| level(db, 100.0)), ["≤ −100", "−99.9", "0.0"]);
        assert_eq!([with_unit(&level(0.0, 0.0)), with_unit(&level(-3.0, 60.0))], ["no echo", "−3.0 dB"]);
    }

    #[test]
    fn straight_ahead_is_0_degrees_and_the_right_positive() {
        assert_eq!((angle_degrees(0.0), angle_of_place_degrees(0.0, 3.0)), (0.0, 0.0));
        assert_eq!(direction(0.0, 1), "±0.0° · cos θ ±0.000");
        assert!((angle_degrees(0.5) - 30.0).abs() < 1e-12);
        assert!((angle_of_place_degrees(-1.0, 1.0) + 45.0).abs() < 1e-12);
        assert_eq!(direction(-0.5, 1), "−30.0° · cos θ −0.500");
        assert!((angle_of_place_degrees(1.0, -1.0) - 135.0).abs() < 1e-12, "behind the array");
    }
}
