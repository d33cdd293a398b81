//! Orthogonal matching pursuit on the near-field polar grid.

use super::beams::{Backprojector, RangeWindow};
use super::conditioning::{Conditioned, condition};
use super::drawing::{Gained, draw};
use super::rendering::silence;
use super::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::radar::Radar;
use crate::signal::{ArrayEcho, TwoEnds};
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use ndarray::Array2;
use num_complex::Complex64;
use rayon::prelude::*;

/// Greedy sparse reconstruction: the atom that explains most of what is left, all gains fitted anew, until only noise is left.
///
/// Y. C. Pati, R. Rezaiifar and P. S. Krishnaprasad, "Orthogonal matching pursuit: recursive function approximation with
/// applications to wavelet decomposition", Asilomar 1993. Atoms are the exact near-field echoes of the cells of the whole array's
/// polar grid; the map is drawn from those that were picked.
#[derive(Debug, Clone, Copy)]
pub struct Omp {
    /// Most atoms it picks.
    pub max_atoms: usize,
}

impl Default for Omp {
    fn default() -> Self {
        Omp { max_atoms: 24 }
    }
}

/// Cells around the strongest one that are tried with exact atoms: range bins and columns to each side.
const NEIGHBOURHOOD: (isize, isize) = (2, 6);

/// Part of the energy that rounding leaves unexplained where phases of 6e4 rad were evaluated in f64: about 1e-11 of each sample's
/// amplitude. It is not white, so that the measured noise understates it.
const ROUNDING: f64 = 1e-22;

/// A cell's echo, picked.
struct Pick {
    bin: usize,
    column: usize,
    atom: ArrayEcho,
}

/// The atom of a cell of the polar grid.
fn atom_of_cell(radar: &Radar, bin: usize, column: usize) -> ArrayEcho {
    ArrayEcho::at(radar, radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64))
}

/// The cell whose exact atom explains most of `residual`, of those around the strongest of `heard`.
fn strongest(radar: &Radar, heard: &Array2<f64>, residual: &[Complex64], taken: &[Pick]) -> Option<Pick> {
    let is_taken = |bin: usize, column: usize| taken.iter().any(|p| (p.bin, p.column) == (bin, column));
    let (start, _) = heard
        .indexed_iter()
        .filter(|((bin, column), _)| *bin > 0 && !is_taken(*bin, *column))
        .max_by(|a, b| a.1.total_cmp(b.1))?;
    let (bins, columns) = heard.dim();
    let cells: Vec<(usize, usize)> = (-NEIGHBOURHOOD.0..=NEIGHBOURHOOD.0)
        .flat_map(|i| (-NEIGHBOURHOOD.1..=NEIGHBOURHOOD.1).map(move |j| (i, j)))
        .filter_map(|(i, j)| Some((start.0.checked_add_signed(i)?, start.1.checked_add_signed(j)?)))
        .filter(|&(bin, column)| bin > 0 && bin < bins && column < columns && !is_taken(bin, column))
        .collect();
    cells
        .into_par_iter()
        .map(|(bin, column)| {
            let atom = atom_of_cell(radar, bin, column);
            (atom.correlate(residual).norm(), Pick { bin, column, atom })
        })
        .reduce_with(|a, b| if b.0 > a.0 { b } else { a })
        .map(|(_, pick)| pick)
}

