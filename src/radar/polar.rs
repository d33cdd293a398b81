//! Range bins and columns as distances and directions, and the distances beyond which waves count as plane.

use super::Radar;

/// A point of the scene as the array's centre sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polar {
    /// Distance from the centre of the array, metres.
    pub range_metres: f64,
    /// Cosine of the angle between the array's axis (+x) and the point.
    pub cos_theta: f64,
}

impl Radar {
    /// Range of bin `k1`, in metres.
    pub fn range_of_bin_metres(&self, k1: f64) -> f64 {
        k1 * self.range_resolution_metres()
    }

    /// Range bin (fractional, not wrapped) of a range in metres.
    pub fn bin_of_range(&self, range_metres: f64) -> f64 {
        range_metres / self.range_resolution_metres()
    }

    /// Change of cos(theta) from one column to the next: `lambda / (N_a d)` over the carrier's turns per wavelength.
    fn cos_per_column(&self) -> f64 {
        self.wavelength_metres()
            / (self.elements as f64 * self.element_spacing_metres)
            / -self.carrier.turns_per_wavelength()
    }

    /// cos(theta) at column `k2` of a map: `(k2 - N_a/2) / (N_a/2)` for half-wavelength spacing and the one-way carrier.
    ///
    /// For the two-way carrier this is one of several directions of the column, and falls from column to column ([`Radar::columns_fall`]).
    pub fn cos_of_column(&self, k2: f64) -> f64 {
        (k2 - (self.elements / 2) as f64) * self.cos_per_column()
    }

    /// Column (fractional, wrapped into `0..N_a`) where a far reflector at cos(theta) appears.
    pub fn column_of_cos(&self, cos_theta: f64) -> f64 {
        (cos_theta / self.cos_per_column() + (self.elements / 2) as f64).rem_euclid(self.elements as f64)
    }

    /// Range from the array's centre in metres and cos(theta) of a point of the scene.
    pub fn polar_of(&self, x_metres: f64, y_metres: f64) -> Polar {
        let range_metres = x_metres.hypot(y_metres);
        let cos_theta = if range_metres > 0.0 { x_metres / range_metres } else { 0.0 };
        Polar { range_metres, cos_theta }
    }

    /// Distance beyond which the whole array's far field begins, in metres: no element's phase is farther than 22.5 degrees from a plane
    /// wave's. That is [`Radar::plane_beyond_metres`] of the aperture where elements send and hear by themselves (2 km for table 3.1), and
    /// more for pairs of antennas, which reach beyond their midpoints.
    pub fn far_field_metres(&self) -> f64 {
        let squares = |n: usize| {
            let pair = self.pair(n);
            pair.transmitter_x_metres.powi(2) + pair.receiver_x_metres.powi(2)
        };
        let largest = (0..self.elements).filter(|n| !self.is_gap(*n)).map(squares).fold(0.0, f64::max);
        4.0 * self.carrier_turns_per_metre().abs() * largest
    }

    /// Half the angle, in radians from broadside, that one end sees without ambiguity.
    pub fn end_field_of_view_radians(&self) -> f64 {
        (0.5 / (self.carrier_turns_per_metre().abs() * self.element_spacing_metres)).min(1.0).asin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Carrier, Convention};

    #[test]
    fn columns_convert_to_cosines_without_loss() {
        let r = Radar::default();
        for k in [0.0, 1.0, 511.5, 512.0, 1023.0] {
            assert!((r.column_of_cos(r.cos_of_column(k)) - k).abs() < 1e-9);
        }
        assert!((r.cos_of_column(768.0) - 0.5).abs() < 1e-12);
        let two_way = Radar { carrier: Carrier::TwoWay, ..r };
        let gap = two_way.column_of_cos(0.25) - two_way.column_of_cos(-0.75);
        assert!(gap.abs() < 1e-9, "two directions share a column");
    }

    #[test]
    fn the_far_field_begins_where_the_phase_is_22_degrees_off() {
        let physical = Radar::default().in_convention(Convention::Physical);
        let (length, wavelength) = (physical.aperture_metres(), physical.wavelength_metres());
        assert!((physical.far_field_metres() * wavelength / length.powi(2) - 4.0).abs() < 1e-9, "4 D^2 / lambda");
        assert!((physical.far_field_metres() - 993.0).abs() < 1.0);
        let pairs = Radar { bandwidth_hz: 1e9, ..Radar::default() }.of_pairs(12, 16).unwrap();
        for radar in [Radar::default(), physical, pairs] {
            let far = radar.far_field_metres();
            // Phase of a point straight ahead, against one element in the middle of the line.
            let degrees = |n| 360.0 * radar.carrier_turns_per_metre() * (radar.pair(n).range_metres(0.0, far) - far);
            let most = (0..radar.elements).map(|n| degrees(n).abs()).fold(0.0, f64::max);
            assert!((most - 22.5).abs() < 0.01, "{most} degrees");
        }
    }

    #[test]
    fn an_end_sees_half_of_what_folds_to_either_side() {
        let sine = |radar: Radar| radar.end_field_of_view_radians().sin();
        let filled = Radar::default().in_convention(Convention::Physical);
        assert!((sine(Radar::default()) - 1.0).abs() < 1e-12 && (sine(filled) - 1.0).abs() < 1e-3);
        let sparse = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        assert!((sine(sparse) - 0.5).abs() < 1e-12);
    }
}
