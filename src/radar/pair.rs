//! Pairs of antennas: who sends, and who hears the echo.

use super::{BuiltArray, Radar};

/// A transmitter and a receiver on the array's axis. One element that does both is a pair whose antennas stand at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// x of the transmitter, metres.
    pub transmitter_x_metres: f64,
    /// x of the receiver, metres.
    pub receiver_x_metres: f64,
}

impl Pair {
    /// Both antennas at `x_metres`.
    pub fn at(x_metres: f64) -> Self {
        Pair { transmitter_x_metres: x_metres, receiver_x_metres: x_metres }
    }

    /// Range of the point at (`x_metres`, `y_metres`): half the path from the transmitter over the point to the receiver.
    pub fn range_metres(&self, x_metres: f64, y_metres: f64) -> f64 {
        let leg = |antenna: f64| (x_metres - antenna).hypot(y_metres);
        (leg(self.transmitter_x_metres) + leg(self.receiver_x_metres)) / 2.0
    }
}

impl Radar {
    /// The pair that channel `n` of the array is: element `n` hears what it sent.
    pub fn pair(&self, n: usize) -> Pair {
        Pair::at(self.element_x_metres(n))
    }
}

impl BuiltArray {
    /// [`Radar::pair`], where the element really stands.
    pub fn pair(&self, radar: &Radar, n: usize) -> Pair {
        Pair::at(self.element_x_metres(radar, n))
    }
}
