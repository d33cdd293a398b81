//! The live network's forward pass without a framework, channels-last; tests compare it with `python/apertura/live.py`, which is trained.

use super::columns::ColumnTaps;
use super::config::{DECODER_CHANNELS, FOLD, INPUT_CHANNELS, WIDE_COLUMNS};
use super::constants::{SPACING_INDEX, window_of};
use super::doubt::DoubtHead;
use super::features::LiveInput;
use super::grid::{
    COARSE_CHANNELS, COARSE_COLUMNS, COLUMNS, CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS,
};
use super::lobes::WindowLobes;
use super::planes::{Plane, PlaneBlock, rectified};
use super::reading::{CELLS, LiveLayers};
use super::size::LiveSize;
use super::winograd::{Conv3x3, ConvResults};
use crate::maps::RangeAngleMap;
use crate::network::kernels::convolution::{PRODUCT_COLUMNS, Packed, convolve, product};
use crate::network::weights::{WeightFile, WeightsError};
use crate::signal::simd::Simd;
use crate::signal::simd::powers::{each, logarithm, power_of_ten};
use rayon::prelude::*;
use std::ops::Range;

const _: () = assert!(FOLD == CELLS && COLUMNS_PER_FINE == CELLS, "layers that spread a cell do so over four");
const COLUMNS_PER_FINE: usize = COLUMNS / FINE_COLUMNS;

/// The network's estimate for one scene, in decades relative to the samples' gain.
#[derive(Debug, Clone, PartialEq)]
pub struct Decades {
    /// log10 |Y| of the whole array, `[samples, elements]` row-major.
    pub map: Vec<f32>,
    /// Estimate of the smallest cell of the true map.
    pub minimum: f32,
    /// Part of the tiles of side lobes in range that were computed; the others are invisible.
    pub computed: f32,
}

/// The live network's weights, packed for [`kernels`](crate::network::kernels).
#[derive(Debug)]
pub struct LiveEngine {
    stem: Conv3x3,
    encoder: [Vec<PlaneBlock>; 4],
    down: [Packed; 3],
    up: [Packed; 3],
    decoder: [Vec<PlaneBlock>; 3],
    widen: Conv3x3,
    fine1: Conv3x3,
    fine2: Packed,
    row_sources: Packed,
    lobes: Vec<WindowLobes>,
    scalar1: Packed,
    scalar2: Packed,
    doubt: Option<DoubtHead>,
    channels: [usize; 4],
    rows: usize,
    columns: usize,
    taps: Option<ColumnTaps>,
}

/// Buffers of a forward pass, to be used again by the next.
#[derive(Debug, Default)]
pub struct LiveScratch {
    hidden: Plane,
    level: [Plane; 4],
    upward: Plane,
    heads: Plane,
    sources: Plane,
    lobes: Vec<f32>,
    pool: Vec<f32>,
    mixed: Vec<f32>,
}

impl LiveEngine {
    /// Packs the weights of `file`, which must fit `size`.
    /// # Errors
    /// [`WeightsError`] names the tensor that is missing or of another shape.
    pub fn new(file: &WeightFile, size: &LiveSize) -> Result<Self, WeightsError> {
        let LiveSize { channels, blocks, fine, rows, columns } = *size;
        let [c0, c1, c2, c3] = channels;
        let [b0, b1, b2, b3] = blocks;
        let layers = LiveLayers { file };
        Ok(LiveEngine {
            stem: layers.stem("stem.conv", INPUT_CHANNELS, c0)?,
            encoder: [
                layers.blocks("enc0", b0, c0, false)?,
                layers.blocks("enc1", b1.div_ceil(2), c1, false)?,
                layers.blocks("enc2", b2.div_ceil(2), c2, true)?,
                layers.blocks("enc3", b3, c3, true)?,
            ],
            down: [
                layers.small("down1", c0, c1, 2)?,
                layers.small("down2", c1, c2, 2)?,
                layers.small("down3", c2, c3, 2)?,
            ],
            up: [layers.up("up0", c1, c0)?, layers.up("up1", c2, c1)?, layers.up("up2", c3, c2)?],
            decoder: [
                layers.blocks("dec0", b0, c0, false)?,
                layers.blocks("dec1", b1, c1, false)?,
                layers.blocks("dec2", b2, c2, true)?,
            ],
            widen: layers.widened("widen.conv", c0, DECODER_CHANNELS)?,
            fine1: layers.conv("fine1.conv", [DECODER_CHANNELS + FINE_CHANNELS; 2], fine)?,
            fine2: layers.small("fine2", fine, 2 * COLUMNS_PER_FINE, 1)?,
            row_sources: layers.small("row_sources", c0, WIDE_COLUMNS / COARSE_COLUMNS, 1)?,
            lobes: WindowLobes::all(file, rows)?,
            scalar1: layers.linear("scalar1", [2 * c3 + SCALARS + CONSTANTS, CONSTANTS], 64)?,
            scalar2: layers.linear("scalar2", [64, 0], 2)?,
            doubt: DoubtHead::new(file, c0)?,
            channels,
            rows,
            columns,
            taps: ColumnTaps::new(columns),
        })
    }

