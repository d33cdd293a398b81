//! Side lobes in range: what the sources of every range row add to all others, for each column by itself.
//!
//! As a matrix product that is the dearest layer of the network. Most of it doesn't show: far from a weak source there is the floor, or a
//! strong source's side lobe. So the product is taken apart into tiles, and those that don't show are left out.

use super::grid::COLUMNS;
use super::reading::circulant;
use super::size::{MAX_ROWS, ROWS_STEP};
use crate::network::kernels::convolution::{PRODUCT_COLUMNS as BLOCK, product};
use crate::network::kernels::vector::LANES;
use crate::signal::simd::{Kernel, LANES_F32, Lanes, Simd};
use rayon::prelude::*;
use std::cell::RefCell;

/// Rows of sources, and rows that they add to, of a tile.
const TILE_SOURCE_ROWS: usize = 8;
const TILE_ROWS: usize = 16;

const _: () = assert!(ROWS_STEP.is_multiple_of(TILE_SOURCE_ROWS), "whole tiles of sources");

/// What all tiles together may add to a cell unseen, as a part of what the cell has at least.
const ALL_UNSEEN: f32 = 0.0096;

/// Words of a bit for each tile of sources.
const WORDS: usize = MAX_ROWS / TILE_SOURCE_ROWS / BITS;
const BITS: usize = u64::BITS as usize;

/// A learned kernel over the rows, which wraps around, and where it is how strong.
#[derive(Debug)]
pub(super) struct RangeLobes {
    rows: usize,
    /// `[rows, rows]`
    kernel: Vec<f32>,
    /// `[rows / TILE_ROWS, rows / TILE_SOURCE_ROWS]`, the first rounded up: the kernel's least and greatest value in a tile.
    reach: Vec<[f32; 2]>,
}

#[derive(Default)]
struct Kept {
    /// `[rows, BLOCK]`
    sources: Vec<f32>,
    /// `[rows / TILE_SOURCE_ROWS, BLOCK]`
    sums: Vec<f32>,
}

thread_local! {
    static KEPT_LOBES: RefCell<Kept> = RefCell::default();
}

impl RangeLobes {
    /// Takes the kernel's decades over the distance in rows, `[rows / 2 + 1]`.
    pub(super) fn new(decades: &[f32]) -> Self {
        let rows = 2 * (decades.len() - 1);
        let kernel = circulant(decades, rows);
        let of_tile = |tile: usize| {
            let (to, from) =
                (tile / (rows / TILE_SOURCE_ROWS) * TILE_ROWS, tile % (rows / TILE_SOURCE_ROWS) * TILE_SOURCE_ROWS);
            let cells =
                (to..(to + TILE_ROWS).min(rows)).flat_map(|row| &kernel[row * rows + from..][..TILE_SOURCE_ROWS]);
            cells.fold([f32::INFINITY, 0.0], |[least, most]: [f32; 2], v| [least.min(*v), most.max(*v)])
        };
        let reach = (0..rows.div_ceil(TILE_ROWS) * (rows / TILE_SOURCE_ROWS)).map(of_tile).collect();
        RangeLobes { rows, kernel, reach }
    }

    /// What a tile may add to a cell unseen, as a part of what the cell has at least: less than a hundredth for all tiles.
    pub(super) fn unseen(&self) -> f32 {
        ALL_UNSEEN / (self.rows / TILE_SOURCE_ROWS) as f32
    }

    /// Side lobes `[1024 / BLOCK, rows, BLOCK]` of sources, of which `read` writes those of a block of columns, over a `floor`. Neither the
    /// floor nor tiles that add no more than the part `unseen` of what there is at least are added. The answer is the part of all tiles that was.
    ///
    /// `read` must not use rayon: what a thread keeps is borrowed meanwhile.
    pub(super) fn add_up(
        &self,
        floor: f32,
        unseen: f32,
        read: impl Fn(usize, &mut [f32]) + Sync,
        out: &mut Vec<f32>,
    ) -> f32 {
        let (simd, rows) = (Simd::chosen(), self.rows);
        out.resize(rows * COLUMNS, 0.0);
        let of_block = |(block, out): (usize, &mut [f32])| {
            KEPT_LOBES.with_borrow_mut(|kept| {
                kept.sources.resize(rows * BLOCK, 0.0);
                read(block, &mut kept.sources);
                simd.run(Sums { sources: &kept.sources, sums: &mut kept.sums });
                let parts = out.chunks_mut(TILE_ROWS * BLOCK).enumerate();
                parts.map(|(to, out)| self.add_to(simd, floor, unseen, to, kept, out)).sum::<usize>()
            })
        };
        let tiles = out.par_chunks_mut(rows * BLOCK).enumerate().map(of_block).sum::<usize>();
        tiles as f32 / (COLUMNS / BLOCK * self.reach.len()) as f32
    }

