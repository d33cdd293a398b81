//! The greedy loop and its second thoughts: detect, refine alone, refine together, until the residual is the floor.

use super::atom::Atom;
use super::detect::Detector;
use super::finish::{Found, finish};
use super::fit::{Fit, Limits, Problem, Tie, energy};
use super::place::{Placer, TABLE_SPACINGS_BINS};
use super::sensor::Sensor;
use crate::maps::channels_range_transform;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::{ReconstructError, Request};
use crate::scene::Reflector;
use crate::signal::floor::thesis_noise_variance;
use crate::signal::{Floor, TwoEnds};
use num_complex::Complex64;

/// Of a refinement of all atoms: many small steps are worth it, close pairs share a long narrow valley.
const TOGETHER: Limits = Limits { iterations: 100, least_gain: 1e-5 };

/// Of a refinement that only tells good starts from bad ones.
pub(super) const GLANCE: Limits = Limits { iterations: 12, least_gain: 1e-2 };

/// A residual counts as the floor up to this many times the floor's expected energy: the rounding model is good to a factor of a few.
const FLOOR_MARGIN: f64 = 16.0;

/// Range bins in a row that only something longer than a few reflectors fills.
const LONG_RUN_BINS: usize = 48;

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

/// Takes the samples apart into atoms.
///
/// # Errors
/// [`ReconstructError::Cancelled`] when the request was cancelled.
pub fn find(radar: &Radar, ends: &TwoEnds, request: &Request, settings: &Settings) -> Result<Found, ReconstructError> {
    let sensor = Sensor::new(radar);
    let peak = ends.first.iter().chain(&ends.last).fold(0.0, |m: f64, v| m.max(v.re.abs().max(v.im.abs())));
    if peak == 0.0 {
        return Ok(Found::nothing());
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
    let complete = search.is_explained(&fit);
    Ok(finish(&sensor, &samples, &windowed, &window, fit, complete, request.floor, scale))
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

    /// Points alone, then lines at the spacings of the thesis' scenes; lines first where the echo is long.
    fn run(&self) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut best = self.problem().solve(&[], Tie::PerEnd);
        let long = self.longest_run() >= LONG_RUN_BINS;
        let points = (!long).then_some(None);
        for spacing_bins in points.into_iter().chain(TABLE_SPACINGS_BINS.map(Some)) {
            let trial = self.attempt(spacing_bins)?;
            if trial.cost < best.cost {
                best = trial;
            }
            // Points that explain nearly everything, and noise, are no matter for lines.
            if self.is_explained(&best) || best.cost < 1e-2 * start || !self.stands_out(&best) {
                break;
            }
        }
        Ok(best)
    }

    /// Greedy search and second thoughts, with points and lines of one spacing or with points alone.
    fn attempt(&self, spacing_bins: Option<f64>) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut best = self.greedy(self.problem().solve(&[], Tie::PerEnd), spacing_bins)?;
        let rounds = if spacing_bins.is_some() { 1 } else { self.settings.rounds };
        for _ in 0..rounds {
            if self.is_explained(&best) || best.cost > 1e-2 * start || best.atoms.is_empty() {
                break;
            }
            let pruned = self.pruned(best.clone())?;
            let mut trial = self.split(&pruned)?;
            if !self.is_explained(&trial) {
                trial = self.greedy(self.pruned(trial)?, None)?;
            }
            if trial.cost >= 0.5 * best.cost {
                break;
            }
            best = trial;
        }
        self.pruned(best)
    }

    /// Adds atoms until the residual is the floor, nothing stands out, or there are too many.
    fn greedy(&self, mut fit: Fit, spacing_bins: Option<f64>) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut lines_missed = 0;
        while !self.is_explained(&fit) && fit.atoms.len() < self.settings.most_atoms {
            self.request.task.check()?;
            let residual = self.unwindowed(&fit);
            let strongest = self.detector.strongest(self.radar, self.sensor, &residual);
            let Some(candidate) = strongest.filter(|c| c.prominence >= self.settings.least_prominence) else { break };
            let placer = Placer { radar: self.radar, problem: Problem { samples: &fit.residual, ..self.problem() } };
            let mut placed = placer.point(&candidate);
            // A point that leaves next to nothing needs no line beside it.
            if let Some(bins) = spacing_bins.filter(|_| lines_missed < 2 && placed.cost > 0.1 * fit.cost) {
                let line = placer.line(&residual, bins);
                match line.filter(|line| line.cost < placed.cost) {
                    Some(line) => (placed, lines_missed) = (line, 0),
                    None => lines_missed += 1,
                }
            }
            let mut atoms = fit.atoms.clone();
            atoms.extend(placed.atoms);
            let grown = self.together(atoms);
            if grown.cost >= 0.999 * fit.cost {
                break;
            }
            fit = grown;
            self.request.task.set_progress(((fit.cost / start).max(1e-30).log10() / -24.0) as f32);
            tracing::debug!(atoms = fit.atoms.len(), unexplained = fit.cost / start, last = ?fit.atoms.last(), "grown");
        }
        Ok(fit)
    }

    fn together(&self, atoms: Vec<Atom>) -> Fit {
        let moving = vec![true; atoms.len()];
        self.problem().refine(atoms, Tie::PerEnd, &moving, TOGETHER)
    }

    /// Without the atoms that explain nothing the others could not, or that ran away.
    fn pruned(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let before = fit.atoms.len();
        let enough = if self.is_explained(&fit) { FLOOR_MARGIN * self.floor_energy(&fit) } else { 2.0 * fit.cost };
        let mut i = 0;
        while i < fit.atoms.len() {
            self.request.task.check()?;
            let mut rest = fit.atoms.clone();
            rest.remove(i);
            let [x, y] = fit.atoms[i].position(0);
            let without = self.problem().solve(&rest, Tie::PerEnd);
            if x.hypot(y) > 2.5 * self.radar.max_range_metres() || without.cost < enough {
                fit = without;
            } else {
                i += 1;
            }
        }
        Ok(if fit.atoms.len() < before { self.together(fit.atoms) } else { fit })
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
        Ok(self.together(best.atoms))
    }

    /// Whether the residual is what the floor alone would leave.
    fn is_explained(&self, fit: &Fit) -> bool {
        match self.request.floor {
            Floor::Snr(_) => !self.stands_out(fit),
            Floor::Thesis | Floor::Exact => fit.cost <= FLOOR_MARGIN * self.floor_energy(fit),
        }
    }

    /// Whether a cell of the residual stands out of it.
    fn stands_out(&self, fit: &Fit) -> bool {
        let residual = self.unwindowed(fit);
        let strongest = self.detector.strongest(self.radar, self.sensor, &residual);
        strongest.is_some_and(|c| c.prominence >= self.settings.least_prominence)
    }

    /// Energy that rounding leaves in the windowed samples, if the atoms of `fit` are what is there.
    fn floor_energy(&self, fit: &Fit) -> f64 {
        let window: f64 = self.window.iter().map(|w| w * w).sum();
        // Even an exact simulation is rounded to f64, and so is the fit.
        let rounding = energy(self.windowed) * 1e-29;
        if self.request.floor != Floor::Thesis {
            return rounding;
        }
        let reflectivity = |g: &[Complex64; 2]| ((g[0].norm_sqr() + g[1].norm_sqr()) / 2.0).sqrt();
        let objects = fit.atoms.iter().zip(&fit.gains).map(|(a, g)| a.object(reflectivity(g)));
        let reflectors: Vec<Reflector> = objects.flat_map(|o| o.reflectors()).collect();
        let variance = thesis_noise_variance(self.radar, &reflectors);
        let of_end = |end| variance[self.radar.end_range(end)].iter().sum::<f64>();
        rounding + window * End::BOTH.map(of_end).iter().sum::<f64>()
    }

    /// Most neighbouring range bins with an echo at either end, 60 dB below the strongest, ranges evened out by the 1/R^2 law.
    fn longest_run(&self) -> usize {
        let ends = self.sensor.unflatten(self.samples);
        let run_of = |end| {
            let profiles = channels_range_transform(self.radar, ends.end(end).view()).profiles;
            let power = |bin: usize| {
                let power: f64 = profiles.column(bin).iter().map(Complex64::norm_sqr).sum();
                power * (bin as f64 + 10.0).powi(4)
            };
            let powers: Vec<f64> = (0..self.radar.samples).map(power).collect();
            let least = 1e-6 * powers.iter().copied().fold(0.0, f64::max);
            powers.split(|p| *p < least).map(<[f64]>::len).max().unwrap_or(0)
        };
        End::BOTH.map(run_of).into_iter().max().unwrap_or(0)
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
}