    /// Estimates the map of one scene. Invisible side lobes are skipped.
    pub fn forward(&self, input: &LiveInput, s: &mut LiveScratch) -> Decades {
        self.forward_over(input, self.lobes[0].columns.skipped_part(), s)
    }

    /// As [`LiveEngine::forward`], with all side lobes, to measure the error of skipping.
    pub fn forward_whole(&self, input: &LiveInput, s: &mut LiveScratch) -> Decades {
        self.forward_over(input, 0.0, s)
    }

    /// The network's estimate of the error of Lambda, `[samples, elements]`, which nine of ten cells don't exceed on scenes and noise as in training.
    /// Call it after [`LiveEngine::forward`], with the same buffers. `None` where the weights lack the head.
    pub fn doubt(&self, s: &LiveScratch) -> Option<RangeAngleMap> {
        Some(self.doubt.as_ref()?.read(&s.level[0], self.taps.as_ref(), self.columns))
    }

    fn forward_over(&self, input: &LiveInput, skipped_part: f32, s: &mut LiveScratch) -> Decades {
        let rows = self.rows;
        assert!(input.rows.len() == ROW_CHANNELS * rows, "an input of {} rows", input.rows.len() / ROW_CHANNELS);
        let scalars = input.scalars.map(|v| (v + 8.0) / 3.0);
        let LiveScratch { hidden, level, upward, .. } = s;
        level[0].reset(rows, COARSE_COLUMNS, self.stem.output());
        let read = |row: usize, line: &mut [f32]| read_input(input, &scalars, row, line);
        self.stem.run([rows, COARSE_COLUMNS], read, &mut level[0].data, |results, out| results.write_outputs(out));
        for k in 0..4 {
            if k > 0 {
                let (above, below) = level.split_at_mut(k);
                let from = &above[k - 1];
                below[0].reset(from.h / 2, from.w / 2, self.down[k - 1].output());
                convolve(&self.down[k - 1], &from.data, from.w, from.w / 2, &mut below[0].data);
            }
            for block in &self.encoder[k] {
                block.forward(&mut level[k], hidden, &mut s.pool, &mut s.mixed);
            }
        }
        let (floor_shift, minimum_shift) = self.scalars(&level[3], &scalars, &input.constants);
        for k in (0..3).rev() {
            let (finer, coarser) = level.split_at_mut(k + 1);
            let from = &coarser[0];
            upward.reset(from.h, from.w, self.up[k].output());
            convolve(&self.up[k], &from.data, from.w, from.w, &mut upward.data);
            add_doubled(upward, &mut finer[k], self.channels[k]);
            for block in &self.decoder[k] {
                block.forward(&mut finer[k], hidden, &mut s.pool, &mut s.mixed);
            }
        }
        let top = &mut level[0];
        top.rectify();
        s.sources.reset(rows, COARSE_COLUMNS, self.row_sources.output());
        convolve(&self.row_sources, &top.data, COARSE_COLUMNS, COARSE_COLUMNS, &mut s.sources.data);
        hidden.reset(rows, COARSE_COLUMNS, self.widen.output());
        let read = |row: usize, line: &mut [f32]| line.copy_from_slice(&top.data[row * line.len()..][..line.len()]);
        self.widen.run([rows, COARSE_COLUMNS], read, &mut hidden.data, |results, out| results.write_outputs(out));
        s.heads.reset(rows, FINE_COLUMNS, self.fine2.output());
        let simd = Simd::chosen();
        let heads = |results: ConvResults, out: &mut [f32]| {
            let sums = results.sums();
            sums.iter_mut().for_each(|v| *v = rectified(*v));
            self.fine2.line(simd, sums, FINE_COLUMNS, FINE_COLUMNS, out);
        };
        let read = |row: usize, line: &mut [f32]| read_fine(&input.fine, hidden, row, line);
        self.fine1.run([rows, FINE_COLUMNS], read, &mut s.heads.data, heads);
        let floor = input.scalars[0] + floor_shift;
        // Only weights that were trained for a window have kernels for it.
        let kernels = self.lobes.get(window_of(&input.constants)).unwrap_or(&self.lobes[0]);
        let (map, computed) = decode(kernels, &s.heads, &s.sources, floor, skipped_part, &mut s.lobes);
        let map = match &self.taps {
            None => map,
            Some(taps) => taps.rows_of(&map),
        };
        Decades { map, minimum: floor - 2.5 + minimum_shift, computed }
    }

