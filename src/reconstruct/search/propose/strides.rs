//! BinSpans of reflectors from their first two: a wall whose points stand too close to be told apart still shows those at its ends.
//!
//! From one point that both ends hear over about another, every step that may be meant is tried over the first few reflectors. The best
//! are moved to where all their echoes add up, over more and more reflectors: the longer the row, the finer it is known, and the fewer
//! wrong ones go along.

use super::phased::{PhasedBeams, ReflectorEcho, Row, RowSums, row_sums};
use crate::reconstruct::fit::{Atom, damped_step};
use crate::signal::simd::{Kernel, Simd};
use crate::task::Task;
use faer::Mat;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Fewest reflectors of a wall, and those over which rows are tried first.
pub const MIN_REFLECTORS: usize = 8;

/// Longest step from one reflector of a row to the next, metres.
pub const MOST_STEP_METRES: f64 = 0.4;

/// Shortest step, metres: nearer points are one that was found twice.
pub const LEAST_STEP_METRES: f64 = 0.02;

/// Neighbours of a point that its row may lead over.
const NEIGHBOURS: usize = 8;

/// Steps of the grid around a pair to each side, along the line of sight and across.
const REACH: [i32; 2] = [7, 9];

/// From one step of the grid to the next, wavelengths over all reflectors of the first glance: halfway between, two thirds of the power
/// still add up.
const PITCH_WAVELENGTHS: f64 = 0.7;

/// Steps of a pair that are followed further.
const KEPT_STEPS: usize = 4;

/// Grids whose best rows are followed further.
const MOST_GRIDS: usize = 48;

/// Reflectors of all rows together that are followed at each length.
const MOST_FOLLOWED: usize = 3000;

/// Most reflectors of a row.
const MOST_REFLECTORS: usize = 140;

/// Growth of the row's length from one step to the next.
const GROWTH: f64 = 1.4;

/// Moves of a row at each length.
const MOVES: usize = 4;

/// A move that adds less than this part of the power is the last.
const LEAST_ADDED: f64 = 0.002;

/// BinSpans and points that reach farther than this many maximum ranges ran away.
pub const MAX_RANGES: f64 = 2.5;

/// A row that adds up to less than this part of the most it did has passed its end.
const PASSED: f64 = 0.4;

/// BinSpans from one of `points` (x, y; metres) over another, best first; one for each first point at most.
pub fn rows_over_pairs(beams: &PhasedBeams, points: &[[f64; 2]], task: &Task) -> Vec<Atom> {
    let neighbours_of = |i: usize| neighbours(points, i).map(move |j| (i, j));
    let pairs: Vec<(usize, usize)> = (0..points.len()).flat_map(neighbours_of).collect();
    // The best rows of every pair, with the part of the beams' power that adds up in each.
    let glance = |&(first, over): &(usize, usize)| {
        let rows = if task.is_cancelled() { Vec::new() } else { grid(beams, points[first], points[over]) };
        let parts = beams.coherent_parts(&rows, MIN_REFLECTORS);
        let best = summits(&parts, (2 * REACH[0] + 1) as usize, KEPT_STEPS).into_iter();
        best.map(|at| (parts[at], Start { first, row: rows[at] })).collect::<Vec<_>>()
    };
    let mut grids: Vec<Vec<(f64, Start)>> = pairs.par_iter().map(glance).collect();
    let best = |grid: &[(f64, Start)]| grid.first().map_or(0.0, |(part, _)| *part);
    grids.sort_by(|a, b| best(b).total_cmp(&best(a)));
    grids.truncate(MOST_GRIDS);
    best_of_each(beams, grids.into_iter().flatten().map(|(_, start)| start).collect(), task)
}

/// A row of a few reflectors, to be followed.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    /// Number of the point that it begins at.
    pub first: usize,
    pub row: Row,
}

/// The rows as far as their echoes add up, best first; one for each first point at most.
///
/// All are followed over more and more reflectors, those ever fewer that add up best: every length takes about as long as the last.
pub fn best_of_each(beams: &PhasedBeams, starts: Vec<Start>, task: &Task) -> Vec<Atom> {
    let mut rows: Vec<Followed> = starts.into_iter().map(Followed::new).collect();
    let mut count = MIN_REFLECTORS;
    while count <= MOST_REFLECTORS && !task.is_cancelled() {
        let most = MOST_FOLLOWED / count;
        rows.sort_by(|a, b| b.part.total_cmp(&a.part));
        rows.par_iter_mut().take(most).for_each(|row| row.lengthen(beams, count));
        rows.iter_mut().skip(most).for_each(|row| row.part = 0.0);
        count = (count as f64 * GROWTH) as usize + 1;
    }
    let mut found: Vec<(usize, (f64, Atom))> =
        rows.iter().filter_map(|row| Some((row.start.first, row.best?))).collect();
    found.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let mut taken = BTreeSet::new();
    found.retain(|(first, _)| taken.insert(*first));
    found.into_iter().map(|(_, (_, atom))| atom).collect()
}

