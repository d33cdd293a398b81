//! The two ends as a measuring device: their samples, and what an atom of the dictionary would leave in them.

use super::atom::Atom;
use crate::radar::{End, Radar};
use crate::scene::Reflector;
use crate::signal::TwoEnds;
use crate::signal::phase::EchoModel;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Samples whose phasors share one coarse phasor; the fine ones are computed once for a channel.
const FINE: usize = 16;

/// Nearest a reflector may come to an element in a fit, metres: keeps a wandering step finite.
const NEAREST_METRES: f64 = 1e-3;

/// Geometry and constants of both ends. A vector over all samples of both ends is laid out channel by channel, first end first.
#[derive(Debug, Clone)]
pub struct Sensor {
    model: EchoModel,
    /// x of every channel's element, metres, first end first.
    pub element_x: Vec<f64>,
    /// Samples a channel.
    pub samples: usize,
    /// Channels an end.
    pub end_elements: usize,
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
            carrier_radians_per_metre: TAU * radar.carrier.turns_per_wavelength() / radar.wavelength_metres(),
            beat_radians_per_metre: TAU / radar.max_range_metres(),
        }
    }

    /// Samples of both ends together.
    pub fn sample_count(&self) -> usize {
        self.element_x.len() * self.samples
    }

    /// Distance at which the carrier's phase repeats.
    pub fn wavelength_metres(&self) -> f64 {
        TAU / self.carrier_radians_per_metre.abs()
    }

    /// Samples of one end.
    pub fn end_len(&self) -> usize {
        self.end_elements * self.samples
    }

    /// Lays the samples out as one vector and scales them by `scale`.
    pub fn flatten(&self, ends: &TwoEnds, scale: f64) -> Vec<Complex64> {
        ends.first.iter().chain(ends.last.iter()).map(|v| v * scale).collect()
    }

    /// The inverse of [`Sensor::flatten`] with scale 1.
    pub fn unflatten(&self, samples: &[Complex64]) -> TwoEnds {
        let shape = (self.end_elements, self.samples);
        let end = |part: &[Complex64]| ndarray::Array2::from_shape_fn(shape, |(c, n)| part[c * self.samples + n]);
        TwoEnds { first: end(&samples[..self.end_len()]), last: end(&samples[self.end_len()..]) }
    }

    /// What `atom` with gain 1 leaves in every sample, times `window`; and its derivatives by the atom's parameters.
    ///
    /// `columns` holds 1 slice for the samples alone, or 1 + [`Atom::parameters`] of them, each of [`Sensor::sample_count`] zeros.
    pub fn add_atom(&self, atom: &Atom, window: &[f64], columns: &mut [&mut [Complex64]]) {
        let Some((value, derivatives)) = columns.split_first_mut() else { return };
        for (channel, &element_x) in self.element_x.iter().enumerate() {
            let rows = channel * self.samples..(channel + 1) * self.samples;
            if derivatives.is_empty() {
                self.add_echoes(atom, element_x, &mut value[rows], |s, n, _, _| s * window[n]);
                continue;
            }
            self.add_echoes(atom, element_x, &mut value[rows.clone()], |s, n, i, to| {
                let s = s * window[n];
                let rate = self.carrier_radians_per_metre + self.beat_radians_per_metre * n as f64;
                let by_distance = s * Complex64::new(-2.0 / to.distance, rate);
                for (k, d) in derivatives.iter_mut().enumerate() {
                    let [sx, sy] = atom.share(i, k);
                    d[rows.start + n] += by_distance * ((to.dx * sx + to.y * sy) / to.distance);
                }
                s
            });
        }
    }

    /// Adds `atom` with gain `gain` to the samples of one element anywhere on the array.
    pub fn add_channel(&self, atom: &Atom, gain: f64, element_x: f64, row: &mut [Complex64]) {
        self.add_echoes(atom, element_x, row, |s, _, _, _| s * gain);
    }

    /// Adds `of(echo, sample, reflector, direction)` to every sample of one element, reflector by reflector.
    #[inline(always)]
    fn add_echoes(
        &self,
        atom: &Atom,
        element_x: f64,
        row: &mut [Complex64],
        mut of: impl FnMut(Complex64, usize, usize, Direction) -> Complex64,
    ) {
        let mut fine = [Complex64::default(); FINE];
        for i in 0..atom.reflectors() {
            let [x, y] = atom.position(i);
            let dx = x - element_x;
            let y = if dx.hypot(y) < NEAREST_METRES { NEAREST_METRES } else { y };
            let echo = self.model.echo(element_x, &Reflector { x_metres: x, y_metres: y, reflectivity: 1.0 });
            let to = Direction { dx, y, distance: echo.distance_metres };
            for (b, f) in fine.iter_mut().enumerate() {
                *f = Complex64::cis(TAU * echo.beat_turns * b as f64);
            }
            for (a, part) in row.chunks_mut(FINE).enumerate() {
                let coarse = Complex64::from_polar(echo.amplitude, TAU * echo.turns_at(a * FINE));
                for (b, (sample, fine)) in part.iter_mut().zip(&fine).enumerate() {
                    *sample += of(coarse * fine, a * FINE + b, i, to);
                }
            }
        }
    }
}

/// Where a reflector lies as seen from an element, metres.
#[derive(Debug, Clone, Copy)]
struct Direction {
    dx: f64,
    y: f64,
    distance: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Line, Object, Scene};
    use crate::signal::exact;

    #[test]
    fn an_atom_is_what_the_exact_formula_gives() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let line = Line { x_metres: 12.0, y_start_metres: 3.0, spacing_metres: 0.11, count: 7, reflectivity: 1.0 };
        let scene = Scene { objects: vec![Object::Line(line)], ..Scene::default() };
        let ends = exact::beat_signal(&radar, &scene.reflectors()).two_ends(&radar);
        let mut value = vec![Complex64::default(); sensor.sample_count()];
        let ones = vec![1.0; sensor.samples];
        let atom = Atom::Line { x: 12.0, start: 3.0, spacing: 0.11, count: 7 };
        sensor.add_atom(&atom, &ones, &mut [&mut value]);
        let expected = sensor.flatten(&ends, 1.0);
        let peak = expected.iter().fold(0.0, |m: f64, v| m.max(v.norm()));
        for (a, b) in value.iter().zip(&expected) {
            assert!((a - b).norm() < 1e-13 * peak);
        }
        assert_eq!(sensor.unflatten(&expected), ends);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let sensor = Sensor::new(&Radar::default());
        let ones = vec![1.0; sensor.samples];
        let value_of = |atom: Atom| {
            let mut v = vec![Complex64::default(); sensor.sample_count()];
            sensor.add_atom(&atom, &ones, &mut [&mut v]);
            v
        };
        for atom in [Atom::Point { x: 3.0, y: 8.0 }, Atom::Line { x: -4.0, start: 2.0, spacing: 0.1, count: 5 }] {
            let p = atom.parameters();
            let mut columns = vec![vec![Complex64::default(); sensor.sample_count()]; p + 1];
            sensor.add_atom(&atom, &ones, &mut columns.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>());
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
