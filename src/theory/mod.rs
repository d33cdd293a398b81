//! Predictions by formula for one reflector or one radar: place and width of a blob, and its ambiguities.
//!
//! | file | predicts |
//! |---|---|
//! | [`squint`] | the offset of a blob's column from the true direction |
//! | [`pattern`] | beam width and highest side lobe of a window |
//! | [`response`] | the map of one reflector at any fraction of a bin and column, in closed form |
//! | [`blob`] | a blob's peak, half-power widths and first side lobes |
//! | [`streak`] | the extent of a near reflector's blob over columns and bins |
//! | [`comb`] | the grating lobes (teeth) of both ends used coherently |
//! | [`aliases`] | ranges that wrap and directions that fold onto the same cell |
//! | [`chirp`] | a chirp and its echoes as frequencies against time |
//! | [`doppler`] | the place of an object in a range-Doppler map |
//! | [`ellipse`] | the area of the least error of any unbiased estimator |
//! | [`overlay`] | all predictions for one reflector, drawn over a map |
//! | [`phasors`] | the contribution of each element to one cell, in the complex plane |
//! | [`consequences`] | quantities of a radar without a scene |
//!
//! Only [`phasors`] uses samples. Tests compare every prediction with a simulated map.

pub mod aliases;
pub mod blob;
pub mod chirp;
pub mod comb;
pub mod consequences;
pub mod doppler;
pub mod ellipse;
pub mod overlay;
pub mod pattern;
pub mod phasors;
pub mod response;
pub mod squint;
pub mod streak;

pub use aliases::{fold_partners, wrap_partners};
pub use blob::{Blob, SideLobe};
pub use comb::comb_teeth;
pub use consequences::Consequences;
pub use ellipse::Ellipse;
pub use overlay::Overlay;
pub use pattern::WindowPattern;
pub use phasors::Phasors;
pub use response::Response;
pub use squint::blob_cell;
pub use streak::Streak;

use crate::maps::Aperture;
use crate::radar::Radar;

/// A place on a map, between its cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPlace {
    /// Row: range bins from the array, wrapped into `0..samples`.
    pub bin: f64,
    /// Column, wrapped into `0..elements`.
    pub column: f64,
}

#[cfg(test)]
impl MapPlace {
    /// Bins and columns from here to `other`, the short way around the map.
    pub fn offset_to(&self, other: &MapPlace, radar: &Radar) -> (f64, f64) {
        let short = |d: f64, len: usize| d - (d / len as f64).round() * len as f64;
        (short(other.bin - self.bin, radar.samples), short(other.column - self.column, radar.elements))
    }
}

fn centre_metres(radar: &Radar, aperture: Aperture) -> f64 {
    match aperture {
        Aperture::Full => 0.0,
        Aperture::End(end) => radar.end_centre_metres(end),
    }
}
