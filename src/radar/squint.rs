//! Beam squint: the offset between a reflector's direction and its column in the map.
//!
//! Over a chirp the beat's phase is added to the carrier's. The carrier's phase is `s q / lambda` turns a metre of distance (equation
//! 3.1), the beat's at sample `n` of `N` another `2 n B / (N c)`. In the middle of the chirp, where windows weigh most, the array is
//! therefore at `f + B / (s q)` in place of the carrier `f`.
//!
//! The axis is drawn for the frequency at which the chirp begins, and blobs follow that in its middle. The physical convention (`s q = 2`)
//! rises from 77 to 79 GHz: its middle is `f + B / 2`, and blobs stand 1.3 % farther from broadside than their reflectors. The thesis'
//! radar (`s q = -1`) falls from `f/2 = 38.5` to 36.5 GHz ([`super::Convention`]): its middle is half of `f - B`, and blobs stand 2.6 % nearer
//! to broadside.

use super::{Polar, Radar};

impl Radar {
    /// cos(theta) of a blob over cos(theta) of its reflector: `1 + B / (s q f)`, 0.974 for table 3.1.
    pub fn squint(&self) -> f64 {
        1.0 + self.beat_turns_per_metre(self.middle_sample()) / self.carrier_turns_per_metre()
    }

    /// Range (not wrapped) and cos(theta) of the blob of a reflector at (x, y), on the map of elements around (`centre_x_metres`, 0).
    pub fn blob_of(&self, centre_x_metres: f64, x_metres: f64, y_metres: f64) -> Polar {
        let seen = self.polar_of(x_metres - centre_x_metres, y_metres);
        Polar { cos_theta: seen.cos_theta * self.squint(), ..seen }
    }

    /// cos(theta) of the reflector behind a blob at `cos_theta`; that of end-fire for a place where no reflector's blob can be.
    pub fn cos_of_blob(&self, cos_theta: f64) -> f64 {
        (cos_theta / self.squint()).clamp(-1.0, 1.0)
    }
}
