//! Range profiles to log-magnitude maps in one pass over the rows: the floor is added, and rows are windowed, transformed, rolled and converted to
//! decades while they are in the cache. The ends' transforms skip the zeros among their inputs. Unchanged and empty rows are not transformed.
//!
//! Decades are f32 (error at most 4e-6); those of [`super::LogMap`] are f64.

mod log;
mod normalise;
mod pruned;
mod whole;

pub use normalise::normalise_into;
pub use whole::whole_map;

use super::{LOG_GUARD, LambdaScale, Normalisation};
use crate::radar::{End, Radar};
use crate::signal::Rows;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Real, Simd};
use crate::signal::synthesis::BlockProfiles;
pub use log::silence_decades;
use log::{Extremes, LogScale, log_rolled};
use ndarray::Array2;
use num_complex::Complex;
use pruned::PrunedFft;
use rayon::prelude::*;
use rustfft::Fft;
use std::sync::Arc;

/// Rows that are gathered from the blocks together: neighbours are in the same cache lines and pages.
const GROUP_ROWS: usize = 8;

/// Largest difference between the logarithms of equal cells, decades.
const ROUNDING_DECADES: f32 = 1e-5;

/// `log10(|Y| + guard)`, `[range bins, columns]`, with its extremes.
#[derive(Debug, Clone, PartialEq)]
pub struct FastLogMap {
    pub cells: Array2<f32>,
    pub min: f32,
    pub max: f32,
    rows: Vec<(f32, f32)>,
}

impl FastLogMap {
    /// An empty scene's map.
    pub fn silence(radar: &Radar) -> Self {
        let guard = LOG_GUARD.log10() as f32;
        let cells = Array2::from_elem((radar.samples, radar.elements), guard);
        FastLogMap { cells, min: guard, max: guard, rows: vec![(guard, guard); radar.samples] }
    }

    pub fn scale(&self, normalisation: Normalisation) -> LambdaScale {
        // A map is flat where cells differ only by the rounding of their logarithms.
        let is_flat = self.max - self.min < ROUNDING_DECADES;
        let min = if is_flat { self.max } else { self.min };
        LambdaScale::new(f64::from(min), f64::from(self.max), normalisation)
    }
}

/// The floor's noise: range profiles of unit noise, and the factor of each element's.
#[derive(Debug, Clone, Copy)]
pub struct MapNoise<'a, T, const W: usize> {
    /// Profiles of noise of unit variance.
    pub unit: &'a BlockProfiles<T, W>,
    /// Standard deviation of every element's samples, in blocks.
    pub deviation: &'a [Lanes<T, W>],
}

/// The input of maps: the sum of several profiles and a floor.
#[derive(Debug, Clone, Copy)]
pub struct MapSources<'a, T, const W: usize> {
    pub profiles: &'a [&'a BlockProfiles<T, W>],
    pub noise: Option<MapNoise<'a, T, W>>,
    /// Upper bound of the magnitude of a map's cells; it only sets the scale at which magnitudes are squared.
    pub bound: f64,
}

/// Transforms prepared for one radar.
#[derive(Clone)]
pub struct MapMaker<T: Real, const W: usize> {
    radar: Radar,
    simd: Simd,
    window: Vec<T>,
    fft: Arc<dyn Fft<T>>,
    ends: PrunedFft<T, W>,
}

impl<T: Real, const W: usize> MapMaker<T, W> {
    /// Prepares the transforms of `radar`.
    pub fn new(radar: &Radar, simd: Simd) -> Self {
        let scale = (radar.elements as f64).sqrt().recip();
        let window = radar.window.weights(radar.elements).into_iter().map(|w| T::of(w * scale)).collect();
        let (fft, ends) = (simd.forward_fft(radar.elements), PrunedFft::new(radar, simd));
        MapMaker { radar: radar.clone(), simd, window, fft, ends }
    }

