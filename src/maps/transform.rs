//! The windowed two-dimensional transform (thesis section 3.1).

use super::log_map::{LOG_GUARD, LogMap, guard};
use crate::radar::{End, Radar};
use crate::signal::BeatSignal;
use crate::signal::simd::Simd;
use ndarray::{Array2, ArrayView2, Zip, s};
use num_complex::Complex64;
use rayon::prelude::*;
use std::ops::Range;

/// The elements of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Aperture {
    Full,
    End(End),
}

impl Aperture {
    /// The first end, the last end, and the whole array.
    pub const ALL: [Aperture; 3] = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];

    pub(crate) fn channels(self, radar: &Radar) -> Range<usize> {
        match self {
            Aperture::Full => 0..radar.elements,
            Aperture::End(end) => radar.end_range(end),
        }
    }
}

/// Windowed range transform of every channel: complex, `[channels, range bins]`.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeProfiles {
    pub profiles: Array2<Complex64>,
}

/// Complex range-angle map, `[range bins, columns]`.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexMap {
    pub cells: Array2<Complex64>,
}

/// Half-power width of a plane wave in the map of `aperture`, columns.
pub fn beam_columns(radar: &Radar, aperture: Aperture) -> f64 {
    let weights = radar.window.weights(aperture.channels(radar).len());
    let magnitude = |columns: f64| {
        let turns = std::f64::consts::TAU * columns / radar.elements as f64;
        let phasors = weights.iter().enumerate().map(|(n, w)| Complex64::from_polar(*w, turns * n as f64));
        phasors.sum::<Complex64>().norm()
    };
    let level = magnitude(0.0) * std::f64::consts::FRAC_1_SQRT_2;
    // A quarter of the main lobe's width under a rectangular window.
    let step = radar.elements as f64 / (2 * weights.len().max(1)) as f64;
    let max_columns = radar.elements as f64 / 2.0;
    let mut high = step.min(max_columns);
    while high < max_columns && magnitude(high) >= level {
        high = (high + step).min(max_columns);
    }
    let mut low = high - step.min(high);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if magnitude(middle) >= level { low = middle } else { high = middle }
    }
    2.0 * low
}

/// Range profiles of the whole array, `[elements, range bins]`.
pub fn range_transform(radar: &Radar, signal: &BeatSignal) -> RangeProfiles {
    channels_range_transform(radar, signal.samples.view())
}

/// As [`range_transform`], in the memory of the samples.
pub fn range_transform_in_place(radar: &Radar, signal: BeatSignal) -> RangeProfiles {
    windowed_in_place(radar, signal.samples, &radar.window.weights(radar.samples))
}

/// Windowed range profiles of any channels, `[channels, samples]` to `[channels, range bins]`.
pub fn channels_range_transform(radar: &Radar, samples: ArrayView2<'_, Complex64>) -> RangeProfiles {
    windowed_range_transform(radar, samples, &radar.window.weights(radar.samples))
}

/// Range profiles of any channels under a window of `radar.samples` weights.
pub fn windowed_range_transform(radar: &Radar, samples: ArrayView2<'_, Complex64>, window: &[f64]) -> RangeProfiles {
    windowed_in_place(radar, samples.as_standard_layout().into_owned(), window)
}

fn windowed_in_place(radar: &Radar, mut profiles: Array2<Complex64>, window: &[f64]) -> RangeProfiles {
    if !profiles.is_standard_layout() {
        profiles = profiles.as_standard_layout().into_owned();
    }
    let fft = Simd::chosen().forward_fft(radar.samples);
    let scale = (radar.samples as f64).sqrt().recip();
    let window: Vec<f64> = window.iter().map(|w| w * scale).collect();
    profiles.outer_iter_mut().into_par_iter().for_each_init(
        || vec![Complex64::default(); fft.get_inplace_scratch_len()],
        |scratch, mut row| {
            row.iter_mut().zip(&window).for_each(|(v, w)| *v *= w);
            if let Some(row) = row.as_slice_mut() {
                fft.process_with_scratch(row, scratch);
            }
        },
    );
    RangeProfiles { profiles }
}

/// Range-angle map of `aperture` from the whole array's `profiles`.
pub fn angle_transform(radar: &Radar, profiles: &RangeProfiles, aperture: Aperture) -> ComplexMap {
    angle_transform_of(radar, profiles.profiles.slice(s![aperture.channels(radar), ..]))
}

/// Range-angle map of the samples of neighbouring channels, `[channels, samples]`, such as those of one end.
pub fn channels_map(radar: &Radar, samples: ArrayView2<'_, Complex64>) -> ComplexMap {
    angle_transform_of(radar, channels_range_transform(radar, samples).profiles.view())
}

/// Range-angle map of channels' profiles: windowed, padded with zeros to N_a, transformed, and rolled by N_a / 2.
pub(super) fn angle_transform_of(radar: &Radar, profiles: ArrayView2<'_, Complex64>) -> ComplexMap {
    let columns = radar.elements;
    let fft = Simd::chosen().forward_fft(columns);
    let scale = (columns as f64).sqrt().recip();
    let window: Vec<f64> = radar.window.weights(profiles.nrows()).into_iter().map(|w| w * scale).collect();
    let mut cells = Array2::zeros((profiles.ncols(), columns));
    cells.outer_iter_mut().into_par_iter().enumerate().for_each_init(
        || vec![Complex64::default(); fft.get_inplace_scratch_len()],
        |scratch, (bin, mut row)| {
            for ((v, w), p) in row.iter_mut().zip(&window).zip(profiles.column(bin)) {
                *v = p * w;
            }
            if let Some(row) = row.as_slice_mut() {
                fft.process_with_scratch(row, scratch);
                row.rotate_right(columns / 2);
            }
        },
    );
    ComplexMap { cells }
}

impl ComplexMap {
    /// `log10(|Y| + guard)` of every cell, the [`guard`] that of the largest.
    pub fn log_magnitude(&self) -> LogMap {
        let largest = self.cells.iter().map(Complex64::norm_sqr).filter(|v| v.is_finite()).fold(0.0, f64::max);
        // Squares of magnitudes below 1e-160 are zero.
        let guard = if largest > 0.0 { guard(largest.sqrt()) } else { LOG_GUARD };
        LogMap::new(Zip::from(&self.cells).par_map_collect(|v| (v.norm() + guard).log10()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::WindowFunction;

    #[test]
    fn beams_are_as_wide_as_harris_has_them() {
        // Harris (1978), table 1: half-power widths in bins.
        for (window, bins) in [(WindowFunction::Rectangular, 0.89), (WindowFunction::Hann, 1.44)] {
            let radar = Radar { elements: 128, end_elements: 16, window, ..Radar::default() };
            assert!((beam_columns(&radar, Aperture::Full) - bins).abs() < 0.03, "{window:?}");
            let end = beam_columns(&radar, Aperture::End(End::First)) / 8.0;
            assert!((end - bins).abs() < 0.15, "{window:?}: {end}");
        }
        let two = Radar { elements: 2, end_elements: 1, ..Radar::default() };
        assert!((0.0..=2.0).contains(&beam_columns(&two, Aperture::End(End::First))));
    }
}
