//! From a fit with a gain for each end to objects: one gain for both ends, the right tooth of the comb, reflectivities.

use super::atom::Atom;
use super::fit::{Fit, Limits, Problem, Tie, energy};
use super::sensor::Sensor;
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
    /// Their reflectivities for samples times `scale`.
    pub reflectivities: Vec<f64>,
    /// What the samples were multiplied with to have a peak between 1 and 2.
    pub scale: f64,
    /// Part of the samples' energy that is left unexplained.
    pub unexplained: f64,
    /// Mean power of the scaled samples.
    pub sample_power: f64,
    /// Mean power of the residual of the scaled samples.
    pub residual_variance: f64,
    /// Whether the residual is down to the floor that was asked for.
    pub complete: bool,
}

impl Found {
    /// What silence holds.
    pub(super) fn nothing() -> Self {
        Found {
            atoms: Vec::new(),
            reflectivities: Vec::new(),
            scale: 1.0,
            unexplained: 0.0,
            sample_power: 0.0,
            residual_variance: 0.0,
            complete: true,
        }
    }
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
    scale: f64,
) -> Found {
    let ones = vec![1.0; sensor.samples];
    // A window keeps unexplained objects from their neighbours; where nothing is unexplained it only throws samples away.
    let problem = if complete {
        Problem { sensor, samples, window: &ones }
    } else {
        Problem { sensor, samples: windowed, window }
    };
    let apart = problem.solve(&fit.atoms, Tie::PerEnd);
    let moving = vec![true; fit.atoms.len()];
    let mut tied = problem.refine(fit.atoms, Tie::Both, &moving, TIED);
    if matches!(floor, Floor::Snr(_)) && tied.atoms.len() <= MOST_COMBED {
        tied = combed(&problem, tied);
    }
    // Gains that agree cost next to nothing to tie; if not, the objects are not right and the ends' own view is the better one.
    let best = if tied.cost <= 4.0 * apart.cost { tied } else { apart };
    let all = energy(problem.samples);
    let weight = problem.window.iter().map(|w| w * w).sum::<f64>() * sensor.element_x.len() as f64;
    Found {
        reflectivities: reflectivities(&best.gains),
        unexplained: best.cost / all,
        sample_power: all / weight,
        residual_variance: best.cost / weight,
        atoms: best.atoms,
        scale,
        complete,
    }
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

/// Real reflectivities from complex gains: the phase all share belongs to the receiver, what is left of each gain is its sign.
fn reflectivities(gains: &[[Complex64; 2]]) -> Vec<f64> {
    let mean: Vec<Complex64> = gains.iter().map(|g| (g[0] + g[1]) / 2.0).collect();
    let doubled: Complex64 = mean.iter().map(|g| g * g).sum();
    let common = Complex64::cis(-doubled.arg() / 2.0);
    let signed: Vec<f64> = mean
        .iter()
        .zip(gains)
        .map(|(m, g)| {
            let size = (g[0].norm() + g[1].norm()) / 2.0;
            if (m * common).re < 0.0 { -size } else { size }
        })
        .collect();
    let sign = if signed.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    signed.into_iter().map(|s| s * sign).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_common_phase_is_not_a_reflectivity() {
        let turned = |size: f64| [Complex64::from_polar(size, 2.5); 2];
        let found = reflectivities(&[turned(2.0), turned(-1.0), turned(0.5)]);
        for (f, expected) in found.iter().zip([2.0, -1.0, 0.5]) {
            assert!((f - expected).abs() < 1e-12);
        }
    }
}
