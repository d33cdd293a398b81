//! Objects from a fit with a gain for each end: one gain for both ends, the right peak of the two ends' ambiguity function, reflectivities.

use super::element_gains::ElementGains;
use super::propose::end_beams::beam_noise_power;
use super::state::{Search, State};
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::Attempt;
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Limits, Profile, Tie, bin_spans};
use num_complex::Complex64;
use rayon::prelude::*;

/// Neighbouring peaks of the ambiguity function, *teeth*, that are tried to each side. They are about a column of the map apart.
const MAX_TEETH: i32 = 6;

/// Largest number of atoms whose teeth are tried.
const MAX_TOOTH_ATOMS: usize = 12;

/// Largest number of reflectors of atoms whose gains are tied: the time grows with its square.
const MAX_TIED_REFLECTORS: usize = 64;

/// Largest number of reflectors that are fitted without a window. They are so few that their steps need no budget.
const MAX_UNWINDOWED_REFLECTORS: usize = 40;

const TIED_LIMITS: Limits = Limits { max_steps: 20, min_decrease: 1e-6, ridge: 0.0 };

/// Largest reflectivity over the largest of objects fitted alone. Larger ones cancel each other.
const MAX_OVER_ALONE: f64 = 1.5;

/// Ridges that are tried one after another where reflectivities cancel each other ([`Limits::ridge`]).
const RIDGES: [f64; 7] = [0.0002, 0.0006, 0.002, 0.006, 0.02, 0.06, 0.2];

/// Range bins and columns within which two points over white noise count as one.
const SAME_PLACE: [f64; 2] = [0.25, 1.0];

/// Largest residual energy with tied gains over that with a gain for each end. At a wrong place it is larger.
const TIED_COST_RATIO: f64 = 4.0;

/// The result of a search. *Scaled samples* are the samples times `scale`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Found {
    /// The objects.
    pub atoms: Vec<Atom>,
    /// Their reflectivities, for scaled samples.
    pub reflectivities: Vec<f64>,
    /// Factor by which the samples were multiplied to have a peak between 1 and 2.
    pub scale: f64,
    /// Residual of the last search from scratch, as a part of the samples' energy, with which answers that follow it are compared.
    pub search_residual_part: f64,
    /// Mean power of the scaled samples.
    pub sample_power: f64,
    /// Mean power of their residual before gains are tied and near points are merged. In a complete list this is the power of the noise.
    pub residual_variance: f64,
    /// Variance of the white noise in that residual.
    pub noise_variance: f64,
    /// Gains of the objects at the first and at the last end, for scaled samples.
    pub gains: Vec<[Complex64; 2]>,
    /// For each object the increase of the residual energy without it, over the residual energy in its range bins, decades.
    pub needed_decades: Vec<f64>,
    /// Residual of the scaled samples with one gain for both ends, as the map is drawn, `[channels * samples]`, first end first.
    pub drawn_residual: Vec<Complex64>,
    /// Whether nothing stands out of the residual.
    pub is_complete: bool,
    /// Gains of the elements where they were estimated. The objects are those of samples without them.
    pub element_gains: Option<ElementGains>,
    /// The attempts, in their order; at most [`MAX_ATTEMPTS`](super::MAX_ATTEMPTS).
    pub trace: Vec<Attempt>,
}

impl Found {
    /// Energy of [`Self::drawn_residual`] without noise, as a part of the samples' energy.
    pub(super) fn drawn_residual_part(&self) -> f64 {
        let count = self.drawn_residual.len().max(1) as f64;
        let power = self.drawn_residual.iter().map(Complex64::norm_sqr).sum::<f64>() / count;
        (power - self.noise_variance).max(0.0) / self.sample_power.max(f64::MIN_POSITIVE)
    }

    /// The result for samples that are all 0.
    pub(super) fn nothing() -> Self {
        Found { scale: 1.0, is_complete: true, ..Found::default() }
    }
}

