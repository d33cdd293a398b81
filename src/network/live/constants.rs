//! The constants of the radar among the live network's inputs, and the conversion of the radar's convention into the thesis'.
//!
//! Lengths in range bins follow from two numbers, bandwidth over carrier and spacing over wavelength: so do migration, curvature and squint. The
//! convention needs no number. In the physical one a sample's phase is `+2 pi (f + n B / N) 2 R / c`; conjugated and read backwards, the
//! samples are those of the thesis' convention at a carrier of `2 (f + B (N - 1) / N)`, in whose map cos(theta) rises with the column.

use super::grid::CONSTANTS;
use crate::network::domain::migration_bins;
use crate::radar::{Carrier, Radar, WindowFunction};
use ndarray::{Array2, ArrayViewMut2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Cosine of the angle off broadside at which the constants have the element's pattern: 60 degrees.
const PATTERN_COS: f64 = 0.5;
/// Index of the spacing among the constants, and of the first window after Hann's.
pub(super) const SPACING_INDEX: usize = 1;
pub(super) const WINDOWS_INDEX: usize = 2;
pub(super) const WINDOW_COUNT: usize = WindowFunction::ALL.len();

/// The constants: migration and spacing relative to table 3.1's, a 1 for another window than Hann's, and the element's pattern.
pub(super) fn constants(radar: &Radar) -> [f32; CONSTANTS] {
    let mut constants = [0.0; CONSTANTS];
    constants[0] = (0.25 * (migration_bins(radar) / migration_bins(&Radar::default())).log2()) as f32;
    constants[SPACING_INDEX] = (cosine_scale(radar).recip() - 1.0) as f32;
    if let Some(window) = WindowFunction::ALL.iter().skip(1).position(|window| *window == radar.window) {
        constants[WINDOWS_INDEX + window] = 1.0;
    }
    // Loss of the two-way pattern, decades.
    constants[CONSTANTS - 1] = radar.pattern().map_or(0.0, |p| -2.0 * p.amplitude(PATTERN_COS).log10()) as f32;
    constants
}

/// Index in [`WindowFunction::ALL`] of the window in these constants.
pub(super) fn window_of(constants: &[f32; CONSTANTS]) -> usize {
    constants[WINDOWS_INDEX..][..WINDOW_COUNT - 1].iter().position(|v| *v == 1.0).map_or(0, |window| window + 1)
}

/// cos(theta) of a reflector with its main lobe in the first column, relative to that of table 3.1. The features of table 3.1 ignore the squint, by
/// which the column's cosine is 2.6 % smaller than the reflector's. The weights were trained so, and it is the same for all radars.
pub(super) fn cosine_scale(radar: &Radar) -> f64 {
    radar.cos_of_column(0.0).abs() * Radar::default().squint() / radar.squint()
}

/// The samples `[elements, samples]` in the thesis' convention.
pub(super) fn in_thesis_convention(radar: &Radar, mut samples: Array2<Complex64>) -> Array2<Complex64> {
    if radar.carrier == Carrier::TwoWay {
        samples.invert_axis(Axis(1));
        samples.mapv_inplace(|v| v.conj());
        return samples.as_standard_layout().into_owned();
    }
    samples
}

/// Reverses the columns of a map `[rows, elements]` where cos(theta) falls with the column of `radar`'s maps: to the radar's order, or back.
pub fn reverse_columns(radar: &Radar, map: &mut [f32]) {
    if radar.cos_of_column(0.0) > 0.0 {
        // Columns wrap around: the first column keeps its place.
        map.par_chunks_mut(radar.elements).for_each(|row| row[1..].reverse());
    }
}

/// As [`reverse_columns`], for a map of any number of columns.
pub fn reverse_rows(radar: &Radar, map: &mut ArrayViewMut2<'_, f32>) {
    if radar.cos_of_column(0.0) > 0.0 {
        map.outer_iter_mut().into_par_iter().for_each(|mut row| {
            if let Some(cells) = row.as_slice_mut() {
                cells[1..].reverse();
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::grid::COLUMNS;
    use crate::radar::{Convention, End};
    use crate::scene::Reflector;
    use crate::signal::exact;

    #[test]
    fn constants_are_relative_to_table_3_1() {
        assert_eq!(constants(&Radar::default()), [0.0; CONSTANTS]);
        for (index, window) in WindowFunction::ALL.into_iter().enumerate() {
            assert_eq!(window_of(&constants(&Radar { window, ..Radar::default() })), index);
        }
        let twice = constants(&Radar { bandwidth_hz: 4e9, ..Radar::default() });
        assert!((twice[0] - 0.25).abs() < 1e-6, "twice the bandwidth is an octave of migration: {twice:?}");
        let dense = constants(&Radar { element_spacing_metres: 1.6e-3, ..Radar::default() });
        assert!((dense[SPACING_INDEX] - (1.6e-3 / Radar::default().element_spacing_metres - 1.0) as f32).abs() < 1e-6);
    }

    #[test]
    fn physical_samples_are_the_thesis_at_another_carrier() {
        let physical = Radar::default().in_convention(Convention::Physical);
        let last = (physical.samples - 1) as f64 / physical.samples as f64;
        let carrier_hz = 2.0 * (physical.carrier_hz + last * physical.bandwidth_hz);
        let thesis = Radar { carrier_hz, carrier: Carrier::OneWay, ..physical.clone() };
        let reflectors = [Reflector { x_metres: 4.0, y_metres: 17.0, reflectivity: 1.0 }];
        let ends = |radar: &Radar| exact::beat_signal(radar, &reflectors).two_ends(radar);
        let (found, expected) = (ends(&physical), ends(&thesis));
        for end in End::BOTH {
            let found = in_thesis_convention(&physical, found.end(end).clone());
            let gap = (&found - expected.end(end)).mapv(|v| v.norm()).into_iter().fold(0.0, f64::max);
            assert!(gap < 1e-8 * found[[0, 0]].norm(), "{gap}");
        }
    }

    #[test]
    fn columns_reversed_twice_are_as_before() {
        let physical = Radar::default().in_convention(Convention::Physical);
        let map: Vec<f32> = (0..3 * COLUMNS).map(|i| i as f32).collect();
        let mut turned = map.clone();
        reverse_columns(&Radar::default(), &mut turned);
        assert_eq!(turned, map);
        reverse_columns(&physical, &mut turned);
        assert_eq!((turned[0], turned[1], turned[COLUMNS - 1]), (0.0, (COLUMNS - 1) as f32, 1.0));
        reverse_columns(&physical, &mut turned);
        assert_eq!(turned, map);
    }
}