    /// Fills `rows` of the maps that are given: first end, last end, whole array.
    pub fn fill(&self, sources: MapSources<'_, T, W>, maps: [Option<&mut FastLogMap>; 3], rows: &Rows) {
        let columns = self.radar.elements;
        let groups = self.radar.samples.div_ceil(GROUP_ROWS);
        let mut parts: Vec<[Option<Part<'_>>; 3]> = (0..groups).map(|_| [None, None, None]).collect();
        let mut totals = Vec::new();
        for (i, map) in maps.into_iter().enumerate() {
            let Some(FastLogMap { cells, min, max, rows }) = map else { continue };
            if let Some(cells) = cells.as_slice_mut() {
                let chunks = cells.chunks_mut(GROUP_ROWS * columns).zip(rows.chunks_mut(GROUP_ROWS));
                for (part, (cells, extremes)) in parts.iter_mut().zip(chunks) {
                    part[i] = Some(Part { cells, extremes });
                }
            }
            totals.push((i, min, max));
        }
        let found = parts
            .into_par_iter()
            .enumerate()
            .map_init(
                || Scratch {
                    rows: vec![Complex::default(); GROUP_ROWS * columns],
                    fft: vec![Complex::default(); self.fft.get_inplace_scratch_len()],
                },
                |scratch, (group, maps)| self.simd.run(Group { maker: self, sources, rows, group, maps, scratch }),
            )
            .reduce(
                || [(f32::INFINITY, f32::NEG_INFINITY); 3],
                |a, b| [0, 1, 2].map(|i| (a[i].0.min(b[i].0), a[i].1.max(b[i].1))),
            );
        for (i, min, max) in totals {
            (*min, *max) = found[i];
        }
    }
}

struct Part<'a> {
    cells: &'a mut [f32],
    extremes: &'a mut [(f32, f32)],
}

struct Scratch<T> {
    rows: Vec<Complex<T>>,
    fft: Vec<Complex<T>>,
}

struct Group<'a, 'b, T: Real, const W: usize> {
    maker: &'a MapMaker<T, W>,
    sources: MapSources<'a, T, W>,
    rows: &'a Rows,
    group: usize,
    maps: [Option<Part<'b>>; 3],
    scratch: &'b mut Scratch<T>,
}

impl<T: Real, const W: usize> Kernel for Group<'_, '_, T, W> {
    type Output = [(f32, f32); 3];

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let Group { maker, sources, rows, group, mut maps, scratch } = self;
        let (bins, columns) = (maker.radar.samples, maker.radar.elements);
        let first = group * GROUP_ROWS;
        let here = first..bins.min(first + GROUP_ROWS);
        let touches = |p: &BlockProfiles<T, W>| here.clone().any(|bin| p.touched.contains(bin));
        let profiles: Vec<&BlockProfiles<T, W>> = sources.profiles.iter().copied().filter(|p| touches(p)).collect();
        let sources = MapSources { profiles: &profiles, ..sources };
        let has_echo = |bin: usize| sources.noise.is_some() || profiles.iter().any(|p| p.touched.contains(bin));
        let is_nonzero = std::array::from_fn(|i| rows.contains(first + i) && has_echo(first + i));
        gather::<T, W, FMA>(&sources, bins, first, &is_nonzero, columns, &mut scratch.rows);
        let log = LogScale::new(sources.bound);
        let silence = silence_decades(sources.bound);
        for (i, (bin, row)) in here.zip(scratch.rows.chunks_mut(columns)).enumerate() {
            if !rows.contains(bin) {
                continue;
            }
            let cells = i * columns..(i + 1) * columns;
            if !is_nonzero[i] {
                for map in maps.iter_mut().flatten() {
                    map.cells[cells.clone()].fill(silence);
                    map.extremes[i] = (silence, silence);
                }
                continue;
            }
            for (end, which) in End::BOTH.into_iter().zip(0..2) {
                if let Some(map) = &mut maps[which] {
                    let mut extremes = Extremes::new();
                    let inputs = &row[maker.radar.end_range(end)];
                    maker.ends.log_row::<FMA>(inputs, &log, &mut map.cells[cells.clone()], &mut extremes);
                    map.extremes[i] = extremes.reduce();
                }
            }
            if let Some(map) = &mut maps[2] {
                let mut extremes = Extremes::new();
                for (v, w) in row.iter_mut().zip(&maker.window) {
                    *v = Complex::new(v.re * *w, v.im * *w);
                }
                maker.fft.process_with_scratch(row, &mut scratch.fft);
                log_rolled::<T, W, FMA>(row, &log, &mut map.cells[cells], &mut extremes);
                map.extremes[i] = extremes.reduce();
            }
        }
        maps.map(|map| {
            let rows = map.iter().flat_map(|m| m.extremes.iter());
            rows.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), (min, max)| (a.min(*min), b.max(*max)))
        })
    }
}

