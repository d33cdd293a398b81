//! The greedy loop and its second thoughts: detect, refine alone, refine together, until the residual is the floor.

use super::atom::Atom;
use super::detect::Detector;
use super::finish::{Found, finish};
use super::fit::{Fit, Limits, Problem, Tie, energy};
use super::place::{LINE_SHAPES, LineShape, Placer, wrapped};
use crate::radar::{End, Radar, hann};
use crate::reconstruct::answer::Request;
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::noise::noise_variance;
use crate::reconstruct::nomp::sensor::Sensor;
use crate::reconstruct::nomp::work::Work;
use crate::scene::Reflector;
use crate::signal::Floor;
use crate::signal::floor::thesis_noise_variance;
use ndarray::ArrayView1;
use num_complex::Complex64;
use rayon::prelude::*;

/// Of a refinement of all atoms: many small steps are worth it, close pairs share a long narrow valley.
const TOGETHER: Limits = Limits { iterations: 100, least_gain: 1e-5 };

/// Of a refinement of all atoms while more are to come.
const GROWING: Limits = Limits { iterations: 100, least_gain: 1e-2 };

/// A residual counts as the floor up to this many times the floor's expected energy: the rounding model is good to a factor of a few.
const FLOOR_MARGIN: f64 = 16.0;

/// Most atoms of one scene.
const MOST_ATOMS: usize = 12;

/// A cell must stand this far above the median cell of the residual, as a ratio of powers. Noise alone reaches about 20.
const LEAST_PROMINENCE: f64 = 60.0;

/// A first object that leaves more than this part of the echoes' energy is not the strongest of a few: no search for a few objects helps.
/// Where one did, on validation scenes of set 3, the first line left 0.66 at most; in clusters and walls of other kinds 0.80 and more.
const HOPELESS: f64 = 0.75;

/// The same of a first line before it is moved: on validation scenes that took at most a sixth more off, and true lines left 0.7.
const UNMOVED: f64 = 0.9;

/// Work that a look for lines amounts to.
const LINE_LOOK: usize = 3000;

/// Takes the samples apart into atoms.
///
/// # Errors
/// [`ReconstructError::Cancelled`] when the request was cancelled.
pub fn find(
    radar: &Radar,
    samples: &[Complex64],
    request: &Request,
    most_work: usize,
) -> Result<Found, ReconstructError> {
    let sensor = Sensor::new(radar).hearing(samples);
    let work = Work::granted(most_work);
    let window = hann(radar.samples);
    let windowed: Vec<Complex64> = samples.iter().enumerate().map(|(i, v)| v * window[i % radar.samples]).collect();
    let search = Search {
        radar,
        sensor: &sensor,
        detector: Detector::new(radar),
        window: &window,
        samples,
        windowed: &windowed,
        request,
        work: &work,
    };
    let fit = search.run()?;
    let complete = search.is_explained(&fit);
    Ok(finish(&sensor, samples, &windowed, &window, fit, complete, request.floor))
}

struct Search<'a> {
    radar: &'a Radar,
    sensor: &'a Sensor,
    detector: Detector,
    window: &'a [f64],
    samples: &'a [Complex64],
    windowed: &'a [Complex64],
    request: &'a Request,
    work: &'a Work,
}

