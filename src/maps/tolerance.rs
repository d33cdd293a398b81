//! The precision of a signal whose numerical errors are invisible in its map.

use super::lambda::Normalisation;
use crate::signal::plan::{self, BEST_TOLERANCE, FLOOR_TOLERANCE, SumSize};
use crate::signal::{Floor, Precision};

/// The largest error of a signal, relative to its amplitudes, that is invisible in a map over `floor` with this normalisation.
///
/// A map normalised by its minimum shows the floor. The errors of f32 exceed the thesis' floor (1e-11 a sample), and those of gridding exceed rounding
/// alone. Over thermal noise, or with a fixed dynamic range, f32 is sufficient until the noise or the range is near its rounding.
pub fn tolerance_for(floor: Floor, normalisation: Normalisation) -> f64 {
    match (normalisation, floor) {
        (Normalisation::DynamicRange(db), _) if db.0 <= 100.0 => 1e-6,
        (Normalisation::MinMax, Floor::Snr(snr)) if snr.0 <= 40.0 => 1e-6,
        (_, Floor::Exact) => BEST_TOLERANCE,
        _ => FLOOR_TOLERANCE,
    }
}

/// The reason for which maps of this floor and normalisation must not be computed in `precision`, as in [`plan::refusal`]. `None` where they may be.
pub fn refusal(
    precision: Precision,
    sum: &SumSize,
    floor: Floor,
    normalisation: Normalisation,
) -> Option<&'static str> {
    match (precision, floor, normalisation) {
        (Precision::F64, ..) => None,
        (Precision::F32, Floor::Exact, Normalisation::MinMax) => {
            Some("f64 although f32 was asked for: without a floor, min-max would show f32's own rounding")
        }
        (Precision::F32, ..) => plan::refusal(sum),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::signal::{Algorithm, SynthesisPlan};

    #[test]
    fn f32_never_meets_min_max_over_a_rounding_floor() {
        for (floor, normalisation, precision) in [
            (Floor::Thesis, Normalisation::MinMax, Precision::F64),
            (Floor::Exact, Normalisation::MinMax, Precision::F64),
            (Floor::Snr(Decibels(80.0)), Normalisation::MinMax, Precision::F64),
            (Floor::Snr(Decibels(20.0)), Normalisation::MinMax, Precision::F32),
            (Floor::Exact, Normalisation::DynamicRange(Decibels(60.0)), Precision::F32),
            (Floor::Exact, Normalisation::DynamicRange(Decibels(200.0)), Precision::F64),
        ] {
            let recipe = SynthesisPlan::cheapest(10, 1.0, tolerance_for(floor, normalisation));
            assert_eq!(recipe.precision, precision, "{floor} {normalisation}");
        }
        let exact = SynthesisPlan::cheapest(1000, 1.0, tolerance_for(Floor::Exact, Normalisation::MinMax));
        assert_eq!(exact.algorithm, Algorithm::Split, "without a floor, gridding's own error would show");
        assert_eq!(SynthesisPlan::cheapest(10, 1e30, 1e-6).precision, Precision::F64, "squares of 1e30 overflow f32");
    }
}
