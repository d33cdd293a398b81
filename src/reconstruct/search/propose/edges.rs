//! Rows from their first reflector alone: at the edge of a row one reflector is resolved, however near the next one.
//!
//! The beams show whether echoes continue from such a point in a direction that rows mostly have. In such a direction a grid of steps is tried over the
//! first few reflectors, and the best rows are lengthened as those of `strides` are.

use super::phased::{PeakPowers, PhasedBeams, Row};
use super::strides::{
    MAX_GRID_PEAKS, MAX_STEP_METRES, MIN_REFLECTORS, RowStart, grid_peaks, longest_of_each, pitches_metres,
};
use crate::reconstruct::fit::Atom;
use crate::task::Task;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Least number of successive range bins with echoes in a direction, and the largest that is counted.
const MIN_RUN_BINS: u32 = 20;
const MAX_RUN_BINS: u32 = 100;

/// Least mean of [`PlacePower::part`] in a direction.
const MIN_BEAM_PART: f64 = 0.3;

/// Least range-compensated power of a continuing echo, over that of the point.
const MIN_COMPENSATED_POWER_PART: f64 = 0.02;

/// Largest number of directions of all points together.
const MAX_DIRECTIONS: usize = 4;

/// Largest difference of a row's direction from one of [`DIRECTIONS_RADIANS`], radians.
const MAX_TURN_RADIANS: f64 = 0.01;

/// Least step, metres. Rows of smaller steps have nearly the same echoes.
const MIN_EDGE_STEP_METRES: f64 = 0.03;

/// Difference of the grid's neighbouring rows at the last of the first reflectors, wavelengths: finer than for pairs, as it has one direction.
const EDGE_PITCH_WAVELENGTHS: f64 = 0.5;

/// Largest number of a direction's rows that are tried over twice as many reflectors.
const MAX_RETRIED_ROWS: usize = 40;

/// Least number of reflectors of a row from an edge. The grid is so fine that the echoes of a few are coherent by chance.
const MIN_EDGE_REFLECTORS: usize = 24;

/// Directions that rows mostly have, radians from the array's axis: along it and across it.
const DIRECTIONS_RADIANS: [f64; 4] = [0.0, FRAC_PI_2, PI, -FRAC_PI_2];

/// Rows from `points` (x, y; metres) nearly along or across the array's axis, the best first; at most one from each point.
pub fn rows_from_edges(beams: &PhasedBeams, points: &[[f64; 2]], task: &Task) -> Vec<Atom> {
    let peak_powers = beams.peak_powers();
    let candidate = |first: usize, radians: f64| {
        run_score(beams, &peak_powers, points[first], radians).map(|score| Direction { first, radians, score })
    };
    let mut directions: Vec<Direction> = (0..points.len())
        .into_par_iter()
        .flat_map_iter(|first| DIRECTIONS_RADIANS.into_iter().filter_map(move |radians| candidate(first, radians)))
        .collect();
    directions.sort_by(|a, b| b.score.total_cmp(&a.score));
    directions.truncate(MAX_DIRECTIONS);
    let starts_of = |direction: &Direction| {
        let (rows, lengths) = rows_in_direction(beams, points[direction.first], direction.radians);
        let parts = beams.coherent_parts(&rows, MIN_REFLECTORS);
        let peaks: Vec<Row> = grid_peaks(&parts, lengths, MAX_RETRIED_ROWS).into_iter().map(|at| rows[at]).collect();
        let parts = beams.coherent_parts(&peaks, 2 * MIN_REFLECTORS);
        let mut best: Vec<(f64, Row)> = parts.into_iter().zip(peaks).collect();
        best.sort_by(|a, b| b.0.total_cmp(&a.0));
        let starts = best.into_iter().take(MAX_GRID_PEAKS);
        starts.map(|(_, row)| RowStart { first: direction.first, row }).collect::<Vec<_>>()
    };
    let starts: Vec<RowStart> =
        directions.par_iter().filter(|_| !task.is_cancelled()).flat_map_iter(starts_of).collect();
    tracing::debug!(directions = directions.len(), starts = starts.len(), "edges");
    let rows = longest_of_each(beams, starts, task).into_iter();
    rows.filter(|row| row.reflector_count() >= MIN_EDGE_REFLECTORS).collect()
}

