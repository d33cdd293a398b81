//! Equation 3.3 by phasors split at 32 samples: sample `n = 32 a + b` is `A[a] * B[b]`, so 512 phasors cost 16 + 32.
//!
//! Rounding errors don't grow as in a recurrence: every phasor is the product of four with exact phase. The sum over reflectors is a matrix product
//! in registers, one lane an element.

use super::block_echoes::BlockEchoes;
use super::path::PairBlocks;
use super::phase::{EchoLanes, EchoModel};
use super::simd::{ComplexLanes, Real, phasor};
use crate::scene::Reflector;

/// Samples in a row of the split.
pub const ROW_SAMPLES: usize = 32;
/// Reflectors whose phasors are computed together: they fit the first-level cache.
pub const CHUNK_REFLECTORS: usize = 8;
/// Distance between phasors that are evaluated from their phase; those between are products.
const EXACT_PHASOR_STEP: usize = 4;
/// Rows and columns of the product kept in registers.
const TILE: (usize, usize) = (2, 4);

/// Rows of the split of chirps of `samples` samples; the last may extend beyond the chirp.
pub const fn rows_of(samples: usize) -> usize {
    samples.div_ceil(ROW_SAMPLES).next_multiple_of(EXACT_PHASOR_STEP)
}

/// Phasors of one reflector: its echo at sample `32 a + b` is `rows[a] * columns[b]`.
#[derive(Debug, Clone)]
pub struct Factors<T, const W: usize> {
    /// Amplitude and phase of every 32nd sample, [`rows_of`] of them.
    pub rows: Vec<ComplexLanes<T, W>>,
    /// Phase from such a sample to each of the next 32.
    pub columns: [ComplexLanes<T, W>; ROW_SAMPLES],
}

/// [`Factors`] by reference, which may have rows of another gain.
#[derive(Debug, Clone, Copy)]
pub struct Product<'a, T, const W: usize> {
    pub rows: &'a [ComplexLanes<T, W>],
    pub columns: &'a [ComplexLanes<T, W>; ROW_SAMPLES],
}

impl<T: Real, const W: usize> Factors<T, W> {
    #[inline(always)]
    pub fn product(&self) -> Product<'_, T, W> {
        Product { rows: &self.rows, columns: &self.columns }
    }

    pub fn new(samples: usize) -> Self {
        let zero = ComplexLanes::zero();
        Factors { rows: vec![zero; rows_of(samples)], columns: [zero; ROW_SAMPLES] }
    }
}

/// Working memory of [`block_signal`].
#[derive(Debug, Clone)]
pub struct SplitScratch<T, const W: usize> {
    factors: Vec<Factors<T, W>>,
    padded: Vec<ComplexLanes<T, W>>,
}

impl<T: Real, const W: usize> SplitScratch<T, W> {
    pub fn new(samples: usize) -> Self {
        let factors = vec![Factors::new(samples); CHUNK_REFLECTORS];
        let padded = vec![ComplexLanes::zero(); factors[0].rows.len() * ROW_SAMPLES];
        SplitScratch { factors, padded }
    }
}

#[inline(always)]
pub(super) fn block_signal<'s, T: Real, const W: usize, const FMA: bool>(
    echoes: &BlockEchoes<'_, W>,
    samples: usize,
    scratch: &'s mut SplitScratch<T, W>,
) -> &'s mut [ComplexLanes<T, W>] {
    let SplitScratch { factors, padded } = scratch;
    padded.fill(ComplexLanes::zero());
    for begin in (0..echoes.len()).step_by(CHUNK_REFLECTORS) {
        let count = CHUNK_REFLECTORS.min(echoes.len() - begin);
        for (i, f) in factors.iter_mut().enumerate().take(count) {
            let echo = echoes.echo::<FMA>(begin + i);
            fill_with::<T, W, FMA>(&echo, &mut f.rows, &mut f.columns);
        }
        let products: [_; CHUNK_REFLECTORS] = std::array::from_fn(|i| factors[i].product());
        add_products::<T, W, FMA>(&products[..count], padded);
    }
    &mut padded[..samples]
}

/// Phasors of `r` at `pairs`, see [`Factors`].
#[inline(always)]
pub fn fill_factors<T: Real, const W: usize, const FMA: bool>(
    model: &EchoModel,
    pairs: impl Into<PairBlocks<W>>,
    r: &Reflector,
    rows: &mut [ComplexLanes<T, W>],
    columns: &mut [ComplexLanes<T, W>; ROW_SAMPLES],
) {
    fill_with::<T, W, FMA>(&model.echo_lanes::<W, FMA>(pairs, r), rows, columns);
}

#[inline(always)]
fn fill_with<T: Real, const W: usize, const FMA: bool>(
    echo: &EchoLanes<W>,
    rows: &mut [ComplexLanes<T, W>],
    columns: &mut [ComplexLanes<T, W>; ROW_SAMPLES],
) {
    let mut fine = [ComplexLanes::zero(); EXACT_PHASOR_STEP];
    for (i, fine) in fine.iter_mut().enumerate() {
        *fine = phasor::<T, W, FMA>(echo.beat_turns_at::<FMA>(i as f64));
    }
    for (i, columns) in columns.chunks_exact_mut(EXACT_PHASOR_STEP).enumerate() {
        let coarse = phasor::<T, W, FMA>(echo.beat_turns_at::<FMA>((i * EXACT_PHASOR_STEP) as f64));
        for (column, fine) in columns.iter_mut().zip(fine) {
            *column = coarse.times::<FMA>(fine);
        }
    }
    let amplitude = echo.amplitude.round_to();
    for (i, fine) in fine.iter_mut().enumerate() {
        *fine = phasor::<T, W, FMA>(echo.beat_turns_at::<FMA>((i * ROW_SAMPLES) as f64)).scaled(amplitude);
    }
    for (i, rows) in rows.chunks_exact_mut(EXACT_PHASOR_STEP).enumerate() {
        let turns = echo.beat_turns_at::<FMA>((i * EXACT_PHASOR_STEP * ROW_SAMPLES) as f64) + echo.carrier_turns;
        let coarse = phasor::<T, W, FMA>(turns);
        for (row, fine) in rows.iter_mut().zip(fine) {
            *row = coarse.times::<FMA>(fine);
        }
    }
}

/// `out[32 a + b] += sum over factors of rows[a] * columns[b]`.
#[inline(always)]
#[allow(clippy::needless_range_loop)] // constant bounds keep the tile in registers
pub fn add_products<T: Real, const W: usize, const FMA: bool>(
    factors: &[Product<'_, T, W>],
    out: &mut [ComplexLanes<T, W>],
) {
    for a in (0..out.len() / ROW_SAMPLES).step_by(TILE.0) {
        for b in (0..ROW_SAMPLES).step_by(TILE.1) {
            let mut tile = [[ComplexLanes::zero(); TILE.1]; TILE.0];
            for f in factors {
                let rows: [_; TILE.0] = std::array::from_fn(|i| f.rows[a + i]);
                for j in 0..TILE.1 {
                    let column = f.columns[b + j];
                    for i in 0..TILE.0 {
                        tile[i][j] = tile[i][j].plus_product::<FMA>(rows[i], column);
                    }
                }
            }
            for (i, sums) in tile.iter().enumerate() {
                let begin = (a + i) * ROW_SAMPLES + b;
                for (sample, sum) in out[begin..begin + TILE.1].iter_mut().zip(sums) {
                    *sample = *sample + *sum;
                }
            }
        }
    }
}
