//! The fit of a single atom: the echo of all its reflectors is computed once, without inner products of the reflectors.

use super::atom::Atom;
use super::echoes::{Samples, echo_of_all};
use super::refine::{Fit, Fitter};
use crate::scene::Reflector;
use num_complex::Complex64;
use rayon::prelude::*;

impl Fitter<'_> {
    /// The result of [`Fitter::solve`] for a single atom with a gain for each end and without a ridge, many times faster.
    pub fn solve_alone(&self, samples: &Samples, atom: Atom) -> Fit {
        let reflectors: Vec<Reflector> = atom.reflectors(1.0).collect();
        self.work.spend(reflectors.len() + 1);
        let sensor = &self.sensor;
        let blocks = (0..samples.blocks.len()).into_par_iter().map(|block| echo_of_all(sensor, &reflectors, block));
        let echo = Samples { blocks: blocks.collect() }.flat(sensor);
        let mut residual = samples.flat(sensor);
        let end_samples = sensor.end_elements * sensor.samples;
        let (mut gains, mut energy) = ([Complex64::ZERO; 2], [0.0; 2]);
        let ends = residual.chunks_exact_mut(end_samples).zip(echo.chunks_exact(end_samples));
        for (end, (residual, echo)) in ends.enumerate() {
            let weights = || self.squared.iter().cycle();
            let weighted = residual.iter().zip(echo).zip(weights());
            let (product, power) = weighted.fold((Complex64::ZERO, 0.0), |(product, power), ((v, echo), w)| {
                (product + echo.conj() * v * w, power + echo.norm_sqr() * w)
            });
            gains[end] = if power > 0.0 { product / power } else { Complex64::ZERO };
            residual.iter_mut().zip(echo).for_each(|(v, echo)| *v -= echo * gains[end]);
            energy[end] = residual.iter().zip(weights()).map(|(v, w)| v.norm_sqr() * w).sum();
        }
        Fit { atoms: vec![atom], gains: vec![gains], residual: Samples::new(sensor, &residual), energy }
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
        let fitter = Fitter::new(&radar, &hann(radar.samples), &task, usize::MAX);
        let wall = Atom::Row { x_metres: -4.0, y_metres: 9.0, dx_metres: 0.03, dy_metres: 0.1, count: 31 };
        // A wall of another gain at each end, and noise.
        let noise: Vec<Complex64> = unit_noise(3, 0).take(fitter.sensor.sample_count()).collect();
        let gains = [Complex64::new(-900.0, 200.0), Complex64::new(0.0, 500.0)];
        let samples = fitter.subtract(&Samples::new(&fitter.sensor, &noise), &[wall], &[gains]).residual;
        let (slow, fast) = (fitter.solve(&samples, vec![wall], Tie::PerEnd, 0.0), fitter.solve_alone(&samples, wall));
        for (end, gain) in gains.iter().enumerate() {
            let [of_slow, of_fast] = [&slow, &fast].map(|fit| fit.gains[0][end]);
            assert!((of_slow - of_fast).norm() < 1e-9, "{of_slow} {of_fast}");
            assert!((of_slow + gain).norm() < 20.0, "{of_slow}");
            assert!((slow.energy[end] / fast.energy[end] - 1.0).abs() < 1e-9);
        }
        for (a, b) in slow.residual.flat(&fitter.sensor).iter().zip(fast.residual.flat(&fitter.sensor)) {
            assert!((a - b).norm() < 1e-6, "{a} {b}");
        }
    }
}
