//! Range profiles to log-magnitude maps in one pass over the rows: floor added, windowed, transformed, rolled and taken to decades
//! while a row is in the cache; the ends by a transform that knows how few of its inputs are not zero.
//!
//! Decades are kept in f32 (an error of at most 4e-6 decades); [`super::LogMap`] keeps them in f64.

use super::lambda::{LambdaScale, Normalisation, RangeAngleMap};
use super::log_map::LOG_GUARD;
use crate::radar::{End, Radar};
use crate::signal::lane_fft::LaneFft;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Real, Simd};
use crate::signal::synthesis::BlockProfiles;
use ndarray::Array2;
use num_complex::Complex;
use rayon::prelude::*;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Rows that are gathered from the blocks at a time: neighbours share cache lines and pages.
const ROWS: usize = 8;

/// `log10(|Y| + 1e-20)`, `[range bins, columns]`, with its extremes.
#[derive(Debug, Clone, PartialEq)]
pub struct Decades {
    /// The cells.
    pub cells: Array2<f32>,
    /// Smallest cell.
    pub min: f32,
    /// Largest cell.
    pub max: f32,
}

impl Decades {
    /// An empty scene's map.
    pub fn silence(radar: &Radar) -> Self {
        let guard = LOG_GUARD.log10() as f32;
        Decades { cells: Array2::from_elem((radar.samples, radar.elements), guard), min: guard, max: guard }
    }

    /// How the decades become Lambda.
    pub fn scale(&self, normalisation: Normalisation) -> LambdaScale {
        LambdaScale::new(f64::from(self.min), f64::from(self.max), normalisation)
    }

    /// Writes Lambda of every cell to `out`, which has the same shape.
    pub fn normalise_into(&self, normalisation: Normalisation, out: &mut RangeAngleMap) {
        let scale = self.scale(normalisation);
        let range = (scale.peak - scale.floor) as f32;
        let (floor, slope) = (scale.floor as f32, if range > 0.0 { 1.0 / range } else { 0.0 });
        if let (Some(cells), Some(lambda)) = (self.cells.as_slice(), out.lambda.as_slice_mut()) {
            cells.par_chunks(1 << 15).zip(lambda.par_chunks_mut(1 << 15)).for_each(|(cells, lambda)| {
                for (c, l) in cells.iter().zip(lambda) {
                    *l = ((c - floor) * slope).clamp(0.0, 1.0);
                }
            });
        }
    }
}

/// The floor's noise: range profiles of unit noise, and by how much each element's are multiplied.
#[derive(Debug, Clone, Copy)]
pub struct Noise<'a, T, const W: usize> {
    /// Profiles of noise of unit variance.
    pub unit: &'a BlockProfiles<T, W>,
    /// Standard deviation of every element's samples, in blocks.
    pub deviation: &'a [Lanes<T, W>],
}

/// What maps are made of: the sum of several profiles and a floor.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a, T, const W: usize> {
    /// Profiles to be added up.
    pub profiles: &'a [&'a BlockProfiles<T, W>],
    /// The floor, if any.
    pub noise: Option<Noise<'a, T, W>>,
    /// No cell of a map is larger than this; it only sets the scale at which magnitudes are squared.
    pub bound: f64,
}

/// Transforms prepared for one radar.
#[derive(Clone)]
pub struct MapMaker<T: Real, const W: usize> {
    radar: Radar,
    simd: Simd,
    window: Vec<T>,
    fft: Arc<dyn Fft<T>>,
    ends: Pruned<T, W>,
}

impl<T: Real, const W: usize> MapMaker<T, W> {
    /// Prepares the transforms of `radar`.
    pub fn new(radar: &Radar, simd: Simd) -> Self {
        let scale = (radar.elements as f64).sqrt().recip();
        MapMaker {
            radar: radar.clone(),
            simd,
            window: radar.window.weights(radar.elements).into_iter().map(|w| T::of(w * scale)).collect(),
            fft: FftPlanner::new().plan_fft_forward(radar.elements),
            ends: Pruned::new(radar),
        }
    }

