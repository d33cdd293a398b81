//! Beam squint: the offset between a blob's column and the true direction.
//!
//! Equation 3.3 turns the carrier's phase `s q` times a wavelength, and the beat's phase `2 B n1 / N c` times a metre. Both change
//! from element to element, and the angle transform can't separate them: sample `n1` hears the wave number
//! `s q / lambda + 2 B n1 / (N c)` turns a metre. A symmetric window weighs the middle of the chirp most, and exactly that wave number
//! decides the column. In the thesis' convention (one-way carrier with minus, two-way beat with plus), a chirp that falls, it is that of
//! `f - B` in place of `f`: 2.6 % lower. In the physical one, a chirp that rises, it is that of `f + B / 2`.

use super::{MapPlace, centre_metres};
use crate::maps::Aperture;
use crate::radar::Radar;

/// Place of a reflector's blob on the map of an aperture: the range from the aperture's middle, and the squinted cosine seen from there.
///
/// It is the middle of a near reflector's streak. The peak ([`super::Blob`]) lies up to half a bin and one column beside it for table 3.1,
/// where the reflector is much nearer than the aperture's far field.
pub fn blob_cell(radar: &Radar, x_metres: f64, y_metres: f64, aperture: Aperture) -> MapPlace {
    cell_seen_from(radar, x_metres, y_metres, centre_metres(radar, aperture))
}

/// The place in the map of the part of the blob that the elements around `element_x_metres` see.
pub(super) fn cell_seen_from(radar: &Radar, x_metres: f64, y_metres: f64, element_x_metres: f64) -> MapPlace {
    let polar = radar.polar_of(x_metres - element_x_metres, y_metres);
    MapPlace {
        bin: radar.bin_of_range(polar.range_metres).rem_euclid(radar.samples as f64),
        column: radar.column_of_cos(polar.cos_theta * radar.squint()),
    }
}
