//! Where the residual may hold a line of reflectors.
//!
//! A line far off broadside packs its points closer than a range bin: no single point stands out, the line does. Each end's beams
//! are laid along every candidate line; the points' echoes are added with the phases the line predicts, a few neighbours at a time,
//! so that a coarse grid of (x, start) still meets them. A true line shows the same gain everywhere along its length and at both
//! ends; one bright reflector does not, so a low quantile of the gains tells them apart.

use super::blocks::{BLOCK, Blocks, GLANCED, glance, heard_along};
use super::phased::{AddedUp, PhasedBeams, Row, added_up};
use super::runs::EchoBins;
use super::source::{Propose, Unexplained};
use crate::radar::Radar;
use crate::reconstruct::fit::Atom;
use crate::task::Task;
use rayon::prelude::*;

/// Starts tried between one point and the next.
const PHASES: usize = 2;

/// Step of the coarse grid in x, as a part of x, and the least and the most of it, metres: the nearer a line, the finer its phases follow its place.
const X_STEP: f64 = 0.006;
const X_STEP_METRES: [f64; 2] = [0.04, 0.12];

/// Part of the maximum range up to which lines are looked for to each side.
const WIDEST: f64 = 0.82;

/// Part of the blocks that may be weaker than the gain a line is credited with.
const QUANTILE: f64 = 0.3;

/// Part of the energy in its range bins that a line must explain to be looked at.
const LEAST_PART: f64 = 0.06;

/// Lines that begin this near to an end are not looked for, metres: their first point alone would speak for all.
const NEAREST_METRES: f64 = 1.5;

/// Part of a line's range bins that hold an echo at either end.
const LEAST_ECHOES: f64 = 0.7;

/// Lines nearer to a better one than this, in x and along y, are its side lobes for now, metres.
const APART_METRES: f64 = 1.0;

/// Starts kept of each column of the coarse grid.
const BEST_OF_COLUMN: usize = 8;

/// Starts of a column that are looked at in the order of what they promise.
const SORTED: usize = 64;

/// The same at the first glance, by a few blocks of the line: they may be too weak by chance.
const GLANCED_PART: f64 = 0.02;

/// Range bins from one point to the next of the lines that are looked for: as the author's program makes the tables' scenes, and as the text
/// says. What is found may turn.
const SPACINGS_BINS: [f64; 2] = [1.5, 1.0];

/// Points of these lines. What is found may become longer or shorter.
const COUNT: usize = 75;

/// Lines of one spacing that are moved to the best place near them, and those of them that are kept.
const MOST_FINE: [usize; 2] = [4, 3];

/// How far around a line of the coarse grid the fine one reaches, and its step, metres.
const FINE_METRES: [f64; 2] = [0.08, 0.005];

/// A line that the residual may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Candidate {
    /// The line.
    atom: Atom,
    /// Part of the energy in its range bins that it would explain, more or less.
    part: f64,
    /// What [`LineDetector::coherent`] comes to where it explains all of it.
    score: f64,
}

/// The line along y from (x, y) on.
fn vertical(x_metres: f64, y_metres: f64, dy_metres: f64, count: usize) -> Atom {
    Atom::Segment { x_metres, y_metres, dx_metres: 0.0, dy_metres, count }
}

/// Long lines along y, looked up as a whole.
pub struct LongLines;

impl Propose for LongLines {
    fn propose(&self, left: &Unexplained) -> Vec<Atom> {
        lines_in(left.radar, left.beams(), left.echoes(), left.task)
    }
}

/// Long lines along y that `residual` (all samples of both ends, not windowed) may hold, where it has `echoes`.
fn lines_in(radar: &Radar, beams: &PhasedBeams, echoes: &EchoBins, task: &Task) -> Vec<Atom> {
    let weights = radar.window.weights(radar.samples);
    let [sum, square] = weights.iter().fold([0.0; 2], |[sum, square], w| [sum + w, square + w * w]);
    let detector = LineDetector {
        beams,
        echoes,
        extent_metres: radar.max_range_metres(),
        bins: radar.samples,
        running: [0, 1].map(|end| beams.running_energy(end)),
        score_of_energy: radar.end_elements as f64 * sum * sum / (radar.samples as f64 * square),
    };
    let mut found = Vec::new();
    for spacing_bins in SPACINGS_BINS {
        if task.is_cancelled() {
            break;
        }
        let coarse = detector.coarse(spacing_bins * radar.range_resolution_metres(), COUNT);
        let mut fine: Vec<Candidate> = coarse.iter().map(|c| detector.fine(c)).collect();
        fine.sort_by(|a, b| b.part.total_cmp(&a.part));
        found.extend(fine.iter().take(MOST_FINE[1]).map(|line| line.atom));
    }
    found
}

/// Looks for lines in the beams of both ends.
struct LineDetector<'a> {
    beams: &'a PhasedBeams,
    echoes: &'a EchoBins,
    extent_metres: f64,
    bins: usize,
    /// Energy of the range bins up to each, at both ends.
    running: [Vec<f64>; 2],
    /// Score of a line that explains energy 1.
    score_of_energy: f64,
}

