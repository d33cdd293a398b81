//! Sparse reconstruction with an l1 penalty, by FISTA.

use super::backprojector::{Backprojector, RangeWindow};
use super::cells::{GridCell, GridCells};
use crate::radar::Radar;
use crate::reconstruct::echoes::{Gained, of_echoes};
use crate::reconstruct::error::Result;
use crate::reconstruct::noise_model::ends_noise_variance;
use crate::reconstruct::polar::too_many_folds;
use crate::reconstruct::significance::decades_above_cells;
use crate::reconstruct::{Family, LayoutSupport, MethodInfo, ReconstructError, Reconstruction, Reconstructor, Request};
use crate::signal::{ArrayEcho, TwoEnds};
use crate::task::Task;
use ndarray::{Array2, Zip};
use num_complex::Complex64;
use rayon::prelude::*;
use std::collections::HashSet;

/// Equation 1.1 of the thesis: the fewest reflectors that explain the samples, relaxed to
/// `min 1/2 ||A x - y||^2 + penalty ||x||_1`.
///
/// A. Beck and M. Teboulle, "A fast iterative shrinkage-thresholding algorithm for linear inverse problems", SIAM J. Imaging Sci. 2, 2009, in
/// its monotone form. A holds exact near-field echoes of cells of the whole array's polar grid: first of those with the largest amplitudes of
/// both ends together, then also of those whose residual exceeds the penalty, whose gains were wrongly taken for zero (R. Tibshirani et al.,
/// "Strong rules for discarding predictors in lasso-type problems", J. R. Stat. Soc. B 74, 2012).
#[derive(Debug, Clone, Copy)]
pub struct Fista {
    /// Penalty, as a part of the one that leaves no reflector, at least the one that suppresses noise. Default by examples/choose_eta.rs.
    pub penalty: f64,
    /// Cells that are candidates; at most 4096 are taken, whose Gram matrix fills 268 MB.
    pub candidates: usize,
    pub iterations: usize,
}

impl Default for Fista {
    fn default() -> Self {
        Fista { penalty: 0.1, candidates: 1024, iterations: 150 }
    }
}

/// Most candidates: memory and time grow with their square.
const MAX_CANDIDATES: usize = 4096;

/// Most rounds of adding cells, and most cells added in a round.
const ADDING_ROUNDS: usize = 2;
const MAX_ADDED_CELLS: usize = 512;

/// Ratio of a cell's residual to the penalty above which the cell is added: the margin covers the error of a look-up.
const MIN_ADDED_RESIDUAL_RATIO: f64 = 1.1;

/// Most reflectors in the map; the strongest that the penalty left.
const MAX_DRAWN_REFLECTORS: usize = 200;

#[derive(Clone)]
struct Problem {
    atoms: Vec<ArrayEcho>,
    /// `A^H A`, row after row.
    gram: Vec<Complex64>,
    /// `A^H y`.
    heard: Vec<Complex64>,
    penalty: f64,
}

