//! Range profiles of few reflectors in closed form, without samples or transform, on the rows where they exceed the tolerance.
//!
//! The symmetric Hann window is a constant and two cosines, so a reflector's windowed range profile is three Dirichlet kernels, `N/(N-1)`
//! bins apart. With `d` the distance from its range to the bin in bins, `x = pi d / N` and `a = pi / (N-1)` they add up to
//!
//! ```text
//! Y = A / sqrt(N) * exp(2 pi j c) * (z - 1) / 2j * g,    z = exp(2 pi j d (N-1) / N),
//! g = cos x / (2 sin x (1 - sin^2 x / sin^2 a))
//! ```
//!
//! without cancellation except at the kernels' centres, `d = 0` and `d = +-N/(N-1)`, around which `z - 1` and the small factor of `g` are
//! expanded together. Side lobes fall as `1 / (pi d^3)` of the peak: 12 bins on each side for 1e-3, 110 for 1e-6.

use super::block_echoes::BlockEchoes;
use super::path::{Path, range_span_metres};
use super::phase::EchoLanes;
use super::rows::Rows;
use super::simd::{ComplexLanes, Lanes, Real, horner, phasor};
use crate::radar::{Radar, WindowFunction};
use crate::scene::Reflector;
use num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// Least samples for which the kernels' centres are apart from their periodic repetitions.
const MIN_SAMPLES: usize = 8;
/// Bins on each side of the peak that contain the kernels' centres.
const PEAK_BINS: f64 = 1.5;

/// Bins on each side of a reflector's range where its profile exceeds a quarter of `tolerance` times its peak: the errors of many add up.
pub fn reach(tolerance: f64) -> usize {
    (PI / 4.0 * tolerance.max(1e-18)).cbrt().recip().ceil() as usize + 1
}

/// Whether `radar` has a closed form: at least [`MIN_SAMPLES`] under a Hann window.
pub fn applies(radar: &Radar) -> bool {
    radar.samples >= MIN_SAMPLES && radar.window == WindowFunction::Hann
}

/// The closed form prepared for one radar and tolerance.
#[derive(Debug, Clone)]
pub struct ClosedForm<T> {
    samples: usize,
    tolerance: f64,
    reach: usize,
    /// `exp(2 pi j n / samples)`.
    turns: Vec<Complex<T>>,
    /// `pi / (samples - 1)`: distance from the middle kernel to its neighbours.
    edge: f64,
}

impl<T: Real> ClosedForm<T> {
    /// Prepares for `radar`. Neglected cells are below `tolerance` times a reflector's peak. `None` where it does not apply ([`applies`]).
    pub fn new(radar: &Radar, tolerance: f64) -> Option<Self> {
        let samples = radar.samples;
        let turn = |n: usize| {
            let (sin, cos) = (TAU * n as f64 / samples as f64).sin_cos();
            Complex::new(T::of(cos), T::of(sin))
        };
        applies(radar).then(|| ClosedForm {
            samples,
            tolerance,
            reach: reach(tolerance).min(samples),
            turns: (0..samples).map(turn).collect(),
            edge: PI / (samples - 1) as f64,
        })
    }

    /// Every row that [`ClosedForm::add_block`] may write to for these reflectors, for elements up to `elements`, in blocks of any width.
    pub fn rows(&self, radar: &Radar, reflectors: &[Reflector], elements: usize) -> Rows {
        let mut rows = Rows::none(self.samples);
        for r in reflectors {
            self.add_rows(radar, range_span_metres(radar, elements, r), self.reach, &mut rows);
        }
        rows
    }

    /// Adds the rows that [`ClosedForm::add_block`] may write to for `paths`.
    pub(super) fn add_path_rows<const W: usize>(&self, radar: &Radar, paths: &[Path<W>], quiet: f64, rows: &mut Rows) {
        for path in paths {
            let Some(reach) = self.reach_of(&path.amplitude, quiet) else { continue };
            self.add_rows(radar, path.range_metres.hi.bounds(), reach, rows);
        }
    }

