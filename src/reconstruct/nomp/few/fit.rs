//! Least-squares fit of a set of atoms to the samples: Levenberg-Marquardt on positions, gains solved exactly at every step.
//!
//! The samples are linear in the gains, so the gains are projected out (variable projection, Golub and Pereyra 1973, in Kaufman's
//! approximation): only positions are searched. Normal equations are good enough for the *step*; the residual itself is always
//! formed from samples, so accuracy is that of f64 and not of its square root.

use super::atom::Atom;
use crate::reconstruct::nomp::sensor::Sensor;
use crate::reconstruct::nomp::solver::{Ridge, damped_step};
use crate::reconstruct::nomp::work::Work;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, MatRef, Par};
use num_complex::Complex64;
use rayon::prelude::*;

/// Which samples share one gain for each atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tie {
    /// Each end has its own gain: the position follows from ranges and from the phases inside each end. No ambiguity.
    PerEnd,
    /// Both ends share the gain: the carrier's phase between the ends counts. Twenty times finer, and ambiguous by whole columns.
    Both,
}

/// Samples, their weights and what they are to be explained with.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// Geometry of the samples.
    pub sensor: &'a Sensor,
    /// The samples to explain, already times `window`.
    pub samples: &'a [Complex64],
    /// Weight of each sample of a chirp.
    pub window: &'a [f64],
    /// What counts the work.
    pub work: &'a Work,
}

/// Atoms with their gains, and what they leave unexplained.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The atoms.
    pub atoms: Vec<Atom>,
    /// Gain of each atom at the first and at the last end.
    pub gains: Vec<[Complex64; 2]>,
    /// Samples minus atoms.
    pub residual: Vec<Complex64>,
    /// Energy of the residual.
    pub cost: f64,
}

impl Fit {
    /// This fit, or `other` if it leaves less.
    pub fn or_better(self, other: Fit) -> Fit {
        if other.cost < self.cost { other } else { self }
    }
}

/// Most atoms of a fit that may run beside others.
const MOST_IN_PARALLEL: usize = 1;

/// No parameter moves by more in one step, metres.
const LONGEST_STEP: f64 = 1e3;

/// Everything known about one set of atoms.
struct State {
    fit: Fit,
    /// Gram matrix of values and derivatives for each block of samples that shares gains.
    grams: Vec<Mat<Complex64>>,
    /// Products of values and derivatives with the residual, for each block.
    slopes: Vec<Vec<Complex64>>,
    /// Column of each atom's value; its derivatives follow.
    first_column: Vec<usize>,
}