    /// Corrections of the floor and of the minimum, from the coarsest level.
    fn scalars(&self, coarsest: &Plane, scalars: &[f32; SCALARS], constants: &[f32; CONSTANTS]) -> (f32, f32) {
        let c = self.channels[3];
        let cells = (coarsest.h * coarsest.w) as f32;
        let mut pooled = vec![0.0f32; 2 * c + SCALARS + CONSTANTS];
        pooled[c..2 * c].fill(f32::NEG_INFINITY);
        for cell in coarsest.data.chunks_exact(coarsest.c) {
            for (i, v) in cell[..c].iter().enumerate() {
                pooled[i] += v / cells;
                pooled[c + i] = pooled[c + i].max(*v);
            }
        }
        pooled[2 * c..][..SCALARS].copy_from_slice(scalars);
        pooled[2 * c + SCALARS..].copy_from_slice(constants);
        let mut hidden = vec![0.0; self.scalar1.output()];
        convolve(&self.scalar1, &pooled, 1, 1, &mut hidden);
        hidden.iter_mut().for_each(|v| *v = v.max(0.0));
        let mut outputs = vec![0.0; self.scalar2.output()];
        convolve(&self.scalar2, &hidden, 1, 1, &mut outputs);
        (outputs[0], outputs[1])
    }
}

/// The map, decades `[samples, 1024]`, of main lobes and sources in range `heads`, and sources in angle `sources`; and the part of tiles computed.
fn decode(
    kernels: &WindowLobes,
    heads: &Plane,
    sources: &Plane,
    floor: f32,
    skipped_part: f32,
    lobes: &mut Vec<f32>,
) -> (Vec<f32>, f32) {
    let floor = 10f32.powf(floor);
    let read = |block: usize, sources: &mut [f32]| {
        for (row, out) in sources.chunks_exact_mut(PRODUCT_COLUMNS).enumerate() {
            let cells = heads.data[(row * FINE_COLUMNS + block * PRODUCT_COLUMNS / COLUMNS_PER_FINE) * heads.c..]
                .chunks_exact(heads.c);
            spread_out(cells, COLUMNS_PER_FINE..2 * COLUMNS_PER_FINE, out);
        }
    };
    let computed = kernels.columns.convolve_into(floor, skipped_part, read, lobes);
    let mut map = vec![0.0; heads.h * COLUMNS];
    map.par_chunks_mut(ROWS_AT_ONCE * COLUMNS).enumerate().for_each(|(chunk, lines)| {
        let mut wide = [0.0; ROWS_AT_ONCE * WIDE_COLUMNS];
        for (at, (line, wide)) in lines.chunks_exact_mut(COLUMNS).zip(wide.chunks_exact_mut(WIDE_COLUMNS)).enumerate() {
            let row = chunk * ROWS_AT_ONCE + at;
            fill_line(heads, lobes, row, line);
            let cells = sources.data[row * COARSE_COLUMNS * sources.c..].chunks_exact(sources.c);
            spread_out(cells, 0..WIDE_COLUMNS / COARSE_COLUMNS, wide);
            for (w, [a, b, c, d, e, f, g, h]) in wide.iter_mut().zip(line.as_chunks::<COLUMNS_PER_SOURCE>().0) {
                // The pairwise sum can be vectorised.
                *w += (((a + b) + (c + d)) + ((e + f) + (g + h))) / COLUMNS_PER_SOURCE as f32;
            }
        }
        add_lobes_in_angle(&kernels.rows, floor, &wide, lines);
        each(lines, logarithm);
    });
    (map, computed)
}