    /// Bins on each side of an echo's range where it exceeds the tolerance times its amplitude, or times `quiet` if larger; `None` for nowhere.
    #[inline(always)]
    fn reach_of<const W: usize>(&self, amplitude: &Lanes<f64, W>, quiet: f64) -> Option<usize> {
        let strongest = amplitude.0.iter().fold(0.0f64, |m, a| m.max(a.abs()));
        if strongest >= quiet {
            return Some(self.reach);
        }
        let tolerance = self.tolerance * (quiet / strongest);
        (tolerance < 4.0).then(|| reach(tolerance).min(self.reach))
    }

    /// Adds the rows around ranges from the nearest to the farthest, in metres.
    fn add_rows(&self, radar: &Radar, (nearest, farthest): (f64, f64), reach: usize, rows: &mut Rows) {
        let bins = |metres: f64| metres / radar.range_resolution_metres();
        // Rounding of a very far range may be whole bins.
        let unsure = 2.0 + bins(farthest) * 1e-15;
        let margin = reach as f64 + unsure;
        rows.insert_wrapped((bins(nearest) - margin).floor(), (bins(farthest) + margin).ceil());
    }

    /// Adds the range profiles of `echoes` to `cells`, `[range bins]`; errors are at most the tolerance times the amplitude, or `quiet` if larger.
    #[inline(always)]
    pub(super) fn add_block<const W: usize, const FMA: bool>(
        &self,
        echoes: &BlockEchoes<'_, W>,
        quiet: f64,
        cells: &mut [ComplexLanes<T, W>],
    ) {
        for i in 0..echoes.len() {
            let echo = echoes.echo::<FMA>(i);
            if let Some(reach) = self.reach_of(&echo.amplitude, quiet) {
                self.add::<W, FMA>(&echo, reach as isize, cells);
            }
        }
    }

    #[inline(always)]
    fn add<const W: usize, const FMA: bool>(&self, echo: &EchoLanes<W>, reach: isize, out: &mut [ComplexLanes<T, W>]) {
        let of = Lanes::<f64, W>::splat;
        let bins = self.samples as f64;
        let position = echo.position_in(bins);
        let middle = position.0[0].round();
        let offset = (position - of(middle)) + echo.beat_turns_low * of(bins);

        let sin_edge = self.edge.sin();
        let amplitude = echo.amplitude * of(bins.sqrt().recip());
        let carrier = phasor::<T, W, FMA>(echo.carrier_turns).scaled(amplitude.round_to());
        // Carrier over 2j, and the factors of g that do not depend on the bin.
        let still = ComplexLanes { re: carrier.im, im: -carrier.re }.scaled(Lanes::splat(T::of(0.25 / sin_edge)));
        let turning = still.times::<FMA>(phasor::<T, W, FMA>(offset * of((bins - 1.0) / bins)));

        let (lowest, highest) = offset.bounds();
        let (first, last) = (lowest.floor() as isize - reach, highest.ceil() as isize + reach);
        let (first, last) = match last - first < self.samples as isize {
            true => (first, last),
            false => (-(self.samples as isize / 2), (self.samples - self.samples / 2) as isize - 1),
        };
        let narrow: Lanes<T, W> = offset.round_to();
        let mut bin = (middle as isize + first).rem_euclid(self.samples as isize) as usize;
        let mut turn = first.rem_euclid(self.samples as isize) as usize;
        for j in first..=last {
            let w = self.turns[turn];
            let turned = turning.times::<FMA>(ComplexLanes::splat(w));
            let distance = narrow - Lanes::splat(T::of(j as f64));
            let mut value = (turned - still).scaled(far::<T, W, FMA>(distance, bins, sin_edge));
            if (j as f64) > lowest - PEAK_BINS && (j as f64) < highest + PEAK_BINS {
                let exact = offset - of(j as f64);
                let near = self.near::<W, FMA>(exact, carrier);
                for i in 0..W {
                    if exact.0[i].abs() < PEAK_BINS {
                        (value.re.0[i], value.im.0[i]) = (near.re.0[i], near.im.0[i]);
                    }
                }
            }
            out[bin] = out[bin] + value;
            bin = if bin + 1 == self.samples { 0 } else { bin + 1 };
            turn = if turn + 1 == self.samples { 0 } else { turn + 1 };
        }
    }