/// The nearest points that may be next to point `i` in a row.
fn neighbours(points: &[[f64; 2]], i: usize) -> impl Iterator<Item = usize> {
    let apart = |j: usize| (points[j][0] - points[i][0]).hypot(points[j][1] - points[i][1]);
    let mut near: Vec<(f64, usize)> = (0..points.len())
        .map(|j| (apart(j), j))
        .filter(|(metres, _)| (LEAST_STEP_METRES..=MOST_STEP_METRES).contains(metres))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().take(NEIGHBOURS).map(|(_, j)| j)
}

/// BinSpans from one point over about another: by steps along the line of sight, and for each of these by steps across.
fn grid(beams: &PhasedBeams, from: [f64; 2], over: [f64; 2]) -> Vec<Row> {
    let step = [over[0] - from[0], over[1] - from[1]];
    let range = from[0].hypot(from[1]).max(0.1);
    let sight = [from[0] / range, from[1] / range];
    let [along, across] = pitches_metres(beams, from, step[0].hypot(step[1]), PITCH_WAVELENGTHS);
    let (along, across) = (sight.map(|v| v * along), [-sight[1] * across, sight[0] * across]);
    let row = |i: i32, j: i32| {
        let [i, j] = [i, j].map(f64::from);
        Row { first_metres: from, step_metres: [0, 1].map(|axis| step[axis] + i * along[axis] + j * across[axis]) }
    };
    let [far, wide] = REACH;
    (-far..=far).flat_map(|i| (-wide..=wide).map(move |j| (i, j))).map(|(i, j)| row(i, j)).collect()
}

/// Steps of a grid over the first few reflectors, for rows of about this step, so that neighbours differ by so many wavelengths over all of
/// them: along the line of sight, and across.
pub fn pitches_metres(beams: &PhasedBeams, from: [f64; 2], step_metres: f64, wavelengths: f64) -> [f64; 2] {
    let range = from[0].hypot(from[1]).max(0.1);
    let between = (beams.views[1].centre_metres - beams.views[0].centre_metres).abs().max(1e-3);
    let wavelength = beams.turns_per_metre.abs().recip();
    let last = (MIN_REFLECTORS - 1) as f64;
    // By the range itself, by its difference between the ends, by the row's curvature.
    let along = wavelengths * wavelength / last;
    let curved = wavelengths * wavelength * range / (step_metres * last * last);
    [along, (along * range / between).min(curved)]
}

/// The `most` highest of those places of a grid of so many `rows` that no neighbour exceeds, best first.
pub fn summits(parts: &[f64], rows: usize, most: usize) -> Vec<usize> {
    let columns = parts.len() / rows.max(1);
    let is_summit = |at: usize| {
        let (i, j) = (at / columns, at % columns);
        let beside = (i.saturating_sub(1)..=(i + 1).min(rows - 1))
            .flat_map(|k| (j.saturating_sub(1)..=(j + 1).min(columns - 1)).map(move |l| k * columns + l));
        beside.into_iter().all(|other| parts[other] <= parts[at])
    };
    let mut summits: Vec<usize> = (0..parts.len()).filter(|&at| parts[at] > 0.0 && is_summit(at)).collect();
    summits.sort_by(|a, b| parts[*b].total_cmp(&parts[*a]));
    summits.truncate(most);
    summits
}

/// A row that is followed over more and more reflectors.
struct Followed {
    start: Start,
    /// Part of the power at its places that adds up; 0 where it has passed its end.
    part: f64,
    most: f64,
    /// Number of reflectors whose echoes add up, more or less, at the length at which most adds up, and the row of that length.
    best: Option<(f64, Atom)>,
}

impl Followed {
    fn new(start: Start) -> Self {
        Followed { start, part: 1.0, most: 0.0, best: None }
    }

    /// Moves the row over its first `count` reflectors to where their echoes add up.
    fn lengthen(&mut self, beams: &PhasedBeams, count: usize) {
        if self.part == 0.0 {
            return;
        }
        self.part = 0.0;
        let Some((row, slope)) = climbed(beams, self.start.row, count) else { return };
        self.start.row = row;
        if slope.added < PASSED * self.most {
            return;
        }
        self.part = slope.added / f64::max(slope.all, f64::MIN_POSITIVE);
        if slope.added > self.most {
            self.most = slope.added;
            let ([x_metres, y_metres], [dx_metres, dy_metres]) = (row.first_metres, row.step_metres);
            let atom = Atom::Segment { x_metres, y_metres, dx_metres, dy_metres, count };
            self.best = Some((self.part * count as f64, atom));
        }
    }
}

