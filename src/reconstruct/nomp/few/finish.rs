//! From a fit with a gain for each end to objects: one gain for both ends, the right tooth of the comb, reflectivities.

use super::atom::Atom;
use super::fit::{Fit, Limits, Problem, Tie};
use crate::reconstruct::nomp::sensor::Sensor;
use crate::reconstruct::nomp::work::Work;
use crate::signal::Floor;
use num_complex::Complex64;

/// Teeth tried to each side: the phase between the ends repeats every column of the full map.
const TEETH: i32 = 6;

/// Most atoms whose teeth are tried one by one.
const MOST_COMBED: usize = 12;

/// Of the refinement with tied gains.
const TIED: Limits = Limits { iterations: 20, least_gain: 1e-6 };

/// What was found in the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The objects.
    pub atoms: Vec<Atom>,
    /// Gain of each object at the first and at the last end.
    pub gains: Vec<[Complex64; 2]>,
    /// Whether the residual is down to the floor that was asked for.
    pub complete: bool,
}

/// Ties the gains of both ends and reads the objects off.
#[allow(clippy::too_many_arguments)]
pub(super) fn finish(
    sensor: &Sensor,
    samples: &[Complex64],
    windowed: &[Complex64],
    window: &[f64],
    fit: Fit,
    complete: bool,
    floor: Floor,
) -> Found {
    let (ones, work) = (vec![1.0; sensor.samples], Work::granted(usize::MAX));
    // A window keeps unexplained objects from their neighbours; where nothing is unexplained it only throws samples away.
    let problem = if complete {
        Problem { sensor, samples, window: &ones, work: &work }
    } else {
        Problem { sensor, samples: windowed, window, work: &work }
    };
    let apart = problem.solve(&fit.atoms, Tie::PerEnd);
    let moving = vec![true; fit.atoms.len()];
    let mut tied = problem.refine(fit.atoms, Tie::Both, &moving, TIED);
    if matches!(floor, Floor::Snr(_)) && tied.atoms.len() <= MOST_COMBED {
        tied = combed(&problem, tied);
    }
    // Gains that agree cost next to nothing to tie; if not, the objects are not right and the ends' own view is the better one.
    let best = if tied.cost <= 4.0 * apart.cost { tied } else { apart };
    Found { atoms: best.atoms, gains: best.gains, complete }
}

/// Each point tried on the neighbouring teeth of the comb, the others staying where they are.
fn combed(problem: &Problem, fit: Fit) -> Fit {
    let sensor = problem.sensor;
    let between_ends = sensor.element_x[sensor.end_elements] - sensor.element_x[0];
    let tooth = sensor.wavelength_metres() / between_ends;
    let mut best = fit;
    for i in 0..best.atoms.len() {
        let Atom::Point { x, y } = best.atoms[i] else { continue };
        let range = x.hypot(y);
        for k in (-TEETH..=TEETH).filter(|k| *k != 0) {
            let cos = x / range + f64::from(k) * tooth;
            if cos.abs() >= 1.0 {
                continue;
            }
            let mut atoms = best.atoms.clone();
            atoms[i] = Atom::Point { x: range * cos, y: range * (1.0 - cos * cos).sqrt() };
            let moving: Vec<bool> = (0..atoms.len()).map(|j| j == i).collect();
            let trial = problem.refine(atoms, Tie::Both, &moving, TIED);
            if trial.cost < best.cost {
                best = trial;
            }
        }
    }
    let moving = vec![true; best.atoms.len()];
    problem.refine(best.atoms, Tie::Both, &moving, TIED)
}
