//! Least-squares refinement of a set of atoms: Levenberg-Marquardt on positions, gains solved exactly at every step.
//!
//! The samples are linear in the gains, so the gains are projected out (variable projection, Golub and Pereyra 1973, in Kaufman's
//! approximation): only positions are searched. Normal equations in closed form are good enough for the *step*; the residual itself is
//! always formed from samples, so accuracy is that of f64 and not of its square root.

use super::atom::Atom;
use super::echoes::{ProductKind, Remainder, Samples, remainder};
use super::gram::Dictionary;
use super::moments::Moments;
use super::sensor::Sensor;
use super::solver::{RidgeSolver, damped_step};
use super::work::WorkBudget;
use crate::radar::Radar;
use crate::reconstruct::hearing::Hearing;
use crate::scene::Reflector;
use crate::task::Task;
use faer::Mat;
use num_complex::Complex64;
use std::sync::Arc;

/// The samples that share one gain for each atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tie {
    /// Each end has its own gain: the position follows from ranges and from the phases inside each end. No ambiguity.
    PerEnd,
    /// Both ends share the gain: the carrier's phase between the ends counts. Twenty times finer, and ambiguous by whole columns.
    Both,
}

/// Limits at which a refinement ends.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Most steps.
    pub max_steps: usize,
    /// A step that lowers the energy by a smaller part than this is the last.
    pub min_decrease: f64,
    /// Price of a gain, relative to the energy of its atom: it keeps inexact atoms from large gains that cancel.
    pub ridge: f64,
}

impl Limits {
    /// Limits of a refinement before further ones: most of the way in a few steps.
    pub const ROUGH: Limits = Limits { max_steps: 12, min_decrease: 1e-2, ridge: 0.0 };

    /// Limits of a refinement once all atoms are there.
    pub const FINAL_FIT: Limits = Limits { max_steps: 60, min_decrease: 1e-4, ridge: 0.0 };
}

/// Gains at the first and at the last end.
pub type Gains = [Complex64; 2];

/// The shared data of all refinements of one search.
#[derive(Clone)]
pub struct Fitter<'a> {
    /// Geometry of the samples.
    pub sensor: Sensor,
    /// Squares of the weights of the samples of a chirp.
    pub squared: Vec<f64>,
    moments: Moments,
    max_range_metres: f64,
    /// The noise beneath the samples.
    pub noise_model: Hearing,
    task: &'a Task,
    /// Work granted to the search, and done by it.
    pub work: Arc<WorkBudget>,
}

/// Most reflectors of a refinement that may run beside others.
const MAX_PARALLEL_REFLECTORS: usize = 16;

/// Inner products of two echoes that take as long as one echo at all channels.
const PRODUCTS_PER_ECHO: usize = 64;

/// Atoms with their gains, and their residual.
#[derive(Debug, Clone)]
pub struct Fit {
    pub atoms: Vec<Atom>,
    pub gains: Vec<Gains>,
    /// Samples minus atoms, not windowed.
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

/// All quantities of one set of atoms at one place.
struct State {
    fit: Fit,
    cost: f64,
    /// Inner products of all columns for each block of samples that shares gains.
    grams: Vec<Mat<Complex64>>,
    /// Products of all columns with the residual, for each block.
    slopes: Vec<Vec<Complex64>>,
    first_column: Vec<usize>,
}

impl<'a> Fitter<'a> {
    /// The workbench for the ends of `radar` under `window`.
    pub fn new(radar: &Radar, window: &[f64], task: &'a Task, max_work: usize) -> Self {
        Fitter {
            sensor: Sensor::new(radar),
            squared: window.iter().map(|w| w * w).collect(),
            moments: Moments::new(window),
            max_range_metres: radar.max_range_metres(),
            noise_model: Hearing::any(),
            task,
            work: Arc::new(WorkBudget::new(max_work)),
        }
    }