    /// The profile less than [`PEAK_BINS`] from the peak, expanded around the nearest of the three kernels' centres.
    #[inline(always)]
    fn near<const W: usize, const FMA: bool>(
        &self,
        distance: Lanes<f64, W>,
        carrier: ComplexLanes<T, W>,
    ) -> ComplexLanes<T, W> {
        let of = Lanes::<f64, W>::splat;
        let bins = self.samples as f64;
        let centre = distance.nearest().map(|v| v.clamp(-1.0, 1.0));
        // At a centre itself both factors are zero; their ratio is that of any small distance.
        let rest = (distance - centre * of(bins / (bins - 1.0))).map(|e| if e.abs() < 1e-30 { 1e-30 } else { e });
        let wave = phasor::<T, W, FMA>(rest * of((bins - 1.0) / (2.0 * bins)));
        let small = phasor::<T, W, FMA>(rest * of(0.5 / bins));
        let side: Lanes<T, W> = centre.round_to();
        let splat = |v: f64| Lanes::splat(T::of(v));
        // Sine and cosine of a +- x, and the sine of 2a +- x.
        let toward = side * small.im;
        let (sin, cos) = self.edge.sin_cos();
        let (double_sin, double_cos) = (2.0 * self.edge).sin_cos();
        let outer_sin = small.re * splat(sin) + toward * splat(cos);
        let outer_cos = small.re * splat(cos) - toward * splat(sin);
        let other_sin = small.re * splat(double_sin) + toward * splat(double_cos);
        let square = splat(sin * sin);
        let middle = square * small.re;
        let middle_below = square - small.im * small.im;
        let outer = -(square * outer_cos);
        let outer_below = outer_sin * other_sin;
        let mut factor = Lanes::splat(T::default());
        for i in 0..W {
            let ratio = wave.im.0[i] / small.im.0[i];
            let at_middle = side.0[i] == T::default();
            let (above, below) = match at_middle {
                true => (middle.0[i], middle_below.0[i]),
                false => (outer.0[i], outer_below.0[i]),
            };
            factor.0[i] = ratio * above / below;
        }
        carrier.times::<FMA>(wave).scaled(factor * splat(0.5))
    }
}

/// `cos x / (q (1 - q^2))` with `q = sin x / sin a`, away from the kernels' centres.
#[inline(always)]
fn far<T: Real, const W: usize, const FMA: bool>(distance: Lanes<T, W>, bins: f64, sin_edge: f64) -> Lanes<T, W> {
    let splat = |v: f64| Lanes::<T, W>::splat(T::of(v));
    let turns = distance * splat(0.5 / bins);
    let square = turns * turns;
    let cos = horner::<T, W, FMA>(T::COS, square);
    let q = turns * horner::<T, W, FMA>(T::SIN, square) * splat(1.0 / sin_edge);
    let below = q - q * q * q;
    cos.zip(below, |a, b| a / b)
}

#[cfg(test)]
mod tests {
    use super::super::algorithm::{Algorithm, Precision};
    use super::super::exact;
    use super::super::plan::SynthesisPlan;
    use super::super::simd::{LANES_F32, LANES_F64, Simd};
    use super::super::synthesis::{BlockProfiles, Synthesis};
    use super::*;
    use crate::scattering::{EchoSources, Sources};
    use crate::scene::{Block, Object, Point, Post, Scene};
    use crate::task::Task;
    use ndarray::{Array1, Array2};
    use num_complex::Complex64;

