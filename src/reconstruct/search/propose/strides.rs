//! Rows from their first two reflectors: a row of reflectors too close to be resolved still has points at its ends.
//!
//! From one point over another one nearby, a grid of steps is tried over the first few reflectors. The best rows are lengthened. At each length they
//! are moved to the largest coherent power of their echoes, and the worst are dropped: the longer the row, the more exact its place.

use super::phased::{PhasedBeams, ReflectorEcho, Row, RowSums, row_sums};
use crate::reconstruct::fit::{Atom, damped_step};
use crate::signal::simd::{Kernel, Simd};
use crate::task::Task;
use faer::Mat;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Least number of reflectors of a row, over which grids are tried.
pub const MIN_REFLECTORS: usize = 8;

/// Largest step from one reflector of a row to the next, metres.
pub const MAX_STEP_METRES: f64 = 0.4;

/// Least distance of two points, metres. Nearer ones are one point, found twice.
pub const MIN_STEP_METRES: f64 = 0.02;

/// Largest number of neighbours of a point that are tried as the second reflector.
const MAX_NEIGHBOURS: usize = 8;

/// Steps of a grid to each side, along the line of sight and across.
const GRID_SIDE_STEPS: [i32; 2] = [7, 9];

/// Difference of neighbouring rows of a grid at the last reflector, wavelengths. Halfway between two rows two thirds of the power are coherent.
const PITCH_WAVELENGTHS: f64 = 0.7;

/// Largest number of a grid's rows that are lengthened.
pub const MAX_GRID_PEAKS: usize = 4;

/// Largest number of grids whose rows are lengthened.
const MAX_GRIDS: usize = 48;

/// Largest number of reflectors of all rows together at a length.
const MAX_FOLLOWED_REFLECTORS: usize = 3000;

/// Largest number of reflectors of a lengthened row.
const MAX_ROW_LENGTH: usize = 140;

/// Ratio of successive lengths of a row.
const LENGTH_RATIO: f64 = 1.4;

/// Largest number of moves of a row at a length.
const MAX_MOVES: usize = 4;

/// Increase of the coherent power below which a move is the last, as a part of the power.
const MIN_ADDED_PART: f64 = 0.002;

/// Largest range of rows and points over the maximum range.
pub const MAX_RANGE_RATIO: f64 = 2.5;

/// Least coherent power of a row over its largest at shorter lengths. With less the row is past its end.
const MIN_POWER_RATIO: f64 = 0.4;

/// Rows from `points` (x, y; metres) over other ones, the best first; at most one from each point.
pub fn rows_over_pairs(beams: &PhasedBeams, points: &[[f64; 2]], task: &Task) -> Vec<Atom> {
    let neighbours_of = |i: usize| neighbours(points, i).map(move |j| (i, j));
    let pairs: Vec<(usize, usize)> = (0..points.len()).flat_map(neighbours_of).collect();
    // The best rows of a pair, with their coherent parts.
    let best_of_grid = |&(first, over): &(usize, usize)| {
        let rows = if task.is_cancelled() { Vec::new() } else { grid(beams, points[first], points[over]) };
        let parts = beams.coherent_parts(&rows, MIN_REFLECTORS);
        let best = grid_peaks(&parts, (2 * GRID_SIDE_STEPS[0] + 1) as usize, MAX_GRID_PEAKS).into_iter();
        best.map(|at| (parts[at], RowStart { first, row: rows[at] })).collect::<Vec<_>>()
    };
    let mut grids: Vec<Vec<(f64, RowStart)>> = pairs.par_iter().map(best_of_grid).collect();
    let best = |grid: &[(f64, RowStart)]| grid.first().map_or(0.0, |(part, _)| *part);
    grids.sort_by(|a, b| best(b).total_cmp(&best(a)));
    grids.truncate(MAX_GRIDS);
    longest_of_each(beams, grids.into_iter().flatten().map(|(_, start)| start).collect(), task)
}

/// The first few reflectors of a row.
#[derive(Debug, Clone, Copy)]
pub struct RowStart {
    /// Number of the point at which it begins.
    pub first: usize,
    pub row: Row,
}

