//! Least-squares fits of atoms: Levenberg-Marquardt steps of their places, gains solved exactly at each step.
//!
//! The samples are linear in the gains, so these are projected out (variable projection, Golub and Pereyra 1973, in Kaufman's approximation). The
//! normal equations, in closed form, give the step only. The residual is computed from the samples, so that the error is that of f64 and not its root.

use super::atom::Atom;
use super::echoes::{ProductKind, Remainder, Samples, remainder};
use super::gram::Dictionary;
use super::moments::Moments;
use super::sensor::Sensor;
use super::solver::{RidgeSolver, damped_step};
use super::work::WorkBudget;
use crate::radar::Radar;
use crate::reconstruct::noise_model::NoiseModel;
use crate::scene::Reflector;
use crate::task::Task;
use faer::Mat;
use num_complex::Complex64;
use std::sync::Arc;

/// Whether an atom has one gain or a gain for each end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tie {
    /// A gain for each end: the place follows from the ranges and from the phases within each end, without ambiguity.
    PerEnd,
    /// One gain: the phase between the ends counts too. The place is twenty times as exact, and ambiguous by columns of the map.
    Both,
}

/// The end of a refinement, and its ridge.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Largest number of steps.
    pub max_steps: usize,
    /// Relative decrease of the energy below which a step is the last.
    pub min_decrease: f64,
    /// Penalty on squared gains, relative to the energy of an atom of gain 1. It keeps inexact atoms from large gains that cancel each other.
    pub ridge: f64,
}

impl Limits {
    /// For a refinement that others follow.
    pub const ROUGH_FIT: Limits = Limits { max_steps: 12, min_decrease: 1e-2, ridge: 0.0 };

    /// For the last refinement of a list of atoms.
    pub const FINAL_FIT: Limits = Limits { max_steps: 60, min_decrease: 1e-4, ridge: 0.0 };
}

/// Gains at the first and at the last end.
pub type Gains = [Complex64; 2];

/// The model of both ends' samples under a window, and the budget of all fits with it.
#[derive(Clone)]
pub struct Fitter<'a> {
    pub sensor: Sensor,
    /// Squares of the window, `[samples]`.
    pub squared: Vec<f64>,
    moments: Moments,
    max_range_metres: f64,
    pub noise_model: NoiseModel,
    pub task: &'a Task,
    /// The budget, shared with the fitters of range gates.
    pub work: Arc<WorkBudget>,
}

/// Largest number of reflectors of a refinement without a budget: it may run beside others, where the work done differs each time.
const MAX_PARALLEL_REFLECTORS: usize = 16;

/// Number of inner products of two echoes in a unit of work.
const PRODUCTS_PER_ECHO: usize = 64;

/// Atoms with their gains, and the residual of samples without them.
#[derive(Debug, Clone)]
pub struct Fit {
    pub atoms: Vec<Atom>,
    pub gains: Vec<Gains>,
    /// Not windowed.
    pub residual: Samples,
    /// Energy of the windowed residual at each end.
    pub energy: [f64; 2],
}

impl Fit {
    /// Energy of the windowed residual.
    pub fn cost(&self) -> f64 {
        self.energy[0] + self.energy[1]
    }
}

#[derive(Debug, Clone, Copy)]
struct FitOptions {
    tie: Tie,
    ridge: f64,
    derivatives: bool,
}

/// Atoms at one step, and the terms of the next.
struct State {
    fit: Fit,
    /// Energy of the windowed residual and the penalty on gains.
    cost: f64,
    /// Gram matrix of the columns of [`Dictionary`], for each end, or the sum of both where gains are tied.
    grams: Vec<Mat<Complex64>>,
    /// Inner products of the columns with the residual, likewise.
    slopes: Vec<Vec<Complex64>>,
    first_column: Vec<usize>,
}

impl<'a> Fitter<'a> {
    /// The model of the ends of `radar` under `window`, `[samples]`, for noise without expectation; `max_work` is in units of [`WorkBudget`].
    pub fn new(radar: &Radar, window: &[f64], task: &'a Task, max_work: usize) -> Self {
        Fitter {
            sensor: Sensor::new(radar),
            squared: window.iter().map(|w| w * w).collect(),
            moments: Moments::new(window),
            max_range_metres: radar.max_range_metres(),
            noise_model: NoiseModel::any(),
            task,
            work: Arc::new(WorkBudget::new(max_work)),
        }
    }

    /// The fitter for the channels of `flat`, `[channels * samples]`, that are not all zero.
    pub fn with_channels_of(self, flat: &[Complex64]) -> Self {
        Fitter { sensor: self.sensor.with_channels_of(flat), ..self }
    }

