//! Block algorithms over the whole array: elements in blocks of one vector, blocks in parallel. Results do not depend on the number of threads.

use super::block_echoes::BlockEchoes;
use super::closed_form::ClosedForm;
use super::floor::unit_noise;
use super::gridded::{self, Gridding};
use super::lane_fft::LaneFft;
use super::phase::EchoModel;
use super::plan::BEST_TOLERANCE;
use super::simd::{ComplexLanes, Kernel, Lanes, Real, Simd};
use super::{Algorithm, Rows, SynthesisPlan, split};
use crate::radar::{BuiltArray, Radar};
use crate::scattering::Sources;
use crate::task::Task;
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;
use std::ops::Range;

/// Windowed range profiles of the whole array, `[block of W elements][range bin]`: one lane an element, meaningless past the last.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockProfiles<T, const W: usize> {
    pub bins: usize,
    pub cells: Vec<ComplexLanes<T, W>>,
    /// Range bins that may be non-zero.
    pub touched: Rows,
}

impl<T: Real, const W: usize> BlockProfiles<T, W> {
    pub fn silence(radar: &Radar) -> Self {
        let bins = radar.samples;
        BlockProfiles {
            bins,
            // Allocated in parallel: most of the time is that of the first access to memory pages.
            cells: rayon::iter::repeat_n(ComplexLanes::zero(), bins * radar.elements.div_ceil(W)).collect(),
            touched: Rows::none(bins),
        }
    }

    pub fn clear(&mut self) {
        let bins = self.bins;
        let runs = std::mem::replace(&mut self.touched, Rows::none(bins)).runs();
        self.cells.par_chunks_mut(bins).for_each(|cells| {
            runs.iter().for_each(|run| cells[run.clone()].fill(ComplexLanes::zero()));
        });
    }

    /// Range profile of one element, `[range bins]`; `None` past the last block.
    pub fn profile(&self, element: usize) -> Option<Vec<Complex64>> {
        let (block, lane) = (element / W, element % W);
        let cells = self.cells.get(block * self.bins..(block + 1) * self.bins)?;
        Some(cells.iter().map(|c| Complex64::new(c.re.0[lane].wide(), c.im.0[lane].wide())).collect())
    }

    /// Adds (`sign` = 1) or subtracts (`sign` = -1) other profiles.
    pub fn add(&mut self, other: &Self, sign: f64) {
        let sign = Lanes::splat(T::of(sign));
        let bins = self.bins;
        self.touched.extend(&other.touched);
        let runs = other.touched.runs();
        self.cells.par_chunks_mut(bins).zip(other.cells.par_chunks(bins)).for_each(|(a, b)| {
            for run in &runs {
                a[run.clone()].iter_mut().zip(&b[run.clone()]).for_each(|(a, b)| *a = *a + b.scaled(sign));
            }
        });
    }
}

/// A plan prepared for one radar.
#[derive(Clone)]
pub struct Synthesis<T: Real, const W: usize> {
    model: EchoModel,
    radar: Radar,
    array: BuiltArray,
    plan: SynthesisPlan,
    method: Method<T>,
    window: Vec<T>,
    fft: LaneFft<T>,
}

#[derive(Clone)]
enum Method<T: Real> {
    Split,
    Gridded(Gridding<T>),
    ClosedForm(ClosedForm<T>),
}

enum Scratch<T, const W: usize> {
    Split(split::SplitScratch<T, W>),
    Gridded(gridded::GriddedScratch<T, W>, Vec<ComplexLanes<T, W>>),
}

struct Block<'a, 'b, T: Real, const W: usize> {
    synthesis: &'a Synthesis<T, W>,
    echoes: &'a BlockEchoes<'a, W>,
    scratch: &'b mut Scratch<T, W>,
}

impl<'b, T: Real, const W: usize> Block<'_, 'b, T, W> {
    #[inline(always)]
    fn samples<const FMA: bool>(self) -> &'b mut [ComplexLanes<T, W>] {
        let Block { synthesis, echoes, scratch } = self;
        match (scratch, &synthesis.method) {
            (Scratch::Gridded(scratch, out), Method::Gridded(gridding)) => {
                gridded::block_signal::<T, W, FMA>(gridding, echoes, scratch, out);
                out
            }
            (Scratch::Split(scratch), _) => split::block_signal::<T, W, FMA>(echoes, synthesis.radar.samples, scratch),
            (Scratch::Gridded(_, out), _) => out,
        }
    }
}

