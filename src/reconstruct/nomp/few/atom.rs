//! The dictionary: what a scene is taken apart into.

use crate::reconstruct::nomp::atom;
use crate::scene::{Line, Object, Point};

/// One object without its gain. Distances in metres; y and -y look alike to a line array, y is kept at 0 or above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Atom {
    /// One reflector.
    Point {
        /// Position along the array.
        x: f64,
        /// Position ahead of the array.
        y: f64,
    },
    /// Reflectors of equal strength at equal spacing along y.
    Line {
        /// Position along the array.
        x: f64,
        /// y of the first reflector.
        start: f64,
        /// Distance between neighbours.
        spacing: f64,
        /// Number of reflectors.
        count: usize,
    },
}

impl Atom {
    /// Number of continuous parameters: (x, y^2) or (x, start, spacing).
    ///
    /// A point's distance from the array follows the square of its y: near the array's axis y itself hardly changes anything, its
    /// square does.
    pub fn parameters(&self) -> usize {
        match self {
            Atom::Point { .. } => 2,
            Atom::Line { .. } => 3,
        }
    }

    /// The atom with its continuous parameters moved by `step`, in the order of [`Atom::parameters`].
    pub fn moved(&self, step: &[f64]) -> Atom {
        match *self {
            Atom::Point { x, y } => Atom::Point { x: x + step[0], y: (y * y + step[1]).max(0.0).sqrt() },
            Atom::Line { x, start, spacing, count } => {
                Atom::Line { x: x + step[0], start: start + step[1], spacing: spacing + step[2], count }
            }
        }
    }

    /// Number of reflectors.
    pub fn reflectors(&self) -> usize {
        match self {
            Atom::Point { .. } => 1,
            Atom::Line { count, .. } => *count,
        }
    }

    /// Position (x, y) of reflector `i`.
    pub fn position(&self, i: usize) -> [f64; 2] {
        match *self {
            Atom::Point { x, y } => [x, y],
            Atom::Line { x, start, spacing, .. } => [x, start + i as f64 * spacing],
        }
    }

    /// How reflector `i`'s x and half the square of its y follow the parameter.
    pub fn share(&self, i: usize, parameter: usize) -> [f64; 2] {
        let [_, y] = self.position(i);
        match (self, parameter) {
            (_, 0) => [1.0, 0.0],
            (Atom::Point { .. }, _) => [0.0, 0.5],
            (_, 1) => [0.0, y],
            _ => [0.0, i as f64 * y],
        }
    }

    /// The atom as the search outside this folder knows it.
    pub fn outside(&self) -> atom::Atom {
        match *self {
            Atom::Point { x, y } => atom::Atom::Point { x_metres: x, y_metres: y },
            Atom::Line { x, start, spacing, count } => {
                atom::Atom::Segment { x_metres: x, y_metres: start, dx_metres: 0.0, dy_metres: spacing, count }
            }
        }
    }

    /// The object of a scene that this atom stands for.
    pub fn object(&self, reflectivity: f64) -> Object {
        match *self {
            Atom::Point { x, y } => Object::Point(Point { x_metres: x, y_metres: y, reflectivity }),
            Atom::Line { x, start, spacing, count } => {
                Object::Line(Line { reflectivity, ..Line::vertical(x, start, spacing, count) })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_steps_in_the_square_of_its_y_and_stays_ahead_of_the_array() {
        let point = Atom::Point { x: 3.0, y: 4.0 };
        assert_eq!(point.moved(&[1.0, 9.0]), Atom::Point { x: 4.0, y: 5.0 });
        assert_eq!(point.moved(&[0.0, -20.0]), Atom::Point { x: 3.0, y: 0.0 });
    }
}
