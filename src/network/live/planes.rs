//! Channels-last pictures and what the live network's engine does with them again and again.

use super::kernel::{Packed, convolve, padded};
use crate::network::weights::{WeightFile, WeightsError};
use rayon::prelude::*;

/// Channels-last picture: `[h, w, c]`.
#[derive(Debug, Clone, Default)]
pub(super) struct Plane {
    pub(super) h: usize,
    pub(super) w: usize,
    pub(super) c: usize,
    pub(super) data: Vec<f32>,
}

impl Plane {
    pub(super) fn reset(&mut self, h: usize, w: usize, c: usize) {
        (self.h, self.w, self.c) = (h, w, c);
        self.data.resize(h * w * c, 0.0);
    }
}

#[derive(Debug)]
pub(super) struct Context {
    pub(super) row: Packed,
    pub(super) col: Packed,
}

#[derive(Debug)]
pub(super) struct Block {
    pub(super) conv1: Packed,
    pub(super) conv2: Packed,
    pub(super) context: Option<Context>,
}

/// 1x1 convolution of means and maxima, each padded to whole vectors.
pub(super) fn pooled_mix(file: &WeightFile, name: &str, c: usize) -> Result<Packed, WeightsError> {
    let weights = file.tensor(&format!("{name}.weight"), &[c, 2 * c, 1, 1])?;
    let bias = file.tensor(&format!("{name}.bias"), &[c])?;
    let lanes = padded(c);
    let mut spread = vec![0.0; c * 2 * lanes];
    for (out, row) in spread.chunks_exact_mut(2 * lanes).zip(weights.chunks_exact(2 * c)) {
        out[..c].copy_from_slice(&row[..c]);
        out[lanes..lanes + c].copy_from_slice(&row[c..]);
    }
    Ok(Packed::new(&spread, &bias, 2 * lanes, 2 * lanes, 1, 1))
}

impl Block {
    pub(super) fn forward(
        &self,
        x: &mut Plane,
        halo: &mut Vec<f32>,
        hidden: &mut Plane,
        delta: &mut Plane,
        pool: &mut Vec<f32>,
        mixed: &mut Vec<f32>,
    ) {
        with_halo(x, true, halo);
        apply(&self.conv1, halo, x.h, x.w, hidden);
        if let Some(context) = &self.context {
            context.forward(hidden, pool, mixed);
        }
        with_halo(hidden, true, halo);
        apply(&self.conv2, halo, x.h, x.w, delta);
        x.data.par_iter_mut().with_min_len(1 << 15).zip(&delta.data).for_each(|(a, b)| *a += b);
    }
}

impl Context {
    pub(super) fn forward(&self, x: &mut Plane, pool: &mut Vec<f32>, mixed: &mut Vec<f32>) {
        let (h, w, c) = (x.h, x.w, x.c);
        pool.clear();
        pool.resize((h + w) * 2 * c, 0.0);
        let (row_pool, col_pool) = pool.split_at_mut(h * 2 * c);
        for pooled in row_pool.chunks_exact_mut(2 * c).chain(col_pool.chunks_exact_mut(2 * c)) {
            pooled[c..].fill(f32::NEG_INFINITY);
        }
        for (y, line) in x.data.chunks_exact(w * c).enumerate() {
            let row = &mut row_pool[y * 2 * c..(y + 1) * 2 * c];
            for (cell, col) in line.chunks_exact(c).zip(col_pool.chunks_exact_mut(2 * c)) {
                for (i, v) in cell.iter().enumerate() {
                    row[i] += v / w as f32;
                    row[c + i] = row[c + i].max(*v);
                    col[i] += v / h as f32;
                    col[c + i] = col[c + i].max(*v);
                }
            }
        }
        mixed.resize((h + w) * c, 0.0);
        let (rows, cols) = mixed.split_at_mut(h * c);
        convolve(&self.row, row_pool, h, h, rows);
        convolve(&self.col, col_pool, w, w, cols);
        mixed.iter_mut().for_each(|v| *v = v.max(0.0));
        let (rows, cols) = mixed.split_at(h * c);
        for (line, row) in x.data.chunks_exact_mut(w * c).zip(rows.chunks_exact(c)) {
            for (cell, col) in line.chunks_exact_mut(c).zip(cols.chunks_exact(c)) {
                for ((v, r), k) in cell.iter_mut().zip(row).zip(col) {
                    *v += r + k;
                }
            }
        }
    }
}

/// Convolves a picture that has its halo.
pub(super) fn apply(weights: &Packed, halo: &[f32], h: usize, w: usize, out: &mut Plane) {
    out.reset(h, w, weights.output());
    convolve(weights, halo, w + 2, w, &mut out.data);
}

/// Copies `x`, through ReLU if asked, into `[h + 2, w + 2, c]`: angles wrap around, ranges end in zeros.
pub(super) fn with_halo(x: &Plane, relu: bool, halo: &mut Vec<f32>) {
    let least = if relu { 0.0 } else { f32::NEG_INFINITY };
    fill_halo(x.h, x.w, x.c, halo, |y, line| {
        let from = &x.data[y * x.w * x.c..(y + 1) * x.w * x.c];
        line.iter_mut().zip(from).for_each(|(a, b)| *a = b.max(least));
    });
}

/// Fills a picture with a halo line by line.
pub(super) fn fill_halo(h: usize, w: usize, c: usize, halo: &mut Vec<f32>, fill: impl Fn(usize, &mut [f32]) + Sync) {
    let line = (w + 2) * c;
    halo.resize((h + 2) * line, 0.0);
    halo[..line].fill(0.0);
    halo[(h + 1) * line..].fill(0.0);
    halo[line..(h + 1) * line].par_chunks_mut(line).with_min_len(8).enumerate().for_each(|(y, line)| {
        fill(y, &mut line[c..(w + 1) * c]);
        line.copy_within(w * c..(w + 1) * c, 0);
        line.copy_within(c..2 * c, (w + 1) * c);
    });
}
