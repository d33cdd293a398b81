//! Polar coordinates of places around other points than the array's centre, and the directions of a radar's columns.
//!
//! The ends of table 3.1 stand a metre to the left and right of the centre: the ranges of one reflector from them differ by up to 26 bins.

use crate::radar::{Pair, Polar, Radar};

/// Distance in far fields at which a wave counts as plane: its front is curved by less than 1e-5 wavelengths over the array.
pub(super) const FAR_FIELDS_AWAY: f64 = 1e4;

/// The reflector at (`range_metres`, `cos_theta`) of the centre, in polar coordinates around `from_x_metres` on the array's axis.
pub(super) fn polar_from(from_x_metres: f64, range_metres: f64, cos_theta: f64) -> Polar {
    let x = range_metres * cos_theta.clamp(-1.0, 1.0);
    let square = range_metres * range_metres - 2.0 * x * from_x_metres + from_x_metres * from_x_metres;
    let range = square.max(1e-12).sqrt();
    Polar { range_metres: range, cos_theta: ((x - from_x_metres) / range).clamp(-1.0, 1.0) }
}

/// The reflector at (`range_metres`, `cos_theta`) of the centre, in polar coordinates around an antenna at `place_metres`, (x, y).
fn polar_from_antenna(place_metres: [f64; 2], range_metres: f64, cos_theta: f64) -> Polar {
    let [from_x_metres, from_y_metres] = place_metres;
    if from_y_metres == 0.0 {
        return polar_from(from_x_metres, range_metres, cos_theta);
    }
    let cos = cos_theta.clamp(-1.0, 1.0);
    let (x, y) = (range_metres * cos - from_x_metres, range_metres * (1.0 - cos * cos).sqrt() - from_y_metres);
    let range = x.hypot(y).max(1e-6);
    Polar { range_metres: range, cos_theta: (x / range).clamp(-1.0, 1.0) }
}

/// The reflector at (`range_metres`, `cos_theta`) of the centre, for a pair of antennas: half the way there and back, and the mean of both
/// cosines, which is the range's derivative where both antennas move.
pub(super) fn polar_from_pair(pair: Pair, range_metres: f64, cos_theta: f64) -> Polar {
    let [transmitter, receiver] = pair.places_metres();
    let there = polar_from_antenna(transmitter, range_metres, cos_theta);
    if pair.is_one() {
        return there;
    }
    let back = polar_from_antenna(receiver, range_metres, cos_theta);
    Polar {
        range_metres: (there.range_metres + back.range_metres) / 2.0,
        cos_theta: (there.cos_theta + back.cos_theta) / 2.0,
    }
}

/// Range of every row of `radar`'s map, metres. A single sample has no ranges: its echoes count as plane waves from far away.
pub(super) fn row_ranges_metres(radar: &Radar) -> Vec<f64> {
    if radar.samples == 1 {
        return vec![FAR_FIELDS_AWAY * radar.far_field_metres()];
    }
    (0..radar.samples).map(|bin| radar.range_of_bin_metres(bin as f64)).collect()
}

/// A direction and the column of the whole array's map that shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Direction {
    pub cos_theta: f64,
    pub column: usize,
}

/// Most directions of one column; wider spacings are refused.
pub(super) const MAX_FOLDS: usize = 8;

/// Every direction of the columns of `radar`'s map, column after column.
///
/// One a column for half a wavelength and the one-way carrier. Wider spacings and the two-way carrier fold several directions into
/// each column (grating lobes); with narrower spacings some columns have none.
pub(super) fn directions(radar: &Radar) -> Vec<Direction> {
    let period = cos_period(radar);
    let of_column = |column: usize| {
        let cos = radar.cos_of_column(column as f64);
        // Rounding must not push the column of the axis itself off it.
        let lowest = cos - ((cos + 1.0 + ROUNDING_COS) / period).floor() * period;
        (0..=MAX_FOLDS)
            .map(move |fold| lowest + fold as f64 * period)
            .take_while(|cos| *cos < 1.0 - ROUNDING_COS)
            .map(move |cos| Direction { cos_theta: cos.max(-1.0), column })
    };
    (0..radar.elements).flat_map(of_column).collect()
}

