//! Rows of reflectors between their first and their last: of a wall whose reflectors stand too close to be told apart, those at its ends
//! are heard all the same, and only how many stand between them is unknown.

use super::edges::LEAST_STEP_METRES;
use super::phased::{Heard, PhasedBeams, Row, Strongest};
use super::source::{Propose, Unexplained};
use super::strides::{MOST_REFLECTORS, Stride, climbed};
use crate::reconstruct::fit::Atom;
use crate::signal::simd::{Kernel, Simd};
use crate::task::Task;
use rayon::prelude::*;

/// Longest step, metres: reflectors farther apart are told apart.
const MOST_STEP_METRES: f64 = 0.16;

/// Fewest range bins from one end to the other.
const LEAST_BINS: f64 = 8.0;

/// Part of the strongest beam that echoes between both have in the mean, in power and at both ends of the array.
const LEAST_ALONG: f64 = 0.5;

/// Places between both at which this is looked up.
const PLACES: usize = 24;

/// Range bins beyond an end where hardly anything may be heard, and the least part of the step to there along the line of sight.
const BEYOND_BINS: [f64; 6] = [2.5, 3.0, 3.5, 4.0, 4.5, 5.0];
const LEAST_BY_SIGHT: f64 = 0.15;

/// How much may be heard there, as a part of what is heard at the end.
const MOST_BEYOND: f64 = 0.1;

/// Most reflectors of the first glance, evenly spread over the row.
const GLANCE: usize = 32;

/// Part of the power at a row's places that adds up at the first glance.
const LEAST_ADDING_UP: f64 = 0.12;

/// Fewest reflectors whose echoes must add up: fewer do by chance, so many counts are tried.
const LEAST_WEIGHT: f64 = 10.0;

/// Rows of as many reflectors whose ends are this near to each other, metres, are one.
const ALIKE_METRES: f64 = 0.1;

/// Points, those first on which the ends agree best, that a wall may begin and end at.
const MOST_ENDS: usize = 80;

/// Lines between two points.
pub struct Between;

impl Propose for Between {
    fn propose(&self, left: &Unexplained) -> Vec<Atom> {
        let rows = rows_between(left.beams(), &left.points_within_range(MOST_ENDS), left.task);
        rows.into_iter().map(|row| row.atom).collect()
    }
}

/// Rows between some two of `points` (x, y; metres), best first.
fn rows_between(beams: &PhasedBeams, points: &[[f64; 2]], task: &Task) -> Vec<Stride> {
    let strongest = beams.strongest();
    let is_filled = |[from, to]: &[[f64; 2]; 2]| {
        let by = [to[0] - from[0], to[1] - from[1]];
        let part = |place: usize| {
            let share = place as f64 / (PLACES + 1) as f64;
            beams.presence(&strongest, [from[0] + share * by[0], from[1] + share * by[1]]).part
        };
        by[0].hypot(by[1]) > LEAST_BINS * beams.bin_metres()
            && is_end(beams, &strongest, *from, by.map(|v| -v))
            && is_end(beams, &strongest, *to, by)
            && (1..=PLACES).map(part).sum::<f64>() > LEAST_ALONG * PLACES as f64
    };
    let pairs: Vec<[[f64; 2]; 2]> = (0..points.len())
        .into_par_iter()
        .flat_map_iter(|i| (0..i).map(move |j| [points[i], points[j]]))
        .filter(is_filled)
        .collect();
    let mut rows: Vec<Stride> = pairs
        .par_iter()
        .filter(|_| !task.is_cancelled())
        .flat_map_iter(|&[from, to]| Simd::chosen().run(Counts { beams, from, to }))
        .filter_map(|(row, count)| Some(climbed(beams, row, count)?.stride(count)))
        .filter(|row| row.weight > LEAST_WEIGHT)
        .collect();
    rows.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut kept: Vec<Stride> = Vec::new();
    for row in rows {
        if !kept.iter().any(|other| are_alike(&row.atom, &other.atom)) {
            kept.push(row);
        }
    }
    tracing::debug!(pairs = pairs.len(), rows = kept.len(), "between");
    kept
}

