//! Maps of elements off the array's line, focused towards the direction of each column.
//!
//! A far reflector in the direction `theta` is nearer to an element at (x, y) than to the array's centre, by `x cos(theta) + y sin(theta)`. The
//! angle transform compensates for the term of x. That of y depends on the sine of the column's direction. Its phase, and with it the shift in range,
//! is removed for a few sines between 0 and 1 (Chebyshev nodes); each column is interpolated between the transforms at its own sine (J.-P. Berrut and
//! L. N. Trefethen, "Barycentric Lagrange interpolation", SIAM Rev. 46, 2004).
//!
//! That is exact for reflectors in the far field of the elements' y. Columns of ambiguous directions are focused towards that of
//! [`Radar::cos_of_column`], corrected for squint.

use super::transform::{Aperture, ComplexMap, angle_transform_of, channels_range_transform};
use crate::radar::{BuiltArray, Radar};
use crate::signal::{BeatSignal, LayoutSamples};
use ndarray::{Array2, ArrayView2, Zip, s};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Largest error of a focused cell, relative to the sum of its elements' magnitudes.
const MAX_RELATIVE_ERROR: f64 = 1e-9;

/// y of each element, metres, from the antennas of `radar` and the errors in `elements`. `None` where maps aren't focused or all y are 0.
fn off_line_metres(radar: &Radar, elements: &BuiltArray) -> Option<Vec<f64>> {
    let y = |n: usize| radar.pair(n).forward_metres() + elements.forward_metres(n);
    let y_metres: Vec<f64> = if radar.focus_off_line { (0..radar.elements).map(y).collect() } else { Vec::new() };
    y_metres.iter().any(|y| *y != 0.0).then_some(y_metres)
}

/// Range-angle map of a signal of `elements`, focused by [`Radar::focus_off_line`] where they are off the line, else with the plain transforms' bits.
pub fn map_of(radar: &Radar, elements: &BuiltArray, signal: &BeatSignal, aperture: Aperture) -> ComplexMap {
    let channels = aperture.channels(radar);
    let samples = signal.samples.slice(s![channels.clone(), ..]);
    let plain = |samples: ArrayView2<'_, Complex64>| {
        angle_transform_of(radar, channels_range_transform(radar, samples).profiles.view())
    };
    let Some(y_metres) = off_line_metres(radar, elements) else { return plain(samples) };
    let y_metres = &y_metres[channels];
    let nodes = nodes(max_turns(radar, y_metres));
    let sines: Vec<f64> = (0..radar.elements).map(|column| sine_of(radar, column)).collect();
    let totals: Vec<f64> = sines.iter().map(|at| (0..nodes.len()).map(|i| node_weight(&nodes, i, *at)).sum()).collect();
    let mut cells = Array2::zeros((radar.samples, radar.elements));
    for (i, sine) in nodes.iter().enumerate() {
        let map = plain(on_line(radar, samples, y_metres, *sine).view());
        // At a node the sum is not finite, and the map is that of the node.
        let weight = |(at, total): (&f64, &f64)| match total.is_finite() {
            true => node_weight(&nodes, i, *at) / total,
            false => f64::from(u8::from(*at == nodes[i])),
        };
        let weights: Vec<f64> = sines.iter().zip(&totals).map(weight).collect();
        Zip::from(cells.rows_mut()).and(map.cells.rows()).par_for_each(|mut row, map| {
            row.iter_mut().zip(&map).zip(&weights).for_each(|((sum, v), w)| *sum += v * *w);
        });
    }
    ComplexMap { cells }
}

/// The map of the array with zeros at elements outside a layout, focused as in [`map_of`].
pub fn layout_map(radar: &Radar, elements: &BuiltArray, layout_samples: &LayoutSamples) -> ComplexMap {
    let mut alone = BeatSignal::silence(radar);
    for (element, samples) in layout_samples.layout.iter().zip(layout_samples.samples.outer_iter()) {
        alone.samples.row_mut(*element).assign(&samples);
    }
    map_of(radar, elements, &alone, Aperture::Full)
}

/// Sine of the direction of echoes in `column`, corrected for squint.
fn sine_of(radar: &Radar, column: usize) -> f64 {
    let cos = radar.cos_of_column(column as f64) / radar.squint();
    (1.0 - cos * cos).max(0.0).sqrt()
}

fn max_turns(radar: &Radar, y_metres: &[f64]) -> f64 {
    let [first, last] = [0.0, radar.samples as f64].map(|n1| radar.turns_per_metre(n1).abs());
    first.max(last) * y_metres.iter().fold(0.0, |max: f64, y| max.max(y.abs()))
}