/// Mean part of the beams' power in a run of echoes from `from` on, times the square root of its range bins; `None` for a short or weak run.
fn run_score(beams: &PhasedBeams, peak_powers: &PeakPowers, from: [f64; 2], radians: f64) -> Option<f64> {
    let place_power = |place| beams.place_power(peak_powers, place);
    let (sin, cos) = radians.sin_cos();
    let least_power = MIN_COMPENSATED_POWER_PART * place_power(from).compensated_power;
    let (mut bins, mut sum) = (0, 0.0);
    while bins < MAX_RUN_BINS {
        let distance = f64::from(bins + 1) * beams.bin_metres();
        let place = [from[0] + distance * cos, from[1] + distance * sin];
        let there = place_power(place);
        if place[1] <= 0.0 || there.compensated_power < least_power {
            break;
        }
        (bins, sum) = (bins + 1, sum + there.part);
    }
    let part = sum / f64::from(bins.max(1));
    (bins >= MIN_RUN_BINS && part > MIN_BEAM_PART).then(|| part * f64::from(bins).sqrt())
}

/// A direction in which echoes continue from a point.
struct Direction {
    /// Number of the point.
    first: usize,
    /// Angle from the array's axis.
    radians: f64,
    /// [`run_score`].
    score: f64,
}

/// A grid of rows from one point in nearly one direction, `[step, turn]`, and its number of steps.
fn rows_in_direction(beams: &PhasedBeams, from_metres: [f64; 2], radians: f64) -> (Vec<Row>, usize) {
    let [along, across] = pitches_metres(beams, from_metres, MAX_STEP_METRES, EDGE_PITCH_WAVELENGTHS);
    let range = from_metres[0].hypot(from_metres[1]).max(0.1);
    let (sin, cos) = radians.sin_cos();
    let along_sight = ((cos * from_metres[0] + sin * from_metres[1]) / range).abs();
    let across_sight = (1.0 - along_sight * along_sight).max(0.0).sqrt();
    let length_pitch_metres = (along_sight / along + across_sight / across).recip();
    // A turn by the pitch moves the last reflector of a row of the mean step by the pitch across.
    let turn_pitch_radians = (along_sight / across + across_sight / along).recip() / (0.5 * MAX_STEP_METRES);
    let turns = (MAX_TURN_RADIANS / turn_pitch_radians).ceil() as i32;
    let lengths = ((MAX_STEP_METRES - MIN_EDGE_STEP_METRES) / length_pitch_metres) as usize + 1;
    let row = |(length, turn): (usize, i32)| {
        let metres = MIN_EDGE_STEP_METRES + length as f64 * length_pitch_metres;
        let (sin, cos) = (radians + f64::from(turn) * turn_pitch_radians).sin_cos();
        Row { first_metres: from_metres, step_metres: [metres * cos, metres * sin] }
    };
    let all = (0..lengths).flat_map(|length| (-turns..=turns).map(move |turn| (length, turn)));
    (all.map(row).collect(), lengths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::scene::{Line, Object, Point, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_wall_with_a_hidden_first_reflector_is_found_from_its_last() {
        let radar = Radar::default();
        let wall = Line::vertical(-7.3, 8.8, 0.1397, 90);
        let point = Point::new(4.0, 8.0);
        let objects = vec![Object::Line(wall.clone()), Object::Point(point.clone())];
        let scene = Scene { objects, ..Scene::default() };
        let flat = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
        let last = [wall.x_metres, wall.y_start_metres + 89.0 * wall.spacing_metres];
        let points = [[point.x_metres, point.y_metres], last];
        let beams = PhasedBeams::new(&radar, &flat);
        let rows = rows_from_edges(&beams, &points, &Task::default());
        let best = *rows.first().expect("a row");
        let [first, second] = [0.0, 1.0].map(|i| best.position_metres(i));
        assert!((first[0] - last[0]).hypot(first[1] - last[1]) < 0.1, "{best:?}");
        assert!((second[1] - first[1] + wall.spacing_metres).abs() < 1e-3 && best.reflector_count() > 40, "{best:?}");
        // Nothing goes on from a point that stands alone.
        assert!(rows_from_edges(&beams, &points[..1], &Task::default()).is_empty());
    }
}
