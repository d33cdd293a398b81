//! Atoms: single reflectors and rows of them, without their gains.

use crate::scene::Reflector;

/// One object without its gain. At a line array y and -y have the same echoes, so that a point's y is 0 or more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Atom {
    Point {
        /// Position along the array.
        x_metres: f64,
        /// Position ahead of the array.
        y_metres: f64,
    },
    /// A row: reflectors of equal strength at equal steps along a straight line of any direction.
    Row {
        /// Position of the first reflector along the array.
        x_metres: f64,
        /// Position of the first reflector ahead of the array.
        y_metres: f64,
        /// Step from one reflector to the next, along the array.
        dx_metres: f64,
        /// Step from one reflector to the next, ahead of the array.
        dy_metres: f64,
        /// Number of reflectors.
        count: usize,
    },
}

impl Atom {
    /// Number of continuous parameters: (x, y^2) of a point, (x, y, dx, dy) of a row.
    /// Near the array's axis a point's distance hardly depends on y, but linearly on its square.
    pub fn parameter_count(&self) -> usize {
        match self {
            Atom::Point { .. } => 2,
            Atom::Row { .. } => 4,
        }
    }

    /// The atom with `step` added to its parameters, in the order of [`Atom::parameter_count`], metres or square metres.
    pub fn moved(&self, step: &[f64]) -> Atom {
        match *self {
            Atom::Point { x_metres, y_metres } => {
                Atom::Point { x_metres: x_metres + step[0], y_metres: (y_metres * y_metres + step[1]).max(0.0).sqrt() }
            }
            Atom::Row { x_metres, y_metres, dx_metres, dy_metres, count } => Atom::Row {
                x_metres: x_metres + step[0],
                y_metres: y_metres + step[1],
                dx_metres: dx_metres + step[2],
                dy_metres: dy_metres + step[3],
                count,
            },
        }
    }

    pub fn reflector_count(&self) -> usize {
        match self {
            Atom::Point { .. } => 1,
            Atom::Row { count, .. } => *count,
        }
    }

    /// Position (x, y) of reflector `i`, metres. Beyond the row's ends it goes on at the same steps.
    pub fn position_metres(&self, i: f64) -> [f64; 2] {
        match *self {
            Atom::Point { x_metres, y_metres } => [x_metres, y_metres],
            Atom::Row { x_metres, y_metres, dx_metres, dy_metres, .. } => {
                [x_metres + i * dx_metres, y_metres + i * dy_metres]
            }
        }
    }

    /// Distance of the first reflector from the array's centre.
    pub fn range_metres(&self) -> f64 {
        let [x, y] = self.position_metres(0.0);
        x.hypot(y)
    }

    /// Derivatives of reflector `i`'s x and of half the square of its y by a parameter, numbered as in [`Atom::parameter_count`].
    pub fn derivatives(&self, i: usize, parameter: usize) -> [f64; 2] {
        let i = i as f64;
        let [_, y] = self.position_metres(i);
        match (self, parameter) {
            (_, 0) => [1.0, 0.0],
            (Atom::Point { .. }, _) => [0.0, 0.5],
            (_, 1) => [0.0, y],
            (_, 2) => [i, 0.0],
            _ => [0.0, i * y],
        }
    }

    pub fn reflectors(&self, reflectivity: f64) -> impl Iterator<Item = Reflector> + use<> {
        let atom = *self;
        (0..self.reflector_count()).map(move |i| {
            let [x_metres, y_metres] = atom.position_metres(i as f64);
            Reflector { x_metres, y_metres, reflectivity }
        })
    }
}

impl From<&Reflector> for Atom {
    fn from(r: &Reflector) -> Self {
        Atom::Point { x_metres: r.x_metres, y_metres: r.y_metres }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_steps_in_the_square_of_its_y() {
        let at = |x_metres, y_metres| Atom::Point { x_metres, y_metres };
        assert_eq!(at(3.0, 4.0).moved(&[1.0, 9.0]), at(4.0, 5.0));
        assert_eq!(at(3.0, 4.0).moved(&[0.0, -20.0]), at(3.0, 0.0), "no step leads behind the array");
    }

    #[test]
    fn a_segment_walks_in_equal_steps() {
        let wall = Atom::Row { x_metres: 1.0, y_metres: 5.0, dx_metres: 0.5, dy_metres: -0.25, count: 3 };
        let places: Vec<[f64; 2]> = wall.reflectors(2.0).map(|r| [r.x_metres, r.y_metres]).collect();
        assert_eq!(places, [[1.0, 5.0], [1.5, 4.75], [2.0, 4.5]]);
        assert_eq!(wall.position_metres(-1.0), [0.5, 5.25]);
    }
}
