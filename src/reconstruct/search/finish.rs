//! From a fit with a gain for each end to objects: one gain for both ends, the right tooth of the comb, reflectivities.

use super::settings::Settings;
use super::state::Answer;
use super::without::Part;
use crate::radar::Radar;
use crate::reconstruct::attempt::Attempt;
use crate::reconstruct::fit::{Atom, Fit, Gains, Limits, Profile, Samples, Tie, Workbench, rows_of};
use crate::reconstruct::{ReconstructError, Request};
use num_complex::Complex64;
use rayon::prelude::*;

/// Teeth tried to each side: the phase between the ends repeats every column of the full map.
const TEETH: i32 = 6;

/// Most atoms whose teeth are tried one by one.
const MOST_COMBED: usize = 12;

/// Most reflectors of atoms whose gains are tied: beyond, all against all takes too long.
const MOST_TIED: usize = 64;

/// Most reflectors that are fitted without a window, where all of them know of each other.
const MOST_UNWINDOWED: usize = 40;

/// Work granted to the refinement without a window.
const MOST_WORK: usize = 50_000;

/// Of the refinement with tied gains.
const TIED: Limits = Limits { iterations: 20, least_gain: 1e-6, ridge: 0.0 };

/// What was found in the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The objects.
    pub atoms: Vec<Atom>,
    /// Their reflectivities for samples times `scale`.
    pub reflectivities: Vec<f64>,
    /// What the samples were multiplied with to have a peak between 1 and 2.
    pub scale: f64,
    /// Part of the samples' energy that was left by the last search from scratch: answers that follow it are measured by it.
    pub left_by_search: f64,
    /// Mean power of the scaled samples.
    pub sample_power: f64,
    /// Mean power of the residual of the scaled samples.
    pub residual_variance: f64,
    /// Variance of the white noise that is heard in that residual.
    pub noise_variance: f64,
    /// Gains of the objects at the first and at the last end, for samples times `scale`.
    pub gains: Vec<[Complex64; 2]>,
    /// For each object the energy that would be left more without it, over what is left around its range, in decades.
    pub needed_decades: Vec<f64>,
    /// Samples times `scale` less the objects as they are drawn, with one gain for both ends, channel by channel, first end first.
    pub left_when_drawn: Vec<Complex64>,
    /// Whether nothing stands out of the residual any more.
    pub complete: bool,
    /// What the search tried, the first first; at most [`MOST_ATTEMPTS`](super::MOST_ATTEMPTS).
    pub trace: Vec<Attempt>,
}

impl Found {
    /// Part of the samples' energy that is neither explained nor noise.
    pub fn energy_left(&self) -> f64 {
        (self.residual_variance - self.noise_variance).max(0.0) / self.sample_power.max(f64::MIN_POSITIVE)
    }

    /// What silence holds.
    pub(super) fn nothing() -> Self {
        Found {
            atoms: Vec::new(),
            reflectivities: Vec::new(),
            scale: 1.0,
            left_by_search: 0.0,
            sample_power: 0.0,
            residual_variance: 0.0,
            noise_variance: 0.0,
            gains: Vec::new(),
            needed_decades: Vec::new(),
            left_when_drawn: Vec::new(),
            complete: true,
            trace: Vec::new(),
        }
    }
}