/// Largest error of a column's cosine.
const ROUNDING_COS: f64 = 1e-9;

/// Period in cos(theta) after which directions share a column.
pub(super) fn cos_period(radar: &Radar) -> f64 {
    (radar.cos_of_column(radar.elements as f64) - radar.cos_of_column(0.0)).abs()
}

/// The reason why the waves at one end are not plane, where all of the radar's ranges are too near.
pub(super) fn no_plane_waves(radar: &Radar) -> Option<String> {
    let end_metres = (radar.end_elements - 1) as f64 * radar.element_spacing_metres;
    let far_metres = radar.plane_beyond_metres(end_metres);
    let seen_metres = radar.max_range_metres();
    // A single sample has no ranges, and counts as far away.
    (radar.samples > 1 && far_metres > seen_metres).then(|| {
        format!(
            "it takes what an end hears for plane waves, but ends of {end_metres:.2} m have their far field beyond \
             {far_metres:.0} m, and the radar sees {seen_metres:.0} m; matched-filter and omp know near fields"
        )
    })
}

/// The refusal of a radar of which more than [`MAX_FOLDS`] directions share a column; `None` for any other radar.
pub(super) fn too_many_folds(radar: &Radar) -> Option<String> {
    let folds = (2.0 / cos_period(radar)).ceil();
    (folds > MAX_FOLDS as f64).then(|| {
        let wavelengths = radar.element_spacing_metres / radar.wavelength_metres();
        format!(
            "elements stand {wavelengths:.3} wavelengths apart, so that each column stands for {folds} directions; at most \
             {MAX_FOLDS} are told apart"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Carrier;

    #[test]
    fn a_place_is_seen_from_where_the_end_is() {
        // The centre sees itself; from 3 m to the left, a reflector 4 m ahead of the centre is 5 m away.
        for (seen, range, cos) in [(polar_from(0.0, 20.0, 0.3), 20.0, 0.3), (polar_from(-3.0, 4.0, 0.0), 5.0, 0.6)] {
            assert!((seen.range_metres - range).abs() < 1e-12 && (seen.cos_theta - cos).abs() < 1e-12, "{seen:?}");
        }
    }

    #[test]
    fn directions_span_what_the_radar_sees_in_columns() {
        let half = Radar::default();
        let with = |wavelengths: f64, carrier| {
            let element_spacing_metres = wavelengths * half.wavelength_metres();
            Radar { elements: 64, element_spacing_metres, carrier, ..half.clone() }
        };
        for (radar, count) in [
            (with(0.5, Carrier::OneWay), 64),
            (with(0.25, Carrier::OneWay), 32),
            (with(1.0, Carrier::OneWay), 128),
            (with(0.5, Carrier::TwoWay), 128),
            (with(1.0, Carrier::TwoWay), 256),
        ] {
            let directions = directions(&radar);
            assert!(directions.len().abs_diff(count) <= 1, "{} of {count}", directions.len());
            let cosines = || directions.iter().map(|d| d.cos_theta);
            let step = 1.01 * cos_period(&radar) / 64.0;
            assert!(cosines().fold(1.0, f64::min) <= -1.0 + step && cosines().fold(-1.0, f64::max) >= 1.0 - step);
            for d in &directions {
                let off = (radar.column_of_cos(d.cos_theta) - d.column as f64).rem_euclid(64.0);
                assert!(off.min(64.0 - off) < 1e-6, "{d:?}");
            }
            assert_eq!(too_many_folds(&radar), None);
        }
        assert!(too_many_folds(&with(5.0, Carrier::OneWay)).unwrap().contains("5.000 wavelengths"));
    }
}
