//! The way down: dilated circular convolutions, each with ReLU and a 2x2 max-pool.

use super::layers::ThesisLayers;
use super::pictures::{Bordered, Parted};
use crate::network::kernels::convolution::Packed;
use crate::network::kernels::vector::{Loop, VECTOR_LANES, Vector, run};
use crate::network::weights::WeightsError;
use crate::signal::simd::Simd;

/// Channels of the input: magnitude and phase of both ends.
pub const CHANNELS: usize = 4;

/// Number of cells in a window of the max-pool: 2 rows by 2 columns, one cell from each part of a [`Parted`] picture.
const POOLED_OUTPUTS: usize = 4;

#[derive(Debug)]
pub(super) struct TowerLevel {
    kernel: Packed,
    size: usize,
    output: usize,
}

impl TowerLevel {
    /// A tower called `name` of `levels` stages with kernels of `size` by `size` cells and `filters` outputs each. Its input has four channels.
    pub(super) fn tower(
        layers: ThesisLayers<'_>,
        name: &str,
        size: usize,
        [filters, levels]: [usize; 2],
    ) -> Result<Vec<TowerLevel>, WeightsError> {
        let stage = |level: usize| {
            let input = if level == 0 { CHANNELS } else { filters };
            let [weights, bias] = layers.conv(&format!("down.{name}.{level}"), [filters, input, size, size], 0)?;
            Ok(TowerLevel { kernel: Packed::new(&weights, &bias, [input; 2], [size; 2], 1), size, output: filters })
        };
        (0..levels).map(stage).collect()
    }

    pub(super) fn forward(&self, from: &Parted, to: &mut Parted) {
        to.reset(from.h / 2, from.w / 2, self.output);
        let simd = Simd::chosen();
        to.fill(|y, line, buffer| {
            let pooled = self.pooled(simd, from, y, buffer);
            for (x, cell) in pooled.chunks_exact(self.kernel.output()).enumerate() {
                line.cell(x).copy_from_slice(&cell[..self.output]);
            }
        });
    }

    pub(super) fn join(&self, from: &Parted, to: &mut Bordered, first: usize) {
        let (simd, channels) = (Simd::chosen(), to.c);
        to.fill(|y, line, buffer| {
            let pooled = self.pooled(simd, from, y, buffer).chunks_exact(self.kernel.output());
            for (to, cell) in line.chunks_exact_mut(channels).zip(pooled) {
                to[first..first + self.output].copy_from_slice(&cell[..self.output]);
            }
        });
    }

    fn pooled<'a>(&self, simd: Simd, from: &Parted, y: usize, buffer: &'a mut Vec<f32>) -> &'a [f32] {
        let width = from.w / 2;
        let size = width * self.kernel.output();
        buffer.resize(POOLED_OUTPUTS * size, 0.0);
        for (part, out) in buffer.chunks_exact_mut(size).enumerate() {
            let seen = from.seen(2 * y + part / 2, part % 2, self.size);
            self.kernel.line(simd, seen, from.row_cells(), width, out);
        }
        let (first, others) = buffer.split_at_mut(size);
        run(simd, Largest { first, others });
        first
    }
}

struct Largest<'a> {
    first: &'a mut [f32],
    others: &'a [f32],
}

impl Loop for Largest<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let size = self.first.len();
        assert!(
            size.is_multiple_of(VECTOR_LANES) && self.others.len() == (POOLED_OUTPUTS - 1) * size,
            "parts of another size"
        );
        // SAFETY: a vector stays inside its part; the caller promises the features.
        unsafe {
            let zero = V::load([0.0; VECTOR_LANES].as_ptr());
            for at in (0..size).step_by(VECTOR_LANES) {
                let to = self.first.as_mut_ptr().add(at);
                let other = |part: usize| V::load(self.others.as_ptr().add(part * size + at));
                V::load(to).larger(other(0)).larger(other(1).larger(other(2))).larger(zero).store(to);
            }
        }
    }
}