    /// The workbench for the channels of `flat` that aren't silent; `flat` are the samples channel by channel.
    pub fn with_channels_of(self, flat: &[Complex64]) -> Self {
        Fitter { sensor: self.sensor.with_channels_of(flat), ..self }
    }

    /// The workbench over noise of this kind.
    pub fn with_noise(self, noise_model: Hearing) -> Self {
        Fitter { noise_model, ..self }
    }

    /// The workbench for chirps of fewer samples, those of `radar`, under a window whose weights have these squares. Both share one count of work.
    pub fn sampled_as(&self, radar: &Radar, squared: Vec<f64>) -> Self {
        let sensor = self.sensor.sampled_as(radar);
        Fitter { sensor, squared, moments: self.moments.sampled_as(radar.samples), ..self.clone() }
    }

    /// `samples` less `atoms` times `gains`; not windowed.
    pub fn subtract(&self, samples: &Samples, atoms: &[Atom], gains: &[Gains]) -> Remainder {
        let reflectors = reflectors(atoms, gains);
        self.work.spend(reflectors.len() + 1);
        remainder(&self.sensor, &self.squared, samples, &reflectors, ProductKind::None)
    }

    pub fn energy(&self, samples: &Samples) -> f64 {
        self.subtract(samples, &[], &[]).energy.iter().sum()
    }

    pub fn solve(&self, samples: &Samples, atoms: Vec<Atom>, tie: Tie, ridge: f64) -> Fit {
        let gains = vec![Gains::default(); atoms.len()];
        self.fit_of(self.state(samples, atoms, gains, FitOptions { tie, ridge, derivatives: false }), samples)
    }

