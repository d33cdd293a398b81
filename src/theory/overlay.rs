//! All predictions for one reflector on one map, to be drawn over it.

use super::{Blob, MapPlace, Streak, blob_cell, centre_metres, comb_teeth, fold_partners, wrap_partners};
use crate::maps::Aperture;
use crate::radar::{Decibels, Polar, Radar};
use crate::scene::Reflector;

/// Level of a streak's ends below its peak.
pub const STREAK_DEPTH: Decibels = Decibels(20.0);
const DRAWN_TEETH: usize = 3;
/// Farthest wrap partners, in maximum ranges.
const WRAPPED_RANGES: f64 = 3.0;

/// Predictions for one reflector, drawn over the map of one aperture.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Place of the reflector seen from the middle of the aperture; its range is the true one, not wrapped.
    pub place: Polar,
    /// Peak, half-power widths and first side lobes.
    pub blob: Blob,
    /// Extent of the blob by the near field, [`STREAK_DEPTH`] down.
    pub streak: Streak,
    /// Places of the next teeth of the two ends' comb.
    pub teeth: Vec<MapPlace>,
    /// cos(theta) of the other directions that share its column.
    pub fold_partners: Vec<f64>,
    /// The other ranges that share its bin, metres.
    pub wrap_partners_metres: Vec<f64>,
}

impl Overlay {
    /// The overlay of `reflector` on the map of `aperture`; `None` for one without an echo. The radar must be valid ([`Radar::validate`]).
    pub fn of(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Option<Overlay> {
        let place = radar.polar_of(reflector.x_metres - centre_metres(radar, aperture), reflector.y_metres);
        let farthest = WRAPPED_RANGES * radar.max_range_metres();
        Some(Overlay {
            place,
            blob: Blob::of(radar, reflector, aperture)?,
            streak: Streak::of(radar, reflector, aperture, STREAK_DEPTH)?,
            teeth: teeth(radar, reflector),
            fold_partners: fold_partners(radar, place.cos_theta),
            wrap_partners_metres: wrap_partners(radar, place, farthest).iter().map(|p| p.range_metres).collect(),
        })
    }
}

fn teeth(radar: &Radar, reflector: &Reflector) -> Vec<MapPlace> {
    let place = radar.polar_of(reflector.x_metres, reflector.y_metres);
    let cell = |cos: f64| {
        let (x_metres, y_metres) = (place.range_metres * cos, place.range_metres * (1.0 - cos * cos).max(0.0).sqrt());
        blob_cell(radar, x_metres, y_metres, Aperture::Full)
    };
    comb_teeth(radar, place, DRAWN_TEETH).into_iter().map(cell).collect()
}
