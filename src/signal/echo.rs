//! The exact near-field echo of a single reflector at the elements of any line.

use crate::radar::{End, Pair, Radar};
use crate::scene::Reflector;
use crate::signal::phase::EchoModel;
use crate::signal::simd::{ComplexLanes, Kernel, LANES_F64, Lanes, Simd};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Samples between exact evaluations of a phasor recurrence: its rounding error is a few parts in 1e16.
const RESTART_SAMPLES: usize = 32;

/// Adds `gain` times the echo of a unit reflector to `samples` of `pair`.
pub fn add_echo(model: &EchoModel, pair: Pair, reflector: &Reflector, gain: Complex64, samples: &mut [Complex64]) {
    let echo = model.echo(pair, reflector);
    let step = Complex64::cis(TAU * echo.turns_at(1) - TAU * echo.turns_at(0));
    for (block, samples) in samples.chunks_mut(RESTART_SAMPLES).enumerate() {
        let mut phasor = gain * echo.sample(block * RESTART_SAMPLES);
        for sample in samples {
            *sample += phasor;
            phasor *= step;
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Series {
    start: Complex64,
    step: Complex64,
    /// `step^samples`.
    last: Complex64,
}

/// Echo of one reflector at several elements: a geometric series for each, and the norm of all samples.
#[derive(Debug, Clone)]
pub struct ArrayEcho {
    /// The reflector; its reflectivity is 1.
    pub reflector: Reflector,
    series: Vec<Series>,
    samples: usize,
    norm: f64,
}

impl ArrayEcho {
    /// The echo of a unit reflector at (`range_metres`, `cos_theta`) from the array's centre, at the elements of both ends.
    pub fn at(radar: &Radar, range_metres: f64, cos_theta: f64) -> Self {
        let ends = End::BOTH.into_iter().flat_map(|end| radar.end_range(end));
        let pairs: Vec<Pair> = ends.map(|n| radar.pair(n)).collect();
        ArrayEcho::at_pairs(radar, &pairs, range_metres, cos_theta)
    }

    pub fn at_pairs(radar: &Radar, pairs: &[Pair], range_metres: f64, cos_theta: f64) -> Self {
        let cos = cos_theta.clamp(-1.0, 1.0);
        let reflector = Reflector::at([range_metres * cos, range_metres * (1.0 - cos * cos).sqrt()], 1.0);
        let model = EchoModel::new(radar);
        let of_pair = |pair: &Pair| {
            let echo = model.echo(*pair, &reflector);
            let phasor_to = |sample: usize| Complex64::cis(TAU * (echo.turns_at(sample) - echo.turns_at(0)));
            Series { start: echo.sample(0), step: phasor_to(1), last: phasor_to(radar.samples) }
        };
        let series = pairs.iter().map(of_pair).collect();
        ArrayEcho { reflector, series, samples: radar.samples, norm: 0.0 }.with_norm()
    }

    fn with_norm(self) -> Self {
        let power: f64 = self.series.iter().map(|s| s.start.norm_sqr()).sum();
        ArrayEcho { norm: (power * self.samples as f64).sqrt(), ..self }
    }

    pub fn masked(mut self, is_measured: &[bool]) -> Self {
        for (series, _) in self.series.iter_mut().zip(is_measured).filter(|(_, is_measured)| !**is_measured) {
            series.start = Complex64::default();
        }
        self.with_norm()
    }

    /// Root of the sum of squares of its samples.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// Its samples scaled to norm 1, element after element: `[elements * samples]`.
    pub fn unit_samples(&self) -> Vec<Complex64> {
        let mut out = Vec::with_capacity(self.series.len() * self.samples);
        for s in &self.series {
            let mut phasor = s.start / self.norm;
            for _ in 0..self.samples {
                out.push(phasor);
                phasor *= s.step;
            }
        }
        out
    }

    /// Inner product of its unit samples with `y`: `sum conj(echo) y`, `y` being `[elements * samples]`.
    pub fn correlate(&self, y: &[Complex64]) -> Complex64 {
        Simd::chosen().run(Correlate { echo: self, y }) / self.norm
    }

    /// Inner product of the unit samples of two echoes, `sum conj(self) other`: a geometric series for each element.
    pub fn inner(&self, other: &ArrayEcho) -> Complex64 {
        let of_pair = |(a, b): (&Series, &Series)| {
            let off = Complex64::from(1.0) - a.step.conj() * b.step;
            let series = match off.norm_sqr() < 1e-16 {
                true => Complex64::from(self.samples as f64),
                false => (Complex64::from(1.0) - a.last.conj() * b.last) / off,
            };
            a.start.conj() * b.start * series
        };
        self.series.iter().zip(&other.series).map(of_pair).sum::<Complex64>() / (self.norm * other.norm)
    }
}

/// Lanes and groups of lanes that are computed independently, to hide the latency of a multiplication.
const W: usize = LANES_F64;
const GROUPS: usize = 4;
const SUMS: usize = W * GROUPS;

/// `sum conj(echo) y`.
struct Correlate<'a> {
    echo: &'a ArrayEcho,
    y: &'a [Complex64],
}

impl Kernel for Correlate<'_> {
    type Output = Complex64;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Complex64 {
        let mut sum = Complex64::default();
        for (s, y) in self.echo.series.iter().zip(self.y.chunks_exact(self.echo.samples)) {
            sum += s.start.conj() * polynomial::<FMA>(s.step.conj(), y);
        }
        sum
    }
}

/// `sum y[n] z^n` for `z` on the unit circle, by Horner's rule in [`SUMS`] interleaved sums, from the last sample.
#[inline(always)]
fn polynomial<const FMA: bool>(z: Complex64, y: &[Complex64]) -> Complex64 {
    let mut powers = [Complex64::from(1.0); SUMS];
    powers[1] = z;
    (2..SUMS).for_each(|i| powers[i] = powers[i / 2] * powers[i.div_ceil(2)]);
    let stride = ComplexLanes::splat(powers[SUMS / 2] * powers[SUMS / 2]);
    let mut sums = [ComplexLanes::<f64, W>::zero(); GROUPS];
    let whole = y.chunks_exact(SUMS);
    let rest = whole.remainder();
    let lanes = |y: &[Complex64], group: usize| ComplexLanes {
        re: Lanes(std::array::from_fn(|l| y.get(group * W + l).map_or(0.0, |v| v.re))),
        im: Lanes(std::array::from_fn(|l| y.get(group * W + l).map_or(0.0, |v| v.im))),
    };
    for (group, sum) in sums.iter_mut().enumerate() {
        *sum = lanes(rest, group);
    }
    for y in whole.rev() {
        for (group, sum) in sums.iter_mut().enumerate() {
            *sum = lanes(y, group).plus_product::<FMA>(*sum, stride);
        }
    }
    let each = sums.iter().flat_map(|s| s.re.0.into_iter().zip(s.im.0));
    each.zip(powers).map(|((re, im), power)| Complex64::new(re, im) * power).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn an_echo_is_the_exact_signal() {
        let radar = Radar::default();
        let echo = ArrayEcho::at(&radar, 17.3, -0.4);
        let scene = Scene::of_points([(echo.reflector.x_metres, echo.reflector.y_metres)]);
        let exact = simulate(&radar, &scene, Floor::Exact, 0).unwrap().two_ends(&radar).flat();
        let unit = echo.unit_samples();
        for (e, u) in exact.iter().zip(&unit) {
            assert!((e / echo.norm() - u).norm() < 1e-13);
        }
        assert!((echo.correlate(&exact) / echo.norm() - 1.0).norm() < 1e-12);
        let mut added = vec![Complex64::default(); 512];
        let model = EchoModel::new(&radar);
        add_echo(&model, radar.pair(0), &echo.reflector, Complex64::from(1.0), &mut added);
        for (a, e) in added.iter().zip(&exact) {
            assert!((a - e).norm() < 1e-13 * echo.norm());
        }
    }

    #[test]
    fn masked_elements_have_zeros_in_an_echo() {
        let radar = Radar { samples: 16, end_elements: 3, ..Radar::default() };
        let is_measured = [true, false, true, true, true, false];
        let whole = ArrayEcho::at(&radar, 17.3, -0.4);
        let part = whole.clone().masked(&is_measured);
        let samples = part.unit_samples();
        let energy: f64 = samples.iter().map(Complex64::norm_sqr).sum();
        assert!((energy - 1.0).abs() < 1e-12 && (part.inner(&part).re - 1.0).abs() < 1e-12);
        for (n, (part, whole)) in samples.chunks(16).zip(whole.unit_samples().chunks(16)).enumerate() {
            let silent = part.iter().all(|v| v.norm_sqr() == 0.0);
            assert!(silent != is_measured[n] && (silent || (part[3] / whole[3]).im.abs() < 1e-12));
        }
    }

    #[test]
    fn inner_products_are_those_of_the_samples() {
        let radar = Radar::default();
        let echoes =
            [(17.3, -0.4), (17.3, -0.402), (17.35, -0.4), (30.0, 0.9)].map(|(r, c)| ArrayEcho::at(&radar, r, c));
        for a in &echoes {
            for b in &echoes {
                let slow: Complex64 = a.unit_samples().iter().zip(b.unit_samples()).map(|(a, b)| a.conj() * b).sum();
                assert!((a.inner(b) - slow).norm() < 1e-8, "{} {slow}", a.inner(b));
            }
        }
    }
}