/// Ties the gains of both ends and reads the objects off.
///
/// # Errors
/// [`ReconstructError::Cancelled`].
pub(super) fn finish(
    radar: &Radar,
    bench: &Workbench,
    samples: &Samples,
    answer: Answer,
    request: &Request,
    settings: &Settings,
    scale: f64,
) -> Result<Found, ReconstructError> {
    let Answer { fit, is_sure: complete } = answer;
    let reflectors: usize = fit.atoms.iter().map(Atom::reflector_count).sum();
    let hearing = bench.hearing;
    // A window keeps unexplained objects from their neighbours; where nothing is unexplained it only throws samples away.
    let flat_bench = (complete && reflectors <= MOST_UNWINDOWED && !settings.lacks(Part::Unwindowed))
        .then(|| Workbench::new(radar, &vec![1.0; radar.samples], &request.task, MOST_WORK))
        .map(|flat| flat.hearing(&samples.flat(&bench.sensor)));
    let bench = flat_bench.as_ref().unwrap_or(bench);
    let apart = if flat_bench.is_some() { bench.solve(samples, fit.atoms, Tie::PerEnd, 0.0) } else { fit };
    let mut best = apart.clone();
    if complete && reflectors <= MOST_TIED && !settings.lacks(Part::Tied) {
        let mut tied = bench.refine(samples, apart.atoms.clone(), apart.gains.clone(), Tie::Both, TIED);
        if request.noise.is_white() && tied.atoms.len() <= MOST_COMBED && !settings.lacks(Part::Teeth) {
            tied = combed(bench, samples, tied);
        }
        // Gains that agree cost next to nothing to tie; if not, the objects are not right and the ends' own view is the better one.
        if tied.cost() <= 4.0 * apart.cost() {
            best = tied;
        }
    }
    request.task.check()?;
    let residual = best.residual.flat(&bench.sensor);
    let noise_variance = hearing.noise_variance(radar, &residual);
    let silence = bench.without(samples, &[], &[]);
    let all = silence.energy[0] + silence.energy[1];
    let weight = bench.squared.iter().sum::<f64>() * bench.sensor.element_x.len() as f64;
    Ok(Found {
        reflectivities: reflectivities(&best.gains),
        left_by_search: best.cost() / all,
        sample_power: all / weight,
        residual_variance: best.cost() / weight,
        noise_variance,
        needed_decades: needed_decades(radar, bench, &best, noise_variance),
        left_when_drawn: left_when_drawn(bench, samples, &best),
        atoms: best.atoms,
        gains: best.gains,
        scale,
        complete,
        trace: Vec::new(),
    })
}

/// For each atom of `fit` the energy that would be left more without it, over what `fit` leaves or noise holds around its range, in decades.
fn needed_decades(radar: &Radar, bench: &Workbench, fit: &Fit, noise_variance: f64) -> Vec<f64> {
    let profile = Profile::new(radar, &fit.residual.flat(&bench.sensor));
    let window = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>();
    let squared = bench.squared.iter().sum::<f64>();
    // Both energies as they are under the radar's window.
    let worths = bench.worths(fit).into_iter().map(|worth| worth * window / squared);
    let of_atom = |(worth, atom): (f64, &Atom)| {
        let noise = noise_variance * window * bench.sensor.element_x.len() as f64 / radar.samples as f64;
        let left = profile.at(&rows_of(radar, atom)).max(noise).max(f64::MIN_POSITIVE);
        (worth / left).max(f64::MIN_POSITIVE).log10()
    };
    worths.zip(&fit.atoms).map(of_atom).collect()
}

/// What the objects leave with one gain for both ends, as they are drawn: an echo that the ends hear differently isn't explained by it.
fn left_when_drawn(bench: &Workbench, samples: &Samples, fit: &Fit) -> Vec<Complex64> {
    let tied: Vec<Gains> = fit.gains.iter().map(|[a, b]| [(a + b) / 2.0; 2]).collect();
    bench.without(samples, &fit.atoms, &tied).residual.flat(&bench.sensor)
}

/// Each point tried on the neighbouring teeth of the comb, the others staying where they are.
fn combed(bench: &Workbench, samples: &Samples, fit: Fit) -> Fit {
    let sensor = &bench.sensor;
    let between_ends = sensor.element_x[sensor.end_elements] - sensor.element_x[0];
    let tooth = sensor.wavelength_metres() / between_ends;
    let mut best = fit;
    for i in 0..best.atoms.len() {
        let Atom::Point { x_metres: x, y_metres: y } = best.atoms[i] else { continue };
        let range = x.hypot(y);
        let own = best.gains[i];
        let base = bench.without(&best.residual, &best.atoms[i..=i], &[[-own[0], -own[1]]]).residual;
        let trials: Vec<Fit> = (-TEETH..=TEETH)
            .into_par_iter()
            .filter(|k| *k != 0)
            .filter_map(|k| {
                let cos = x / range + f64::from(k) * tooth;
                let y_metres = range * (1.0 - cos * cos).max(0.0).sqrt();
                let atom = Atom::Point { x_metres: range * cos, y_metres };
                (cos.abs() < 1.0).then(|| bench.refine(&base, vec![atom], vec![Gains::default()], Tie::Both, TIED))
            })
            .collect();
        let trial = trials.into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
        if let Some(trial) = trial.filter(|t| t.cost() < best.cost()) {
            (best.atoms[i], best.gains[i]) = (trial.atoms[0], trial.gains[0]);
            (best.residual, best.energy) = (trial.residual, trial.energy);
        }
    }
    bench.refine(samples, best.atoms, best.gains, Tie::Both, TIED)
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