    /// Fills the maps that are given: first end, last end, whole array.
    pub fn fill(&self, sources: Sources<'_, T, W>, maps: [Option<&mut Decades>; 3]) {
        let columns = self.radar.elements;
        let groups = self.radar.samples.div_ceil(ROWS);
        let mut rows: Vec<[Option<&mut [f32]>; 3]> = (0..groups).map(|_| [None, None, None]).collect();
        let mut extremes = Vec::new();
        for (i, map) in maps.into_iter().enumerate() {
            extremes.push(map.map(|map| {
                if let Some(cells) = map.cells.as_slice_mut() {
                    for (group, chunk) in rows.iter_mut().zip(cells.chunks_mut(ROWS * columns)) {
                        group[i] = Some(chunk);
                    }
                }
                (&mut map.min, &mut map.max)
            }));
        }
        let found = rows
            .into_par_iter()
            .enumerate()
            .map_init(
                || Scratch {
                    rows: vec![Complex::default(); ROWS * columns],
                    fft: vec![Complex::default(); self.fft.get_inplace_scratch_len()],
                },
                |scratch, (group, maps)| self.simd.run(Group { maker: self, sources, group, maps, scratch }),
            )
            .reduce(
                || [(f32::INFINITY, f32::NEG_INFINITY); 3],
                |a, b| [0, 1, 2].map(|i| (a[i].0.min(b[i].0), a[i].1.max(b[i].1))),
            );
        for (extremes, found) in extremes.into_iter().zip(found) {
            if let Some((min, max)) = extremes {
                (*min, *max) = found;
            }
        }
    }
}

struct Scratch<T> {
    rows: Vec<Complex<T>>,
    fft: Vec<Complex<T>>,
}

struct Group<'a, 'b, T: Real, const W: usize> {
    maker: &'a MapMaker<T, W>,
    sources: Sources<'a, T, W>,
    group: usize,
    maps: [Option<&'b mut [f32]>; 3],
    scratch: &'b mut Scratch<T>,
}

impl<T: Real, const W: usize> Kernel for Group<'_, '_, T, W> {
    /// Smallest and largest cell of each map.
    type Output = [(f32, f32); 3];

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let Group { maker, sources, group, mut maps, scratch } = self;
        let (bins, columns) = (maker.radar.samples, maker.radar.elements);
        let first = group * ROWS;
        let count = ROWS.min(bins - first);
        gather::<T, W, FMA>(&sources, bins, first..first + count, columns, &mut scratch.rows);
        let log = LogScale::new(sources.bound);
        let mut extremes = [Extremes::new(); 3];
        for (i, row) in scratch.rows.chunks_mut(columns).take(count).enumerate() {
            for (end, which) in End::BOTH.into_iter().zip(0..2) {
                if let Some(map) = &mut maps[which] {
                    let out = &mut map[i * columns..(i + 1) * columns];
                    let inputs = &row[maker.radar.end_range(end)];
                    maker.ends.log_row::<FMA>(inputs, &log, out, &mut extremes[which]);
                }
            }
            if let Some(map) = &mut maps[2] {
                let out = &mut map[i * columns..(i + 1) * columns];
                for (v, w) in row.iter_mut().zip(&maker.window) {
                    *v = Complex::new(v.re * *w, v.im * *w);
                }
                maker.fft.process_with_scratch(row, &mut scratch.fft);
                log_rolled::<T, W, FMA>(row, &log, out, &mut extremes[2]);
            }
        }
        extremes.map(|e| e.reduce())
    }
}