impl Omp {
    /// Picks atoms of `samples` and fits their gains.
    fn pursue(
        &self,
        radar: &Radar,
        conditioned: &Conditioned,
        request: &Request,
    ) -> Result<Vec<Gained>, ReconstructError> {
        let samples = conditioned.ends.flat();
        let noise = conditioned.noise_variance * samples.len() as f64 * 1.1;
        let enough = noise.max(energy(&samples) * ROUNDING);
        let backprojector = Backprojector::new(radar, RangeWindow::None);
        let mut residual = samples.clone();
        let mut picks: Vec<Pick> = Vec::new();
        // Orthonormal basis of the picked atoms.
        let mut basis: Vec<Vec<Complex64>> = Vec::new();
        while picks.len() < self.max_atoms && energy(&residual) > enough {
            request.task.check()?;
            request.task.set_progress(0.9 * picks.len() as f32 / self.max_atoms as f32);
            let [first, last] = backprojector.amplitudes(&TwoEnds::of_flat(radar, &residual));
            let heard = ndarray::Zip::from(&first).and(&last).par_map_collect(|a, b| (a + b).norm_sqr());
            let Some(pick) = strongest(radar, &heard, &residual, &picks) else { break };
            let mut direction = pick.atom.unit_samples();
            // Twice: once leaves rounding error along atoms that lie close together.
            for _ in 0..2 {
                for b in &basis {
                    let along = inner(b, &direction);
                    subtract(&mut direction, b, along);
                }
            }
            let length = energy(&direction).sqrt();
            if length < 1e-7 {
                break; // the picked atom is no new one
            }
            direction.iter_mut().for_each(|v| *v /= length);
            let along = inner(&direction, &residual);
            let before = energy(&residual);
            subtract(&mut residual, &direction, along);
            basis.push(direction);
            picks.push(pick);
            if energy(&residual) > before * 0.9999 {
                break; // nothing on the grid explains what is left
            }
        }
        Ok(fit(&picks, &samples))
    }
}

/// Gains of the picked atoms by least squares.
fn fit(picks: &[Pick], samples: &[Complex64]) -> Vec<Gained> {
    if picks.is_empty() {
        return Vec::new();
    }
    let columns: Vec<Vec<Complex64>> = picks.iter().map(|p| p.atom.unit_samples()).collect();
    let matrix = Mat::from_fn(samples.len(), picks.len(), |i, j| columns[j][i]);
    let gains = matrix.qr().solve_lstsq(Mat::from_fn(samples.len(), 1, |i, _| samples[i]));
    picks
        .iter()
        .enumerate()
        .map(|(j, p)| Gained { reflector: p.atom.reflector, gain: gains[(j, 0)] / p.atom.norm() })
        .collect()
}

fn energy(v: &[Complex64]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum()
}

fn inner(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

fn subtract(from: &mut [Complex64], what: &[Complex64], times: Complex64) {
    from.iter_mut().zip(what).for_each(|(f, w)| *f -= w * times);
}

impl Reconstructor for Omp {
    fn name(&self) -> &'static str {
        "omp"
    }

    fn description(&self) -> &'static str {
        "greedy sparse fit of exact near-field echoes on the polar grid, and their exact map"
    }

    fn eta(&self) -> f32 {
        0.856 // by tests/choose_eta.rs
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        let Some(conditioned) = condition(radar, ends)? else { return Ok(silence(radar)) };
        let found = self.pursue(radar, &conditioned, request)?;
        Ok(draw(radar, &found, conditioned.gain, conditioned.noise_variance, request))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Reflector, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn reflectors_on_the_grid_are_recovered_exactly() {
        let radar = Radar::default();
        let cells = [(150usize, 700usize), (230, 512), (231, 300), (390, 620)];
        let atoms = cells.map(|(bin, column)| atom_of_cell(&radar, bin, column));
        let scene = Scene::of_points(atoms.iter().map(|a| (a.reflector.x_metres, a.reflector.y_metres)));
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let mut found = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
        found.sort_by(|a, b| a.y_metres.total_cmp(&b.y_metres));
        let mut expected: Vec<Reflector> = scene.reflectors();
        expected.sort_by(|a, b| a.y_metres.total_cmp(&b.y_metres));
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (f, e) in found.iter().zip(&expected) {
            assert_eq!((f.x_metres, f.y_metres), (e.x_metres, e.y_metres));
            assert!((f.reflectivity - 1.0).abs() < 1e-8, "{f:?}");
        }
    }
}