impl Search<'_> {
    /// The objects of `answer`. `scale` is as in [`Found::scale`].
    pub fn finished(&self, answer: State, scale: f64) -> Result<Found, ReconstructError> {
        let State { fit, is_complete, .. } = answer;
        let reflectors: usize = fit.atoms.iter().map(Atom::reflector_count).sum();
        // A window keeps the residual of missing objects from others. Without missing ones it only loses energy.
        if is_complete && reflectors <= MAX_UNWINDOWED_REFLECTORS {
            let window = vec![1.0; self.radar.samples];
            let fitter = Fitter::new(self.radar, &window, self.fitter.task, usize::MAX)
                .with_channels_of(&self.samples.flat(&self.fitter.sensor))
                .with_noise(self.fitter.noise_model);
            let fit = fitter.solve(self.samples, fit.atoms, Tie::PerEnd, 0.0);
            return Search { fitter: &fitter, ..*self }.described(fit, is_complete, scale);
        }
        self.described(fit, is_complete, scale)
    }

    /// The objects of `fit` with the gains and the reflectivities that they are drawn with.
    fn described(&self, fit: Fit, is_complete: bool, scale: f64) -> Result<Found, ReconstructError> {
        let fitter = self.fitter;
        let weight = fitter.squared.iter().sum::<f64>() * fitter.sensor.element_x.len() as f64;
        let residual_variance = fit.cost() / weight;
        let best = if is_complete { self.with_tied_gains(fit) } else { fit };
        let best = if self.has_white_noise { self.merged(best) } else { best };
        let is_certain = is_complete && !self.has_white_noise;
        let best = if is_certain { best } else { self.bounded(best) };
        fitter.task.check()?;
        let noise_variance = fitter.noise_model.noise_variance(self.radar, &best.residual.flat(&fitter.sensor));
        let all = fitter.energy(self.samples);
        // With the mean of both gains, an echo whose strength differs between the ends stays in the residual.
        let drawn_gains: Vec<Gains> = best.gains.iter().map(|[a, b]| [(a + b) / 2.0; 2]).collect();
        Ok(Found {
            reflectivities: reflectivities(&best.gains),
            search_residual_part: best.cost() / all,
            sample_power: all / weight,
            residual_variance,
            noise_variance,
            needed_decades: self.needed_decades(&best, noise_variance),
            drawn_residual: fitter.subtract(self.samples, &best.atoms, &drawn_gains).residual.flat(&fitter.sensor),
            atoms: best.atoms,
            gains: best.gains,
            scale,
            is_complete,
            ..Found::default()
        })
    }

    /// `fit` without the weaker one of two points within [`SAME_PLACE`].
    fn merged(&self, fit: Fit) -> Fit {
        let place = |atom: &Atom| {
            let range = atom.range_metres().max(f64::MIN_POSITIVE);
            [self.radar.bin_of_range(range), self.radar.column_of_cos(atom.position_metres(0.0)[0] / range)]
        };
        let is_point = |i: usize| matches!(fit.atoms[i], Atom::Point { .. });
        let places: Vec<[f64; 2]> = fit.atoms.iter().map(place).collect();
        let power = |i: usize| fit.gains[i].iter().map(Complex64::norm_sqr).sum::<f64>();
        let is_same = |i: usize, j: usize| {
            is_point(i) && is_point(j) && (0..2).all(|k| (places[i][k] - places[j][k]).abs() < SAME_PLACE[k])
        };
        let n = places.len();
        let is_weaker = |i: usize, j: usize| (power(i), j) < (power(j), i);
        let kept: Vec<usize> =
            (0..n).filter(|&i| !(0..n).any(|j| j != i && is_same(i, j) && is_weaker(i, j))).collect();
        if kept.len() == n {
            return fit;
        }
        self.fitter.solve(self.samples, kept.into_iter().map(|i| fit.atoms[i]).collect(), tie_of(&fit), 0.0)
    }

    /// `fit` with a ridge on its gains that grows until none exceeds [`MAX_OVER_ALONE`].
    fn bounded(&self, mut fit: Fit) -> Fit {
        let alone = fit.atoms.par_iter().map(|atom| magnitude(&self.fitter.solve_alone(self.samples, *atom).gains[0]));
        let limit = MAX_OVER_ALONE * alone.reduce(|| 0.0, f64::max);
        let tie = tie_of(&fit);
        for ridge in RIDGES {
            if fit.gains.iter().all(|gains| magnitude(gains) <= limit) {
                break;
            }
            fit = self.fitter.solve(self.samples, fit.atoms, tie, ridge);
        }
        fit
    }

    /// `fit` with one gain for both ends, and over white noise on the best tooth, unless it has many reflectors or the residual grows.
    pub fn with_tied_gains(&self, fit: Fit) -> Fit {
        let reflectors: usize = fit.atoms.iter().map(Atom::reflector_count).sum();
        if reflectors > MAX_TIED_REFLECTORS {
            return fit;
        }
        let mut tied = self.fitter.refine(self.samples, fit.atoms.clone(), fit.gains.clone(), Tie::Both, TIED_LIMITS);
        if self.has_white_noise && tied.atoms.len() <= MAX_TOOTH_ATOMS {
            tied = self.on_best_teeth(tied);
        }
        if tied.cost() <= TIED_COST_RATIO * fit.cost() { tied } else { fit }
    }

    /// [`Found::needed_decades`]; the residual energy is at least that of noise.
    fn needed_decades(&self, fit: &Fit, noise_variance: f64) -> Vec<f64> {
        let (radar, fitter) = (self.radar, self.fitter);
        let profile = Profile::new(radar, &fit.residual.flat(&fitter.sensor));
        // Both energies are under the radar's window.
        let noise = 2.0 * beam_noise_power(radar, noise_variance);
        let window = radar.window.weights(radar.samples).iter().map(|w| w * w).sum::<f64>();
        let own_window = fitter.squared.iter().sum::<f64>();
        let of_atom = |(energy, atom): (f64, &Atom)| {
            let residual = profile.energy(&bin_spans(radar, atom)).max(noise).max(f64::MIN_POSITIVE);
            (energy * window / own_window / residual).max(f64::MIN_POSITIVE).log10()
        };
        fitter.marginal_energies(fit).into_iter().zip(&fit.atoms).map(of_atom).collect()
    }

    /// `fit` with each point on its best tooth, one after another.
    fn on_best_teeth(&self, fit: Fit) -> Fit {
        let sensor = &self.fitter.sensor;
        let between_ends = sensor.element_x[sensor.end_elements] - sensor.element_x[0];
        let tooth = sensor.wavelength_metres() / between_ends;
        let mut best = fit;
        for i in 0..best.atoms.len() {
            let Atom::Point { x_metres: x, y_metres: y } = best.atoms[i] else { continue };
            let range = x.hypot(y);
            let base = self.fitter.residual_without(&best, &[i]).residual;
            let trials: Vec<Fit> = (-MAX_TEETH..=MAX_TEETH)
                .into_par_iter()
                .filter(|k| *k != 0)
                .filter_map(|k| {
                    let cos = x / range + f64::from(k) * tooth;
                    let y_metres = range * (1.0 - cos * cos).max(0.0).sqrt();
                    let atom = Atom::Point { x_metres: range * cos, y_metres };
                    (cos.abs() < 1.0)
                        .then(|| self.fitter.refine(&base, vec![atom], vec![Gains::default()], Tie::Both, TIED_LIMITS))
                })
                .collect();
            let trial = trials.into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
            if let Some(trial) = trial.filter(|t| t.cost() < best.cost()) {
                (best.atoms[i], best.gains[i]) = (trial.atoms[0], trial.gains[0]);
                (best.residual, best.energy) = (trial.residual, trial.energy);
            }
        }
        self.fitter.refine(self.samples, best.atoms, best.gains, Tie::Both, TIED_LIMITS)
    }
}

