//! Maps from the beat signal: range profiles, complex range-angle map, log-magnitude, Lambda, threshold, Cartesian view.
//!
//! Every map is `[range bin, column]`, row `k1` at `k1 * c / 2B`, column `k2` at cos(theta) = `(k2 - N_a/2) / (N_a/2)` (half-wavelength spacing,
//! one-way carrier; under the two-way carrier cos(theta) falls from column to column). Transforms are orthonormal: `1/sqrt(N_r)` over range,
//! `1/sqrt(N_a)` over the elements.

pub mod archive;
pub mod cartesian;
pub mod cfar;
pub mod doppler;
pub mod fast;
pub mod focus;
mod lambda;
mod log_map;
pub mod network_input;
pub mod peaks;
mod spectra;
pub mod tolerance;
mod transform;

pub use lambda::{LambdaScale, Mask, Normalisation, RangeAngleMap};
pub use log_map::{LOG_GUARD, LogMap, guard};
pub use spectra::{Spectrum, centred_spectrum};
pub use transform::{
    Aperture, ComplexMap, RangeProfiles, angle_transform, beam_columns, channels_map, channels_range_transform,
    range_transform, range_transform_in_place, windowed_range_transform,
};

use crate::radar::{BuiltArray, Radar};
use crate::signal::BeatSignal;

/// Log-magnitude maps of both ends and of the whole array.
#[derive(Debug, Clone, PartialEq)]
pub struct LogMaps {
    /// Map of the first end ("input 0").
    pub first: LogMap,
    /// Map of the last end ("input 1").
    pub last: LogMap,
    /// Map of the whole array ("target").
    pub full: LogMap,
}

impl LogMaps {
    /// All three maps of a beat signal of `elements`, focused where [`Radar::focus_off_line`] says so.
    pub fn of_elements(radar: &Radar, elements: &BuiltArray, signal: &BeatSignal) -> LogMaps {
        // Plain maps share their range profiles; each focused map has its own.
        let profiles = (!radar.focus_off_line).then(|| range_transform(radar, signal));
        let map = |aperture| match &profiles {
            Some(profiles) => angle_transform(radar, profiles, aperture).log_magnitude(),
            None => focus::map_of(radar, elements, signal, aperture).log_magnitude(),
        };
        let [first, last, full] = Aperture::ALL.map(map);
        LogMaps { first, last, full }
    }

    /// As [`LogMaps::of_elements`], for elements without errors.
    pub fn of_signal(radar: &Radar, signal: &BeatSignal) -> LogMaps {
        LogMaps::of_elements(radar, &BuiltArray::default(), signal)
    }
}
