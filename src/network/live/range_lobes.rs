//! Side lobes in range: every column is circularly convolved with a learned kernel.
//!
//! As a dense matrix product this would be the most expensive layer of the network. Most of its terms are far below the floor or the side lobes of a
//! stronger source. So the matrix is divided into tiles, and a tile whose upper bound is below that level is skipped.

use super::grid::COLUMNS;
use super::reading::circulant;
use super::size::{MAX_ROWS, ROWS_STEP};
use crate::network::kernels::convolution::{PRODUCT_COLUMNS as BLOCK, product};
use crate::network::kernels::vector::VECTOR_LANES;
use crate::signal::simd::{Kernel, LANES_F32, Lanes, Simd};
use rayon::prelude::*;
use std::cell::RefCell;

/// Size of a tile of the kernel's matrix: source rows by output rows.
const TILE_SOURCE_ROWS: usize = 8;
const TILE_ROWS: usize = 16;

const _: () = assert!(ROWS_STEP.is_multiple_of(TILE_SOURCE_ROWS), "whole tiles of sources");

/// Upper bound of the sum of all skipped tiles in a cell, relative to a lower bound of the cell's amplitude.
const MAX_SKIPPED_PART: f32 = 0.0096;

/// Words of a mask with one bit for each tile along the sources.
const MASK_WORDS: usize = MAX_ROWS / TILE_SOURCE_ROWS / WORD_BITS;
const WORD_BITS: usize = u64::BITS as usize;

/// The kernel as a circulant matrix over range rows, and its extremes in each tile.
#[derive(Debug)]
pub(super) struct RangeLobes {
    rows: usize,
    /// `[rows, rows]`
    kernel: Vec<f32>,
    /// Minimum and maximum of the kernel in each tile, `[rows / TILE_ROWS, rows / TILE_SOURCE_ROWS]`, the first rounded up.
    extremes: Vec<[f32; 2]>,
}

/// A thread's buffers.
#[derive(Default)]
struct Buffers {
    /// Amplitudes of the sources, `[rows, BLOCK]`.
    sources: Vec<f32>,
    /// Sums of the sources of each tile, `[rows / TILE_SOURCE_ROWS, BLOCK]`.
    sums: Vec<f32>,
}

thread_local! {
    static LOBE_BUFFERS: RefCell<Buffers> = RefCell::default();
}

impl RangeLobes {
    /// The side lobes of a kernel, decades for each circular distance in rows, `[rows / 2 + 1]`.
    pub(super) fn new(decades: &[f32]) -> Self {
        let rows = 2 * (decades.len() - 1);
        let kernel = circulant(decades, rows);
        let tile_extremes = |tile: usize| {
            let (to, from) =
                (tile / (rows / TILE_SOURCE_ROWS) * TILE_ROWS, tile % (rows / TILE_SOURCE_ROWS) * TILE_SOURCE_ROWS);
            let cells =
                (to..(to + TILE_ROWS).min(rows)).flat_map(|row| &kernel[row * rows + from..][..TILE_SOURCE_ROWS]);
            cells.fold([f32::INFINITY, 0.0], |[min, max]: [f32; 2], v| [min.min(*v), max.max(*v)])
        };
        let extremes = (0..rows.div_ceil(TILE_ROWS) * (rows / TILE_SOURCE_ROWS)).map(tile_extremes).collect();
        RangeLobes { rows, kernel, extremes }
    }

    /// The part of a cell's lower bound below which a tile is skipped: all skipped tiles together are below 1 %.
    pub(super) fn skipped_part(&self) -> f32 {
        MAX_SKIPPED_PART / (self.rows / TILE_SOURCE_ROWS) as f32
    }

    /// Computes the side lobes `out` `[1024 / BLOCK, rows, BLOCK]` of the sources that `read` writes for a block of columns. Tiles below the part
    /// `skipped_part` of a cell's lower bound are skipped; `floor` is in that bound, but is not added. Returns the fraction of tiles computed.
    /// `read` must not use rayon, since the thread's buffers are borrowed.
    pub(super) fn convolve_into(
        &self,
        floor: f32,
        skipped_part: f32,
        read: impl Fn(usize, &mut [f32]) + Sync,
        out: &mut Vec<f32>,
    ) -> f32 {
        let (simd, rows) = (Simd::chosen(), self.rows);
        out.resize(rows * COLUMNS, 0.0);
        let convolve_block = |(block, out): (usize, &mut [f32])| {
            LOBE_BUFFERS.with_borrow_mut(|buffers| {
                buffers.sources.resize(rows * BLOCK, 0.0);
                read(block, &mut buffers.sources);
                simd.run(SourceSums { sources: &buffers.sources, sums: &mut buffers.sums });
                let parts = out.chunks_mut(TILE_ROWS * BLOCK).enumerate();
                parts.map(|(to, out)| self.fill(simd, floor, skipped_part, to, buffers, out)).sum::<usize>()
            })
        };
        let tiles = out.par_chunks_mut(rows * BLOCK).enumerate().map(convolve_block).sum::<usize>();
        tiles as f32 / (COLUMNS / BLOCK * self.extremes.len()) as f32
    }