impl Problem<'_> {
    /// Gains and residual for `atoms` where they are.
    pub fn solve(&self, atoms: &[Atom], tie: Tie) -> Fit {
        self.state(atoms.to_vec(), tie, &vec![false; atoms.len()]).fit
    }

    /// Columns of every atom, and of its derivatives where `moving`; gains, residual and products.
    fn state(&self, atoms: Vec<Atom>, tie: Tie, moving: &[bool]) -> State {
        let rows = self.sensor.sample_count();
        let mut first_column = Vec::with_capacity(atoms.len());
        let mut columns = 0;
        for (atom, moving) in atoms.iter().zip(moving) {
            first_column.push(columns);
            columns += 1 + if *moving { atom.parameters() } else { 0 };
        }
        let reflectors: usize = atoms.iter().map(Atom::reflectors).sum();
        self.work.spend(3 * reflectors + columns * columns / 2);
        let mut flat = vec![Complex64::default(); rows * columns];
        let mut rest = flat.chunks_exact_mut(rows);
        let own: Vec<Vec<&mut [Complex64]>> = atoms
            .iter()
            .zip(moving)
            .map(|(atom, moving)| rest.by_ref().take(1 + if *moving { atom.parameters() } else { 0 }).collect())
            .collect();
        atoms
            .par_iter()
            .zip(own)
            .for_each(|(atom, mut columns)| self.sensor.fill_atom(atom, self.window, &mut columns));
        let all = MatRef::from_column_major_slice(&flat, rows, columns);

        let mut residual = self.samples.to_vec();
        let end = self.sensor.end_len();
        let (first, last) = rayon::join(|| gram(all.subrows(0, end)), || gram(all.subrows(end, end)));
        let grams = match tie {
            Tie::PerEnd => vec![first, last],
            Tie::Both => vec![first + last],
        };
        let block_len = residual.len() / grams.len();
        let solved: Vec<(Vec<Complex64>, Vec<Complex64>)> = residual
            .par_chunks_mut(block_len)
            .zip(&grams)
            .enumerate()
            .map(|(block, (residual, gram))| {
                let column = |j: usize| &flat[j * rows + block * block_len..][..block_len];
                let values = Mat::from_fn(atoms.len(), atoms.len(), |i, j| gram[(first_column[i], first_column[j])]);
                let solver = Ridge::new(&values, 0.0);
                let mut gains = vec![Complex64::default(); atoms.len()];
                // The second pass removes what the squared condition number of the normal equations left.
                for _ in 0..2 {
                    let rhs = Mat::from_fn(atoms.len(), 1, |i, _| dot(column(first_column[i]), residual));
                    let step = solver.solve(&rhs);
                    for (i, gain) in gains.iter_mut().enumerate() {
                        for (r, v) in residual.iter_mut().zip(column(first_column[i])) {
                            *r -= v * step[(i, 0)];
                        }
                        *gain += step[(i, 0)];
                    }
                }
                (gains, (0..columns).map(|j| dot(column(j), residual)).collect())
            })
            .collect();
        let gains = (0..atoms.len()).map(|i| [solved[0].0[i], solved[solved.len() - 1].0[i]]).collect();
        let slopes = solved.into_iter().map(|s| s.1).collect();
        let cost = energy(&residual);
        State { fit: Fit { atoms, gains, residual, cost }, grams, slopes, first_column }
    }

    /// Moves the atoms marked in `moving` to a local minimum of the residual's energy.
    pub fn refine(&self, atoms: Vec<Atom>, tie: Tie, moving: &[bool], limits: Limits) -> Fit {
        let mut state = self.state(atoms, tie, moving);
        let mut damping = 1e-3;
        for _ in 0..limits.iterations {
            // Large fits run one at a time, small ones in parallel.
            let is_spent = state.fit.atoms.len() > MOST_IN_PARALLEL && self.work.is_spent();
            if state.fit.cost == 0.0 || !moving.contains(&true) || is_spent {
                break;
            }
            let (hessian, gradient) = self.normal_equations(&state, moving);
            let mut accepted = None;
            for _ in 0..6 {
                let step = damped_step(&hessian, &gradient, damping);
                let Some(step) = step.filter(|step| step.iter().all(|s| s.abs() < LONGEST_STEP)) else {
                    damping *= 10.0;
                    continue;
                };
                // The most that the step can gain; at a minimum nothing, and no shorter step gains more.
                let most = 2.0 * step.iter().zip(&gradient).map(|(s, g)| s * g).sum::<f64>();
                if most < 0.1 * limits.least_gain * state.fit.cost {
                    break;
                }
                let mut at = 0;
                let atoms = state.fit.atoms.iter().zip(moving).map(|(atom, moving)| {
                    if !*moving {
                        return *atom;
                    }
                    let own = &step[at..at + atom.parameters()];
                    at += atom.parameters();
                    atom.moved(own)
                });
                let trial = self.state(atoms.collect(), tie, moving);
                if trial.fit.cost < state.fit.cost {
                    accepted = Some(trial);
                    damping = (damping * 0.1).max(1e-12);
                    break;
                }
                damping *= 10.0;
            }
            let Some(trial) = accepted else { break };
            let gained = 1.0 - trial.fit.cost / state.fit.cost;
            state = trial;
            if gained < limits.least_gain {
                break;
            }
        }
        state.fit
    }

    /// Gauss-Newton matrix and gradient for the parameters of the moving atoms, gains projected out.
    fn normal_equations(&self, state: &State, moving: &[bool]) -> (Mat<f64>, Vec<f64>) {
        let atoms = &state.fit.atoms;
        // (atom, column) of every parameter.
        let parameters: Vec<(usize, usize)> = (0..atoms.len())
            .filter(|&i| moving[i])
            .flat_map(|i| (0..atoms[i].parameters()).map(move |k| (i, k)))
            .map(|(i, k)| (i, state.first_column[i] + 1 + k))
            .collect();
        let size = parameters.len();
        let mut hessian = Mat::<f64>::zeros(size, size);
        let mut gradient = vec![0.0; size];
        for (b, gram) in state.grams.iter().enumerate() {
            let gain = |atom: usize| state.fit.gains[atom][b];
            let values =
                Mat::from_fn(atoms.len(), atoms.len(), |i, j| gram[(state.first_column[i], state.first_column[j])]);
            let cross = Mat::from_fn(atoms.len(), size, |i, j| {
                gram[(state.first_column[i], parameters[j].1)] * gain(parameters[j].0)
            });
            let projected = Ridge::new(&values, 0.0).solve(&cross);
            let explained = cross.adjoint() * &projected;
            for (j, &(aj, cj)) in parameters.iter().enumerate() {
                gradient[j] += (gain(aj).conj() * state.slopes[b][cj]).re;
                for (k, &(ak, ck)) in parameters.iter().enumerate() {
                    let product = gain(aj).conj() * gain(ak) * gram[(cj, ck)];
                    hessian[(j, k)] += product.re - explained[(j, k)].re;
                }
            }
        }
        (hessian, gradient)
    }
}

/// When a refinement ends.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Most steps.
    pub iterations: usize,
    /// A step that lowers the energy by a smaller part than this is the last.
    pub least_gain: f64,
}

impl Limits {
    /// Of a refinement that only tells good starts from bad ones.
    pub const GLANCE: Limits = Limits { iterations: 12, least_gain: 1e-2 };
}

/// `A^H A`, on one thread: the other end's has the next.
fn gram(a: MatRef<'_, Complex64>) -> Mat<Complex64> {
    let n = a.ncols();
    let mut product = Mat::zeros(n, n);
    triangular::matmul(
        product.as_mut(),
        BlockStructure::TriangularLower,
        Accum::Replace,
        a.adjoint(),
        BlockStructure::Rectangular,
        a,
        BlockStructure::Rectangular,
        Complex64::from(1.0),
        Par::Seq,
    );
    for j in 1..n {
        for i in 0..j {
            product[(i, j)] = product[(j, i)].conj();
        }
    }
    product
}

/// `a^H b`, in four sums that don't wait for each other.
fn dot(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    let mut sums = [Complex64::default(); 4];
    let (a_fours, b_fours) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = a_fours.remainder().iter().zip(b_fours.remainder());
    let rest: Complex64 = rest.map(|(a, b)| a.conj() * b).sum();
    for (a, b) in a_fours.zip(b_fours) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a.conj() * b;
        }
    }
    sums.iter().sum::<Complex64>() + rest
}

/// Sum of squared magnitudes.
pub fn energy(v: &[Complex64]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum()
}
