//! One more atom: candidates of a residual, each moved to its own best place.

use super::atom::Atom;
use super::detect::Candidate;
use super::fit::{Fit, Limits, Problem, Tie};
use super::lines::{LineCandidate, LineDetector};
use super::search::GLANCE;
use crate::radar::Radar;
use num_complex::Complex64;

/// Spacings at which lines are looked for, range bins: the tables' scenes as the author's program makes them, and as the text says.
/// Refinement then moves the spacing freely.
pub const TABLE_SPACINGS_BINS: [f64; 2] = [1.5, 1.0];

/// Points of the lines that are looked for; a line found may become longer or shorter.
const LINE_POINTS: usize = 75;

/// Of one new atom by itself.
const ALONE: Limits = Limits { iterations: 15, least_gain: 1e-3 };

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
        let range = candidate.x.hypot(candidate.y).max(1e-3);
        let other = if range > self.radar.max_range_metres() { -1.0 } else { 1.0 };
        let far = 1.0 + other * self.radar.max_range_metres() / range;
        let own = self.refined(Atom::Point { x: candidate.x, y: candidate.y }, ALONE);
        let wrapped = self.refined(Atom::Point { x: candidate.x * far, y: candidate.y * far }, ALONE);
        // The nearer one unless the other is clearly better.
        let (near, far) = if other > 0.0 { (own, wrapped) } else { (wrapped, own) };
        if far.cost < 0.5 * near.cost { far } else { near }
    }

    /// The best line at about `spacing_bins` in `residual` (not windowed), moved to its best place.
    pub fn line(&self, residual: &[Complex64], spacing_bins: f64) -> Option<Fit> {
        let detector = LineDetector::new(self.radar, self.problem.sensor, residual);
        let spacing = spacing_bins * self.radar.range_resolution_metres();
        let coarse = detector.coarse(spacing, LINE_POINTS, 8);
        let mut fine: Vec<LineCandidate> = coarse.iter().map(|c| detector.fine(&c.atom, 0.06, 0.004)).collect();
        fine.sort_by(|a, b| b.score.total_cmp(&a.score));
        fine.truncate(3);
        let placed = fine.iter().map(|line| self.refined(line.atom, ALONE));
        placed.min_by(|a, b| a.cost.total_cmp(&b.cost)).map(|line| self.slid(line))
    }

    /// A line tried one and two points further along and with other numbers of points: each such slip is a local minimum of its
    /// own, in which all points but a few still meet.
    fn slid(&self, mut best: Fit) -> Fit {
        for _ in 0..12 {
            let Some(&Atom::Line { x, start, spacing, count }) = best.atoms.first() else { return best };
            let moved = |points: i32, longer: isize| {
                let count = count.saturating_add_signed(longer);
                let start = start + f64::from(points) * spacing;
                (2..=1000).contains(&count).then_some(Atom::Line { x, start, spacing, count })
            };
            let slips = [-2, -1, 1, 2].into_iter().filter_map(|k| moved(k, 0)).map(|atom| self.refined(atom, GLANCE));
            let lengths = [(0, 1), (0, -1), (1, -1), (-1, 1), (0, 8), (0, -8), (8, -8), (-8, 8)];
            let lengths = lengths.into_iter().filter_map(|(k, longer)| moved(k, longer));
            let lengths = lengths.map(|atom| self.problem.solve(&[atom], Tie::PerEnd));
            let Some(trial) = slips.chain(lengths).min_by(|a, b| a.cost.total_cmp(&b.cost)) else { return best };
            if trial.cost >= 0.995 * best.cost {
                break;
            }
            best = self.refined(trial.atoms[0], GLANCE);
        }
        best
    }
}