    pub fn with_noise(self, noise_model: NoiseModel) -> Self {
        Fitter { noise_model, ..self }
    }

    /// The fitter for chirps of fewer samples, those of `radar`, under a window with the squares `squared`. Both have one budget.
    pub fn sampled_as(&self, radar: &Radar, squared: Vec<f64>) -> Self {
        let sensor = self.sensor.sampled_as(radar);
        Fitter { sensor, squared, moments: self.moments.sampled_as(radar.samples), ..self.clone() }
    }

    /// `samples` without `atoms` of the gains `gains`.
    pub fn subtract(&self, samples: &Samples, atoms: &[Atom], gains: &[Gains]) -> Remainder {
        let reflectors = reflectors(atoms, gains);
        self.work.spend(reflectors.len() + 1);
        remainder(&self.sensor, &self.squared, samples, &reflectors, ProductKind::None)
    }

    /// Energy of the windowed samples.
    pub fn energy(&self, samples: &Samples) -> f64 {
        self.subtract(samples, &[], &[]).energy.iter().sum()
    }

    /// Least-squares gains of `atoms` at their places, with a `ridge` as in [`Limits`].
    pub fn solve(&self, samples: &Samples, atoms: Vec<Atom>, tie: Tie, ridge: f64) -> Fit {
        let gains = vec![Gains::default(); atoms.len()];
        let fit = self.state(samples, atoms, gains, FitOptions { tie, ridge, derivatives: false }).fit;
        self.fit_of(samples, fit.atoms, fit.gains)
    }

    /// Moves `atoms` to a local minimum of the energy of the residual. The gains begin at `gains`, which are zeros or near the truth.
    pub fn refine(&self, samples: &Samples, atoms: Vec<Atom>, gains: Vec<Gains>, tie: Tie, limits: Limits) -> Fit {
        let options = FitOptions { tie, ridge: limits.ridge, derivatives: true };
        let mut state = self.state(samples, atoms, gains, options);
        let mut damping = 1e-3;
        let is_large = state.fit.atoms.iter().map(Atom::reflector_count).sum::<usize>() > MAX_PARALLEL_REFLECTORS;
        for _ in 0..limits.max_steps {
            if is_large && self.work.is_spent() {
                break;
            }
            if state.cost <= 0.0 || state.fit.atoms.is_empty() || self.task.is_cancelled() {
                break;
            }
            let Some(trial) = self.step(samples, &state, options, &mut damping, 0.1 * limits.min_decrease) else {
                break;
            };
            let decrease = 1.0 - trial.cost / state.cost;
            state = trial;
            if decrease < limits.min_decrease {
                break;
            }
        }
        self.fit_of(samples, state.fit.atoms, state.fit.gains)
    }

    /// The state after one step, with `damping` adapted to it; `None` where no step lowers the energy by `min_decrease` of it.
    fn step(
        &self,
        samples: &Samples,
        state: &State,
        options: FitOptions,
        damping: &mut f64,
        min_decrease: f64,
    ) -> Option<State> {
        let equations = normal_equations(state, options.ridge);
        for _ in 0..6 {
            let step = damped_step(&equations.hessian, &equations.gradient, *damping);
            let Some(step) = step.filter(|s| self.is_within_reach(&state.fit.atoms, s)) else {
                *damping *= 10.0;
                continue;
            };
            // The decrease by the linear model; a shorter step has a smaller one.
            let max_decrease = 2.0 * step.iter().zip(&equations.gradient).map(|(s, g)| s * g).sum::<f64>();
            if max_decrease < min_decrease * state.cost {
                return None;
            }
            let mut at = 0;
            let atoms = state.fit.atoms.iter().map(|atom| {
                at += atom.parameter_count();
                atom.moved(&step[at - atom.parameter_count()..at])
            });
            let gains = equations.gains_after(&state.fit.gains, &step);
            let trial = self.state(samples, atoms.collect(), gains, options);
            if trial.cost < state.cost {
                *damping = (*damping * 0.1).max(1e-12);
                return Some(trial);
            }
            *damping *= 10.0;
        }
        None
    }

    /// Whether `step` moves no parameter by more than the maximum range, after which ranges repeat; of a point's square of y, by more than its square.
    fn is_within_reach(&self, atoms: &[Atom], step: &[f64]) -> bool {
        let limit = |atom: &Atom, k: usize| match (atom, k) {
            (Atom::Point { .. }, 1) => self.max_range_metres.powi(2),
            _ => self.max_range_metres,
        };
        let parameters = atoms.iter().flat_map(|atom| (0..atom.parameter_count()).map(move |k| (atom, k)));
        parameters.zip(step).all(|((atom, k), v)| v.abs() < limit(atom, k))
    }

