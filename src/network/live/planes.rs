//! Channels-last tensors, and the residual blocks of the live network's engine.

use super::winograd::{Conv3x3, ConvResults};
use crate::network::kernels::convolution::{Packed, convolve};
use crate::network::kernels::vector::VECTOR_LANES;
use crate::signal::simd::{Kernel, Lanes, Simd};
use rayon::prelude::*;

/// A tensor `[h, w, c]`.
#[derive(Debug, Clone, Default)]
pub(super) struct Plane {
    pub(super) h: usize,
    pub(super) w: usize,
    pub(super) c: usize,
    pub(super) data: Vec<f32>,
}

impl Plane {
    /// Sets the shape. The values are those of earlier use.
    pub(super) fn reset(&mut self, h: usize, w: usize, c: usize) {
        (self.h, self.w, self.c) = (h, w, c);
        self.data.resize(h * w * c, 0.0);
    }

    pub(super) fn read_rectified(&self, y: usize, line: &mut [f32]) {
        let size = self.w * self.c;
        line.iter_mut().zip(&self.data[y * size..]).for_each(|(to, v)| *to = rectified(*v));
    }

    pub(super) fn rectify(&mut self) {
        self.data.par_chunks_mut(1 << 15).for_each(|part| part.iter_mut().for_each(|v| *v = rectified(*v)));
    }
}

#[inline]
pub(super) fn rectified(v: f32) -> f32 {
    if v > 0.0 { v } else { 0.0 }
}

/// 1x1 convolutions of the means and maxima of rows and of columns, whose ReLU is added to the cells of the row and the column.
#[derive(Debug)]
pub(super) struct PlaneContext {
    pub(super) row: Packed,
    pub(super) col: Packed,
}

/// A residual block: ReLU, 3x3 convolution, context, ReLU, 3x3 convolution.
#[derive(Debug)]
pub(super) struct PlaneBlock {
    pub(super) conv1: Conv3x3,
    pub(super) conv2: Conv3x3,
    pub(super) context: Option<PlaneContext>,
}

impl PlaneBlock {
    pub(super) fn forward(&self, x: &mut Plane, hidden: &mut Plane, pool: &mut Vec<f32>, mixed: &mut Vec<f32>) {
        hidden.reset(x.h, x.w, self.conv1.output());
        self.conv1.run(
            [x.h, x.w],
            |y, line| x.read_rectified(y, line),
            &mut hidden.data,
            |results, out| results.write_outputs(out),
        );
        if let Some(context) = &self.context {
            context.forward(hidden, pool, mixed);
        }
        let add =
            |results: ConvResults, out: &mut [f32]| out.iter_mut().zip(results.sums()).for_each(|(a, b)| *a += *b);
        self.conv2.run([x.h, x.w], |y, line| hidden.read_rectified(y, line), &mut x.data, add);
    }
}

impl PlaneContext {
    pub(super) fn forward(&self, x: &mut Plane, pool: &mut Vec<f32>, mixed: &mut Vec<f32>) {
        let (h, w, c) = (x.h, x.w, x.c);
        pool.resize((h + w) * 2 * c, 0.0);
        let (row_pool, column_pool) = pool.split_at_mut(h * 2 * c);
        Simd::chosen().run(Pool { x, rows: row_pool, columns: column_pool });
        mixed.resize((h + w) * c, 0.0);
        let (rows, cols) = mixed.split_at_mut(h * c);
        convolve(&self.row, row_pool, h, h, rows);
        convolve(&self.col, column_pool, w, w, cols);
        mixed.iter_mut().for_each(|v| *v = rectified(*v));
        let (rows, cols) = mixed.split_at(h * c);
        x.data.par_chunks_mut(w * c).with_min_len(16).zip(rows.par_chunks(c)).for_each(|(line, row)| {
            for (cell, column) in line.chunks_exact_mut(c).zip(cols.chunks_exact(c)) {
                for ((v, r), k) in cell.iter_mut().zip(row).zip(column) {
                    *v += r + k;
                }
            }
        });
    }
}

type Vector = Lanes<f32, VECTOR_LANES>;

/// Kernel of the means and maxima over rows and over columns, `[h, 2 c]` and `[w, 2 c]`: the means of all channels, then the maxima.
struct Pool<'a> {
    x: &'a Plane,
    rows: &'a mut [f32],
    columns: &'a mut [f32],
}

impl Kernel for Pool<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let &Plane { h, w, c, ref data } = self.x;
        let pool = |pooled: &mut [f32], first: usize, step: usize, count: usize| {
            for channel in (0..c).step_by(VECTOR_LANES) {
                let (mut sum, mut max) = (Vector::splat(0.0), Vector::splat(f32::NEG_INFINITY));
                for cell in 0..count {
                    let v = Vector::load(&data[(first + cell * step) * c + channel..]);
                    sum = sum + v;
                    max = max.zip(v, f32::max);
                }
                (sum * Vector::splat((count as f32).recip())).store(&mut pooled[channel..]);
                max.store(&mut pooled[c + channel..]);
            }
        };
        self.rows.chunks_exact_mut(2 * c).enumerate().for_each(|(y, pooled)| pool(pooled, y * w, 1, w));
        self.columns.chunks_exact_mut(2 * c).enumerate().for_each(|(x, pooled)| pool(pooled, x, w, h));
    }
}