/// Writes the sums of the sources to `out`, `[rows, elements]`, for those rows from `first` on that are `wanted`.
#[inline(always)]
fn gather<T: Real, const W: usize, const FMA: bool>(
    sources: &MapSources<'_, T, W>,
    bins: usize,
    first: usize,
    wanted: &[bool; GROUP_ROWS],
    columns: usize,
    out: &mut [Complex<T>],
) {
    for block in 0..columns.div_ceil(W) {
        for (i, _) in wanted.iter().enumerate().filter(|(_, wanted)| **wanted) {
            let cell = block * bins + first + i;
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
            let out = &mut out[i * columns + begin..i * columns + end];
            let mut cells = [Complex::<T>::default(); W];
            for (lane, cell) in cells.iter_mut().enumerate() {
                *cell = Complex::new(sum.re.0[lane], sum.im.0[lane]);
            }
            match out.first_chunk_mut::<W>() {
                Some(out) => *out = cells,
                None => out.copy_from_slice(&cells[..end - begin]),
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
    use crate::signal::{SynthesisPlan, exact, synthesis::Synthesis};
    use crate::task::Task;

    fn compare(radar: &Radar, simd: Simd) {
        let scene = Scene::of_points([(1.0, 6.0), (-2.0, 9.5), (4.0, 3.3)]);
        let reflectors = scene.reflectors();
        let expected = LogMaps::of_signal(radar, &exact::beat_signal(radar, &reflectors));
        let plan = SynthesisPlan { simd, ..SynthesisPlan::cheapest(3, 10.0, 1e-15) };
        macro_rules! check {
            ($t:ty, $lanes:expr, $down:expr, $error:expr) => {{
                let mut profiles = BlockProfiles::silence(radar);
                Synthesis::<$t, $lanes>::new(radar, plan).range_profiles(&reflectors, &mut profiles, &Task::default());
                let mut maps = [(); 3].map(|()| FastLogMap::silence(radar));
                let [a, b, c] = &mut maps;
                MapMaker::<$t, $lanes>::new(radar, simd).fill(
                    MapSources { profiles: &[&profiles], noise: None, bound: 1e4 },
                    [Some(a), Some(b), Some(c)],
                    &Rows::all(radar.samples),
                );
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
    fn rows_that_are_left_out_stay() {
        let radar = Radar { elements: 64, samples: 128, end_elements: 4, ..Radar::default() };
        let reflectors = Scene::of_points([(0.1, 1.0)]).reflectors();
        let mut profiles = BlockProfiles::<f64, LANES_F64>::silence(&radar);
        let plan = SynthesisPlan::cheapest(1, 100.0, 1e-3).on_few_rows(&radar, 1);
        Synthesis::new(&radar, plan).range_profiles(&reflectors, &mut profiles, &Task::default());
        let touched = profiles.touched.clone();
        assert!(!touched.is_empty() && touched.count() < 128);
        let maker = MapMaker::new(&radar, Simd::best());
        let sources = MapSources { profiles: &[&profiles], noise: None, bound: 1e4 };
        let mut map = FastLogMap::silence(&radar);
        map.cells.fill(7.0);
        let mut half = Rows::none(128);
        half.insert_wrapped(0.0, 15.0);
        maker.fill(sources, [None, None, Some(&mut map)], &half);
        for (bin, row) in map.cells.outer_iter().enumerate() {
            let expected = if bin > 15 { 7.0 } else { -20.0 };
            let sounds = bin <= 15 && touched.contains(bin);
            // A touched row may yet be empty.
            assert!(row.iter().all(|v| if sounds { *v >= -20.0 && *v < 7.0 } else { *v == expected }), "row {bin}");
        }
        assert!(map.cells.iter().any(|v| *v > -20.0 && *v < 7.0));
        let mut all = FastLogMap::silence(&radar);
        maker.fill(sources, [None, None, Some(&mut all)], &Rows::all(128));
        maker.fill(sources, [None, None, Some(&mut map)], &Rows::all(128));
        assert_eq!(all, map);
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