    /// Computes a block's side lobes in the output rows of tile row `to`, and returns the number of tiles computed.
    fn fill(&self, simd: Simd, floor: f32, skipped_part: f32, to: usize, buffers: &Buffers, out: &mut [f32]) -> usize {
        let (rows, tiles) = (self.rows, self.rows / TILE_SOURCE_ROWS);
        let extremes = &self.extremes[to * tiles..][..tiles];
        let visible = simd.run(VisibleTiles { extremes, sums: &buffers.sums, floor, skipped_part });
        let tiles = (0..tiles).filter(|tile| visible[tile / WORD_BITS] >> (tile % WORD_BITS) & 1 == 1);
        let runs = tiles.map(|tile| tile * TILE_SOURCE_ROWS..(tile + 1) * TILE_SOURCE_ROWS);
        product(simd, &self.kernel[to * TILE_ROWS * rows..][..out.len() / BLOCK * rows], &buffers.sources, runs, out);
        visible.iter().map(|word| word.count_ones() as usize).sum()
    }
}

type Vector = Lanes<f32, LANES_F32>;

struct SourceSums<'a> {
    sources: &'a [f32],
    sums: &'a mut Vec<f32>,
}

impl Kernel for SourceSums<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.sums.resize(self.sources.len() / TILE_SOURCE_ROWS, 0.0);
        for (rows, sums) in self.sources.chunks_exact(TILE_SOURCE_ROWS * BLOCK).zip(self.sums.chunks_exact_mut(BLOCK)) {
            for at in (0..BLOCK).step_by(VECTOR_LANES) {
                let row = |row: usize| Vector::load(&rows[row * BLOCK + at..]);
                (1..TILE_SOURCE_ROWS).fold(row(0), |sum, i| sum + row(i)).store(&mut sums[at..]);
            }
        }
    }
}

/// Kernel that finds the tiles to compute in one row of tiles, as a mask.
struct VisibleTiles<'a> {
    extremes: &'a [[f32; 2]],
    sums: &'a [f32],
    floor: f32,
    skipped_part: f32,
}

impl Kernel for VisibleTiles<'_> {
    type Output = [u64; MASK_WORDS];

    #[inline(always)]
    fn run<const FMA: bool>(self) -> [u64; MASK_WORDS] {
        let mut visible = [0; MASK_WORDS];
        for at in (0..BLOCK).step_by(VECTOR_LANES) {
            let sum = |tile: usize| Vector::load(&self.sums[tile * BLOCK + at..]);
            let mut lower_bound = Vector::splat(self.floor);
            for (tile, &[minimum, _]) in self.extremes.iter().enumerate() {
                lower_bound = sum(tile).mul_add::<FMA>(Lanes::splat(minimum), lower_bound);
            }
            lower_bound = lower_bound * Lanes::splat(self.skipped_part);
            for (word, (visible, extremes)) in visible.iter_mut().zip(self.extremes.chunks(WORD_BITS)).enumerate() {
                let mut bits = 0;
                for (bit, &[_, maximum]) in extremes.iter().enumerate() {
                    let over = sum(word * WORD_BITS + bit).mul_add::<FMA>(Lanes::splat(maximum), -lower_bound);
                    bits |= u64::from(over.0.iter().any(|v| *v > 0.0)) << bit;
                }
                *visible |= bits;
            }
        }
        visible
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skipped_tiles_are_invisible() {
        [512, 200, 1024].into_iter().for_each(check_skipped_tiles);
    }

    fn check_skipped_tiles(rows: usize) {
        // Tails like those of a Hann window, and sources over fifteen decades, most of them weak.
        let decades: Vec<f32> = (0..=rows / 2).map(|k| -3.0 - 3.0 * (1.0 + k as f32).log10()).collect();
        let lobes = RangeLobes::new(&decades);
        let source = |row: usize, column: usize| {
            let random = ((row * COLUMNS + column) as u32).wrapping_mul(2_654_435_761) >> 8;
            let strong = if row % 97 == 5 && column % 50 < 9 { 12.0 } else { 0.0 };
            10f32.powf(strong - 13.0 - 4.0 * random as f32 / (1 << 24) as f32)
        };
        let read = |block: usize, to: &mut [f32]| {
            to.iter_mut().enumerate().for_each(|(i, to)| *to = source(i / BLOCK, block * BLOCK + i % BLOCK));
        };
        let floor = 1e-14;
        let mut found = Vec::new();
        let part = lobes.convolve_into(floor, lobes.skipped_part(), read, &mut found);
        assert!(part < 0.5, "{part} of all tiles");
        let mut worst: f32 = 0.0;
        for column in (0..COLUMNS).step_by(7) {
            for row in 0..rows {
                let kernel = &lobes.kernel[row * rows..][..rows];
                let all: f32 = kernel.iter().enumerate().map(|(from, k)| k * source(from, column)).sum();
                let found = found[(column / BLOCK * rows + row) * BLOCK + column % BLOCK];
                worst = worst.max(((all + floor) / (found + floor)).log10().abs());
            }
        }
        // A hundredth of a decade is a thousandth of Lambda over ten.
        assert!(worst < 5e-3, "{worst} decades");
    }
}
