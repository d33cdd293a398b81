//! What the live network is told of the radar, and how the radar's convention becomes the thesis'.
//!
//! Lengths in range bins follow from two numbers, bandwidth over carrier and spacing over wavelength: so do migration, curvature and squint. The
//! convention needs no number. In the physical one a sample's phase is `+2 pi (f + n B / N) 2 R / c`; conjugated and read backwards, the
//! samples are those of the thesis' convention at a carrier of `2 (f + B (N - 1) / N)`, in whose map cos(theta) rises with the column.

use super::grid::{COLUMNS, CONSTANTS};
use crate::network::domain::migration_bins;
use crate::radar::{Carrier, Radar, WindowFunction};
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Cosine of the angle off broadside, 60 degrees, at which the network is told the pattern of an element.
const PATTERN_COS: f64 = 0.5;
/// Where the spacing stands among the constants, and the windows beside Hann's.
pub(super) const SPACING_AT: usize = 1;
pub(super) const WINDOWS_AT: usize = 2;
/// How many windows there are.
pub(super) const WINDOWS: usize = WindowFunction::ALL.len();

/// Migration and spacing relative to table 3.1's, which of the other windows, and the pattern: all 0 for the radar of table 3.1.
pub(super) fn constants(radar: &Radar) -> [f32; CONSTANTS] {
    let mut constants = [0.0; CONSTANTS];
    constants[0] = (0.25 * (migration_bins(radar) / migration_bins(&Radar::default())).log2()) as f32;
    constants[SPACING_AT] = (cosine_scale(radar).recip() - 1.0) as f32;
    if let Some(window) = WindowFunction::ALL.iter().skip(1).position(|window| *window == radar.window) {
        constants[WINDOWS_AT + window] = 1.0;
    }
    // Both ways, in decades.
    constants[CONSTANTS - 1] = radar.pattern().map_or(0.0, |p| -2.0 * p.amplitude(PATTERN_COS).log10()) as f32;
    constants
}

/// Which of [`WindowFunction::ALL`] these constants name.
pub(super) fn window_of(constants: &[f32; CONSTANTS]) -> usize {
    constants[WINDOWS_AT..][..WINDOWS - 1].iter().position(|v| *v == 1.0).map_or(0, |window| window + 1)
}

/// cos(theta) of the reflector whose blob stands in the first column, over that of table 3.1. There the grids take the blob's cosine for the
/// reflector's, 2.6 % too small; weights learned with that, so it stays for all radars.
pub(super) fn cosine_scale(radar: &Radar) -> f64 {
    radar.cos_of_column(0.0).abs() * Radar::default().squint() / radar.squint()
}

/// The samples of an end as the thesis' convention has them.
pub(super) fn in_thesis_convention(radar: &Radar, mut samples: Array2<Complex64>) -> Array2<Complex64> {
    if radar.carrier == Carrier::TwoWay {
        samples.invert_axis(Axis(1));
        samples.mapv_inplace(|v| v.conj());
        return samples.as_standard_layout().into_owned();
    }
    samples
}

/// Turns rows of [`COLUMNS`] around where cos(theta) falls with the column of `radar`'s maps: from the network's order to the map's, or back.
pub fn turn_columns(radar: &Radar, map: &mut [f32]) {
    if radar.cos_of_column(0.0) > 0.0 {
        // The first column's direction is that of one column beyond the last.
        map.par_chunks_mut(COLUMNS).for_each(|row| row[1..].reverse());
    }
}