/// Adds up the sources of a few rows into `out`, `[rows, elements]`.
#[inline(always)]
fn gather<T: Real, const W: usize, const FMA: bool>(
    sources: &Sources<'_, T, W>,
    bins: usize,
    rows: std::ops::Range<usize>,
    columns: usize,
    out: &mut [Complex<T>],
) {
    for block in 0..columns.div_ceil(W) {
        for (i, bin) in rows.clone().enumerate() {
            let cell = block * bins + bin;
            let mut sum = ComplexLanes::<T, W>::zero();
            for p in sources.profiles {
                sum = sum + p.cells[cell];
            }
            if let Some(noise) = sources.noise {
                let (unit, deviation) = (noise.unit.cells[cell], noise.deviation[block]);
                sum.re = unit.re.mul_add::<FMA>(deviation, sum.re);
                sum.im = unit.im.mul_add::<FMA>(deviation, sum.im);
            }
            let begin = block * W;
            let end = columns.min(begin + W);
            for (lane, v) in out[i * columns + begin..i * columns + end].iter_mut().enumerate() {
                *v = Complex::new(sum.re.0[lane], sum.im.0[lane]);
            }
        }
    }
}

/// The scale at which magnitudes are squared in f32 without overflow, and what it adds to the decades.
#[derive(Debug, Clone, Copy)]
struct LogScale {
    factor: f64,
    guard: f32,
    decades: f32,
}

impl LogScale {
    fn new(bound: f64) -> Self {
        let factor = if bound > 0.0 { 1e15 / bound } else { 1.0 };
        LogScale { factor, guard: (LOG_GUARD * factor) as f32, decades: factor.log10() as f32 }
    }

    /// `log10(|v| + 1e-20)`; exact zeros are -20.
    #[inline(always)]
    fn decades<T: Real, const W: usize, const FMA: bool>(&self, v: ComplexLanes<T, W>) -> Lanes<f32, W> {
        let v = v.scaled(Lanes::splat(T::of(self.factor)));
        let power = v.re.mul_add::<FMA>(v.re, v.im * v.im);
        let mut out = Lanes::splat(0.0);
        for i in 0..W {
            let magnitude = (power.0[i].wide() as f32).sqrt() + self.guard;
            let value = log10::<FMA>(magnitude) - self.decades;
            out.0[i] = if magnitude > 0.0 { value } else { LOG_GUARD.log10() as f32 };
        }
        out
    }
}

/// log10 of a positive normal number, within 4e-6 for results below 32.
///
/// `v = 2^e m` with m in [0.707, 1.414), and `ln m = 2 artanh((m - 1)/(m + 1))` by its series, whose argument is below 0.172.
#[inline(always)]
fn log10<const FMA: bool>(v: f32) -> f32 {
    const HALF_ROOT: i32 = 0x3f35_04f3; // bits of sqrt(1/2)
    let bits = v.to_bits() as i32;
    let exponent = (bits - HALF_ROOT) >> 23;
    let m = f32::from_bits((bits - (exponent << 23)) as u32);
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let fused = |a: f32, b: f32, c: f32| if FMA { a.mul_add(b, c) } else { a * b + c };
    let series = fused(fused(fused(fused(s2, 1.0 / 9.0, 1.0 / 7.0), s2, 1.0 / 5.0), s2, 1.0 / 3.0), s2, 1.0);
    fused(exponent as f32, std::f32::consts::LOG10_2, s * series * (2.0 * std::f32::consts::LOG10_E))
}

#[derive(Debug, Clone, Copy)]
struct Extremes {
    min: Lanes<f32, 8>,
    max: Lanes<f32, 8>,
}

impl Extremes {
    fn new() -> Self {
        Extremes { min: Lanes::splat(f32::INFINITY), max: Lanes::splat(f32::NEG_INFINITY) }
    }

    #[inline(always)]
    fn take<const W: usize>(&mut self, v: Lanes<f32, W>) {
        for (i, v) in v.0.iter().enumerate() {
            let i = i % 8;
            self.min.0[i] = if *v < self.min.0[i] { *v } else { self.min.0[i] };
            self.max.0[i] = if *v > self.max.0[i] { *v } else { self.max.0[i] };
        }
    }

