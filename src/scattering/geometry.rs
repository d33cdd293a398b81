//! Arithmetic of places in the plane.

use std::ops::{Add, Mul, Sub};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct V(pub f64, pub f64);

impl From<[f64; 2]> for V {
    fn from([x, y]: [f64; 2]) -> Self {
        V(x, y)
    }
}

impl From<V> for [f64; 2] {
    fn from(v: V) -> Self {
        [v.0, v.1]
    }
}

impl Add for V {
    type Output = V;
    fn add(self, o: V) -> V {
        V(self.0 + o.0, self.1 + o.1)
    }
}

impl Sub for V {
    type Output = V;
    fn sub(self, o: V) -> V {
        V(self.0 - o.0, self.1 - o.1)
    }
}

impl Mul<f64> for V {
    type Output = V;
    fn mul(self, by: f64) -> V {
        V(self.0 * by, self.1 * by)
    }
}

impl V {
    pub fn dot(self, o: V) -> f64 {
        self.0 * o.0 + self.1 * o.1
    }

    /// Cross product of `self` and `o`: positive where `o` lies counter-clockwise.
    pub fn cross(self, o: V) -> f64 {
        self.0 * o.1 - self.1 * o.0
    }

    pub fn norm(self) -> f64 {
        root(self.dot(self))
    }

    /// A quarter turn clockwise.
    pub fn right(self) -> V {
        V(self.1, -self.0)
    }
}

/// Hypotenuse without protection from overflow and underflow, which no scene needs.
pub(super) fn hypotenuse(a: f64, b: f64) -> f64 {
    root(a * a + b * b)
}

pub(super) fn root(v: f64) -> f64 {
    v.sqrt()
}

/// Whether the stretches from `x` to `p` and from `a` to `b` cross, and not just touch.
pub(super) fn crosses(x: V, p: V, a: V, b: V) -> bool {
    let side = |o: V, u: V, v: V| (u - o).cross(v - o);
    side(x, p, a) * side(x, p, b) < 0.0 && side(a, b, x) * side(a, b, p) < 0.0
}
