//! The test for points on a row.

use crate::reconstruct::fit::Atom;

/// Largest number of reflectors of a row.
pub const MAX_ROW_REFLECTORS: usize = 250;

/// Distance from a row's axis below which a point counts as its part, metres.
const MAX_AXIS_DISTANCE_METRES: f64 = 0.06;

/// Whether `atom` is a point on the axis of `row`, between its ends or at most a step beyond.
pub fn is_on_row(row: &Atom, atom: &Atom) -> bool {
    let (Atom::Row { dx_metres: dx, dy_metres: dy, count, .. }, Atom::Point { .. }) = (*row, *atom) else {
        return false;
    };
    let ([x, y], [point_x, point_y]) = (row.position_metres(0.0), atom.position_metres(0.0));
    let (to_x, to_y, step) = (point_x - x, point_y - y, dx.hypot(dy));
    let along_steps = (to_x * dx + to_y * dy) / (step * step);
    let beside_metres = (to_x * dy - to_y * dx).abs() / step;
    beside_metres < MAX_AXIS_DISTANCE_METRES && (-1.0..=count as f64).contains(&along_steps)
}