/// The rows with as many reflectors as have coherent echoes, best first; one a point at most, and limited reflectors in all at each length.
pub fn longest_of_each(beams: &PhasedBeams, starts: Vec<RowStart>, task: &Task) -> Vec<Atom> {
    let mut rows: Vec<GrowingRow> = starts.into_iter().map(GrowingRow::new).collect();
    let mut count = MIN_REFLECTORS;
    while count <= MAX_ROW_LENGTH && !task.is_cancelled() {
        let max_rows = MAX_FOLLOWED_REFLECTORS / count;
        rows.sort_by(|a, b| b.part.total_cmp(&a.part));
        rows.par_iter_mut().take(max_rows).for_each(|row| row.lengthen(beams, count));
        rows.iter_mut().skip(max_rows).for_each(|row| row.part = 0.0);
        count = (count as f64 * LENGTH_RATIO) as usize + 1;
    }
    let mut found: Vec<(usize, (f64, Atom))> =
        rows.iter().filter_map(|row| Some((row.start.first, row.best?))).collect();
    found.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let mut taken = BTreeSet::new();
    found.retain(|(first, _)| taken.insert(*first));
    found.into_iter().map(|(_, (_, atom))| atom).collect()
}

/// The nearest points that may be the second reflector of a row from point `i`.
fn neighbours(points: &[[f64; 2]], i: usize) -> impl Iterator<Item = usize> {
    let distance = |j: usize| (points[j][0] - points[i][0]).hypot(points[j][1] - points[i][1]);
    let mut near: Vec<(f64, usize)> = (0..points.len())
        .map(|j| (distance(j), j))
        .filter(|(metres, _)| (MIN_STEP_METRES..=MAX_STEP_METRES).contains(metres))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().take(MAX_NEIGHBOURS).map(|(_, j)| j)
}

/// A grid of rows from one point over another one, `[along the line of sight, across]`.
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
    let [far, wide] = GRID_SIDE_STEPS;
    (-far..=far).flat_map(|i| (-wide..=wide).map(move |j| (i, j))).map(|(i, j)| row(i, j)).collect()
}

/// Differences of a grid's steps, metres, along and across the line of sight, that move reflector [`MIN_REFLECTORS`] by `wavelengths` in range.
pub fn pitches_metres(beams: &PhasedBeams, from: [f64; 2], step_metres: f64, wavelengths: f64) -> [f64; 2] {
    let range = from[0].hypot(from[1]).max(0.1);
    let between = (beams.views[1].centre_metres - beams.views[0].centre_metres).abs().max(1e-3);
    let wavelength = beams.turns_per_metre.abs().recip();
    let last = (MIN_REFLECTORS - 1) as f64;
    // A step across changes the difference of the ranges at the ends, or the curvature of the range along the row, by as much.
    let along = wavelengths * wavelength / last;
    let curved = wavelengths * wavelength * range / (step_metres * last * last);
    [along, (along * range / between).min(curved)]
}

/// Numbers of the local maxima of a grid `[rows, columns]`, at most `max_peaks`, the largest first.
pub fn grid_peaks(parts: &[f64], rows: usize, max_peaks: usize) -> Vec<usize> {
    let columns = parts.len() / rows.max(1);
    let is_peak = |at: usize| {
        let (i, j) = (at / columns, at % columns);
        let beside = (i.saturating_sub(1)..=(i + 1).min(rows - 1))
            .flat_map(|k| (j.saturating_sub(1)..=(j + 1).min(columns - 1)).map(move |l| k * columns + l));
        beside.into_iter().all(|other| parts[other] <= parts[at])
    };
    let mut peaks: Vec<usize> = (0..parts.len()).filter(|&at| parts[at] > 0.0 && is_peak(at)).collect();
    peaks.sort_by(|a, b| parts[*b].total_cmp(&parts[*a]));
    peaks.truncate(max_peaks);
    peaks
}

/// A row at successive lengths.
struct GrowingRow {
    start: RowStart,
    /// Coherent part of the power at its places; 0 once it is dropped.
    part: f64,
    /// Largest coherent power.
    max_power: f64,
    /// The row at the length with that power, after its coherent part times its number of reflectors.
    best: Option<(f64, Atom)>,
}

impl GrowingRow {
    fn new(start: RowStart) -> Self {
        GrowingRow { start, part: 1.0, max_power: 0.0, best: None }
    }

    /// Moves the row to the largest coherent power of its first `count` reflectors.
    fn lengthen(&mut self, beams: &PhasedBeams, count: usize) {
        if self.part == 0.0 {
            return;
        }
        self.part = 0.0;
        let Some((row, equations)) = maximised(beams, self.start.row, count) else { return };
        self.start.row = row;
        if equations.coherent_power < MIN_POWER_RATIO * self.max_power {
            return;
        }
        self.part = equations.coherent_power / f64::max(equations.power, f64::MIN_POSITIVE);
        if equations.coherent_power > self.max_power {
            self.max_power = equations.coherent_power;
            let ([x_metres, y_metres], [dx_metres, dy_metres]) = (row.first_metres, row.step_metres);
            let atom = Atom::Row { x_metres, y_metres, dx_metres, dy_metres, count };
            self.best = Some((self.part * count as f64, atom));
        }
    }
}