/// The `count` cells, without those `known`, with the largest amplitudes of both ends, in grid order, correlated above `least` with a unit echo.
fn candidates(
    radar: &Radar,
    cells: &GridCells<'_>,
    heard_of: [Array2<Complex64>; 2],
    count: usize,
    known: &[GridCell],
    least: f64,
) -> Vec<GridCell> {
    let [first, last] = heard_of;
    // The scale of unit atoms: a far reflector's echo is weak, its atom is not.
    let scale = 0.5 * (radar.samples * radar.end_elements) as f64;
    let power = Zip::from(&first).and(&last).par_map_collect(|a, b| scale * (a + b).norm_sqr());
    let known: HashSet<(usize, usize)> = known.iter().map(|cell| (cell.bin, cell.direction)).collect();
    let mut heard: Vec<(usize, GridCell, f64)> = power
        .indexed_iter()
        .enumerate()
        .map(|(i, ((bin, direction), power))| (i, GridCell { bin, direction }, *power))
        .filter(|(_, cell, power)| *power > least * least && cells.may_hold(*cell))
        .filter(|(_, cell, _)| !known.contains(&(cell.bin, cell.direction)))
        .collect();
    let count = count.min(heard.len());
    if count > 0 {
        // Equal powers keep the order of the grid, so that the choice is the same on every run.
        heard.select_nth_unstable_by(count - 1, |a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
    }
    heard.truncate(count);
    heard.sort_unstable_by_key(|(i, _, _)| *i);
    heard.into_iter().map(|(_, cell, _)| cell).collect()
}

#[derive(Debug, Clone, Copy)]
enum Penalty {
    /// This part of the penalty that would leave no reflector at all, and at least `least`.
    Part { part: f64, least: f64 },
    /// A given penalty.
    Known(f64),
}

impl Problem {
    fn new(cells: &GridCells<'_>, chosen: &[GridCell], ends: &TwoEnds, penalty: Penalty, task: &Task) -> Result<Self> {
        let atoms: Vec<ArrayEcho> = chosen.par_iter().filter_map(|cell| cells.echo(*cell)).collect();
        task.check()?;
        task.set_progress(0.1);
        let samples = ends.flat();
        let heard: Vec<Complex64> = atoms.par_iter().map(|a| a.correlate(&samples)).collect();
        let count = atoms.len();
        let mut gram = vec![Complex64::default(); count * count];
        gram.par_chunks_mut(count.max(1)).enumerate().try_for_each(|(i, row)| {
            task.check()?;
            for (j, cell) in row.iter_mut().enumerate() {
                *cell = atoms[i].inner(&atoms[j]);
            }
            Ok::<(), ReconstructError>(())
        })?;
        let largest = heard.iter().fold(0.0, |m: f64, h| m.max(h.norm()));
        let penalty = match penalty {
            Penalty::Part { part, least } => f64::max(part * largest, least),
            Penalty::Known(penalty) => penalty,
        };
        Ok(Problem { atoms, gram, heard, penalty })
    }

    fn left(&self, radar: &Radar, ends: &TwoEnds, x: &[Complex64]) -> TwoEnds {
        let mut left = ends.flat();
        for (atom, gain) in self.atoms.iter().zip(x).filter(|(_, gain)| gain.norm_sqr() > 0.0) {
            left.iter_mut().zip(atom.unit_samples()).for_each(|(left, unit)| *left -= gain * unit);
        }
        TwoEnds::of_flat(radar, &left)
    }

    fn gram_times(&self, x: &[Complex64]) -> Vec<Complex64> {
        let n = self.atoms.len();
        let support: Vec<(usize, Complex64)> =
            x.iter().copied().enumerate().filter(|(_, v)| v.norm_sqr() > 0.0).collect();
        self.gram.par_chunks(n.max(1)).map(|row| support.iter().map(|(j, v)| row[*j] * v).sum()).collect()
    }

    fn objective(&self, x: &[Complex64], gram_x: &[Complex64]) -> f64 {
        x.iter()
            .zip(gram_x)
            .zip(&self.heard)
            .map(|((x, g), h)| 0.5 * (x.conj() * g).re - (x.conj() * h).re + self.penalty * x.norm())
            .sum()
    }

    fn lipschitz(&self) -> f64 {
        let mut v = self.heard.clone();
        let mut largest = 1.0;
        for _ in 0..12 {
            let length = v.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            if length == 0.0 {
                break;
            }
            v.iter_mut().for_each(|v| *v /= length);
            v = self.gram_times(&v);
            largest = v.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        }
        1.05 * largest
    }

    /// Monotone FISTA; `watch` is called with the objective after every iteration.
    fn solve(&self, iterations: usize, request: &Request, mut watch: impl FnMut(f64)) -> Result<Vec<Complex64>> {
        let n = self.atoms.len();
        let step = 1.0 / self.lipschitz();
        let (mut x, mut gram_x) = (vec![Complex64::default(); n], vec![Complex64::default(); n]);
        let (mut ahead, mut gram_ahead) = (x.clone(), gram_x.clone());
        let mut best = 0.0;
        let mut momentum = 1.0f64;
        for iteration in 0..iterations {
            request.task.check()?;
            request.task.set_progress(0.2 + 0.7 * iteration as f32 / iterations as f32);
            let slopes = gram_ahead.iter().zip(&self.heard).map(|(g, h)| g - h);
            let stepped = ahead.iter().zip(slopes).map(|(a, slope)| a - slope * step);
            let next: Vec<Complex64> = stepped.map(|v| shrink(v, self.penalty * step)).collect();
            let gram_next = self.gram_times(&next);
            let objective = self.objective(&next, &gram_next);
            let next_momentum = (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt()) / 2.0;
            // Monotone: a step that raises the objective moves the extrapolation point, not the answer.
            let better = objective <= best;
            let forward = (momentum - 1.0) / next_momentum;
            let pull = momentum / next_momentum;
            let (weight_next, weight_old) = if better { (1.0 + forward, -forward) } else { (pull, 1.0 - pull) };
            let mix = |a: &[Complex64], b: &[Complex64]| -> Vec<Complex64> {
                a.iter().zip(b).map(|(a, b)| a * weight_next + b * weight_old).collect()
            };
            (ahead, gram_ahead) = (mix(&next, &x), mix(&gram_next, &gram_x));
            if better {
                (x, gram_x, best) = (next, gram_next, objective);
            }
            momentum = next_momentum;
            watch(best);
        }
        Ok(x)
    }
}

/// The proximal step of the l1 norm: magnitudes less `by`, phases kept.
fn shrink(v: Complex64, by: f64) -> Complex64 {
    let norm = v.norm();
    if norm > by { v * ((norm - by) / norm) } else { Complex64::default() }
}

impl Reconstructor for Fista {
    fn lists_few_elements(&self) -> bool {
        false
    }

    fn family(&self) -> Family {
        Family::Sparse
    }

    fn info(&self) -> MethodInfo {
        MethodInfo {
            name: "fista",
            description: "sparse fit with an l1 penalty on the near-field polar grid, among the cells heard most, and its exact map",
            prior_knowledge: "that a scene holds few reflectors, each in one of the 1024 cells from which both ends heard most or of at most 1024 more that \
                these leave unexplained; its penalty was chosen on scenes like the tables', the noise it measures itself",
            eta: 0.847, // by examples/choose_eta.rs
        }
    }

    fn layout_support(&self) -> LayoutSupport {
        LayoutSupport::Halves
    }

    fn check_radar(&self, radar: &Radar) -> Result<()> {
        too_many_folds(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        let cells = GridCells::with_measured_elements(radar, ends);
        let backprojector = Backprojector::new(&cells, RangeWindow::None);
        let count = self.candidates.min(MAX_CANDIDATES);
        let mut chosen = candidates(radar, &cells, backprojector.amplitudes(ends), count, &[], 0.0);
        let noise_variance = ends_noise_variance(radar, ends, request.noise);
        // At least the level that noise alone exceeds in no cell: the universal threshold of D. L. Donoho and I. M. Johnstone, "Ideal spatial
        // adaptation by wavelet shrinkage", Biometrika 81, 1994, at the chance of the other thresholds.
        let (bins, directions) = cells.dim();
        let least = 10f64.powf(decades_above_cells(noise_variance, bins * directions));
        let penalty = Penalty::Part { part: self.penalty, least };
        let mut problem = Problem::new(&cells, &chosen, ends, penalty, &request.task)?;
        let mut x = problem.solve(self.iterations, request, |_| {})?;
        for _ in 0..ADDING_ROUNDS {
            let left = backprojector.amplitudes(&problem.left(radar, ends, &x));
            let (penalty, room) = (problem.penalty, MAX_ADDED_CELLS.min(MAX_CANDIDATES.saturating_sub(chosen.len())));
            let more = candidates(radar, &cells, left, room, &chosen, MIN_ADDED_RESIDUAL_RATIO * penalty);
            if more.is_empty() {
                break;
            }
            chosen.extend(more);
            problem = Problem::new(&cells, &chosen, ends, Penalty::Known(penalty), &request.task)?;
            x = problem.solve(self.iterations, request, |_| {})?;
        }
        let gained = |(atom, x): (&ArrayEcho, &Complex64)| Gained { reflector: atom.reflector, gain: x / atom.norm() };
        let kept = problem.atoms.iter().zip(&x).filter(|(_, x)| x.norm_sqr() > 0.0);
        let mut found: Vec<Gained> = kept.map(gained).collect();
        found.sort_by(|a, b| b.gain.norm().total_cmp(&a.gain.norm()));
        found.truncate(MAX_DRAWN_REFLECTORS);
        Ok(of_echoes(radar, ends, &found, noise_variance, request))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn shrinking_keeps_the_phase() {
        assert_eq!(shrink(Complex64::new(3.0, 4.0), 2.5), Complex64::new(1.5, 2.0));
        assert_eq!(shrink(Complex64::new(0.3, 0.4), 2.5), Complex64::default());
    }

    #[test]
    fn cells_that_are_needed_are_added_later() {
        let radar = Radar::default();
        // The near one fills all of the first few cells.
        let scene = Scene::of_points([(3.0, 7.0), (-5.0, 16.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let few = Fista { candidates: 24, ..Fista::default() };
        let found = few.reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
        let near = |r: &crate::scene::Reflector| (r.x_metres + 5.0).hypot(r.y_metres - 16.0) < 0.3;
        assert!(found.iter().any(near), "{found:?}");
    }

    #[test]
    fn the_objective_falls_to_a_sparse_answer() {
        let radar = Radar::default();
        let scene = Scene::of_points([(3.0, 12.0), (-5.0, 9.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let request = Request::default();
        let cells = GridCells::with_measured_elements(&radar, &ends);
        let heard = Backprojector::new(&cells, RangeWindow::None).amplitudes(&ends);
        let chosen = candidates(&radar, &cells, heard, 300, &[], 0.0);
        let problem =
            Problem::new(&cells, &chosen, &ends, Penalty::Part { part: 0.02, least: 0.0 }, &request.task).unwrap();
        let mut objectives = vec![0.0];
        let x = problem.solve(150, &request, |o| objectives.push(o)).unwrap();
        assert!(objectives.windows(2).all(|w| w[1] <= w[0]), "{objectives:?}");
        assert!(objectives[150] < objectives[1]);
        let used = |x: &[Complex64]| x.iter().filter(|x| x.norm_sqr() > 0.0).count();
        let strict = Problem { penalty: 20.0 * problem.penalty, ..problem.clone() };
        let fewer = used(&strict.solve(150, &request, |_| {}).unwrap());
        assert!(fewer >= 2 && 2 * fewer < used(&x), "a higher price buys fewer reflectors: {fewer}, {}", used(&x));
        // The optimality condition of an l1 penalty: no correlation of the residual exceeds it.
        let gram_x = problem.gram_times(&x);
        let worst = gram_x.iter().zip(&problem.heard).map(|(g, h)| (h - g).norm()).fold(0.0, f64::max);
        assert!(worst < 1.5 * problem.penalty, "{worst} {}", problem.penalty);
    }
}
