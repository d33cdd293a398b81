//! Levels of a map in decibels as text.

use super::numbers::signed;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_level_below_200_decibels_or_the_floor_is_told() {
        assert_eq!([-281.5, -200.0, -199.9].map(|db| level(db, 330.0)), ["≤ −200", "≤ −200", "−199.9"]);
        assert_eq!([-281.5, 281.5, -3.0].map(difference), ["≤ −200", "≥ +200", "−3.0"]);
        assert_eq!([-100.0, -99.9, -0.01].map(|db| level(db, 100.0)), ["≤ −100", "−99.9", "0.0"]);
        assert_eq!([with_unit(&level(0.0, 0.0)), with_unit(&level(-3.0, 60.0))], ["no echo", "−3.0 dB"]);
    }
}
