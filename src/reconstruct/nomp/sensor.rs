//! The two ends as a measuring device: their samples, and what an atom of the dictionary would leave in them.

use super::few::atom::Atom;
use crate::radar::{End, Radar};
use crate::scene::Reflector;
use crate::signal::phase::EchoModel;
use crate::signal::simd::{ComplexLanes, Kernel, LANES_F64, Lanes, Simd};
use crate::signal::split::{CHUNK, Factors, STRIDE, add_product, fill_factors};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Nearest a reflector may come to an element in a fit, metres: keeps a wandering step finite.
pub const NEAREST_METRES: f64 = 1e-3;

/// Channels evaluated together, one lane each.
pub const W: usize = LANES_F64;

/// Reflectors from which on an atom is worth more than one thread.
const MANY_REFLECTORS: usize = 16;

/// Geometry and constants of both ends. A vector over all samples of both ends is laid out channel by channel, first end first.
#[derive(Debug, Clone)]
pub struct Sensor {
    /// Phases of echoes.
    pub model: EchoModel,
    /// x of every channel's element, metres, first end first.
    pub element_x: Vec<f64>,
    /// Samples a channel.
    pub samples: usize,
    /// Channels an end.
    pub end_elements: usize,
    /// Whether each channel hears: one that doesn't has no echoes.
    pub hears: Vec<bool>,
    carrier_radians_per_metre: f64,
    beat_radians_per_metre: f64,
}

impl Sensor {
    /// The two ends of `radar`.
    pub fn new(radar: &Radar) -> Self {
        let element_x = End::BOTH.iter().flat_map(|&e| radar.end_range(e)).map(|n| radar.element_x_metres(n));
        Sensor {
            model: EchoModel::new(radar),
            element_x: element_x.collect(),
            samples: radar.samples,
            end_elements: radar.end_elements,
            hears: vec![true; 2 * radar.end_elements],
            carrier_radians_per_metre: TAU * radar.carrier.turns_per_wavelength() / radar.wavelength_metres(),
            beat_radians_per_metre: TAU / radar.max_range_metres(),
        }
    }

    /// The same where those channels alone hear of which `flat`, the samples channel by channel, holds something.
    pub fn hearing(mut self, flat: &[Complex64]) -> Self {
        for (hears, channel) in self.hears.iter_mut().zip(flat.chunks_exact(self.samples)) {
            *hears = channel.iter().any(|v| v.norm_sqr() > 0.0);
        }
        self
    }

    /// Samples of both ends together.
    pub fn sample_count(&self) -> usize {
        self.element_x.len() * self.samples
    }

    /// Distance at which the carrier's phase repeats.
    pub fn wavelength_metres(&self) -> f64 {
        TAU / self.carrier_radians_per_metre.abs()
    }

    /// Phase of sample `n` for each metre of distance.
    #[inline(always)]
    fn radians_per_metre(&self, n: f64) -> f64 {
        self.carrier_radians_per_metre + self.beat_radians_per_metre * n
    }

    /// Phase for each metre of distance at the middle of the chirp, and how much it grows over the whole chirp.
    pub fn radians_per_metre_over_chirp(&self) -> [f64; 2] {
        let middle = (self.samples as f64 - 1.0) / 2.0;
        [self.radians_per_metre(middle), self.beat_radians_per_metre * self.samples as f64]
    }

    /// Samples of one end.
    pub fn end_len(&self) -> usize {
        self.end_elements * self.samples
    }

    /// What `atom` with gain 1 leaves in every sample, times `window`; and its derivatives by the atom's parameters.
    ///
    /// `columns` holds 1 slice for the samples alone, or 1 + [`Atom::parameters`] of them, each of [`Sensor::sample_count`].
    /// Derivatives are good to about 1e-6 of their size: they only point the way.
    pub fn fill_atom(&self, atom: &Atom, window: &[f64], columns: &mut [&mut [Complex64]]) {
        let mut blocks: Vec<Block> =
            self.element_x.chunks(W).map(|xs| Block { sensor: self, atom, window, xs, columns: Vec::new() }).collect();
        for column in columns.iter_mut() {
            for (block, part) in blocks.iter_mut().zip(column.chunks_mut(W * self.samples)) {
                block.columns.push(part);
            }
        }
        if atom.reflectors() < MANY_REFLECTORS {
            blocks.into_iter().for_each(|block| Simd::chosen().run(block));
        } else {
            blocks.into_par_iter().for_each(|block| Simd::chosen().run(block));
        }
        for column in columns.iter_mut() {
            let channels = column.chunks_mut(self.samples).zip(&self.hears);
            channels.filter(|(_, hears)| !**hears).for_each(|(channel, _)| channel.fill(Complex64::default()));
        }
    }
}

/// An atom at a few neighbouring channels.
struct Block<'a> {
    sensor: &'a Sensor,
    atom: &'a Atom,
    window: &'a [f64],
    /// Where the elements stand; at most `W`.
    xs: &'a [f64],
    /// Room for the samples and their derivatives, channel by channel.
    columns: Vec<&'a mut [Complex64]>,
}

/// Where a reflector lies as seen from each element, metres.
#[derive(Clone, Copy)]
struct Direction {
    dx: Lanes<f64, W>,
    distance: Lanes<f64, W>,
}