    /// What a block's sources add to the rows of a tile, [`TILE_ROWS`] or what is left, in how many tiles.
    fn add_to(&self, simd: Simd, floor: f32, unseen: f32, to: usize, kept: &Kept, out: &mut [f32]) -> usize {
        let (rows, tiles) = (self.rows, self.rows / TILE_SOURCE_ROWS);
        let reach = &self.reach[to * tiles..][..tiles];
        let shows = simd.run(Shows { reach, sums: &kept.sums, floor, unseen });
        let tiles = (0..tiles).filter(|tile| shows[tile / BITS] >> (tile % BITS) & 1 == 1);
        let runs = tiles.map(|tile| tile * TILE_SOURCE_ROWS..(tile + 1) * TILE_SOURCE_ROWS);
        product(simd, &self.kernel[to * TILE_ROWS * rows..][..out.len() / BLOCK * rows], &kept.sources, runs, out);
        shows.iter().map(|word| word.count_ones() as usize).sum()
    }
}

type Vector = Lanes<f32, LANES_F32>;

/// Sums of [`TILE_SOURCE_ROWS`] rows of sources each.
struct Sums<'a> {
    sources: &'a [f32],
    sums: &'a mut Vec<f32>,
}

impl Kernel for Sums<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.sums.resize(self.sources.len() / TILE_SOURCE_ROWS, 0.0);
        for (rows, sums) in self.sources.chunks_exact(TILE_SOURCE_ROWS * BLOCK).zip(self.sums.chunks_exact_mut(BLOCK)) {
            for at in (0..BLOCK).step_by(LANES) {
                let row = |row: usize| Vector::load(&rows[row * BLOCK + at..]);
                (1..TILE_SOURCE_ROWS).fold(row(0), |sum, i| sum + row(i)).store(&mut sums[at..]);
            }
        }
    }
}

/// Which sources show in some rows: a bit for each tile.
struct Shows<'a> {
    reach: &'a [[f32; 2]],
    sums: &'a [f32],
    floor: f32,
    unseen: f32,
}

impl Kernel for Shows<'_> {
    type Output = [u64; WORDS];

    #[inline(always)]
    fn run<const FMA: bool>(self) -> [u64; WORDS] {
        let mut shows = [0; WORDS];
        for at in (0..BLOCK).step_by(LANES) {
            let sum = |tile: usize| Vector::load(&self.sums[tile * BLOCK + at..]);
            let mut least = Vector::splat(self.floor);
            for (tile, &[of_least, _]) in self.reach.iter().enumerate() {
                least = sum(tile).mul_add::<FMA>(Lanes::splat(of_least), least);
            }
            least = least * Lanes::splat(self.unseen);
            for (word, (shows, reach)) in shows.iter_mut().zip(self.reach.chunks(BITS)).enumerate() {
                let mut bits = 0;
                for (bit, &[_, of_most]) in reach.iter().enumerate() {
                    let over = sum(word * BITS + bit).mul_add::<FMA>(Lanes::splat(of_most), -least);
                    bits |= u64::from(over.0.iter().any(|v| *v > 0.0)) << bit;
                }
                *shows |= bits;
            }
        }
        shows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_does_not_show() {
        [512, 200, 1024].into_iter().for_each(check_what_is_left_out);
    }

    fn check_what_is_left_out(rows: usize) {
        // Tails as those of a Hann window, and sources over fifteen decades, most of them weak.
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
        let part = lobes.add_up(floor, lobes.unseen(), read, &mut found);
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