fn tie_of(fit: &Fit) -> Tie {
    if fit.gains.iter().all(|g| g[0] == g[1]) { Tie::Both } else { Tie::PerEnd }
}

/// Magnitude of an object's reflectivity.
fn magnitude(gains: &Gains) -> f64 {
    (gains[0].norm() + gains[1].norm()) / 2.0
}

/// Real reflectivities from complex gains: without the phase that all gains share, each gain has a sign. The sum is positive.
fn reflectivities(gains: &[Gains]) -> Vec<f64> {
    let mean: Vec<Complex64> = gains.iter().map(|g| (g[0] + g[1]) / 2.0).collect();
    let doubled: Complex64 = mean.iter().map(|g| g * g).sum();
    let common = Complex64::cis(-doubled.arg() / 2.0);
    let signed: Vec<f64> =
        mean.iter().zip(gains).map(|(m, g)| if (m * common).re < 0.0 { -magnitude(g) } else { magnitude(g) }).collect();
    let sign = if signed.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    signed.into_iter().map(|s| s * sign).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Detector, Settings, Trace};
    use super::*;
    use crate::radar::{Decibels, Radar, hann};
    use crate::reconstruct::fit::Samples;
    use crate::scene::{Reflector, Scene};
    use crate::signal::floor::snr_noise_variance;
    use crate::signal::{Floor, simulate};
    use crate::task::Task;

    #[test]
    fn of_two_points_in_one_cell_the_stronger_stays() {
        let (radar, task) = (Radar::default(), Task::default());
        let scene = Scene::of_points([(3.0, 11.0), (-6.0, 17.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let fitter = &Fitter::new(&radar, &hann(radar.samples), &task, usize::MAX);
        let samples = &Samples::new(&fitter.sensor, &ends.flat());
        let (detector, settings, trace) = (&Detector::of(&radar), &Settings::default(), &Trace::default());
        let search = Search { radar: &radar, fitter, detector, samples, has_white_noise: true, settings, trace };
        let point = |x_metres: f64, y_metres: f64| Atom::Point { x_metres, y_metres };
        // The second is a few millimetres beside the first, the third a range bin.
        let atoms = vec![point(3.0, 11.0), point(3.001, 11.004), point(3.02, 11.08), point(-6.0, 17.0)];
        let kept = search.merged(fitter.solve(samples, atoms.clone(), Tie::PerEnd, 0.0)).atoms;
        assert_eq!(kept, [atoms[0], atoms[2], atoms[3]]);
        assert_eq!(search.merged(fitter.solve(samples, kept.clone(), Tie::PerEnd, 0.0)).atoms, kept);
    }

    #[test]
    fn merged_points_are_no_noise() {
        let (radar, task, snr) = (Radar::default(), Task::default(), Decibels(40.0));
        let scene = Scene::of_points([(3.0, 11.0), (3.003, 11.012)]);
        let ends = simulate(&radar, &scene, Floor::Snr(snr), 0).unwrap().two_ends(&radar);
        let fitter = &Fitter::new(&radar, &hann(radar.samples), &task, usize::MAX);
        let samples = &Samples::new(&fitter.sensor, &ends.flat());
        let (detector, settings, trace) = (&Detector::of(&radar), &Settings::default(), &Trace::default());
        let search = Search { radar: &radar, fitter, detector, samples, has_white_noise: true, settings, trace };
        let point = |r: Reflector| Atom::Point { x_metres: r.x_metres, y_metres: r.y_metres };
        let atoms = scene.reflectors().into_iter().map(point).collect();
        let found = search.described(fitter.solve(samples, atoms, Tie::PerEnd, 0.0), true, 1.0).unwrap();
        let added = snr_noise_variance(&radar, &scene.reflectors(), snr)[0];
        assert_eq!(found.atoms.len(), 1);
        assert!((found.residual_variance / added - 1.0).abs() < 0.1, "{:e} for {added:e}", found.residual_variance);
    }

    #[test]
    fn the_common_phase_is_not_a_reflectivity() {
        let turned = |size: f64| [Complex64::from_polar(size, 2.5); 2];
        let found = reflectivities(&[turned(2.0), turned(-1.0), turned(0.5)]);
        for (f, expected) in found.iter().zip([2.0, -1.0, 0.5]) {
            assert!((f - expected).abs() < 1e-12);
        }
    }
}