/// Adds the side lobes in angle of the sources `wide` and the floor to all cells of `lines`.
fn add_lobes_in_angle(rows: &[f32], floor: f32, wide: &[f32; ROWS_AT_ONCE * WIDE_COLUMNS], lines: &mut [f32]) {
    let simd = Simd::chosen();
    for (block, kernel) in rows.chunks_exact(WIDE_COLUMNS * PRODUCT_COLUMNS).enumerate() {
        let mut lobes = [0.0; ROWS_AT_ONCE * PRODUCT_COLUMNS];
        product(simd, wide, kernel, std::iter::once(0..WIDE_COLUMNS), &mut lobes);
        for (line, lobes) in lines.chunks_exact_mut(COLUMNS).zip(lobes.chunks_exact(PRODUCT_COLUMNS)) {
            let cells = line[block * PRODUCT_COLUMNS * COLUMNS_PER_SOURCE..].chunks_exact_mut(COLUMNS_PER_SOURCE);
            for (cells, lobe) in cells.zip(lobes) {
                cells.iter_mut().for_each(|v| *v += lobe + floor);
            }
        }
    }
}

/// Rows that are decoded together.
const ROWS_AT_ONCE: usize = 8;

const COLUMNS_PER_SOURCE: usize = COLUMNS / WIDE_COLUMNS;

/// Amplitudes of these channels of neighbouring cells, cell after cell.
fn spread_out<'a>(cells: impl Iterator<Item = &'a [f32]>, channels: Range<usize>, out: &mut [f32]) {
    for (out, cell) in out.chunks_exact_mut(channels.len()).zip(cells) {
        out.copy_from_slice(&cell[channels.clone()]);
    }
    each(out, |v| power_of_ten((v * 3.0 - 3.0).clamp(-18.0, 4.0)));
}

fn fill_line(heads: &Plane, lobes: &[f32], row: usize, line: &mut [f32]) {
    spread_out(heads.data[row * FINE_COLUMNS * heads.c..].chunks_exact(heads.c), 0..COLUMNS_PER_FINE, line);
    for (block, line) in line.chunks_exact_mut(PRODUCT_COLUMNS).enumerate() {
        let lobes = &lobes[(block * heads.h + row) * PRODUCT_COLUMNS..][..PRODUCT_COLUMNS];
        line.iter_mut().zip(lobes).for_each(|(sum, lobe)| *sum += lobe);
    }
}

/// Scales decades to the network's input.
fn decades_in(v: f32) -> f32 {
    ((v + 3.0) / 3.0).clamp(-4.0, 2.0)
}

fn fine_in(fine: &[f32], row: usize) -> [[f32; FINE_COLUMNS]; FINE_CHANNELS] {
    std::array::from_fn(|channel| {
        let at = (channel * (fine.len() / FINE_CHANNELS / FINE_COLUMNS) + row) * FINE_COLUMNS;
        let mut line = [0.0; FINE_COLUMNS];
        line.iter_mut().zip(&fine[at..at + FINE_COLUMNS]).for_each(|(to, v)| *to = decades_in(*v));
        line
    })
}

