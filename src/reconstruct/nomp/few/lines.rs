//! Where the residual may hold a line of reflectors.
//!
//! A line far off broadside packs its points closer than a range bin: no single point stands out, the line does. Each end's beams
//! are laid along every candidate line; the points' echoes are added with the phases the line predicts, a few neighbours at a time,
//! so that a coarse grid of (x, start) still meets them. A true line shows the same gain everywhere along its length and at both
//! ends; one bright reflector does not, so a low quantile of the gains tells them apart.

use super::atom::Atom;
use crate::radar::Radar;
use crate::reconstruct::nomp::phased::{Heard, PhasedBeams, Row};
use crate::signal::simd::{Kernel, Simd};
use num_complex::Complex64;
use rayon::prelude::*;

/// Points added with their phases before magnitudes are taken.
const BLOCK: usize = 5;

/// Starts tried between one point and the next.
const PHASES: usize = 3;

/// Step of the coarse grid in x, metres.
const X_STEP_METRES: f64 = 0.05;

/// Part of the blocks that may be weaker than the gain a line is credited with.
const QUANTILE: f64 = 0.3;

/// Starts kept of each column of the coarse grid.
const BEST_OF_COLUMN: usize = 8;

/// Starts of a column that are looked at in the order of what they promise.
const SORTED: usize = 64;

/// A line that the residual may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineCandidate {
    /// The line.
    pub atom: Atom,
    /// Energy it would explain, in arbitrary units that are the same for all candidates of one residual.
    pub score: f64,
}

/// Looks for lines in the beams of both ends.
pub struct LineDetector {
    beams: PhasedBeams,
    extent_metres: f64,
}

impl LineDetector {
    /// Forms the beams of `residual` (all samples of both ends, not windowed).
    pub fn new(radar: &Radar, residual: &[Complex64]) -> Self {
        LineDetector { beams: PhasedBeams::new(radar, residual), extent_metres: radar.max_range_metres() }
    }

    /// What each of `count` reflectors at x, one behind the other from `start`, would have left at an end.
    fn echoes(&self, end: usize, x: f64, start: f64, spacing: f64, count: usize) -> Vec<Heard> {
        let mut heard = vec![Heard::default(); count];
        let row = Row { first_metres: [x, start], step_metres: [0.0, spacing] };
        Simd::chosen().run(Column { detector: self, end, row, heard: &mut heard });
        heard
    }

    /// The best lines of `count` points at `spacing` metres on the coarse grid, best first, none beside another.
    pub fn coarse(&self, spacing: f64, count: usize, most: usize) -> Vec<LineCandidate> {
        let columns = (2.0 * 0.82 * self.extent_metres / X_STEP_METRES) as usize;
        let x = |column: usize| column as f64 * X_STEP_METRES - 0.82 * self.extent_metres;
        let mut found: Vec<LineCandidate> =
            (0..columns).into_par_iter().flat_map_iter(|column| self.best_at(x(column), spacing, count)).collect();
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut apart: Vec<LineCandidate> = Vec::new();
        for candidate in found {
            if apart.iter().all(|a| distance(&a.atom, &candidate.atom) > 0.12) {
                apart.push(candidate);
                if apart.len() == most {
                    break;
                }
            }
        }
        apart
    }

    /// The best lines of the coarse grid at x, metres.
    fn best_at(&self, x: f64, spacing: f64, count: usize) -> Vec<LineCandidate> {
        let blocks = (count / BLOCK).max(1);
        let starts = (self.extent_metres / spacing) as usize;
        let offsets: [f64; PHASES] = std::array::from_fn(|phase| spacing * phase as f64 / PHASES as f64);
        let ends = offsets.map(|o| [0, 1].map(|end| Blocks::new(self, end, x, o, spacing, starts + count)));
        let at = (2.0 * blocks as f64 * QUANTILE) as usize;
        let mut best: Vec<LineCandidate> = Vec::with_capacity(BEST_OF_COLUMN + 1);
        let mut gains = Vec::with_capacity(2 * blocks);
        for Trial { bound, weight, phase, start } in trials(&ends, starts, blocks) {
            let least = if best.len() < BEST_OF_COLUMN { 0.0 } else { best[BEST_OF_COLUMN - 1].score };
            if bound <= least {
                continue;
            }
            gains.clear();
            for end in &ends[phase] {
                gains.extend((0..blocks).map(|b| end.gain[start + b * BLOCK]));
            }
            // Counting tells sooner than finding it whether the quantile is large enough.
            let needed = (least / weight).sqrt();
            if gains.iter().filter(|gain| **gain <= needed).count() > at {
                continue;
            }
            let gain = *gains.select_nth_unstable_by(at, f64::total_cmp).1;
            let score = gain * gain * weight;
            if score > least {
                let start = offsets[phase] + start as f64 * spacing;
                best.push(LineCandidate { atom: Atom::Line { x, start, spacing, count }, score });
                best.sort_by(|a, b| b.score.total_cmp(&a.score));
                best.truncate(BEST_OF_COLUMN);
            }
        }
        best
    }