impl Kernel for Block<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(mut self) {
        let sensor = self.sensor;
        let last = self.xs.len() - 1;
        let element_x = Lanes(std::array::from_fn(|lane| self.xs[lane.min(last)]));
        let mut factors = vec![Factors::<f64, W>::new(sensor.samples); CHUNK.min(self.atom.reflectors())];
        let rows = factors.first().map_or(0, |f| f.rows.len());
        let mut sums = vec![vec![ComplexLanes::zero(); rows * STRIDE]; self.columns.len()];
        let mut plain = vec![vec![ComplexLanes::zero(); rows]; factors.len()];
        let mut directions = [Direction { dx: Lanes::splat(0.0), distance: Lanes::splat(1.0) }; CHUNK];
        for first in (0..self.atom.reflectors()).step_by(CHUNK) {
            let count = CHUNK.min(self.atom.reflectors() - first);
            let factors = &mut factors[..count];
            for (i, f) in factors.iter_mut().enumerate() {
                let [x, y] = self.atom.position(first + i);
                let dx = Lanes::splat(x) - element_x;
                let nearest = dx.0.iter().fold(f64::INFINITY, |m, d| m.min(d.abs()));
                let y = if nearest.hypot(y) < NEAREST_METRES { NEAREST_METRES } else { y };
                let reflector = Reflector { x_metres: x, y_metres: y, reflectivity: 1.0 };
                fill_factors::<f64, W, FMA>(&sensor.model, element_x, &reflector, f);
                directions[i] = Direction { dx, distance: (dx * dx + Lanes::splat(y * y)).sqrt() };
            }
            add_product::<f64, W, FMA>(factors, &mut sums[0]);
            if self.columns.len() == 1 {
                continue;
            }
            for (plain, f) in plain.iter_mut().zip(factors.iter()) {
                plain.copy_from_slice(&f.rows);
            }
            for (k, sum) in sums[1..].iter_mut().enumerate() {
                for (i, f) in factors.iter_mut().enumerate() {
                    let to = directions[i];
                    let [by_x, by_half_square] = self.atom.share(first + i, k);
                    let along = to.dx * Lanes::splat(by_x) + Lanes::splat(by_half_square);
                    let along = along.zip(to.distance, |a, b| a / b);
                    for (a, (row, plain)) in f.rows.iter_mut().zip(&plain[i]).enumerate() {
                        // By the distance R, an echo changes by j rate - 2/R of itself: `rate` is common to all reflectors and
                        // comes last, what is left changes little within a row.
                        let rate = sensor.radians_per_metre((a * STRIDE + STRIDE / 2) as f64);
                        let decay = to.distance.map(|r| 2.0 / (r * rate));
                        let change = ComplexLanes { re: along, im: along * decay };
                        *row = plain.times::<FMA>(change);
                    }
                }
                add_product::<f64, W, FMA>(factors, sum);
            }
        }
        for (k, (sum, column)) in sums.iter().zip(&mut self.columns).enumerate() {
            for (lane, channel) in column.chunks_mut(sensor.samples).enumerate() {
                for (n, ((out, v), w)) in channel.iter_mut().zip(sum).zip(self.window).enumerate() {
                    let (re, im) = (v.re.0[lane] * w, v.im.0[lane] * w);
                    let rate = sensor.radians_per_metre(n as f64);
                    *out = if k == 0 { Complex64::new(re, im) } else { Complex64::new(-im * rate, re * rate) };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::{TwoEnds, exact};

    #[test]
    fn an_atom_is_what_the_exact_formula_gives() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let line = Line::vertical(12.0, 3.0, 0.11, 7);
        let scene = Scene { objects: vec![Object::Line(line)], ..Scene::default() };
        let ends = exact::beat_signal(&radar, &scene.reflectors()).two_ends(&radar);
        let mut value = vec![Complex64::default(); sensor.sample_count()];
        let ones = vec![1.0; sensor.samples];
        let atom = Atom::Line { x: 12.0, start: 3.0, spacing: 0.11, count: 7 };
        sensor.fill_atom(&atom, &ones, &mut [&mut value]);
        let expected = ends.flat();
        let peak = expected.iter().fold(0.0, |m: f64, v| m.max(v.norm()));
        for (a, b) in value.iter().zip(&expected) {
            assert!((a - b).norm() < 1e-13 * peak);
        }
        assert_eq!(TwoEnds::of_flat(&radar, &expected), ends);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let sensor = Sensor::new(&Radar::default());
        let ones = vec![1.0; sensor.samples];
        let value_of = |atom: Atom| {
            let mut v = vec![Complex64::default(); sensor.sample_count()];
            sensor.fill_atom(&atom, &ones, &mut [&mut v]);
            v
        };
        for atom in [Atom::Point { x: 3.0, y: 8.0 }, Atom::Line { x: -4.0, start: 2.0, spacing: 0.1, count: 5 }] {
            let p = atom.parameters();
            let mut columns = vec![vec![Complex64::default(); sensor.sample_count()]; p + 1];
            sensor.fill_atom(&atom, &ones, &mut columns.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>());
            for k in 0..p {
                let h = 1e-7;
                let mut step = vec![0.0; p];
                step[k] = h;
                let up = value_of(atom.moved(&step));
                step[k] = -h;
                let down = value_of(atom.moved(&step));
                let size = columns[k + 1].iter().fold(0.0, |m: f64, v| m.max(v.norm()));
                for row in (0..sensor.sample_count()).step_by(97) {
                    let difference = (up[row] - down[row]) / (2.0 * h);
                    assert!((difference - columns[k + 1][row]).norm() < 1e-6 * size, "{atom:?} parameter {k}");
                }
            }
        }
    }
}
