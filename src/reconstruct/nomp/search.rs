//! The greedy loop: detect, refine alone, refine together, until the residual is the floor.

use super::atom::Atom;
use super::detect::{Candidate, Detector};
use super::fit::{Fit, Limits, Problem, Tie, energy};
use super::sensor::Sensor;
use crate::radar::{Radar, hann};
use crate::reconstruct::{ReconstructError, Request};
use crate::scene::Reflector;
use crate::signal::floor::thesis_noise_variance;
use crate::signal::{Floor, TwoEnds};
use num_complex::Complex64;

/// Of a refinement of all atoms: many small steps are worth it, close pairs share a long narrow valley.
const TOGETHER: Limits = Limits { iterations: 100, enough: 0.0, least_gain: 1e-5 };

/// Of a refinement that only tells good starts from bad ones.
const GLANCE: Limits = Limits { iterations: 12, enough: 0.0, least_gain: 1e-2 };

/// Bounds on time and memory, and what counts as found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Most atoms of one scene.
    pub most_atoms: usize,
    /// A cell must stand this far above the median cell of the residual, as a ratio of powers. Noise alone reaches about 20.
    pub least_prominence: f64,
    /// Most rounds of second thoughts when the first attempt does not explain the samples.
    pub rounds: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { most_atoms: 12, least_prominence: 60.0, rounds: 3 }
    }
}

/// What was found in the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The objects.
    pub atoms: Vec<Atom>,
    /// Their reflectivities for samples times `scale`.
    pub reflectivities: Vec<f64>,
    /// What the samples were multiplied with to have a peak of 1.
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

/// Takes the samples apart into atoms.
///
/// # Errors
/// [`ReconstructError::Cancelled`] when the request was cancelled.
pub fn find(radar: &Radar, ends: &TwoEnds, request: &Request, settings: &Settings) -> Result<Found, ReconstructError> {
    let sensor = Sensor::new(radar);
    let peak = ends.first.iter().chain(&ends.last).fold(0.0, |m: f64, v| m.max(v.re.abs().max(v.im.abs())));
    if peak == 0.0 {
        return Ok(Found {
            atoms: Vec::new(),
            reflectivities: Vec::new(),
            scale: 1.0,
            unexplained: 0.0,
            sample_power: 0.0,
            residual_variance: 0.0,
            complete: true,
        });
    }
    let scale = peak.recip().min(f64::MAX);
    let samples = sensor.flatten(ends, scale);
    let window = hann(radar.samples);
    let windowed: Vec<Complex64> = samples.iter().enumerate().map(|(i, v)| v * window[i % radar.samples]).collect();
    let search = Search {
        radar,
        sensor: &sensor,
        detector: Detector::new(radar),
        window: &window,
        samples: &samples,
        windowed: &windowed,
        request,
        settings,
    };
    let fit = search.run()?;
    request.task.set_progress(1.0);
    Ok(search.found(fit, scale))
}

struct Search<'a> {
    radar: &'a Radar,
    sensor: &'a Sensor,
    detector: Detector,
    window: &'a [f64],
    samples: &'a [Complex64],
    windowed: &'a [Complex64],
    request: &'a Request,
    settings: &'a Settings,
}