impl LineDetector<'_> {
    /// The best lines of `count` points at `spacing` metres on the coarse grid, best first, none beside another.
    fn coarse(&self, spacing: f64, count: usize) -> Vec<Candidate> {
        let [least, most] = X_STEP_METRES;
        let next = |x: &f64| Some(x + (X_STEP * x).clamp(least, most)).filter(|x| *x < WIDEST * self.extent_metres);
        let right: Vec<f64> = std::iter::successors(Some(0.0), next).collect();
        let columns: Vec<f64> = right[1..].iter().rev().map(|x| -x).chain(right.iter().copied()).collect();
        let mut found: Vec<Candidate> =
            columns.into_par_iter().flat_map_iter(|x| self.best_at(x, spacing, count)).collect();
        found.sort_by(|a, b| b.part.total_cmp(&a.part));
        let mut apart: Vec<Candidate> = Vec::new();
        for candidate in found {
            if apart.iter().all(|a| distance(&a.atom, &candidate.atom) > APART_METRES) {
                apart.push(candidate);
                if apart.len() == MOST_FINE[0] {
                    break;
                }
            }
        }
        apart
    }

    /// What [`LineDetector::coherent`] comes to where a line along y at x explains all that there is in its range bins; infinite where one
    /// point would speak for all, and where too few of the bins hold an echo.
    fn score_of_all(&self, x: f64, along: [f64; 2]) -> f64 {
        let energy = [0, 1].map(|end| {
            let [near, far] = along.map(|y| self.beams.views[end].of_place([x, y], 0.0).0);
            if near < NEAREST_METRES {
                return f64::INFINITY;
            }
            let [near, far] = [near, far].map(|range| (range * self.bins as f64 / self.extent_metres) as usize);
            if self.echoes.part(end, [near, far]) < LEAST_ECHOES {
                return f64::INFINITY;
            }
            let running = &self.running[end];
            let up_to = |bin: usize| (bin / self.bins) as f64 * running[self.bins] + running[bin % self.bins];
            up_to(far + 1) - up_to(near)
        });
        self.score_of_energy * (energy[0] + energy[1]).max(f64::MIN_POSITIVE)
    }

    /// The best lines of the coarse grid at x, metres.
    fn best_at(&self, x: f64, spacing: f64, count: usize) -> Vec<Candidate> {
        let blocks = (count / BLOCK).max(1);
        let starts = (self.extent_metres / spacing) as usize;
        let y = |start: usize| start as f64 * spacing;
        let scores: Vec<f64> =
            (0..starts).step_by(BLOCK).map(|start| self.score_of_all(x, [y(start), y(start + count)])).collect();
        // From the first start that may be one to the last.
        let may_be = |score: &f64| score.is_finite();
        let Some(skipped) = scores.iter().position(may_be) else { return Vec::new() };
        let scores = &scores[skipped..=scores.iter().rposition(may_be).unwrap_or(skipped)];
        let first_y = y(skipped * BLOCK);
        let starts = (scores.len() * BLOCK).min(starts - skipped * BLOCK);
        let row = |offset: f64| Row { first_metres: [x, offset], step_metres: [0.0, spacing] };
        let offsets: Vec<f64> = (0..PHASES)
            .map(|phase| first_y + spacing * phase as f64 / PHASES as f64)
            .filter(|offset| self.may_hold(row(*offset), starts + count, scores, count))
            .collect();
        let blocks_of = |offset: &f64| [0, 1].map(|end| Blocks::new(self.beams, end, row(*offset), starts + count));
        let ends: Vec<[Blocks; 2]> = offsets.iter().map(blocks_of).collect();
        let at = (2.0 * blocks as f64 * QUANTILE) as usize;
        let mut best: Vec<Candidate> = Vec::with_capacity(BEST_OF_COLUMN + 1);
        let mut gains = Vec::with_capacity(2 * blocks);
        for Trial { bound, weight, phase, start } in trials(&ends, scores, starts, blocks) {
            let least = if best.len() < BEST_OF_COLUMN { LEAST_PART } else { best[BEST_OF_COLUMN - 1].part };
            if bound <= least {
                continue;
            }
            gains.clear();
            for end in &ends[phase] {
                gains.extend((0..blocks).map(|b| end.gain[start + b * BLOCK]));
            }
            // Counting tells sooner than finding it whether the quantile is large enough.
            let needed = (least * scores[start / BLOCK] / weight).sqrt();
            if gains.iter().filter(|gain| **gain <= needed).count() > at {
                continue;
            }
            let gain = *gains.select_nth_unstable_by(at, f64::total_cmp).1;
            let score = scores[start / BLOCK];
            let part = gain * gain * weight / score;
            if part > least {
                let start = offsets[phase] + start as f64 * spacing;
                best.push(Candidate { atom: vertical(x, start, spacing, count), part, score });
                best.sort_by(|a, b| b.part.total_cmp(&a.part));
                best.truncate(BEST_OF_COLUMN);
            }
        }
        best
    }

    /// Whether a line of `count` points may stand somewhere in a column: by every third block of it.
    fn may_hold(&self, row: Row, points: usize, scores: &[f64], count: usize) -> bool {
        let window = count / (GLANCED * BLOCK) - 1;
        let mut may = vec![true; (points / (GLANCED * BLOCK) + 1).saturating_sub(window)];
        for end in 0..2 {
            let blocks = glance(self.beams, end, row, points);
            for (at, may) in may.iter_mut().enumerate() {
                let own = &blocks[at..at + window];
                // What the whole line weighs at both ends.
                let weight =
                    own.iter().map(|block| block.weight).sum::<f64>() * (2 * count) as f64 / (window * BLOCK) as f64;
                let needed = GLANCED_PART * scores[(at * GLANCED).min(scores.len() - 1)] / weight;
                *may &= 4 * own.iter().filter(|block| block.power > needed).count() >= 3 * window;
            }
        }
        may.contains(&true)
    }

    /// Energy that a line explains when all its points at one end are added with their phases; the sum over both ends.
    fn coherent(&self, atom: &Atom) -> f64 {
        let Atom::Segment { x_metres, y_metres, dx_metres, dy_metres, count } = *atom else { return 0.0 };
        let row = Row { first_metres: [x_metres, y_metres], step_metres: [dx_metres, dy_metres] };
        let mut energy = 0.0;
        for end in 0..2 {
            let AddedUp { sum, weight, .. } = added_up(&heard_along(self.beams, end, row, count));
            energy += sum.norm_sqr() / weight;
        }
        energy
    }

    /// The best place for `atom` on a fine grid around it, all points added with their phases.
    fn fine(&self, candidate: &Candidate) -> Candidate {
        let score = candidate.score;
        let [reach, step] = FINE_METRES;
        let steps = (reach / step).round() as i32;
        (-steps..=steps)
            .into_par_iter()
            .flat_map_iter(|i| (-steps..=steps).map(move |j| (i, j)))
            .map(|(i, j)| {
                let atom = candidate.atom.moved(&[f64::from(i) * step, f64::from(j) * step, 0.0, 0.0]);
                Candidate { atom, part: self.coherent(&atom) / score, score }
            })
            .reduce(|| Candidate { part: 0.0, ..*candidate }, |a, b| if b.part > a.part { b } else { a })
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
fn trials(ends: &[[Blocks; 2]], scores: &[f64], starts: usize, blocks: usize) -> Vec<Trial> {
    let mut trials: Vec<Trial> = Vec::with_capacity(ends.len() * starts);
    for (phase, ends) in ends.iter().enumerate() {
        trials.extend((0..starts).map(|start| {
            let [a, b] = [0, 1].map(|end| ends[end].totals(start, blocks));
            let (sum, weight) = (a[0] + b[0], a[1] + b[1]);
            // The quantile can't exceed the mean of all over the part that lies above it.
            let bound = sum / (2 * blocks) as f64 / (1.0 - QUANTILE);
            Trial { bound: bound * bound * weight / scores[start / BLOCK], weight, phase, start }
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

/// Larger of the distances in x and in start, metres.
fn distance(a: &Atom, b: &Atom) -> f64 {
    let ([ax, ay], [bx, by]) = (a.position_metres(0.0), b.position_metres(0.0));
    (ax - bx).abs().max((ay - by).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::hearing::Hearing;
    use crate::scene::{Line, Object, Point, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn lines_of_both_spacings_are_seen_behind_a_near_point() {
        let radar = Radar::default();
        for [x, y, bins] in [[-17.3, 6.0, 1.5], [9.6, 24.0, 1.0]] {
            let step = bins * radar.range_resolution_metres();
            let line = Object::Line(Line::vertical(x, y, step, 90));
            let point = Object::Point(Point { reflectivity: 0.5, ..Point::new(2.0, 6.0) });
            let scene = Scene { objects: vec![line, point], ..Scene::default() };
            let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
            let flat = ends.flat();
            let echoes = EchoBins::of(&radar, &flat, Hearing::any().noise_variance(&radar, &flat));
            let seen = lines_in(&radar, &PhasedBeams::new(&radar, &flat), &echoes, &Task::default());
            // 75 of the line's 90 reflectors, whichever end they are nearer to.
            let is_part = |atom: &Atom| {
                let [first, last] = [0.0, 74.0].map(|i| atom.position_metres(i));
                let begins = (y - 0.2..y + 15.0 * step + 0.2).contains(&first[1]);
                (first[0] - x).abs() < 0.15 && begins && (last[1] - first[1] - 74.0 * step).abs() < 1e-9
            };
            assert!(seen.iter().any(is_part), "x {x}: {seen:?}");
        }
    }
}