    /// Moves `atoms` to a local minimum of the energy of their residual in `samples`. `gains` are the first gains: zeros, or near the truth.
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
            let gained = 1.0 - trial.cost / state.cost;
            state = trial;
            if gained < limits.min_decrease {
                break;
            }
        }
        self.fit_of(state, samples)
    }

    /// One accepted step, with the damping that it takes; `None` at a minimum, where no step gains `min_decrease` of the energy.
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
            // The largest possible gain of the step; at a minimum it is 0, and no shorter step gains more.
            let most = 2.0 * step.iter().zip(&equations.gradient).map(|(s, g)| s * g).sum::<f64>();
            if most < min_decrease * state.cost {
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

    /// Whether no place is moved farther than the maximum range, after which ranges repeat: a point's second parameter is a square of a distance.
    fn is_within_reach(&self, atoms: &[Atom], step: &[f64]) -> bool {
        let most = |atom: &Atom, k: usize| match (atom, k) {
            (Atom::Point { .. }, 1) => self.max_range_metres.powi(2),
            _ => self.max_range_metres,
        };
        let parameters = atoms.iter().flat_map(|atom| (0..atom.parameter_count()).map(move |k| (atom, k)));
        parameters.zip(step).all(|((atom, k), v)| v.abs() < most(atom, k))
    }

    /// Growth of the energy without each atom, with the other gains fitted anew.
    pub fn marginal_energies(&self, fit: &Fit) -> Vec<f64> {
        let dictionary = Dictionary::new(&self.sensor, &self.moments, &fit.atoms, false);
        let n = fit.atoms.len();
        let mut marginal_energies = vec![0.0; n];
        for (end, gram) in dictionary.grams().iter().enumerate() {
            let inverse = RidgeSolver::new(gram, 0.0).solve(&Mat::identity(n, n));
            for (i, worth) in marginal_energies.iter_mut().enumerate() {
                *worth += fit.gains[i][end].norm_sqr() / inverse[(i, i)].re.max(f64::MIN_POSITIVE);
            }
        }
        marginal_energies
    }

    /// Energy under the window, at both ends, of a point whose samples have this amplitude.
    pub fn energy_of_amplitude(&self, amplitude: f64, radar: &Radar) -> f64 {
        2.0 * radar.end_elements as f64 * amplitude * amplitude * self.squared.iter().sum::<f64>()
    }

    /// Energy that the noise measured in the residual of `fit` gives to one gain under the window.
    pub fn noise_energy(&self, radar: &Radar, fit: &Fit) -> f64 {
        let flat = fit.residual.flat(&self.sensor);
        let variance = self.noise_model.noise_variance(radar, &flat);
        let [square, fourth] = self.squared.iter().fold([0.0; 2], |[s, f], w| [s + w, f + w * w]);
        variance * fourth / square
    }

    /// `fit` without the atoms of the indices `gone`, which go back into its residual.
    pub fn remove(&self, fit: Fit, gone: &[usize]) -> Fit {
        let atoms: Vec<Atom> = gone.iter().map(|&i| fit.atoms[i]).collect();
        let back: Vec<Gains> = gone.iter().map(|&i| fit.gains[i].map(|g| -g)).collect();
        let left = self.subtract(&fit.residual, &atoms, &back);
        let kept: Vec<usize> = (0..fit.atoms.len()).filter(|i| !gone.contains(i)).collect();
        Fit {
            atoms: kept.iter().map(|&i| fit.atoms[i]).collect(),
            gains: kept.iter().map(|&i| fit.gains[i]).collect(),
            residual: left.residual,
            energy: left.energy,
        }
    }

    /// The state of `atoms`; gains start at `gains` and end at their optimum.
    fn state(&self, samples: &Samples, atoms: Vec<Atom>, mut gains: Vec<Gains>, options: FitOptions) -> State {
        let FitOptions { tie, ridge, derivatives } = options;
        if tie == Tie::Both {
            // Different gains would stay different, since every step is the same at both ends.
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
        // The second pass removes the error of a large squared condition number of the normal equations, or of a far start.
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
            let mut gained = 0.0;
            for (block, ((slopes, gram), solver)) in slopes.iter_mut().zip(&grams).zip(&solvers).enumerate() {
                let price = |i: usize| gains[i][block] * (ridge * gram[(columns[i], columns[i])].re);
                cost += (0..n).map(|i| (price(i).conj() * gains[i][block]).re).sum::<f64>();
                let pull: Vec<Complex64> = (0..n).map(|i| slopes[columns[i]] - price(i)).collect();
                let step = solver.solve(&Mat::from_fn(n, 1, |i, _| pull[i]));
                gained += (0..n).map(|i| (step[(i, 0)].conj() * pull[i]).re).sum::<f64>();
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
            if pass == 2 || gained < 0.9 * cost {
                let cost = (cost - gained).max(0.0);
                let first_column = dictionary.first_column.clone();
                drop(dictionary);
                let fit = Fit { atoms, gains, residual: left.residual, energy: left.energy };
                return State { fit, cost, grams, slopes, first_column };
            }
        }
        unreachable!("the last pass returns")
    }

    /// The fit of a state, its residual formed anew from samples.
    fn fit_of(&self, state: State, samples: &Samples) -> Fit {
        let left = self.subtract(samples, &state.fit.atoms, &state.fit.gains);
        Fit { residual: left.residual, energy: left.energy, ..state.fit }
    }
}

fn reflectors(atoms: &[Atom], gains: &[Gains]) -> Vec<(Reflector, Gains)> {
    atoms.iter().zip(gains).flat_map(|(atom, gains)| atom.reflectors(1.0).map(move |r| (r, *gains))).collect()
}

/// Gauss-Newton equations for the parameters of all atoms, gains projected out.
struct Equations {
    hessian: Mat<f64>,
    gradient: Vec<f64>,
    /// Derivatives of the gains by the parameters, for each block of samples that shares gains.
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
        let change = |gain_derivatives: &Mat<Complex64>, i: usize| {
            step.iter().enumerate().map(|(j, s)| gain_derivatives[(i, j)] * *s).sum::<Complex64>()
        };
        let last = self.gain_derivatives.len() - 1;
        let moved = gains.iter().enumerate();
        moved
            .map(|(i, g)| [g[0] - change(&self.gain_derivatives[0], i), g[1] - change(&self.gain_derivatives[last], i)])
            .collect()
    }
}
