//! Back-projection: the amplitude of both ends at every cell of the centre's polar grid.
//!
//! An end of a dozen elements (2 cm) is so small that spherical waves are plane on it, and longer ones are cut into blocks that are; the finely
//! padded spectrum of each block has the amplitude at any range and angle of its own. Every cell of the centre's grid looks up its range and
//! angle at each block, and the phase of its distance. This is the near-field matched filter of Cafforio, Prati and Rocca ("SAR data focusing
//! using seismic migration techniques", 1991) with an interpolator instead of a sum over samples.

use super::cells::GridCells;
use crate::maps::centred_spectrum;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::polar::polar_from_pair;
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

const BLOCK_ELEMENTS: usize = 16;

/// A block's far field begins at most at this part of the maximum range.
const MAX_FAR_FIELD_PART: f64 = 1.0 / 64.0;

/// Bytes of tables for each cell of the grid: larger tables are made anew each time, block by block.
const MAX_TABLE_BYTES_PER_CELL: usize = 64;

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
    /// `None` where the tables would be too large.
    places: Option<Array2<Place>>,
}

pub(super) struct Backprojector<'a> {
    cells: &'a GridCells<'a>,
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
    let plane =
        |elements: &usize| radar.samples == 1 || far_metres(*elements) <= radar.max_range_metres() * MAX_FAR_FIELD_PART;
    let longest = (1..=BLOCK_ELEMENTS).rev().find(plane).unwrap_or(1);
    let count = radar.end_elements.div_ceil(longest);
    let edge = |i: usize| i * radar.end_elements / count;
    (0..count).map(|i| edge(i)..edge(i + 1)).collect()
}

impl<'a> Backprojector<'a> {
    pub fn new(cells: &'a GridCells<'a>, window: RangeWindow) -> Self {
        let radar = cells.radar();
        let blocks = blocks(radar);
        let longest = blocks.iter().map(Range::len).max().unwrap_or(1);
        let window = match window {
            RangeWindow::Hann => hann(radar.samples),
            RangeWindow::None => vec![1.0; radar.samples],
        };
        let weight = window.iter().sum::<f64>() * radar.end_elements as f64;
        let is_held = 2 * blocks.len() * size_of::<Place>() <= MAX_TABLE_BYTES_PER_CELL;
        let (rows, columns) = (ROWS_PER_BIN * radar.samples, (COLUMNS_PER_ELEMENT * longest).next_power_of_two());
        let mut projector = Backprojector { cells, blocks: [vec![], vec![]], rows, columns, window, weight };
        projector.blocks = End::BOTH.map(|end| {
            let block = |elements: &Range<usize>| {
                let places = is_held.then(|| projector.places(end, elements));
                Block { elements: elements.clone(), places }
            };
            blocks.iter().map(block).collect()
        });
        projector
    }

    /// Amplitude of each end at every cell, in phase where one reflector is there: 1 for a reflector whose samples have amplitude 1.
    pub fn amplitudes(&self, ends: &TwoEnds) -> [Array2<Complex64>; 2] {
        [(End::First, &self.blocks[0]), (End::Last, &self.blocks[1])].map(|(end, blocks)| {
            let mut sum = Array2::zeros(self.cells.dim());
            for Block { elements, places } in blocks {
                let heard = ends.end(end).slice(s![elements.clone(), ..]);
                let spectrum = centred_spectrum(heard, &self.window, self.rows, self.columns);
                match places {
                    Some(places) => self.add(places, &spectrum, &mut sum),
                    None => self.add(&self.places(end, elements), &spectrum, &mut sum),
                }
            }
            sum
        })
    }

    fn add(&self, places: &Array2<Place>, spectrum: &Array2<Complex64>, sum: &mut Array2<Complex64>) {
        let scale = 1.0 / self.weight;
        Zip::from(sum).and(places).par_for_each(|sum, place| {
            let (r, c) = (place.row.floor(), place.column.floor());
            let (fr, fc) = (f64::from(place.row - r), f64::from(place.column - c));
            let (r, c) = (r as usize % self.rows, c as usize % self.columns);
            let (next_r, next_c) = ((r + 1) % self.rows, (c + 1) % self.columns);
            let near = spectrum[[r, c]] * (1.0 - fc) + spectrum[[r, next_c]] * fc;
            let far = spectrum[[next_r, c]] * (1.0 - fc) + spectrum[[next_r, next_c]] * fc;
            *sum += (near * (1.0 - fr) + far * fr) * place.phase * scale;
        });
    }

    /// Places of all cells in the spectrum of some elements of an end.
    fn places(&self, end: End, elements: &Range<usize>) -> Array2<Place> {
        let radar = self.cells.radar();
        let (rows, columns) = (self.rows as f64, self.columns as f64);
        let turns_per_metre = radar.turns_per_metre((radar.samples / 2) as f64);
        // Turns from one element to the next for cos(theta) = 1.
        let per_element = -radar.carrier_turns_per_metre() * radar.element_spacing_metres;
        let pair = radar.pair(radar.end_range(end).start + elements.start + elements.len() / 2);
        let mut places = Array2::from_elem(self.cells.dim(), Place::default());
        let ranges = &self.cells.range_metres;
        places.axis_iter_mut(Axis(0)).into_par_iter().zip(ranges).for_each(|(mut row, range_metres)| {
            for (place, direction) in row.iter_mut().zip(&self.cells.directions) {
                let seen = polar_from_pair(pair, *range_metres, direction.cos_theta);
                let bins = radar.bin_of_range(seen.range_metres);
                let turns = (per_element * seen.cos_theta + 0.5).rem_euclid(1.0);
                *place = Place {
                    row: ((bins * ROWS_PER_BIN as f64) % rows) as f32,
                    column: (turns * columns) as f32,
                    phase: Complex64::cis(-TAU * (turns_per_metre * seen.range_metres).fract()),
                };
            }
        });
        places
    }
}