/// Gauss-Newton equations of a row's first place and step, (x, y, dx, dy), for the phases of its echoes.
struct PhaseEquations {
    /// Power that reflectors of one gain explain, the sum of both ends.
    coherent_power: f64,
    /// Power of the beams at the places.
    power: f64,
    gradient: [f64; 4],
    hessian: [[f64; 4]; 4],
}

/// `row` moved to the largest coherent power of its first `count` reflectors; `None` as from [`equations`].
fn maximised(beams: &PhasedBeams, mut row: Row, count: usize) -> Option<(Row, PhaseEquations)> {
    let mut equations = equations(beams, &row, count)?;
    let mut damping = 1e-2;
    for _ in 0..MAX_MOVES {
        let Some(step) = damped_step(&Mat::from_fn(4, 4, |p, q| equations.hessian[p][q]), &equations.gradient, damping)
        else {
            damping *= 10.0;
            continue;
        };
        let moved = Row {
            first_metres: [row.first_metres[0] + step[0], row.first_metres[1] + step[1]],
            step_metres: [row.step_metres[0] + step[2], row.step_metres[1] + step[3]],
        };
        match self::equations(beams, &moved, count).filter(|s| s.coherent_power > equations.coherent_power) {
            Some(better) => {
                let increase = better.coherent_power - equations.coherent_power;
                (equations, row, damping) = (better, moved, damping * 0.3);
                if increase < MIN_ADDED_PART * equations.power {
                    break;
                }
            }
            None => damping *= 10.0,
        }
    }
    Some((row, equations))
}

/// Equations of the echoes' phases against their sum's, weighted by their parts; `None` for a row behind the array or beyond [`MAX_RANGE_RATIO`].
fn equations(beams: &PhasedBeams, row: &Row, count: usize) -> Option<PhaseEquations> {
    let is_valid = |i: f64| {
        let [x, y] = row.place_metres(i);
        y > 0.0 && x.hypot(y) < MAX_RANGE_RATIO * beams.max_range_metres()
    };
    if !is_valid(0.0) || !is_valid((count - 1) as f64) {
        return None;
    }
    let mut echoes = vec![ReflectorEcho::default(); count];
    Some(Simd::chosen().run(PhaseKernel { beams, row, echoes: &mut echoes }))
}

/// Kernel of [`equations`], for a reflector in each entry of the buffer `echoes`.
struct PhaseKernel<'a> {
    beams: &'a PhasedBeams,
    row: &'a Row,
    echoes: &'a mut [ReflectorEcho],
}

impl Kernel for PhaseKernel<'_> {
    type Output = PhaseEquations;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> PhaseEquations {
        let PhaseKernel { beams, row, echoes } = self;
        let mut out = PhaseEquations { coherent_power: 0.0, power: 0.0, gradient: [0.0; 4], hessian: [[0.0; 4]; 4] };
        for (end, view) in beams.views.iter().enumerate() {
            beams.reflector_echoes::<FMA>(end, row, echoes);
            let RowSums { sum, weight, power } = row_sums(echoes);
            out.coherent_power += sum.norm_sqr() / weight;
            out.power += power;
            let (mut total, mut mean) = (0.0, [0.0; 4]);
            let mut products = [[0.0; 4]; 4];
            let direction = sum.conj() * weight.recip();
            for (i, h) in echoes.iter().enumerate() {
                let i = i as f64;
                let share = h.weighted * direction;
                // The echoes' phases have been multiplied by those of minus the range.
                let radians_per_metre = -TAU * beams.turns_per_metre;
                let [by_x, by_y] = view.slope(row.place_metres(i), 1e-3).map(|slope| radians_per_metre * slope);
                let by = [by_x, by_y, i * by_x, i * by_y];
                let weight = share.re.max(0.0);
                total += weight;
                for p in 0..4 {
                    out.gradient[p] -= 2.0 * share.im * by[p];
                    mean[p] += weight * by[p];
                    for q in 0..4 {
                        products[p][q] += weight * by[p] * by[q];
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
        let follow = |step_metres| maximised(&beams, Row { first_metres: [1.0, 5.0], step_metres }, MIN_REFLECTORS);
        assert!(follow([0.0, 0.1]).is_some());
        for step_metres in [[0.0, 1e300], [1e30, 0.0], [f64::NAN, 0.1], [f64::INFINITY, 0.0], [0.0, -1.0]] {
            assert!(follow(step_metres).is_none(), "{step_metres:?}");
        }
    }
}
