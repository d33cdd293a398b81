//! One more atom: candidates of a residual, each moved to its own best place.

use super::atom::Atom;
use super::detect::Candidate;
use super::fit::{Fit, Limits, Problem, Tie};
use super::lines::{LineCandidate, LineDetector};
use crate::radar::Radar;
use num_complex::Complex64;
use rayon::prelude::*;

/// A line to look for. What is found may become longer or shorter; the spacing moves by less than a wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineShape {
    /// Distance between neighbours, range bins.
    pub spacing_bins: f64,
    /// Points at least.
    pub points: usize,
}

/// Lines that are looked for, in this order: at the spacings of the tables' scenes as the author's program makes them, and as the text
/// says; first as long as those, then shorter ones.
pub const LINE_SHAPES: [LineShape; 4] = [
    LineShape { spacing_bins: 1.5, points: 75 },
    LineShape { spacing_bins: 1.0, points: 75 },
    LineShape { spacing_bins: 1.5, points: 30 },
    LineShape { spacing_bins: 1.0, points: 30 },
];

/// Of one new atom by itself.
const ALONE: Limits = Limits { iterations: 15, least_gain: 1e-3 };

/// Most points of a line.
const MOST_POINTS: i32 = 1000;

/// Points by which each end of a line is moved once the other objects are known.
const STRETCH: i32 = 6;

/// Most times a line is slid.
const MOST_SLIDES: usize = 16;

/// A slide must leave less than this part of what was left: one point of a line may be a small part of all that is there.
const LEAST_SLIDE: f64 = 0.9999;

/// Places atoms in the residual that its `problem` holds.
pub struct Placer<'a> {
    /// The radar.
    pub radar: &'a Radar,
    /// The residual to explain with one more atom.
    pub problem: Problem<'a>,
}

impl Placer<'_> {
    fn refined(&self, atom: Atom, limits: Limits) -> Fit {
        self.problem.refine(vec![atom], Tie::PerEnd, &[true], limits)
    }

    /// The candidate moved to its best place, at its own range or one wrap nearer or further out: ranges repeat, curvature does not.
    pub fn point(&self, candidate: &Candidate) -> Fit {
        let other = wrapped(candidate.x, candidate.y, self.radar.max_range_metres());
        let own = Atom::Point { x: candidate.x, y: candidate.y };
        let (own, wrapped) = rayon::join(|| self.refined(own, ALONE), || self.refined(other, ALONE));
        // The nearer one unless the other is clearly better.
        let is_near = candidate.x.hypot(candidate.y) <= self.radar.max_range_metres();
        let (near, far) = if is_near { (own, wrapped) } else { (wrapped, own) };
        if far.cost < 0.5 * near.cost { far } else { near }
    }

    /// The best line of about `shape` in `residual` (not windowed), moved to its best place; `None` where it leaves more than `most_cost` before
    /// it is moved.
    pub fn line(&self, residual: &[Complex64], shape: LineShape, most_cost: f64) -> Option<Fit> {
        let detector = LineDetector::new(self.radar, residual);
        let spacing = shape.spacing_bins * self.radar.range_resolution_metres();
        let coarse = detector.coarse(spacing, shape.points, 8);
        let mut fine: Vec<LineCandidate> = coarse.iter().map(|c| detector.fine(&c.atom, 0.06, 0.004)).collect();
        fine.sort_by(|a, b| b.score.total_cmp(&a.score));
        fine.truncate(3);
        if !fine.iter().any(|line| self.problem.solve(&[line.atom], Tie::PerEnd).cost <= most_cost) {
            return None;
        }
        let placed: Vec<Fit> = fine.par_iter().map(|line| self.refined(line.atom, ALONE)).collect();
        cheapest(placed).map(|line| self.slid(line.atoms[0]))
    }

    /// The line with both ends moved by up to [`STRETCH`] points, whatever leaves least; nothing else moves.
    pub fn stretched(&self, line: Atom) -> Atom {
        let ends = (-STRETCH..=STRETCH).flat_map(|first| (-STRETCH..=STRETCH).map(move |last| (first, last)));
        let trials: Vec<Atom> = ends.filter_map(|(first, last)| stretched(line, first, last)).collect();
        let tried = trials.into_par_iter().map(|atom| self.problem.solve(&[atom], Tie::PerEnd));
        cheapest(tried.collect()).map_or(line, |fit| fit.atoms[0])
    }

    /// A line tried one and two points further along and with other numbers of points: each such slip is a local minimum of its
    /// own, in which all points but a few still meet.
    pub fn slid(&self, line: Atom) -> Fit {
        let mut best = self.refined(line, Limits::GLANCE);
        for _ in 0..MOST_SLIDES {
            let line = best.atoms[0];
            let moved = |(first, last)| stretched(line, first, last);
            let slips = [-2, -1, 1, 2].into_iter().filter_map(|k| moved((k, k))).map(|atom| (atom, true));
            let lengths = [(0, 1), (0, -1), (1, 0), (-1, 0), (0, 8), (0, -8), (8, 0), (-8, 0)];
            let lengths = lengths.into_iter().filter_map(moved).map(|atom| (atom, false));
            let trials: Vec<(Atom, bool)> = slips.chain(lengths).collect();
            let tried = trials.into_par_iter().map(|(atom, slipped)| {
                if slipped { self.refined(atom, Limits::GLANCE) } else { self.problem.solve(&[atom], Tie::PerEnd) }
            });
            let Some(trial) = cheapest(tried.collect()) else { return best };
            if trial.cost >= LEAST_SLIDE * best.cost {
                break;
            }
            best = self.refined(trial.atoms[0], Limits::GLANCE);
        }
        best
    }
}

/// `line` from `first` points further along to `last` points beyond its end; `None` where fewer than two points are left, or too many.
fn stretched(line: Atom, first: i32, last: i32) -> Option<Atom> {
    let Atom::Line { x, start, spacing, count } = line else { return None };
    let count = i32::try_from(count).ok()? - first + last;
    let start = start + f64::from(first) * spacing;
    (2..=MOST_POINTS).contains(&count).then_some(Atom::Line { x, start, spacing, count: count as usize })
}

/// The point at (x, y) one wrap of the range further out, or nearer if it lies beyond the maximum range.
pub fn wrapped(x: f64, y: f64, max_range_metres: f64) -> Atom {
    let range = x.hypot(y).max(1e-3);
    let other = if range > max_range_metres { -1.0 } else { 1.0 };
    let far = 1.0 + other * max_range_metres / range;
    Atom::Point { x: x * far, y: y * far }
}

/// The fit that leaves least; of equals the first.
fn cheapest(fits: Vec<Fit>) -> Option<Fit> {
    fits.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
}