/// Whether hardly anything is heard beyond `place` in the direction of `away`.
fn is_end(beams: &PhasedBeams, strongest: &Strongest, place: [f64; 2], away: [f64; 2]) -> bool {
    let [length, range] = [away, place].map(|v| v[0].hypot(v[1]).max(1e-3));
    let by_sight = (away[0] * place[0] + away[1] * place[1]).abs() / (length * range);
    let metres = beams.bin_metres() / by_sight.max(LEAST_BY_SIGHT);
    let power = |place: [f64; 2]| {
        let there = beams.presence(strongest, place);
        there.part * there.even_power
    };
    let most = MOST_BEYOND * power(place);
    let beyond = |bins: f64| [0, 1].map(|axis| place[axis] + bins * metres * away[axis] / length);
    BEYOND_BINS.iter().map(|&bins| beyond(bins)).all(|place| place[1] < 0.0 || power(place) < most)
}

/// Whether two rows are of as many reflectors and about the same ends.
fn are_alike(a: &Atom, b: &Atom) -> bool {
    let last = a.reflector_count() as f64 - 1.0;
    let apart = |i: f64, k: f64| {
        let ([ax, ay], [bx, by]) = (a.position_metres(i), b.position_metres(k));
        (ax - bx).hypot(ay - by)
    };
    let same = apart(0.0, 0.0).max(apart(last, last));
    let turned = apart(0.0, last).max(apart(last, 0.0));
    a.reflector_count() == b.reflector_count() && same.min(turned) < ALIKE_METRES
}

/// Rows of all counts of reflectors from one point to another.
struct Counts<'a> {
    beams: &'a PhasedBeams,
    from: [f64; 2],
    to: [f64; 2],
}

impl Kernel for Counts<'_> {
    type Output = Vec<(Row, usize)>;

    /// Those whose echoes may add up.
    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let Counts { beams, from, to } = self;
        let by = [to[0] - from[0], to[1] - from[1]];
        let metres = by[0].hypot(by[1]);
        let least = (LEAST_WEIGHT as usize).max((metres / MOST_STEP_METRES) as usize + 2);
        let most = MOST_REFLECTORS.min((metres / LEAST_STEP_METRES) as usize + 1);
        let mut heard = [Heard::default(); GLANCE];
        let mut adds_up = |count: &usize| {
            let every = count.div_ceil(GLANCE);
            let step_metres = by.map(|v| v / (count - 1) as f64 * every as f64);
            let row = Row { first_metres: from, step_metres };
            beams.part_adding_up::<FMA>(&row, &mut heard[..count.div_ceil(every)]) > LEAST_ADDING_UP
        };
        let row = |count: usize| Row { first_metres: from, step_metres: by.map(|v| v / (count - 1) as f64) };
        (least..=most).filter(|count| adds_up(count)).map(|count| (row(count), count)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::scene::{Line, Object, Point, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_dense_wall_is_found_between_its_ends() {
        let radar = Radar::default();
        let wall = Line::vertical(18.5, 20.27, 1.36 * radar.range_resolution_metres(), 91);
        let point = Point::new(4.0, 8.0);
        let objects = vec![Object::Line(wall.clone()), Object::Point(point.clone())];
        let scene = Scene { objects, ..Scene::default() };
        let flat = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
        let [first, last] = [[wall.x_metres, wall.y_start_metres], wall.end_metres()];
        // As well as both ends' tones tell them.
        let points = [[point.x_metres, point.y_metres], [first[0] + 0.002, first[1]], [last[0] - 0.002, last[1]]];
        let beams = PhasedBeams::new(&radar, &flat);
        let rows = rows_between(&beams, &points, &Task::default());
        let best = rows.first().expect("a row").atom;
        assert_eq!(best.reflector_count(), 91, "{best:?}");
        let ends = [0.0, 90.0].map(|i| best.position_metres(i));
        let off = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(off(ends[0], last) < 0.02 && off(ends[1], first) < 0.02, "{best:?}");
        // Not between a point and an end of the wall: the beams hold nothing there.
        assert!(rows_between(&beams, &points[..2], &Task::default()).is_empty());
        // And not from within the wall, where it goes on.
        let within = wall.place_metres(40.0);
        assert!(rows_between(&beams, &[within, last], &Task::default()).is_empty());
    }
}
