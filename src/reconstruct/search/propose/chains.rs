//! Points found one by one that stand in a row at equal steps: where a wall may be.

use super::source::{Propose, Unexplained};
use super::strides::LEAST_STEP_METRES;
use crate::reconstruct::fit::{Atom, Gains};

/// Longest step from one reflector of a wall to the next, metres.
const MOST_STEP_METRES: f64 = 0.5;

/// A point counts as the next of a row when it stands this near to where that is expected, as a part of the step.
const OFF: f64 = 0.12;

/// Reflectors of one wall are alike within this factor while their neighbours are not known.
const MOST_UNLIKE: f64 = 1.6;

/// Points that make a row.
const LEAST_POINTS: usize = 4;

/// A point and its echo made independent of its range.
#[derive(Debug, Clone, Copy)]
struct Standing {
    at: [f64; 2],
    size: f64,
}

/// Lines through points that were found one by one.
pub struct Chains;

impl Propose for Chains {
    fn propose(&self, left: &Unexplained) -> Vec<Atom> {
        rows_of_points(&left.found.atoms, &left.found.gains)
    }
}

/// Rows of points at equal steps, longest first, none of which shares a point with a longer one.
fn rows_of_points(atoms: &[Atom], gains: &[Gains]) -> Vec<Atom> {
    let standing = |(atom, gains): (&Atom, &Gains)| {
        matches!(atom, Atom::Point { .. })
            .then(|| Standing { at: atom.position_metres(0.0), size: (gains[0].norm() + gains[1].norm()) / 2.0 })
    };
    let points: Vec<Standing> = atoms.iter().zip(gains).filter_map(standing).collect();
    let mut rows: Vec<Vec<usize>> = Vec::new();
    for i in 0..points.len() {
        for j in (0..points.len()).filter(|j| *j != i) {
            let row = row_from(&points, i, j);
            if row.len() >= LEAST_POINTS {
                rows.push(row);
            }
        }
    }
    rows.sort_by_key(|row| std::cmp::Reverse(row.len()));
    let mut taken = vec![false; points.len()];
    let mut found = Vec::new();
    for row in rows {
        if row.iter().any(|i| taken[*i]) {
            continue;
        }
        row.iter().for_each(|i| taken[*i] = true);
        found.push(straight_through(&row.iter().map(|i| points[*i].at).collect::<Vec<_>>()));
    }
    found
}

/// The points that follow each other at equal steps from `i` over `j`.
fn row_from(points: &[Standing], i: usize, j: usize) -> Vec<usize> {
    let between = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let alike = |k: usize| {
        let (a, b) = (points[i].size, points[k].size);
        a.max(b) <= MOST_UNLIKE * a.min(b)
    };
    let step = between(points[i].at, points[j].at);
    if !(LEAST_STEP_METRES..=MOST_STEP_METRES).contains(&step) || !alike(j) {
        return Vec::new();
    }
    let mut row = vec![i, j];
    loop {
        let (last, before) = (points[row[row.len() - 1]].at, points[row[row.len() - 2]].at);
        let expected = [2.0 * last[0] - before[0], 2.0 * last[1] - before[1]];
        let next = (0..points.len())
            .filter(|k| !row.contains(k) && alike(*k))
            .min_by(|a, b| between(points[*a].at, expected).total_cmp(&between(points[*b].at, expected)));
        match next.filter(|k| between(points[*k].at, expected) < OFF * step) {
            Some(k) => row.push(k),
            None => return row,
        }
    }
}

/// The segment at equal steps that fits these places best.
fn straight_through(places: &[[f64; 2]]) -> Atom {
    let n = places.len() as f64;
    let middle = (n - 1.0) / 2.0;
    let spread: f64 = (0..places.len()).map(|i| (i as f64 - middle).powi(2)).sum();
    let [x, y] = [0, 1].map(|axis| {
        let mean = places.iter().map(|p| p[axis]).sum::<f64>() / n;
        let step = places.iter().enumerate().map(|(i, p)| (i as f64 - middle) * p[axis]).sum::<f64>() / spread;
        [mean - middle * step, step]
    });
    Atom::Segment { x_metres: x[0], y_metres: y[0], dx_metres: x[1], dy_metres: y[1], count: places.len() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn rows_are_told_from_stray_points() {
        let wall = Atom::Segment { x_metres: 1.0, y_metres: 5.0, dx_metres: 0.08, dy_metres: -0.05, count: 9 };
        let mut places: Vec<[f64; 2]> = wall.reflectors(1.0).map(|r| [r.x_metres, r.y_metres]).collect();
        places.extend([[3.0, 9.0], [1.4, 4.9], [0.9, 5.2], [-7.0, 20.0]]);
        places.swap(0, 10);
        let atoms: Vec<Atom> = places.iter().map(|[x, y]| Atom::Point { x_metres: *x, y_metres: *y }).collect();
        let gains = vec![[Complex64::from(1.0); 2]; atoms.len()];
        let found = rows_of_points(&atoms, &gains);
        let [Atom::Segment { x_metres, y_metres, dx_metres, dy_metres, count }] = found[..] else {
            panic!("{found:?}")
        };
        assert_eq!(count, 9);
        // Either end may be the first.
        let off = if dx_metres > 0.0 {
            [x_metres - 1.0, y_metres - 5.0, dx_metres - 0.08, dy_metres + 0.05]
        } else {
            [x_metres - 1.64, y_metres - 4.6, dx_metres + 0.08, dy_metres - 0.05]
        };
        assert!(off.iter().all(|o| o.abs() < 1e-9), "{found:?}");
    }
}