    /// For each atom the increase of the residual's energy without it, the gains of the others fitted again.
    pub fn marginal_energies(&self, fit: &Fit) -> Vec<f64> {
        let dictionary = Dictionary::new(&self.sensor, &self.moments, &fit.atoms, false);
        let n = fit.atoms.len();
        let mut energies = vec![0.0; n];
        for (end, gram) in dictionary.grams().iter().enumerate() {
            let inverse = RidgeSolver::new(gram, 0.0).solve(&Mat::identity(n, n));
            for (i, energy) in energies.iter_mut().enumerate() {
                *energy += fit.gains[i][end].norm_sqr() / inverse[(i, i)].re.max(f64::MIN_POSITIVE);
            }
        }
        energies
    }

    /// Energy of the windowed echo, at both ends, of a point with this amplitude at all elements.
    pub fn energy_of_amplitude(&self, amplitude: f64) -> f64 {
        2.0 * self.sensor.end_elements as f64 * amplitude * amplitude * self.squared.iter().sum::<f64>()
    }

    /// Mean energy that one gain explains of the noise in the residual of `fit`.
    pub fn noise_energy(&self, radar: &Radar, fit: &Fit) -> f64 {
        let flat = fit.residual.flat(&self.sensor);
        let variance = self.noise_model.noise_variance(radar, &flat);
        let [square, fourth] = self.squared.iter().fold([0.0; 2], |[s, f], w| [s + w, f + w * w]);
        variance * fourth / square
    }

    /// The residual of `fit` without the atoms of the numbers `removed`, whose echoes are added to it. The other gains stay as they are.
    pub fn residual_without(&self, fit: &Fit, removed: &[usize]) -> Remainder {
        let atoms: Vec<Atom> = removed.iter().map(|&i| fit.atoms[i]).collect();
        let negative: Vec<Gains> = removed.iter().map(|&i| fit.gains[i].map(|g| -g)).collect();
        self.subtract(&fit.residual, &atoms, &negative)
    }

    /// `fit` without the atoms of the numbers `removed`, as [`Self::residual_without`].
    pub fn remove(&self, fit: &Fit, removed: &[usize]) -> Fit {
        let left = self.residual_without(fit, removed);
        let kept: Vec<usize> = (0..fit.atoms.len()).filter(|i| !removed.contains(i)).collect();
        Fit {
            atoms: kept.iter().map(|&i| fit.atoms[i]).collect(),
            gains: kept.iter().map(|&i| fit.gains[i]).collect(),
            residual: left.residual,
            energy: left.energy,
        }
    }

    /// The state of `atoms` with their least-squares gains; these begin at `gains`.
    fn state(&self, samples: &Samples, atoms: Vec<Atom>, mut gains: Vec<Gains>, options: FitOptions) -> State {
        let FitOptions { tie, ridge, derivatives } = options;
        if tie == Tie::Both {
            // Steps are the same at both ends, so that different gains would stay different.
            gains.iter_mut().for_each(|g| *g = [(g[0] + g[1]) / 2.0; 2]);
        }
        let dictionary = Dictionary::new(&self.sensor, &self.moments, &atoms, derivatives);
        let [first, last] = dictionary.grams();
        let grams = match tie {
            Tie::PerEnd => vec![first, last],
            Tie::Both => vec![first + last],
        };
        let n = atoms.len();
        let echoes: usize = atoms.iter().map(Atom::reflector_count).sum();
        self.work.spend(echoes * echoes / PRODUCTS_PER_ECHO);
        let columns = &dictionary.first_column;
        let values = |gram: &Mat<Complex64>| Mat::from_fn(n, n, |i, j| gram[(columns[i], columns[j])]);
        let solvers: Vec<RidgeSolver> = grams.iter().map(|gram| RidgeSolver::new(&values(gram), ridge)).collect();
        // Further passes remove the error of normal equations of a large condition number, or of gains that begin far off.
        for pass in 0..3 {
            self.work.spend(2 * echoes + 1);
            let kind = if derivatives { ProductKind::Slopes } else { ProductKind::Values };
            let left = remainder(&self.sensor, &self.squared, samples, &reflectors(&atoms, &gains), kind);
            let [first, last] = dictionary.slopes(&left.products);
            let mut slopes = match tie {
                Tie::PerEnd => vec![first, last],
                Tie::Both => vec![first.iter().zip(&last).map(|(a, b)| a + b).collect()],
            };
            let mut cost = left.energy[0] + left.energy[1];
            let mut decrease = 0.0;
            for (block, ((slopes, gram), solver)) in slopes.iter_mut().zip(&grams).zip(&solvers).enumerate() {
                let penalty = |i: usize| gains[i][block] * (ridge * gram[(columns[i], columns[i])].re);
                cost += (0..n).map(|i| (penalty(i).conj() * gains[i][block]).re).sum::<f64>();
                let slope: Vec<Complex64> = (0..n).map(|i| slopes[columns[i]] - penalty(i)).collect();
                let step = solver.solve(&Mat::from_fn(n, 1, |i, _| slope[i]));
                decrease += (0..n).map(|i| (step[(i, 0)].conj() * slope[i]).re).sum::<f64>();
                for (i, gains) in gains.iter_mut().enumerate() {
                    match tie {
                        Tie::PerEnd => gains[block] += step[(i, 0)],
                        Tie::Both => gains.iter_mut().for_each(|g| *g += step[(i, 0)]),
                    }
                }
                for (c, slope) in slopes.iter_mut().enumerate() {
                    *slope -= (0..n).map(|i| gram[(c, columns[i])] * step[(i, 0)]).sum::<Complex64>();
                }
            }
            if pass == 2 || decrease < 0.9 * cost {
                let cost = (cost - decrease).max(0.0);
                let first_column = dictionary.first_column.clone();
                drop(dictionary);
                let fit = Fit { atoms, gains, residual: left.residual, energy: left.energy };
                return State { fit, cost, grams, slopes, first_column };
            }
        }
        unreachable!("the last pass returns")
    }

