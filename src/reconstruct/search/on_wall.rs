//! The test for points on a wall.

use crate::reconstruct::fit::Atom;

/// Most reflectors of a wall.
pub const MOST_REFLECTORS: usize = 250;

/// Points this near to a wall's axis belong to it or stand for what belongs to it, metres.
const BESIDE_METRES: f64 = 0.06;

/// Whether `atom` is a point on the axis of `wall`, between its ends or less than a step beyond.
pub fn is_on(wall: &Atom, atom: &Atom) -> bool {
    let (Atom::Segment { dx_metres: dx, dy_metres: dy, count, .. }, Atom::Point { .. }) = (*wall, *atom) else {
        return false;
    };
    let ([x, y], [point_x, point_y]) = (wall.position_metres(0.0), atom.position_metres(0.0));
    let (to_x, to_y, step) = (point_x - x, point_y - y, dx.hypot(dy));
    let along_steps = (to_x * dx + to_y * dy) / (step * step);
    let beside_metres = (to_x * dy - to_y * dx).abs() / step;
    beside_metres < BESIDE_METRES && (-1.0..=count as f64).contains(&along_steps)
}
