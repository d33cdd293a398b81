//! The fit of one atom by itself: its echo is computed once, without inner products of its reflectors.

use super::atom::Atom;
use super::echoes::{Samples, echo_of_all};
use super::refine::{Fit, Workbench};
use super::sensor::W;
use crate::scene::Reflector;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Simd};
use num_complex::Complex64;
use rayon::prelude::*;

impl Workbench<'_> {
    /// The result of [`Workbench::solve`] for a single atom, many times faster.
    pub fn solve_alone(&self, samples: &Samples, atom: Atom) -> Fit {
        let reflectors: Vec<Reflector> = atom.reflectors(1.0).collect();
        self.work.spend(reflectors.len() + 1);
        let (sensor, simd, squared) = (&self.sensor, Simd::chosen(), &self.squared);
        let listen = |(block, samples): (usize, &Block)| {
            simd.run(Listen { squared, samples, echo: echo_of_all(sensor, &reflectors, block) })
        };
        let heard: Vec<Heard> = samples.blocks.par_iter().enumerate().map(listen).collect();
        let mut sums = [(Complex64::default(), 0.0); 2];
        for channel in 0..sensor.element_x.len() {
            let (heard, lane) = (&heard[channel / W], channel % W);
            let (shared, power) = &mut sums[channel / sensor.end_elements];
            *shared += Complex64::new(heard.shared.re.0[lane], heard.shared.im.0[lane]);
            *power += heard.power.0[lane];
        }
        let gains = sums.map(|(shared, power)| if power > 0.0 { shared / power } else { Complex64::default() });
        let last = sensor.element_x.len() - 1;
        let leave = |(block, (samples, heard)): (usize, (&Block, &Heard))| {
            let gain = |lane: usize| gains[(block * W + lane).min(last) / sensor.end_elements];
            let gain = ComplexLanes {
                re: Lanes(std::array::from_fn(|lane| -gain(lane).re)),
                im: Lanes(std::array::from_fn(|lane| -gain(lane).im)),
            };
            simd.run(Leave { squared, samples, echo: &heard.echo, gain })
        };
        let left: Vec<Left> = samples.blocks.iter().zip(&heard).enumerate().map(leave).collect();
        let mut energy = [0.0; 2];
        for channel in 0..sensor.element_x.len() {
            energy[channel / sensor.end_elements] += left[channel / W].energy.0[channel % W];
        }
        let residual = Samples { blocks: left.into_iter().map(|left| left.residual).collect() };
        Fit { atoms: vec![atom], gains: vec![gains], residual, energy }
    }
}

/// Samples of one block of channels.
type Block = Vec<ComplexLanes<f64, W>>;

/// An echo at one block of channels, with its products with the samples there and with itself.
struct Heard {
    echo: Block,
    shared: ComplexLanes<f64, W>,
    power: Lanes<f64, W>,
}

/// Kernel of these products under a window.
struct Listen<'a> {
    squared: &'a [f64],
    samples: &'a [ComplexLanes<f64, W>],
    echo: Block,
}

impl Kernel for Listen<'_> {
    type Output = Heard;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Heard {
        let (mut shared, mut power) = (ComplexLanes::zero(), Lanes::splat(0.0));
        for ((v, echo), w) in self.samples.iter().zip(&self.echo).zip(self.squared) {
            let weighted = echo.scaled(Lanes::splat(*w));
            shared = shared.plus_product::<FMA>(weighted.conj(), *v);
            power = weighted.re.mul_add::<FMA>(echo.re, weighted.im.mul_add::<FMA>(echo.im, power));
        }
        Heard { echo: self.echo, shared, power }
    }
}

/// The residual of one block of channels after an echo of some gain, and its energy under the window.
struct Left {
    residual: Block,
    energy: Lanes<f64, W>,
}

/// Kernel that adds an echo of some gain to one block of channels.
struct Leave<'a> {
    squared: &'a [f64],
    samples: &'a [ComplexLanes<f64, W>],
    echo: &'a [ComplexLanes<f64, W>],
    gain: ComplexLanes<f64, W>,
}

impl Kernel for Leave<'_> {
    type Output = Left;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Left {
        let mut residual = self.samples.to_vec();
        let mut energy = Lanes::splat(0.0);
        for (left, echo) in residual.iter_mut().zip(self.echo) {
            *left = left.plus_product::<FMA>(*echo, self.gain);
        }
        for (v, w) in residual.iter().zip(self.squared) {
            energy = (v.re * v.re + v.im * v.im).mul_add::<FMA>(Lanes::splat(*w), energy);
        }
        Left { residual, energy }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Radar, hann};
    use crate::reconstruct::fit::refine::Tie;
    use crate::signal::floor::unit_noise;
    use crate::task::Task;

    #[test]
    fn an_atom_by_itself_is_solved_as_by_the_normal_equations() {
        let radar = Radar { end_elements: 11, ..Radar::default() };
        let task = Task::default();
        let bench = Workbench::new(&radar, &hann(radar.samples), &task, usize::MAX);
        let wall = Atom::Segment { x_metres: -4.0, y_metres: 9.0, dx_metres: 0.03, dy_metres: 0.1, count: 31 };
        // A wall of another gain at each end, and noise.
        let noise: Vec<Complex64> = unit_noise(3, 0).take(bench.sensor.sample_count()).collect();
        let gains = [Complex64::new(-900.0, 200.0), Complex64::new(0.0, 500.0)];
        let samples = bench.without(&Samples::new(&bench.sensor, &noise), &[wall], &[gains]).residual;
        let (slow, fast) = (bench.solve(&samples, vec![wall], Tie::PerEnd, 0.0), bench.solve_alone(&samples, wall));
        for (end, gain) in gains.iter().enumerate() {
            let [of_slow, of_fast] = [&slow, &fast].map(|fit| fit.gains[0][end]);
            assert!((of_slow - of_fast).norm() < 1e-9, "{of_slow} {of_fast}");
            assert!((of_slow + gain).norm() < 20.0, "{of_slow}");
            assert!((slow.energy[end] / fast.energy[end] - 1.0).abs() < 1e-9);
        }
        for (a, b) in slow.residual.flat(&bench.sensor).iter().zip(fast.residual.flat(&bench.sensor)) {
            assert!((a - b).norm() < 1e-6, "{a} {b}");
        }
    }
}
