//! Back-projection: the amplitude of both ends at every cell of the centre's polar grid.
//!
//! An end of a dozen elements (2 cm) is so small that spherical waves are plane on it, and longer ones are cut into blocks that are; the finely
//! padded spectrum of each block has the amplitude at any range and angle of its own. Every cell of the centre's grid looks up its range and
//! angle at each block, and the phase of its distance. This is the near-field matched filter of Cafforio, Prati and Rocca ("SAR data focusing
//! using seismic migration techniques", 1991) with an interpolator instead of a sum over samples.

use super::cells::GridCells;
use crate::maps::centred_spectrum;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::seen::{seen_by, too_many_folds};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis, Zip, s};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Spectrum rows for each range bin: enough for linear interpolation.
const ROWS_PER_BIN: usize = 4;

/// Least spectrum columns for each element.
const COLUMNS_PER_ELEMENT: usize = 20;

const BLOCK: usize = 16;

/// A block's far field begins at most at this part of the maximum range.
const NEAR_PART: f64 = 1.0 / 64.0;

const MOST_TABLE_BYTES: usize = 1 << 30;

/// Place of one cell of the centre's grid in one block's spectrum.
#[derive(Clone, Copy, Default)]
struct Place {
    row: f32,
    column: f32,
    /// Turns of phase there.
    phase: Complex64,
}

struct Block {
    elements: Range<usize>,
    places: Array2<Place>,
}

pub(super) struct Backprojector {
    blocks: [Vec<Block>; 2],
    rows: usize,
    columns: usize,
    window: Vec<f64>,
    /// Sum of the weights of one end's samples.
    weight: f64,
}

/// The weighting of samples over range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RangeWindow {
    /// Low side lobes.
    Hann,
    /// Equal weights: the matched filter proper.
    None,
}

/// Elements of each block of one end, within the end: as many as a spherical wave is plane on.
fn blocks(radar: &Radar) -> Vec<Range<usize>> {
    let far_metres = |elements: usize| {
        2.0 * ((elements - 1) as f64 * radar.element_spacing_metres).powi(2) / radar.wavelength_metres()
    };
    if !radar.is_monostatic() {
        // Neighbouring elements may have different antennas, which share no plane wave.
        return (0..radar.end_elements).map(|n| n..n + 1).collect();
    }
    let plane = |elements: &usize| radar.samples == 1 || far_metres(*elements) <= radar.max_range_metres() * NEAR_PART;
    let longest = (1..=BLOCK).rev().find(plane).unwrap_or(1);
    let count = radar.end_elements.div_ceil(longest);
    let edge = |i: usize| i * radar.end_elements / count;
    (0..count).map(|i| edge(i)..edge(i + 1)).collect()
}

/// The reason why the tables can't be made for `radar`: a column has too many directions, or the tables take too much memory.
pub(super) fn no_tables(radar: &Radar) -> Option<String> {
    too_many_folds(radar).or_else(|| too_large(radar))
}

fn too_large(radar: &Radar) -> Option<String> {
    let (bins, directions) = GridCells::new(radar).dim();
    let bytes = 2 * blocks(radar).len() * bins * directions * size_of::<Place>();
    (bytes > MOST_TABLE_BYTES).then(|| {
        format!("its tables for {bins} range bins and {directions} directions would fill {bytes} bytes; at most {MOST_TABLE_BYTES}")
    })
}

impl Backprojector {
    pub fn new(radar: &Radar, cells: &GridCells<'_>, window: RangeWindow) -> Self {
        let rows = ROWS_PER_BIN * radar.samples;
        let blocks = blocks(radar);
        let longest = blocks.iter().map(Range::len).max().unwrap_or(1);
        let columns = (COLUMNS_PER_ELEMENT * longest).next_power_of_two();
        let window = match window {
            RangeWindow::Hann => hann(radar.samples),
            RangeWindow::None => vec![1.0; radar.samples],
        };
        let weight = window.iter().sum::<f64>() * radar.end_elements as f64;
        let blocks = End::BOTH.map(|end| {
            let place = |elements: &Range<usize>| {
                let first = radar.end_range(end).start + elements.start;
                let places = places(radar, cells, first + elements.len() / 2, rows, columns);
                Block { elements: elements.clone(), places }
            };
            blocks.iter().map(place).collect()
        });
        Backprojector { blocks, rows, columns, window, weight }
    }

    /// Amplitude of each end at every cell, in phase where one reflector is there: 1 for a reflector whose samples have amplitude 1.
    pub fn amplitudes(&self, ends: &TwoEnds) -> [Array2<Complex64>; 2] {
        [(End::First, &self.blocks[0]), (End::Last, &self.blocks[1])].map(|(end, blocks)| {
            let dim = blocks.first().map_or((0, 0), |b| b.places.dim());
            let mut sum = Array2::zeros(dim);
            for block in blocks {
                let heard = ends.end(end).slice(s![block.elements.clone(), ..]);
                self.add(block, &centred_spectrum(heard, &self.window, self.rows, self.columns), &mut sum);
            }
            sum
        })
    }

    fn add(&self, block: &Block, spectrum: &Array2<Complex64>, sum: &mut Array2<Complex64>) {
        let scale = 1.0 / self.weight;
        Zip::from(sum).and(&block.places).par_for_each(|sum, place| {
            let (r, c) = (place.row.floor(), place.column.floor());
            let (fr, fc) = (f64::from(place.row - r), f64::from(place.column - c));
            let (r, c) = (r as usize % self.rows, c as usize % self.columns);
            let (next_r, next_c) = ((r + 1) % self.rows, (c + 1) % self.columns);
            let near = spectrum[[r, c]] * (1.0 - fc) + spectrum[[r, next_c]] * fc;
            let far = spectrum[[next_r, c]] * (1.0 - fc) + spectrum[[next_r, next_c]] * fc;
            *sum += (near * (1.0 - fr) + far * fr) * place.phase * scale;
        });
    }
}

fn places(radar: &Radar, cells: &GridCells<'_>, origin: usize, rows: usize, columns: usize) -> Array2<Place> {
    let turns_per_metre = radar.turns_per_metre((radar.samples / 2) as f64);
    // Turns from one element to the next for cos(theta) = 1.
    let per_element = -radar.carrier_turns_per_metre() * radar.element_spacing_metres;
    let pair = radar.pair(origin);
    let mut places = Array2::from_elem(cells.dim(), Place::default());
    places.axis_iter_mut(Axis(0)).into_par_iter().zip(&cells.range_metres).for_each(|(mut row, range_metres)| {
        for (place, direction) in row.iter_mut().zip(&cells.directions) {
            let seen = seen_by(pair, *range_metres, direction.cos_theta);
            let bins = radar.bin_of_range(seen.range_metres);
            let turns = ((per_element * seen.cos_theta + 0.5).rem_euclid(1.0)) * columns as f64;
            *place = Place {
                row: ((bins * ROWS_PER_BIN as f64) % rows as f64) as f32,
                column: turns as f32,
                phase: Complex64::cis(-TAU * (turns_per_metre * seen.range_metres).fract()),
            };
        }
    });
    places
}