    fn reduce(self) -> (f32, f32) {
        (self.min.0.into_iter().fold(f32::INFINITY, f32::min), self.max.0.into_iter().fold(f32::NEG_INFINITY, f32::max))
    }
}

/// Decades of a transformed row, rolled by half its length.
#[inline(always)]
fn log_rolled<T: Real, const W: usize, const FMA: bool>(
    row: &[Complex<T>],
    log: &LogScale,
    out: &mut [f32],
    extremes: &mut Extremes,
) {
    let half = row.len() / 2;
    let (low, high) = out.split_at_mut(half);
    let (positive, negative) = row.split_at(row.len() - half);
    for (from, to) in [(positive, high), (negative, low)] {
        for (from, to) in from.chunks(W).zip(to.chunks_mut(W)) {
            let mut v = ComplexLanes::<T, W>::zero();
            for (i, (re, im)) in v.re.0.iter_mut().zip(&mut v.im.0).enumerate() {
                // A short last chunk repeats its first cell, so that the extremes stay right.
                let c = from[if i < from.len() { i } else { 0 }];
                (*re, *im) = (c.re, c.im);
            }
            let d = log.decades::<T, W, FMA>(v);
            extremes.take(d);
            to.copy_from_slice(&d.0[..from.len()]);
        }
    }
}

/// Transform of a few inputs padded with zeros: `columns = small * stride` splits into `stride` transforms of `small` points,
/// `X[stride p + q] = sum_n (x[n] w^(n q)) exp(-2 pi j n p / small)`, one lane a `q`.
#[derive(Clone)]
struct Pruned<T: Real, const W: usize> {
    columns: usize,
    /// Window times twiddle: `[q / W][n]`.
    twiddles: Vec<Vec<ComplexLanes<T, W>>>,
    small: LaneFft<T>,
    points: usize,
    /// Where the lengths do not fit: window and plain transform.
    plain: Option<(Vec<T>, Arc<dyn Fft<T>>)>,
}

/// Most points of the small transforms.
const MAX_POINTS: usize = 64;

impl<T: Real, const W: usize> Pruned<T, W> {
    fn new(radar: &Radar) -> Self {
        let (inputs, columns) = (radar.end_elements, radar.elements);
        let points = inputs.next_power_of_two();
        let scale = (columns as f64).sqrt().recip();
        let window: Vec<f64> = radar.window.weights(inputs).into_iter().map(|w| w * scale).collect();
        let fits = points <= MAX_POINTS && columns.is_multiple_of(2 * points * W);
        let stride = columns / points;
        let twiddle = |n: usize, q: usize| {
            let (sin, cos) = (-std::f64::consts::TAU * (n * q) as f64 / columns as f64).sin_cos();
            (window[n] * cos, window[n] * sin)
        };
        let chunk = |begin: usize| {
            let lanes = |n: usize, part: fn((f64, f64)) -> f64| {
                Lanes(std::array::from_fn(|i| T::of(part(twiddle(n, begin + i)))))
            };
            (0..inputs).map(|n| ComplexLanes { re: lanes(n, |t| t.0), im: lanes(n, |t| t.1) }).collect()
        };
        Pruned {
            columns,
            twiddles: if fits { (0..stride).step_by(W).map(chunk).collect() } else { Vec::new() },
            small: LaneFft::new(points),
            points,
            plain: (!fits)
                .then(|| (window.iter().map(|w| T::of(*w)).collect(), FftPlanner::new().plan_fft_forward(columns))),
        }
    }