impl Search<'_> {
    fn problem(&self) -> Problem<'_> {
        Problem { sensor: self.sensor, samples: self.windowed, window: self.window, work: self.work }
    }

    /// Points and lines at the spacings of the thesis' scenes, one spacing after the other.
    fn run(&self) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut best = self.problem().solve(&[], Tie::PerEnd);
        for shape in LINE_SHAPES {
            if self.work.is_spent() {
                break;
            }
            let trial = self.attempt(shape)?;
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

    /// Greedy search and second thoughts, with points and lines of one shape.
    fn attempt(&self, shape: LineShape) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut best = self.greedy(self.problem().solve(&[], Tie::PerEnd), shape)?;
        if self.has_second_thoughts(&best, start) {
            let mut trial = self.straightened(self.pruned(best.clone())?)?;
            for again in [Self::tied, Self::unwrapped, Self::split] {
                if !self.is_explained(&trial) && !self.work.is_spent() {
                    self.request.task.check()?;
                    trial = again(self, trial);
                }
            }
            if !self.is_explained(&trial) {
                trial = self.greedy(self.pruned(trial)?, shape)?;
            }
            if trial.cost < 0.1 * best.cost {
                best = trial;
            }
        }
        let best = self.pruned(best)?;
        self.straightened(best)
    }

    /// Whether much is explained, not all, and there is time for more.
    fn has_second_thoughts(&self, fit: &Fit, start: f64) -> bool {
        !self.is_explained(fit) && fit.cost <= 1e-2 * start && !fit.atoms.is_empty() && !self.work.is_spent()
    }

    /// Adds atoms until the residual is the floor, nothing stands out, or there are too many.
    fn greedy(&self, mut fit: Fit, shape: LineShape) -> Result<Fit, ReconstructError> {
        let start = energy(self.windowed);
        let mut lines_missed = 0;
        while !self.is_explained(&fit) && fit.atoms.len() < MOST_ATOMS && !self.work.is_spent() {
            self.request.task.check()?;
            let residual = self.unwindowed(&fit);
            let strongest = self.detector.strongest(self.radar, &residual);
            let Some(candidate) = strongest.filter(|c| c.prominence >= LEAST_PROMINENCE) else { break };
            let placer = Placer { radar: self.radar, problem: Problem { samples: &fit.residual, ..self.problem() } };
            let mut placed = placer.point(&candidate);
            // A point that leaves next to nothing needs no line beside it.
            if lines_missed < 2 && placed.cost > 0.1 * fit.cost {
                self.work.spend(LINE_LOOK);
                let most = if fit.atoms.is_empty() { self.hopeless_cost(start, UNMOVED) } else { f64::INFINITY };
                let line = placer.line(&residual, shape, most);
                match line.filter(|line| line.cost < placed.cost) {
                    Some(line) => (placed, lines_missed) = (line, 0),
                    None => lines_missed += 1,
                }
            }
            let mut atoms = fit.atoms.clone();
            atoms.extend(placed.atoms);
            let grown = self.together(atoms, GROWING);
            if grown.cost >= 0.999 * fit.cost {
                break;
            }
            fit = grown;
            self.request.task.set_progress(((fit.cost / start).max(1e-30).log10() / -24.0) as f32);
            tracing::debug!(atoms = fit.atoms.len(), unexplained = fit.cost / start, last = ?fit.atoms.last(), "grown");
            // A first object that leaves nearly all of what is no noise.
            if fit.atoms.len() == 1 && fit.cost > self.hopeless_cost(start, HOPELESS) {
                break;
            }
        }
        Ok(fit)
    }

    /// What noise and `part` of all else leave of the energy `start`.
    fn hopeless_cost(&self, start: f64, part: f64) -> f64 {
        let channels = self.samples.chunks_exact(self.radar.samples);
        let window: f64 = self.window.iter().map(|w| w * w).sum();
        let noise = window * channels.len() as f64 * noise_variance(self.radar, channels.map(ArrayView1::from));
        noise + part * (start - noise)
    }

    fn together(&self, atoms: Vec<Atom>, limits: Limits) -> Fit {
        let moving = vec![true; atoms.len()];
        self.problem().refine(atoms, Tie::PerEnd, &moving, limits)
    }

    /// All atoms moved with one gain for both ends: reflectors too close for one end's beam are told apart by both ends together.
    fn tied(&self, fit: Fit) -> Fit {
        let moving = vec![true; fit.atoms.len()];
        let tied = self.problem().refine(fit.atoms.clone(), Tie::Both, &moving, TOGETHER);
        // Gains that need not agree leave no more than gains that must.
        let loosened = self.problem().solve(&tied.atoms, Tie::PerEnd);
        if self.is_explained(&loosened) { loosened } else { self.together(loosened.atoms, TOGETHER).or_better(fit) }
    }

    /// Without the atoms that explain nothing the others could not, or that ran away.
    fn pruned(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let before = fit.atoms.len();
        let enough = if self.is_explained(&fit) { FLOOR_MARGIN * self.floor_energy(&fit) } else { 2.0 * fit.cost };
        let mut i = 0;
        while i < fit.atoms.len() && !self.work.is_spent() {
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
        Ok(if fit.atoms.len() < before { self.together(fit.atoms, TOGETHER) } else { fit })
    }

    /// The best of replacing one atom by two beside each other: two reflectors closer than a beam are first found as one.
    fn split(&self, fit: Fit) -> Fit {
        let pairs = |i: usize| {
            let Atom::Point { x, y } = fit.atoms[i] else { return Vec::new() };
            let turned = |radians: f64| {
                let (sin, cos) = radians.sin_cos();
                Atom::Point { x: x * cos - y * sin, y: (x * sin + y * cos).abs() }
            };
            let halves = [0.01, 0.04, 0.12].map(|radians| [turned(radians), turned(-radians)]);
            let start = |halves: [Atom; 2]| {
                let mut atoms = fit.atoms.clone();
                atoms[i] = halves[0];
                atoms.push(halves[1]);
                Start { atoms, range_metres: x.hypot(y) }
            };
            halves.into_iter().map(start).collect()
        };
        self.best_of((0..fit.atoms.len()).flat_map(pairs).collect(), fit)
    }

    /// The fit to the best of other starts, or `fit` if none is better.
    fn best_of(&self, starts: Vec<Start>, fit: Fit) -> Fit {
        let glance = |start: Start| {
            let moving = self.beside(&start.atoms, start.range_metres);
            self.problem().refine(start.atoms, Tie::PerEnd, &moving, Limits::GLANCE)
        };
        let best = starts.into_par_iter().map(glance).min_by(|a, b| a.cost.total_cmp(&b.cost));
        match best.filter(|best| best.cost < fit.cost) {
            Some(best) => self.together(best.atoms, TOGETHER),
            None => fit,
        }
    }

    /// Every line slid once more, now that the other objects are known, and without the points that patch its ends: a line found
    /// one point too far along leaves a missing and a surplus point, which then are found as points of opposite sign.
    fn straightened(&self, mut fit: Fit) -> Result<Fit, ReconstructError> {
        let mut i = 0;
        while i < fit.atoms.len() && !self.work.is_spent() {
            self.request.task.check()?;
            let on_line: Vec<bool> = fit.atoms.iter().map(|atom| patches(&fit.atoms[i], atom)).collect();
            if matches!(fit.atoms[i], Atom::Line { .. }) && (on_line.contains(&true) || !self.is_explained(&fit)) {
                let others = |j: usize| j != i && !on_line[j];
                let residual = self.residual(&fit, others, self.windowed, self.window);
                let placer = Placer { radar: self.radar, problem: Problem { samples: &residual, ..self.problem() } };
                let slid = placer.slid(placer.stretched(fit.atoms[i])).atoms;
                let kept = |range: std::ops::Range<usize>| range.filter(|j| others(*j)).map(|j| fit.atoms[j]);
                let atoms: Vec<Atom> = kept(0..i).chain(slid).chain(kept(i + 1..fit.atoms.len())).collect();
                let place = kept(0..i).count();
                let trial = self.together(atoms, TOGETHER);
                if self.is_explained(&trial) || trial.cost < fit.cost {
                    (fit, i) = (trial, place);
                }
            }
            i += 1;
        }
        Ok(fit)
    }

    /// The best of trying a point one wrap of the range further out or nearer, without the points beside it: near the array's axis the
    /// ends hardly tell the two apart, and several points in the wrong place make up for one in the right.
    fn unwrapped(&self, fit: Fit) -> Fit {
        let without = |atom: &Atom| {
            let Atom::Point { x, y } = *atom else { return None };
            let beside = self.beside(&fit.atoms, x.hypot(y));
            let mut atoms: Vec<Atom> = fit.atoms.iter().zip(beside).filter(|(_, b)| !b).map(|(a, _)| *a).collect();
            atoms.push(wrapped(x, y, self.radar.max_range_metres()));
            Some(Start { atoms, range_metres: x.hypot(y) })
        };
        self.best_of(fit.atoms.iter().filter_map(without).collect(), fit)
    }

    /// Which of `atoms` are points as far away as `range`, wraps of the range aside.
    fn beside(&self, atoms: &[Atom], range: f64) -> Vec<bool> {
        let wrap = self.radar.max_range_metres();
        let is_beside = |atom: &Atom| match *atom {
            Atom::Point { x, y } => {
                let apart = (x.hypot(y) - range).rem_euclid(wrap);
                apart.min(wrap - apart) < BESIDE_METRES
            }
            Atom::Line { .. } => false,
        };
        atoms.iter().map(is_beside).collect()
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
        let strongest = self.detector.strongest(self.radar, &residual);
        strongest.is_some_and(|c| c.prominence >= LEAST_PROMINENCE)
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

    /// The residual without the window, of the atoms and gains of `fit`.
    fn unwindowed(&self, fit: &Fit) -> Vec<Complex64> {
        self.residual(fit, |_| true, self.samples, &vec![1.0; self.radar.samples])
    }

    /// `samples` less those atoms of `fit` that are `taken`, each with its gains and times `window`.
    fn residual(
        &self,
        fit: &Fit,
        taken: impl Fn(usize) -> bool,
        samples: &[Complex64],
        window: &[f64],
    ) -> Vec<Complex64> {
        let mut residual = samples.to_vec();
        let mut column = vec![Complex64::default(); self.sensor.sample_count()];
        for (_, (atom, gains)) in fit.atoms.iter().zip(&fit.gains).enumerate().filter(|(i, _)| taken(*i)) {
            self.sensor.fill_atom(atom, window, &mut [&mut column]);
            for (i, (r, v)) in residual.iter_mut().zip(&column).enumerate() {
                *r -= v * gains[i / self.sensor.end_len()];
            }
        }
        residual
    }
}

/// Atoms to try instead of those of a fit.
struct Start {
    atoms: Vec<Atom>,
    /// Only the points this far away move at first.
    range_metres: f64,
}

/// Points this much nearer or further than another, metres, are beside it.
const BESIDE_METRES: f64 = 1.0;

/// Whether `atom` is a point on `line` or just beyond its ends.
fn patches(line: &Atom, atom: &Atom) -> bool {
    let (Atom::Line { x, start, spacing, count }, Atom::Point { x: point_x, y }) = (*line, *atom) else { return false };
    let beyond = 10.0 * spacing.abs();
    let end = start + count as f64 * spacing;
    (point_x - x).abs() < 0.05 && (start.min(end) - beyond..=start.max(end) + beyond).contains(&y)
}