    fn profiles_of(radar: &Radar, mut samples: Array2<Complex64>) -> Array2<Complex64> {
        let scale = (radar.samples as f64).sqrt().recip();
        let window = radar.window.weights(radar.samples);
        let fft = rustfft::FftPlanner::new().plan_fft_forward(radar.samples);
        for mut row in samples.outer_iter_mut() {
            let mut profile: Vec<Complex64> = row.iter().zip(&window).map(|(v, w)| v * w * scale).collect();
            fft.process(&mut profile);
            row.assign(&Array1::from(profile));
        }
        samples
    }

    /// Largest error of a cell relative to the largest cell, by either precision.
    fn error<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, plan: SynthesisPlan) -> f64 {
        let reflectors = sources.into();
        let expected = profiles_of(radar, exact::beat_signal(radar, reflectors).samples);
        let peak = expected.iter().fold(0.0f64, |m, v| m.max(v.norm()));
        let worst = |profile: &dyn Fn(usize) -> Vec<num_complex::Complex64>| {
            let of = |n: usize| profile(n).iter().zip(expected.row(n)).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            (0..radar.elements).map(of).fold(0.0, f64::max) / peak
        };
        match plan.precision {
            Precision::F32 => {
                let mut out = BlockProfiles::silence(radar);
                Synthesis::<f32, LANES_F32>::new(radar, plan).range_profiles(reflectors, &mut out, &Task::default());
                worst(&|n| out.profile(n).unwrap())
            }
            Precision::F64 => {
                let mut out = BlockProfiles::silence(radar);
                Synthesis::<f64, LANES_F64>::new(radar, plan).range_profiles(reflectors, &mut out, &Task::default());
                worst(&|n| out.profile(n).unwrap())
            }
        }
    }

    fn plan(tolerance: f64, simd: Simd) -> SynthesisPlan {
        SynthesisPlan { simd, ..SynthesisPlan::cheapest(1, 1.0, tolerance) }.with_algorithm(Algorithm::ClosedForm)
    }

    #[test]
    fn profiles_equal_the_windowed_transform_of_samples() {
        let radar = Radar { elements: 90, ..Radar::default() };
        let max = radar.max_range_metres();
        for (x, y) in [(0.5, 9.0), (-20.0, 3.0), (0.02, 0.001), (3.0, max - 0.01), (0.1, -4.0), (1e5, 1e4)] {
            let reflectors = Scene::of_points([(x, y)]).reflectors();
            for simd in Simd::available() {
                for tolerance in [1e-3, 1e-6, 1e-9, 1e-14] {
                    let e = error(&radar, &reflectors, plan(tolerance, simd));
                    assert!(e < tolerance, "({x}, {y}) at {tolerance:e} with {simd:?}: {e:e}");
                }
            }
        }
    }

    #[test]
    fn profiles_of_bodies_equal_the_windowed_transform_of_samples() {
        let radar = Radar { elements: 90, ..Radar::default() };
        let objects = vec![
            Object::Box(Block::new([1.0, 9.0], [4.5, 1.8], 80.0)),
            Object::Post(Post::new(-2.0, 12.0, 0.2)),
            Object::Point(Point::new(1.5, 25.0)),
        ];
        let echoing = EchoSources::of(&radar, &Scene { objects, ..Scene::default() });
        for tolerance in [1e-3, 1e-6, 1e-12] {
            let e = error(&radar, &echoing, plan(tolerance, Simd::best()));
            assert!(e < tolerance, "{tolerance:e}: {e:e}");
        }
    }

    #[test]
    fn quiet_echoes_write_fewer_rows_within_the_tolerance() {
        let radar = Radar { elements: 90, ..Radar::default() };
        let objects = vec![
            Object::Point(Point::new(1.5, 25.0)),
            Object::Point(Point { reflectivity: 1e-4, ..Point::new(0.5, 6.0) }),
            Object::Box(Block::new([1.0, 20.0], [1.5, 0.8], 80.0)),
        ];
        let echoing = EchoSources::of(&radar, &Scene { objects, ..Scene::default() });
        let amplitude = crate::signal::plan::amplitude_bound(&radar, &echoing);
        let quiet = amplitude / echoing.len() as f64;
        for tolerance in [1e-3, 1e-6] {
            let synthesis = Synthesis::<f64, LANES_F64>::new(&radar, plan(tolerance, Simd::best()));
            let [mut all, mut few] = [(); 2].map(|()| BlockProfiles::silence(&radar));
            synthesis.range_profiles(&echoing, &mut all, &Task::default());
            synthesis.range_profiles_beside(&echoing, quiet, &mut few, &Task::default());
            let of = |n: usize| all.profile(n).unwrap().into_iter().zip(few.profile(n).unwrap());
            let worst = (0..radar.elements).flat_map(of).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            // The peak of an echo of amplitude 1 is the window's sum over the root of the samples.
            let scale = amplitude * (radar.samples as f64).sqrt() / 2.0;
            assert!(worst > 0.0 && worst < tolerance / 2.0 * scale, "{tolerance:e}: {:e}", worst / scale);
            assert!(few.touched.count() < all.touched.count(), "{tolerance:e}: {}", few.touched.count());
            for element in 0..radar.elements {
                let profile = few.profile(element).unwrap();
                let beyond = profile.iter().enumerate().filter(|(bin, _)| !few.touched.contains(*bin));
                assert!(beyond.map(|(_, cell)| cell.norm()).sum::<f64>() == 0.0, "{tolerance:e}, element {element}");
            }
        }
    }

    #[test]
    fn ranges_near_the_kernels_centres_keep_every_digit() {
        // Elements as good as in one place, so that all see the same range: whole bins, and the centres of the outer kernels.
        let radar =
            Radar { elements: 8, end_elements: 3, element_spacing_metres: 1e-9, samples: 64, ..Radar::default() };
        let bin = radar.range_resolution_metres();
        for offset in [0.0, 1e-14, 1e-9, 1e-4, -1e-12, 0.5, 64.0 / 63.0 - 1.0, 1.0 - 64.0 / 63.0, 0.499_999_99] {
            let reflectors = Scene::of_points([(0.0, (20.0 + offset) * bin)]).reflectors();
            let e = error(&radar, &reflectors, plan(1e-15, Simd::best()));
            assert!(e < 3e-15, "{offset}: {e:e}");
        }
    }

    #[test]
    fn other_windows_have_none() {
        let radar = Radar { window: WindowFunction::Blackman, elements: 16, end_elements: 3, ..Radar::default() };
        let reflectors = Scene::of_points([(0.5, 9.0)]).reflectors();
        assert_eq!(SynthesisPlan::cheapest(1, 1.0, 1e-3).on_few_rows(&radar, 1).algorithm, Algorithm::Split);
        let e = error(&radar, &reflectors, plan(1e-3, Simd::best()));
        assert!(e < 1e-6, "forced, it is evaluated by phasor split: {e:e}");
    }

    #[test]
    fn only_the_rows_that_matter_are_touched() {
        let radar = Radar::default();
        let reflectors = Scene::of_points([(0.0, 15.0)]).reflectors();
        let mut out = BlockProfiles::<f64, LANES_F64>::silence(&radar);
        for (tolerance, most) in [(1e-3, 36), (1e-6, 236), (1e-12, 512)] {
            let synthesis = Synthesis::new(&radar, plan(tolerance, Simd::best()));
            synthesis.range_profiles(&reflectors, &mut out, &Task::default());
            assert!(out.touched.count() <= most, "{tolerance:e}: {}", out.touched.count());
            for element in [0, 500, 1023] {
                for (bin, cell) in out.profile(element).unwrap().iter().enumerate() {
                    assert!(out.touched.contains(bin) || cell.norm() == 0.0, "element {element}, bin {bin}: {cell}");
                }
            }
        }
    }
}