/// Derivatives of the echoes' phases, and their products.
struct Slope {
    /// The part of the power at the places that adds up.
    added: f64,
    /// All power there.
    all: f64,
    gradient: [f64; 4],
    hessian: [[f64; 4]; 4],
}

/// `row` moved so that the echoes of its first `count` reflectors add up to most; `None` where it leaves what is echoes.
fn climbed(beams: &PhasedBeams, mut row: Row, count: usize) -> Option<(Row, Slope)> {
    let mut slope = slope(beams, &row, count)?;
    let mut damping = 1e-2;
    for _ in 0..MOVES {
        let Some(step) = damped_step(&Mat::from_fn(4, 4, |p, q| slope.hessian[p][q]), &slope.gradient, damping) else {
            damping *= 10.0;
            continue;
        };
        let moved = Row {
            first_metres: [row.first_metres[0] + step[0], row.first_metres[1] + step[1]],
            step_metres: [row.step_metres[0] + step[2], row.step_metres[1] + step[3]],
        };
        match self::slope(beams, &moved, count).filter(|s| s.added > slope.added) {
            Some(better) => {
                let gained = better.added - slope.added;
                (slope, row, damping) = (better, moved, damping * 0.3);
                if gained < LEAST_ADDED * slope.all {
                    break;
                }
            }
            None => damping *= 10.0,
        }
    }
    Some((row, slope))
}

/// Gauss-Newton equations of the phases against that of their sum, weighted by how much each adds to it; `None` where the row leaves what is echoes.
fn slope(beams: &PhasedBeams, row: &Row, count: usize) -> Option<Slope> {
    let is_heard = |i: f64| {
        let [x, y] = row.place_metres(i);
        y > 0.0 && x.hypot(y) < MAX_RANGES * beams.max_range_metres()
    };
    if !is_heard(0.0) || !is_heard((count - 1) as f64) {
        return None;
    }
    let mut echoes = vec![ReflectorEcho::default(); count];
    Some(Simd::chosen().run(SlopeOf { beams, row, echoes: &mut echoes }))
}

/// The equations of a row of as many reflectors as `echoes` has room for.
struct SlopeOf<'a> {
    beams: &'a PhasedBeams,
    row: &'a Row,
    echoes: &'a mut [ReflectorEcho],
}

impl Kernel for SlopeOf<'_> {
    type Output = Slope;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Slope {
        let SlopeOf { beams, row, echoes } = self;
        let mut out = Slope { added: 0.0, all: 0.0, gradient: [0.0; 4], hessian: [[0.0; 4]; 4] };
        for (end, view) in beams.views.iter().enumerate() {
            beams.reflector_echoes::<FMA>(end, row, echoes);
            let RowSums { sum, weight, power } = row_sums(echoes);
            (out.added, out.all) = (out.added + sum.norm_sqr() / weight, out.all + power);
            let (mut total, mut mean) = (0.0, [0.0; 4]);
            let mut products = [[0.0; 4]; 4];
            let towards = sum.conj() * weight.recip();
            for (i, h) in echoes.iter().enumerate() {
                let i = i as f64;
                let share = h.weighted * towards;
                // Phases as they were taken off: by minus the turns of the distance.
                let turn = -TAU * beams.turns_per_metre;
                let [by_x, by_y] = view.slope(row.place_metres(i), 1e-3).map(|slope| turn * slope);
                let by = [by_x, by_y, i * by_x, i * by_y];
                let certain = share.re.max(0.0);
                total += certain;
                for p in 0..4 {
                    out.gradient[p] -= 2.0 * share.im * by[p];
                    mean[p] += certain * by[p];
                    for q in 0..4 {
                        products[p][q] += certain * by[p] * by[q];
                    }
                }
            }
            for p in 0..4 {
                for q in 0..4 {
                    let common = mean[p] * mean[q] / f64::max(total, f64::MIN_POSITIVE);
                    out.hessian[p][q] += 2.0 * (products[p][q] - common);
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use num_complex::Complex64;

    #[test]
    fn rows_that_ran_away_are_not_followed() {
        let radar = Radar::default();
        let beams = PhasedBeams::new(&radar, &vec![Complex64::ONE; 2 * radar.end_elements * radar.samples]);
        let follow = |step_metres| climbed(&beams, Row { first_metres: [1.0, 5.0], step_metres }, MIN_REFLECTORS);
        assert!(follow([0.0, 0.1]).is_some());
        for step_metres in [[0.0, 1e300], [1e30, 0.0], [f64::NAN, 0.1], [f64::INFINITY, 0.0], [0.0, -1.0]] {
            assert!(follow(step_metres).is_none(), "{step_metres:?}");
        }
    }
}