struct ToRows<'a, 'b, T: Real, const W: usize>(Block<'a, 'b, T, W>, &'b mut [Complex64]);

impl<T: Real, const W: usize> Kernel for ToRows<'_, '_, T, W> {
    type Output = ();
    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let samples = self.0.synthesis.radar.samples;
        let block = self.0.samples::<FMA>();
        for (lane, row) in self.1.chunks_mut(samples).enumerate() {
            for (out, v) in row.iter_mut().zip(block.iter()) {
                *out = Complex64::new(v.re.0[lane].wide(), v.im.0[lane].wide());
            }
        }
    }
}

struct ToProfiles<'a, 'b, T: Real, const W: usize>(
    &'a Synthesis<T, W>,
    Option<Block<'a, 'b, T, W>>,
    &'b mut [ComplexLanes<T, W>],
    &'b mut Vec<ComplexLanes<T, W>>,
);

impl<T: Real, const W: usize> Kernel for ToProfiles<'_, '_, T, W> {
    type Output = ();
    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let ToProfiles(synthesis, block, cells, spare) = self;
        if let Some(block) = block {
            cells.copy_from_slice(block.samples::<FMA>());
        }
        for (cell, window) in cells.iter_mut().zip(&synthesis.window) {
            *cell = cell.scaled(Lanes::splat(*window));
        }
        synthesis.fft.process::<W, FMA>(cells, spare);
    }
}

struct AddProfiles<'a, 'b, T: Real, const W: usize> {
    plan: &'a ClosedForm<T>,
    echoes: &'a BlockEchoes<'a, W>,
    quiet: f64,
    cells: &'b mut [ComplexLanes<T, W>],
}

impl<T: Real, const W: usize> Kernel for AddProfiles<'_, '_, T, W> {
    type Output = ();
    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.plan.add_block::<W, FMA>(self.echoes, self.quiet, self.cells);
    }
}

impl<T: Real, const W: usize> Synthesis<T, W> {
    /// Prepares `plan` for `radar`; algorithms other than [`Algorithm::Gridded`] and [`Algorithm::ClosedForm`] are evaluated by phasor split.
    pub fn new(radar: &Radar, plan: SynthesisPlan) -> Self {
        let scale = (radar.samples as f64).sqrt().recip();
        Synthesis {
            model: EchoModel::new(radar),
            radar: radar.clone(),
            array: BuiltArray::default(),
            plan,
            method: match plan.algorithm {
                Algorithm::Gridded => Method::Gridded(Gridding::new(radar, plan.tolerance)),
                Algorithm::ClosedForm => {
                    ClosedForm::new(radar, plan.tolerance).map_or(Method::Split, Method::ClosedForm)
                }
                Algorithm::Direct | Algorithm::Exact | Algorithm::Split => Method::Split,
            },
            window: radar.window.weights(radar.samples).into_iter().map(|w| T::of(w * scale)).collect(),
            fft: LaneFft::new(radar.samples),
        }
    }

    /// The synthesis at the true element positions of `array`.
    pub fn at(self, array: &BuiltArray) -> Self {
        Synthesis { array: array.clone(), ..self }
    }

    fn echoes<'a>(&'a self, sources: Sources<'a>, first_element: usize) -> BlockEchoes<'a, W> {
        BlockEchoes::new(&self.model, sources, |lane| self.array.pair(&self.radar, first_element + lane))
    }

    pub fn plan(&self) -> &SynthesisPlan {
        &self.plan
    }

    fn simd(&self) -> Simd {
        self.plan.simd
    }

    fn scratch(&self) -> Scratch<T, W> {
        let samples = self.radar.samples;
        match self.method {
            Method::Gridded(_) => {
                Scratch::Gridded(gridded::GriddedScratch::new(samples), vec![ComplexLanes::zero(); samples])
            }
            Method::Split | Method::ClosedForm(_) => Scratch::Split(split::SplitScratch::new(samples)),
        }
    }