    /// `samples` without `atoms` of the gains `gains`.
    pub fn fit_of(&self, samples: &Samples, atoms: Vec<Atom>, gains: Vec<Gains>) -> Fit {
        let Remainder { residual, energy, .. } = self.subtract(samples, &atoms, &gains);
        Fit { atoms, gains, residual, energy }
    }
}

/// The reflectors of all atoms, with the gains of their atoms.
fn reflectors(atoms: &[Atom], gains: &[Gains]) -> Vec<(Reflector, Gains)> {
    atoms.iter().zip(gains).flat_map(|(atom, gains)| atom.reflectors(1.0).map(move |r| (r, *gains))).collect()
}

/// Gauss-Newton equations of the parameters of all atoms, gains projected out.
struct Equations {
    hessian: Mat<f64>,
    gradient: Vec<f64>,
    /// Derivatives of the negative gains by the parameters, `[atoms, parameters]`, for each Gram matrix.
    gain_derivatives: Vec<Mat<Complex64>>,
}

fn normal_equations(state: &State, ridge: f64) -> Equations {
    let atoms = &state.fit.atoms;
    // (atom, column) of every parameter.
    let parameters: Vec<(usize, usize)> = (0..atoms.len())
        .flat_map(|i| (0..atoms[i].parameter_count()).map(move |k| (i, k)))
        .map(|(i, k)| (i, state.first_column[i] + 1 + k))
        .collect();
    let (n, size) = (atoms.len(), parameters.len());
    let mut equations = Equations {
        hessian: Mat::zeros(size, size),
        gradient: vec![0.0; size],
        gain_derivatives: Vec::with_capacity(2),
    };
    for (b, gram) in state.grams.iter().enumerate() {
        let gain = |atom: usize| state.fit.gains[atom][b];
        let values = Mat::from_fn(n, n, |i, j| gram[(state.first_column[i], state.first_column[j])]);
        let cross =
            Mat::from_fn(n, size, |i, j| gram[(state.first_column[i], parameters[j].1)] * gain(parameters[j].0));
        let projected = RidgeSolver::new(&values, ridge).solve(&cross);
        let explained = cross.adjoint() * &projected;
        for (j, &(aj, cj)) in parameters.iter().enumerate() {
            equations.gradient[j] += (gain(aj).conj() * state.slopes[b][cj]).re;
            for (k, &(ak, ck)) in parameters.iter().enumerate() {
                let product = gain(aj).conj() * gain(ak) * gram[(cj, ck)];
                equations.hessian[(j, k)] += product.re - explained[(j, k)].re;
            }
        }
        equations.gain_derivatives.push(projected);
    }
    equations
}

impl Equations {
    /// The gains after `step` of the parameters, to first order.
    fn gains_after(&self, gains: &[Gains], step: &[f64]) -> Vec<Gains> {
        let change = |end: usize, i: usize| {
            let derivatives = &self.gain_derivatives[end.min(self.gain_derivatives.len() - 1)];
            step.iter().enumerate().map(|(j, s)| derivatives[(i, j)] * *s).sum::<Complex64>()
        };
        gains.iter().enumerate().map(|(i, g)| [g[0] - change(0, i), g[1] - change(1, i)]).collect()
    }
}