/// Chebyshev nodes in [0, 1], enough to interpolate `exp(j 2 pi turns s)` within [`MAX_RELATIVE_ERROR`].
fn nodes(turns: f64) -> Vec<f64> {
    // The error of m nodes is at most 2 (a / 4)^m / m! for a phase of a radians over the interval.
    let quarter = TAU * turns / 4.0;
    let (mut count, mut log_error) = (0, 2f64.ln());
    while count < 2 || log_error > MAX_RELATIVE_ERROR.ln() || (count as f64) < quarter {
        count += 1;
        log_error += (quarter / count as f64).ln();
    }
    (0..count).map(|i| (1.0 - ((2 * i + 1) as f64 * PI / (2 * count) as f64).cos()) / 2.0).collect()
}

/// The weight of node `i` for an interpolation `at` a sine between nodes, before all weights are divided by their sum.
fn node_weight(nodes: &[f64], i: usize, at: f64) -> f64 {
    let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    sign * ((2 * i + 1) as f64 * PI / (2 * nodes.len()) as f64).sin() / (at - nodes[i])
}

/// The samples as measured by elements on the line, for far reflectors in the direction with this sine.
fn on_line(radar: &Radar, samples: ArrayView2<'_, Complex64>, y_metres: &[f64], sine: f64) -> Array2<Complex64> {
    let mut turned = samples.as_standard_layout().into_owned();
    turned.outer_iter_mut().into_par_iter().zip(y_metres).for_each(|(mut row, y)| {
        let turns = |n1: f64| radar.turns_per_metre(n1) * y * sine;
        let mut turn = Complex64::cis(TAU * turns(0.0).fract());
        let step = Complex64::cis(TAU * (turns(1.0) - turns(0.0)));
        for v in &mut row {
            *v *= turn;
            turn *= step;
        }
    });
    turned
}

#[cfg(test)]
mod tests {
    use super::super::{angle_transform, range_transform};
    use super::*;
    use crate::radar::{ElementError, End};
    use crate::scene::Reflector;
    use crate::signal::exact;

    fn small() -> Radar {
        Radar { elements: 32, end_elements: 8, samples: 16, focus_off_line: true, ..Radar::default() }
    }

    fn scattered(radar: &Radar) -> BuiltArray {
        let of = |n: usize| ElementError { forward_millimetres: (n * 7 % 9) as f64 - 5.0, ..ElementError::default() };
        BuiltArray { elements: (0..radar.elements).map(of).collect() }
    }

    fn signal(radar: &Radar) -> BeatSignal {
        let of = |x_metres, y_metres| Reflector { x_metres, y_metres, reflectivity: 1.0 };
        exact::beat_signal(radar, &[of(0.1, 0.6), of(-0.4, 0.3)])
    }

    #[test]
    fn a_cell_is_the_sum_over_elements_and_samples() {
        let radar = small();
        let (elements, signal) = (scattered(&radar), signal(&radar));
        let (wn, ws) = (radar.window.weights(32), radar.window.weights(16));
        let map = map_of(&radar, &elements, &signal, Aperture::Full).cells;
        let peak = map.iter().map(|v| v.norm()).fold(0.0, f64::max);
        for (bin, column) in [(8, 16), (3, 20), (7, 5), (15, 31), (0, 0)] {
            let cos = radar.cos_of_column(column as f64) / radar.squint();
            let mut sum = Complex64::default();
            for ((n, n1), v) in signal.samples.indexed_iter() {
                let nearer = elements.forward_metres(n) * (1.0 - cos * cos).max(0.0).sqrt();
                let back = radar.turns_per_metre(n1 as f64) * nearer
                    - (bin * n1) as f64 / 16.0
                    - n as f64 * (column as f64 - 16.0) / 32.0;
                sum += v * wn[n] * ws[n1] * Complex64::cis(TAU * back);
            }
            let off = (map[[bin, column]] - sum / 512f64.sqrt()).norm();
            assert!(off < 1e-8 * peak, "bin {bin}, column {column}: {off:e} of {peak:e}");
        }
    }

    #[test]
    fn what_stands_on_the_line_or_asks_for_nothing_keeps_its_bits() {
        let radar = small();
        let signal = signal(&radar);
        let profiles = range_transform(&radar, &signal);
        let unasked = Radar { focus_off_line: false, ..radar.clone() };
        for aperture in [Aperture::Full, Aperture::End(End::Last)] {
            let plain = angle_transform(&radar, &profiles, aperture);
            assert_eq!(map_of(&radar, &BuiltArray::default(), &signal, aperture), plain);
            assert_eq!(map_of(&unasked, &scattered(&radar), &signal, aperture), plain);
            assert_ne!(map_of(&radar, &scattered(&radar), &signal, aperture), plain);
        }
    }
}
