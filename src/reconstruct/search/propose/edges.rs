//! BinSpans of reflectors from their first alone: at the edge of a wall one reflector is heard by itself, however close the next.
//!
//! From such a point the beams tell whether echoes go on in a direction that rows mostly have. There every step that may be meant is tried
//! over the first few reflectors, and the best are followed as rows over two points are.

use super::phased::{PhasedBeams, PlacePower, Row};
use super::strides::{MIN_REFLECTORS, MOST_STEP_METRES, Start, best_of_each, pitches_metres, summits};
use crate::reconstruct::fit::Atom;
use crate::task::Task;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Range bins over which echoes must go on, and beyond which it no longer matters.
const BINS: [u32; 2] = [20, 100];

/// Part of the peak_powers beam that echoes in the right direction have in the mean, in power and at both ends.
const LEAST_ALONG: f64 = 0.3;

/// Power of echoes that go on, evened out over range, as a part of the point's own.
const LEAST_EVEN: f64 = 0.02;

/// Most directions of all points that are looked into.
const MOST_LOOKS: usize = 4;

/// Radians by which a wall may deviate from its direction.
const WITHIN_RADIANS: f64 = 0.01;

/// Shortest step, metres: rows of closer reflectors are all alike.
const LEAST_STEP_METRES: f64 = 0.03;

/// From one row of a look to the next, wavelengths over the first few reflectors: one direction is looked into, so that steps may be finer
/// than over pairs.
const PITCH_WAVELENGTHS: f64 = 0.5;

/// BinSpans of one look that are tried over twice as many reflectors, and those that are followed.
const KEPT_ROWS: [usize; 2] = [40, 4];

/// Fewest reflectors of a row from an edge: the step is tried so finely that a few add up by chance.
const LEAST_FROM_EDGE: usize = 24;

/// Directions that rows mostly have, radians from the array's axis: along it and across it.
const DIRECTIONS_RADIANS: [f64; 4] = [0.0, FRAC_PI_2, PI, -FRAC_PI_2];

/// BinSpans that begin at one of `points` (x, y; metres) and lead about along or across the array's axis, best first; one for each point at most.
pub fn rows_from_edges(beams: &PhasedBeams, points: &[[f64; 2]], task: &Task) -> Vec<Atom> {
    let peak_powers = beams.peak_powers();
    let look = |first: usize, radians: f64| {
        let place_power = |place| beams.place_power(&peak_powers, place);
        let score = going_on(place_power, beams.bin_metres(), points[first], radians)?;
        Some(Look { first, radians, score })
    };
    let mut looks: Vec<Look> = (0..points.len())
        .into_par_iter()
        .flat_map_iter(|first| DIRECTIONS_RADIANS.into_iter().filter_map(move |radians| look(first, radians)))
        .collect();
    looks.sort_by(|a, b| b.score.total_cmp(&a.score));
    looks.truncate(MOST_LOOKS);
    let rows_of = |look: &Look| {
        let (rows, lengths) = fan(beams, points[look.first], look.radians);
        let parts = beams.coherent_parts(&rows, MIN_REFLECTORS);
        let kept: Vec<Row> = summits(&parts, lengths, KEPT_ROWS[0]).into_iter().map(|at| rows[at]).collect();
        let parts = beams.coherent_parts(&kept, 2 * MIN_REFLECTORS);
        let mut longer: Vec<(f64, Row)> = parts.into_iter().zip(kept).collect();
        longer.sort_by(|a, b| b.0.total_cmp(&a.0));
        longer.truncate(KEPT_ROWS[1]);
        longer
    };
    let starts: Vec<Start> = looks
        .par_iter()
        .filter(|_| !task.is_cancelled())
        .flat_map_iter(|look| rows_of(look).into_iter().map(|(_, row)| Start { first: look.first, row }))
        .collect();
    tracing::debug!(looks = looks.len(), starts = starts.len(), "edges");
    let rows = best_of_each(beams, starts, task).into_iter();
    rows.filter(|row| row.reflector_count() >= LEAST_FROM_EDGE).collect()
}

/// Clarity and length of the echoes from `from` on in a direction; `None` where they soon end.
fn going_on(
    place_power: impl Fn([f64; 2]) -> PlacePower,
    bin_metres: f64,
    from: [f64; 2],
    radians: f64,
) -> Option<f64> {
    let (sin, cos) = radians.sin_cos();
    let least_power = LEAST_EVEN * place_power(from).range_compensated_power;
    let (mut bins, mut sum) = (0, 0.0);
    while bins < BINS[1] {
        let distance = f64::from(bins + 1) * bin_metres;
        let place = [from[0] + distance * cos, from[1] + distance * sin];
        let there = place_power(place);
        if place[1] <= 0.0 || there.range_compensated_power < least_power {
            break;
        }
        (bins, sum) = (bins + 1, sum + there.part);
    }
    let part = sum / f64::from(bins.max(1));
    (bins >= BINS[0] && part > LEAST_ALONG).then(|| part * f64::from(bins).sqrt())
}

/// A direction in which echoes go on from a point.
struct Look {
    /// Number of the point.
    first: usize,
    radians: f64,
    score: f64,
}

/// BinSpans from one point in about one direction, turned from one side to the other, length after length; and the number of lengths.
fn fan(beams: &PhasedBeams, from_metres: [f64; 2], radians: f64) -> (Vec<Row>, usize) {
    let [along, across] = pitches_metres(beams, from_metres, MOST_STEP_METRES, PITCH_WAVELENGTHS);
    let range = from_metres[0].hypot(from_metres[1]).max(0.1);
    let (sin, cos) = radians.sin_cos();
    let by_sight = ((cos * from_metres[0] + sin * from_metres[1]) / range).abs();
    let by_side = (1.0 - by_sight * by_sight).max(0.0).sqrt();
    let length_pitch_metres = (by_sight / along + by_side / across).recip();
    // A turn moves the ends of middling steps by the pitch across them.
    let turn_pitch_radians = (by_sight / across + by_side / along).recip() / (0.5 * MOST_STEP_METRES);
    let turns = (WITHIN_RADIANS / turn_pitch_radians).ceil() as i32;
    let lengths = ((MOST_STEP_METRES - LEAST_STEP_METRES) / length_pitch_metres) as usize + 1;
    let row = |(length, turn): (usize, i32)| {
        let metres = LEAST_STEP_METRES + length as f64 * length_pitch_metres;
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