/// Writes a line of the first convolution's input, with channels in the order of `Live.forward` in `python/apertura/live.py`.
fn read_input(input: &LiveInput, scalars: &[f32; SCALARS], row: usize, line: &mut [f32]) {
    const COARSE_AT: usize = FINE_CHANNELS * FOLD;
    const ROWS_AT: usize = COARSE_AT + COARSE_CHANNELS;
    const SCALARS_AT: usize = ROWS_AT + ROW_CHANNELS;
    const GRID_AT: usize = SCALARS_AT + SCALARS;
    const CONSTANTS_AT: usize = GRID_AT + 4;
    let rows = input.rows.len() / ROW_CHANNELS;
    let fine = fine_in(&input.fine, row);
    let coarse: [&[f32]; COARSE_CHANNELS] =
        std::array::from_fn(|c| &input.coarse[(c * rows + row) * COARSE_COLUMNS..][..COARSE_COLUMNS]);
    let mut whole_row = [0.0; INPUT_CHANNELS - ROWS_AT];
    for (c, v) in whole_row[..ROW_CHANNELS].iter_mut().enumerate() {
        let of_row = input.rows[c * rows + row];
        *v = if c < 4 { of_row } else { decades_in(of_row) };
    }
    whole_row[ROW_CHANNELS..GRID_AT - ROWS_AT].copy_from_slice(scalars);
    let range = row as f32;
    whole_row[CONSTANTS_AT - ROWS_AT..].copy_from_slice(&input.constants);
    whole_row[GRID_AT - ROWS_AT..][..2]
        .copy_from_slice(&[range / (rows / 2) as f32 - 1.0, (range + 4.0).log10() - 2.0]);
    let half = (COARSE_COLUMNS / 2) as f32;
    for (k, cell) in line.chunks_exact_mut(INPUT_CHANNELS).enumerate() {
        for (to, plane) in cell.chunks_exact_mut(FOLD).zip(&fine) {
            to.copy_from_slice(&plane[k * FOLD..(k + 1) * FOLD]);
        }
        for (c, (to, plane)) in cell[COARSE_AT..].iter_mut().zip(coarse).enumerate() {
            *to = if c < 4 { decades_in(plane[k]) } else { plane[k] };
        }
        cell[ROWS_AT..].copy_from_slice(&whole_row);
        let u = (k as f32 - half) / half / (1.0 + input.constants[SPACING_INDEX]);
        cell[GRID_AT + 2..CONSTANTS_AT].copy_from_slice(&[u, (1.0 - u * u).max(0.0).sqrt()]);
    }
}

/// Writes a line of the fine convolution's input: the decoder's channels and the fine features.
fn read_fine(fine: &[f32], widened: &Plane, row: usize, line: &mut [f32]) {
    let fine = fine_in(fine, row);
    let cells = widened.data[row * COARSE_COLUMNS * widened.c..]
        .chunks_exact(widened.c)
        .flat_map(|cell| cell.chunks_exact(DECODER_CHANNELS));
    for (k, (cell, from)) in line.chunks_exact_mut(DECODER_CHANNELS + FINE_CHANNELS).zip(cells).enumerate() {
        cell[..DECODER_CHANNELS].copy_from_slice(from);
        cell[DECODER_CHANNELS..].iter_mut().zip(&fine).for_each(|(to, plane)| *to = plane[k]);
    }
}

/// Adds `from` `[h, w, 4 c]`, whose channels are those of 2 x 2 cells one after another, to `to` `[2 h, 2 w, c]`.
fn add_doubled(from: &Plane, to: &mut Plane, c: usize) {
    let (w, width, lanes) = (from.w, to.w, to.c);
    to.data.par_chunks_mut(width * lanes).with_min_len(8).enumerate().for_each(|(y, line)| {
        for (x, cell) in line.chunks_exact_mut(lanes).enumerate() {
            let at = ((y / 2) * w + x / 2) * from.c + (2 * (y % 2) + x % 2) * c;
            cell.iter_mut().zip(&from.data[at..at + c]).for_each(|(v, more)| *v += more);
        }
    });
}