    /// Decades of the rolled transform of `inputs`.
    #[inline(always)]
    fn log_row<const FMA: bool>(
        &self,
        inputs: &[Complex<T>],
        log: &LogScale,
        out: &mut [f32],
        extremes: &mut Extremes,
    ) {
        if let Some((window, fft)) = &self.plain {
            let mut row = vec![Complex::default(); self.columns];
            for ((v, x), w) in row.iter_mut().zip(inputs).zip(window) {
                *v = Complex::new(x.re * *w, x.im * *w);
            }
            fft.process(&mut row);
            return log_rolled::<T, W, FMA>(&row, log, out, extremes);
        }
        let stride = self.columns / self.points;
        let mut data = [ComplexLanes::<T, W>::zero(); MAX_POINTS];
        let mut spare = [ComplexLanes::<T, W>::zero(); MAX_POINTS];
        for (chunk, twiddles) in self.twiddles.iter().enumerate() {
            for ((d, x), t) in data.iter_mut().zip(inputs).zip(twiddles) {
                let x = ComplexLanes { re: Lanes::splat(x.re), im: Lanes::splat(x.im) };
                *d = t.times::<FMA>(x);
            }
            data[inputs.len()..self.points].fill(ComplexLanes::zero());
            self.small.process::<W, FMA>(&mut data[..self.points], &mut spare[..self.points]);
            for (p, v) in data[..self.points].iter().enumerate() {
                let column = (stride * p + chunk * W + self.columns / 2) % self.columns;
                let d = log.decades::<T, W, FMA>(*v);
                extremes.take(d);
                out[column..column + W].copy_from_slice(&d.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::LogMaps;
    use crate::radar::WindowFunction;
    use crate::scene::Scene;
    use crate::signal::simd::{LANES_F32, LANES_F64};
    use crate::signal::{Recipe, exact, synthesis::Synthesis};

    #[test]
    fn log10_is_within_four_millionths() {
        let mut v = 1e-31f32;
        while v < 1e16 {
            for got in [log10::<true>(v), log10::<false>(v)] {
                assert!((f64::from(got) - f64::from(v).log10()).abs() < 4e-6, "{v:e}: {got}");
            }
            v *= 1.000_37;
        }
    }

    fn compare(radar: &Radar, simd: Simd) {
        let scene = Scene::of_points([(1.0, 6.0), (-2.0, 9.5), (4.0, 3.3)]);
        let reflectors = scene.reflectors();
        let expected = LogMaps::of_signal(radar, &exact::beat_signal(radar, &reflectors));
        let recipe = Recipe { simd, ..Recipe::plan(3, 10.0, 1e-15) };
        macro_rules! check {
            ($t:ty, $lanes:expr, $down:expr, $error:expr) => {{
                let mut profiles = BlockProfiles::silence(radar);
                Synthesis::<$t, $lanes>::new(radar, recipe).range_profiles(&reflectors, &mut profiles);
                let mut maps = [(); 3].map(|()| Decades::silence(radar));
                let [a, b, c] = &mut maps;
                MapMaker::<$t, $lanes>::new(radar, simd)
                    .fill(Sources { profiles: &[&profiles], noise: None, bound: 1e4 }, [Some(a), Some(b), Some(c)]);
                for (fast, slow) in maps.iter().zip([&expected.first, &expected.last, &expected.full]) {
                    for (f, s) in fast.cells.iter().zip(slow.decades()) {
                        if *s > slow.max() - $down {
                            assert!((f64::from(*f) - s).abs() < $error, "{} {simd:?}: {f} for {s}", stringify!($t));
                        }
                    }
                    assert!((f64::from(fast.max) - slow.max()).abs() < 1e-5);
                    assert_eq!(fast.min, fast.cells.iter().copied().fold(f32::INFINITY, f32::min));
                }
            }};
        }
        check!(f64, LANES_F64, 11.0, 1e-3);
        check!(f32, LANES_F32, 4.0, 1e-2);
    }

    #[test]
    fn fast_maps_agree_with_plain_ones_on_every_instruction_set() {
        for simd in Simd::available() {
            compare(&Radar::default(), simd);
            let small = Radar { elements: 90, samples: 60, end_elements: 7, ..Radar::default() };
            compare(&small, simd);
            compare(&Radar { window: WindowFunction::Hamming, elements: 256, samples: 64, ..small }, simd);
        }
    }
}
