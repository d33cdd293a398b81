//! Back-projection: what both ends heard from every cell of the centre's polar grid.
//!
//! Each end is small enough (2 cm) to see spherical waves as plane; its finely padded spectrum says what it heard from any range
//! and angle of its own. Every cell of the centre's grid looks up its range and angle at each end, and the phase that its
//! distance gives. That is the near-field matched filter of Cafforio, Prati and Rocca ("SAR data focusing using seismic
//! migration techniques", 1991) with an interpolator instead of a sum over samples.

use super::registered::seen_from;
use crate::maps::centred_spectrum;
use crate::radar::{End, Radar, hann};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis, Zip};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Spectrum rows for each range bin: enough for linear interpolation.
const ROWS_PER_BIN: usize = 4;

/// Least spectrum columns for each element.
const COLUMNS_PER_ELEMENT: usize = 20;

/// Where one cell of the centre's grid lies in one end's spectrum.
#[derive(Clone, Copy, Default)]
struct Place {
    row: f32,
    column: f32,
    /// Turns of phase there.
    phase: Complex64,
}

/// Looks up both ends for every cell of the centre's grid, `[range bins, columns]`.
pub(super) struct Backprojector {
    places: [Array2<Place>; 2],
    rows: usize,
    columns: usize,
    window: Vec<f64>,
    /// Sum of the weights of one end's samples.
    weight: f64,
}

/// How samples are weighted over range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RangeWindow {
    /// Low side lobes.
    Hann,
    /// All samples alike: the matched filter proper.
    None,
}

impl Backprojector {
    pub fn new(radar: &Radar, window: RangeWindow) -> Self {
        let rows = ROWS_PER_BIN * radar.samples;
        let columns = (COLUMNS_PER_ELEMENT * radar.end_elements).next_power_of_two();
        let window = match window {
            RangeWindow::Hann => hann(radar.samples),
            RangeWindow::None => vec![1.0; radar.samples],
        };
        let carrier = radar.carrier.turns_per_wavelength() / radar.wavelength_metres();
        let beat = (radar.samples / 2) as f64 / radar.max_range_metres();
        // Turns from one element to the next for cos(theta) = 1.
        let per_element = -carrier * radar.element_spacing_metres;
        let places = End::BOTH.map(|end| {
            let origin = radar.element_x_metres(radar.end_range(end).start + radar.end_elements / 2);
            let mut places = Array2::from_elem((radar.samples, radar.elements), Place::default());
            places.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each(|(bin, mut row)| {
                let range = radar.range_of_bin_metres(bin as f64);
                for (column, place) in row.iter_mut().enumerate() {
                    let seen = seen_from(origin, range, radar.cos_of_column(column as f64));
                    let bins = radar.bin_of_range(seen.range_metres);
                    let turns = ((per_element * seen.cos_theta + 0.5).rem_euclid(1.0)) * columns as f64;
                    *place = Place {
                        row: ((bins * ROWS_PER_BIN as f64) % rows as f64) as f32,
                        column: turns as f32,
                        phase: Complex64::cis(-TAU * ((carrier + beat) * seen.range_metres).fract()),
                    };
                }
            });
            places
        });
        let weight = window.iter().sum::<f64>() * radar.end_elements as f64;
        Backprojector { places, rows, columns, window, weight }
    }

    /// Amplitude that each end heard from every cell, in phase where one reflector is there: 1 for a reflector whose samples have
    /// amplitude 1.
    pub fn amplitudes(&self, ends: &TwoEnds) -> [Array2<Complex64>; 2] {
        let spectra =
            End::BOTH.map(|end| centred_spectrum(ends.end(end).view(), &self.window, self.rows, self.columns));
        let [a, b] = &self.places;
        [self.look_up(a, &spectra[0]), self.look_up(b, &spectra[1])]
    }

    fn look_up(&self, places: &Array2<Place>, spectrum: &Array2<Complex64>) -> Array2<Complex64> {
        let mut out = Array2::zeros(places.dim());
        let scale = 1.0 / self.weight;
        Zip::from(&mut out).and(places).par_for_each(|out, place| {
            let (r, c) = (place.row.floor(), place.column.floor());
            let (fr, fc) = (f64::from(place.row - r), f64::from(place.column - c));
            let (r, c) = (r as usize % self.rows, c as usize % self.columns);
            let (next_r, next_c) = ((r + 1) % self.rows, (c + 1) % self.columns);
            let near = spectrum[[r, c]] * (1.0 - fc) + spectrum[[r, next_c]] * fc;
            let far = spectrum[[next_r, c]] * (1.0 - fc) + spectrum[[next_r, next_c]] * fc;
            *out = (near * (1.0 - fr) + far * fr) * place.phase * scale;
        });
        out
    }
}