impl Search<'_> {
    fn problem(&self) -> Problem<'_> {
        Problem { sensor: self.sensor, samples: self.windowed, window: self.window }
    }

    /// Residual energy of the windowed samples that the floor alone would leave, if `atoms` are what is there.
    fn floor_energy(&self, fit: &Fit) -> f64 {
        let window: f64 = self.window.iter().map(|w| w * w).sum();
        let all = energy(self.windowed);
        match self.request.floor {
            Floor::Snr(snr) => all / (1.0 + snr.power_ratio()),
            Floor::Exact => all * 1e-28,
            Floor::Thesis => {
                let reflectors: Vec<Reflector> = fit
                    .atoms
                    .iter()
                    .zip(&fit.gains)
                    .flat_map(|(a, g)| a.object((g[0].norm_sqr() + g[1].norm_sqr()).sqrt()).reflectors())
                    .collect();
                let variance = thesis_noise_variance(self.radar, &reflectors);
                let ends = variance.iter().take(self.sensor.end_elements).sum::<f64>()
                    + variance.iter().rev().take(self.sensor.end_elements).sum::<f64>();
                ends * window
            }
        }
    }

    fn run(&self) -> Result<Fit, ReconstructError> {
        let mut best = self.greedy(self.problem().solve(&[], Tie::PerEnd))?;
        for _ in 0..self.settings.rounds {
            if self.is_explained(&best) {
                break;
            }
            let pruned = self.pruned(best.clone())?;
            let trial = self.split(&pruned)?;
            let trial = if self.is_explained(&trial) { trial } else { self.greedy(self.pruned(trial)?)? };
            if trial.cost >= 0.5 * best.cost {
                break;
            }
            best = trial;
        }
        self.pruned(best)
    }

    fn is_explained(&self, fit: &Fit) -> bool {
        fit.cost <= 16.0 * self.floor_energy(fit)
    }

    /// Adds atoms until the residual is the floor, nothing stands out, or there are too many.
    fn greedy(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        while !self.is_explained(&fit) && fit.atoms.len() < self.settings.most_atoms {
            self.request.task.check()?;
            let Some(grown) = self.grown(&fit) else { break };
            if grown.cost >= 0.999 * fit.cost {
                break;
            }
            fit = grown;
            self.request.task.set_progress(((fit.cost / start).max(1e-30).log10() / -24.0) as f32);
            tracing::debug!(atoms = fit.atoms.len(), unexplained = fit.cost / start, "grown");
        }
        Ok(fit)
    }

    /// Without the atoms that explain nothing the others could not, or that ran away.
    fn pruned(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let mut i = 0;
        while i < fit.atoms.len() {
            self.request.task.check()?;
            let mut rest = fit.atoms.clone();
            rest.remove(i);
            let far = fit.atoms[i].position(0).into_iter().fold(0.0, f64::hypot) > 2.5 * self.radar.max_range_metres();
            let without = self.problem().solve(&rest, Tie::PerEnd);
            let enough = if self.is_explained(&fit) { 16.0 * self.floor_energy(&fit) } else { 2.0 * fit.cost };
            if far || without.cost < enough {
                fit = without;
            } else {
                i += 1;
            }
        }
        let moving = vec![true; fit.atoms.len()];
        Ok(self.problem().refine(fit.atoms, Tie::PerEnd, &moving, TOGETHER))
    }

    /// The best of replacing one atom by two beside each other: two reflectors closer than a beam are first found as one.
    fn split(&self, fit: &Fit) -> Result<Fit, ReconstructError> {
        let mut best = fit.clone();
        for i in 0..fit.atoms.len() {
            let Atom::Point { x, y } = fit.atoms[i] else { continue };
            for radians in [0.01, 0.04, 0.12] {
                self.request.task.check()?;
                let turned = |angle: f64| {
                    let (sin, cos) = angle.sin_cos();
                    Atom::Point { x: x * cos - y * sin, y: (x * sin + y * cos).abs() }
                };
                let mut atoms = fit.atoms.clone();
                atoms[i] = turned(radians);
                atoms.push(turned(-radians));
                let moving = vec![true; atoms.len()];
                let trial = self.problem().refine(atoms, Tie::PerEnd, &moving, GLANCE);
                if trial.cost < best.cost {
                    best = trial;
                }
            }
        }
        let moving = vec![true; best.atoms.len()];
        Ok(self.problem().refine(best.atoms, Tie::PerEnd, &moving, TOGETHER))
    }

    /// One more atom, then everything together; `None` where nothing stands out any more.
    fn grown(&self, fit: &Fit) -> Option<Fit> {
        let problem = self.problem();
        let residual = self.unwindowed(fit);
        let candidate = self.detector.strongest(self.radar, self.sensor, &residual, 1).pop()?;
        if candidate.prominence < self.settings.least_prominence {
            return None;
        }
        let atom = self.placed(&fit.residual, &candidate);
        let mut atoms = fit.atoms.clone();
        atoms.push(atom);
        let moving = vec![true; atoms.len()];
        Some(problem.refine(atoms, Tie::PerEnd, &moving, TOGETHER))
    }

    /// The residual without the window, of the atoms and gains of `fit`.
    fn unwindowed(&self, fit: &Fit) -> Vec<Complex64> {
        let mut residual = self.samples.to_vec();
        let ones = vec![1.0; self.radar.samples];
        let mut column = vec![Complex64::default(); self.sensor.sample_count()];
        for (atom, gains) in fit.atoms.iter().zip(&fit.gains) {
            column.fill(Complex64::default());
            self.sensor.add_atom(atom, &ones, &mut [&mut column]);
            for (i, (r, v)) in residual.iter_mut().zip(&column).enumerate() {
                *r -= v * gains[i / self.sensor.end_len()];
            }
        }
        residual
    }

    /// A candidate moved to its best place in `residual`, at its own range or one wrap further out.
    fn placed(&self, residual: &[Complex64], candidate: &Candidate) -> Atom {
        let problem = Problem { samples: residual, ..self.problem() };
        let range = candidate.x.hypot(candidate.y);
        let wrapped = 1.0 + self.radar.max_range_metres() / range.max(1e-3);
        let limits = Limits { iterations: 15, enough: 0.0, least_gain: 1e-3 };
        [1.0, wrapped]
            .into_iter()
            .map(|far| Atom::Point { x: candidate.x * far, y: candidate.y * far })
            .map(|atom| problem.refine(vec![atom], Tie::PerEnd, &[true], limits))
            .reduce(|near, far| if far.cost < 0.5 * near.cost { far } else { near })
            .map_or(Atom::Point { x: candidate.x, y: candidate.y }, |fit| fit.atoms[0])
    }

    fn found(&self, fit: Fit, scale: f64) -> Found {
        let complete = self.is_explained(&fit);
        let tied = self.problem().refine(
            fit.atoms.clone(),
            Tie::Both,
            &vec![true; fit.atoms.len()],
            Limits { iterations: 10, enough: 0.0, least_gain: 1e-3 },
        );
        let all = energy(self.windowed);
        let window: f64 = self.window.iter().map(|w| w * w).sum::<f64>() * self.sensor.element_x.len() as f64;
        Found {
            reflectivities: tied.gains.iter().map(|g| g[0].norm()).collect(),
            atoms: tied.atoms,
            scale,
            unexplained: tied.cost / all,
            sample_power: all / window,
            residual_variance: tied.cost / window,
            complete,
        }
    }
}