    /// Energy that a line explains when all its points at one end are added with their phases; the sum over both ends.
    pub fn coherent(&self, atom: &Atom) -> f64 {
        let (x, start, spacing, count) = match *atom {
            Atom::Line { x, start, spacing, count } => (x, start, spacing, count),
            Atom::Point { x, y } => (x, y, 0.0, 1),
        };
        let mut energy = 0.0;
        for end in 0..2 {
            let (mut sum, mut weight) = (Complex64::default(), 0.0);
            for echo in self.echoes(end, x, start, spacing, count) {
                sum += echo.weighted;
                weight += echo.weight;
            }
            energy += sum.norm_sqr() / weight;
        }
        energy
    }

    /// The best place for `atom` on a fine grid around it, all points added with their phases.
    pub fn fine(&self, atom: &Atom, reach_metres: f64, step_metres: f64) -> LineCandidate {
        let steps = (reach_metres / step_metres).round() as i32;
        (-steps..=steps)
            .into_par_iter()
            .flat_map_iter(|i| (-steps..=steps).map(move |j| (i, j)))
            .map(|(i, j)| {
                let atom = atom.moved(&[f64::from(i) * step_metres, f64::from(j) * step_metres, 0.0]);
                LineCandidate { atom, score: self.coherent(&atom) }
            })
            .reduce(|| LineCandidate { atom: *atom, score: 0.0 }, |a, b| if b.score > a.score { b } else { a })
    }
}

/// A start of the coarse grid and the most that its score can be.
#[derive(Debug, Clone, Copy)]
struct Trial {
    bound: f64,
    weight: f64,
    phase: usize,
    start: usize,
}

/// Every start of every phase with the most that its score can be: those that promise most first, hardly any of the others is looked at.
fn trials(ends: &[[Blocks; 2]; PHASES], starts: usize, blocks: usize) -> Vec<Trial> {
    let mut trials: Vec<Trial> = Vec::with_capacity(PHASES * starts);
    for (phase, ends) in ends.iter().enumerate() {
        trials.extend((0..starts).map(|start| {
            let [a, b] = [0, 1].map(|end| ends[end].totals(start, blocks));
            let (sum, weight) = (a[0] + b[0], a[1] + b[1]);
            // The quantile can't exceed the mean of all over the part that lies above it.
            let bound = sum / (2 * blocks) as f64 / (1.0 - QUANTILE);
            Trial { bound: bound * bound * weight, weight, phase, start }
        }));
    }
    let by_bound = |a: &Trial, b: &Trial| b.bound.total_cmp(&a.bound).then((a.phase, a.start).cmp(&(b.phase, b.start)));
    if trials.len() > SORTED {
        trials.select_nth_unstable_by(SORTED, by_bound);
    }
    let sorted = trials.len().min(SORTED);
    trials[..sorted].sort_unstable_by(by_bound);
    trials
}

/// What a column of reflectors would have left at one end.
struct Column<'a> {
    detector: &'a LineDetector,
    end: usize,
    row: Row,
    heard: &'a mut [Heard],
}

impl Kernel for Column<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.detector.beams.listen::<FMA>(self.end, &self.row, self.heard);
    }
}

/// Blocks of neighbouring points in one column of the grid as one end sees them, one for every first point.
struct Blocks {
    /// Magnitude of each block's gain.
    gain: Vec<f64>,
    /// Running sums of gain and weight (sum of squared amplitudes) in steps of [`BLOCK`] points.
    running: Vec<[f64; 2]>,
}

impl Blocks {
    fn new(detector: &LineDetector, end: usize, x: f64, offset: f64, spacing: f64, points: usize) -> Self {
        let (mut sum, mut weight) = (Complex64::default(), 0.0);
        let mut prefix = Vec::with_capacity(points + 1);
        prefix.push((sum, weight));
        for echo in detector.echoes(end, x, offset, spacing, points) {
            sum += echo.weighted;
            weight += echo.weight;
            prefix.push((sum, weight));
        }
        let first = 0..=points.saturating_sub(BLOCK);
        let mut blocks = Blocks { gain: Vec::with_capacity(points), running: Vec::with_capacity(points) };
        for i in first {
            let last = (i + BLOCK).min(points);
            let weight = prefix[last].1 - prefix[i].1;
            let gain = (prefix[last].0 - prefix[i].0).norm_sqr().sqrt() / weight;
            let before = if i >= BLOCK { blocks.running[i - BLOCK] } else { [0.0; 2] };
            blocks.gain.push(gain);
            blocks.running.push([before[0] + gain, before[1] + weight]);
        }
        blocks
    }

    /// Sum of gains and of weights of `count` blocks, one behind the other from point `start`.
    fn totals(&self, start: usize, count: usize) -> [f64; 2] {
        let last = self.running[start + (count - 1) * BLOCK];
        let before = if start >= BLOCK { self.running[start - BLOCK] } else { [0.0; 2] };
        [last[0] - before[0], last[1] - before[1]]
    }
}

/// Larger of the distances in x and in start, metres.
fn distance(a: &Atom, b: &Atom) -> f64 {
    let ([ax, ay], [bx, by]) = (a.position(0), b.position(0));
    (ax - bx).abs().max((ay - by).abs())
}