    /// Samples of neighbouring elements, `[elements, samples]`; incomplete after a cancellation of `task`.
    pub fn samples<'a>(
        &self,
        sources: impl Into<Sources<'a>>,
        elements: Range<usize>,
        task: &Task,
    ) -> Array2<Complex64> {
        let sources = sources.into();
        let mut out = Array2::zeros((elements.len(), self.radar.samples));
        out.axis_chunks_iter_mut(Axis(0), W).into_par_iter().enumerate().for_each_init(
            || self.scratch(),
            |scratch, (block, mut rows)| {
                if let (Some(rows), false) = (rows.as_slice_mut(), task.is_cancelled()) {
                    let echoes = &self.echoes(sources, elements.start + block * W);
                    self.simd().run(ToRows(Block { synthesis: self, echoes, scratch }, rows));
                }
            },
        );
        out
    }

    /// Windowed range profiles of every element, written over `out`; incomplete after a cancellation of `task`.
    pub fn range_profiles<'a>(&self, sources: impl Into<Sources<'a>>, out: &mut BlockProfiles<T, W>, task: &Task) {
        self.range_profiles_beside(sources, 0.0, out, task);
    }

    /// As [`Synthesis::range_profiles`], for a part of a scene's echoes. The error of each is at most the plan's tolerance times its amplitude, or
    /// times `quiet` where that is larger. If `quiet` is the mean amplitude of all echoes, the error of the sum at most doubles. Only the closed form
    /// uses it.
    pub fn range_profiles_beside<'a>(
        &self,
        sources: impl Into<Sources<'a>>,
        quiet: f64,
        out: &mut BlockProfiles<T, W>,
        task: &Task,
    ) {
        let (sources, bins) = (sources.into(), self.radar.samples);
        if sources.is_empty() {
            return out.clear();
        }
        if let Method::ClosedForm(plan) = &self.method {
            let before = out.touched.runs();
            let fill = |(block, cells): (usize, &mut [ComplexLanes<T, W>])| {
                before.iter().for_each(|run| cells[run.clone()].fill(ComplexLanes::zero()));
                let mut rows = Rows::none(bins);
                if task.is_cancelled() {
                    return rows;
                }
                let echoes = &self.echoes(sources, block * W);
                plan.add_path_rows(&self.radar, &echoes.paths, quiet, &mut rows);
                self.simd().run(AddProfiles { plan, echoes, quiet, cells });
                rows
            };
            let joined = |mut rows: Rows, others: Rows| {
                rows.extend(&others);
                rows
            };
            let path_rows = out.cells.par_chunks_mut(bins).enumerate().map(fill).reduce(|| Rows::none(bins), joined);
            let point_rows = plan.rows(&self.radar, sources.points, self.radar.elements.next_multiple_of(W));
            out.touched = joined(point_rows, path_rows);
            return;
        }
        out.touched = Rows::all(bins);
        out.cells.par_chunks_mut(bins).enumerate().for_each_init(
            || (self.scratch(), vec![ComplexLanes::zero(); bins]),
            |(scratch, spare), (block, cells)| {
                if task.is_cancelled() {
                    return;
                }
                let block = Block { synthesis: self, echoes: &self.echoes(sources, block * W), scratch };
                self.simd().run(ToProfiles(self, Some(block), cells, spare));
            },
        );
    }
}

/// Windowed range profiles of white noise of unit variance: [`super::floor::unit_noise`] of every element.
pub fn unit_noise_profiles<T: Real, const W: usize>(radar: &Radar, seed: u64) -> BlockProfiles<T, W> {
    let synthesis = Synthesis::<T, W>::new(radar, SynthesisPlan::cheapest(0, 0.0, BEST_TOLERANCE));
    let mut out = BlockProfiles::silence(radar);
    out.touched = Rows::all(radar.samples);
    let bins = radar.samples;
    out.cells.par_chunks_mut(bins).enumerate().for_each_init(
        || vec![ComplexLanes::zero(); bins],
        |spare, (block, cells)| {
            for lane in 0..W {
                for (cell, noise) in cells.iter_mut().zip(unit_noise(seed, block * W + lane)) {
                    (cell.re.0[lane], cell.im.0[lane]) = (T::of(noise.re), T::of(noise.im));
                }
            }
            synthesis.simd().run(ToProfiles(&synthesis, None, cells, spare));
        },
    );
    out
}
