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
    /// The antennas of element `n`: one that hears what it sent, or a transmitter and a receiver. Beyond the last element it is as if the
    /// line went on.
    pub fn pair(&self, n: usize) -> Pair {
        let of_antennas = self.antennas.as_ref().and_then(|antennas| antennas.pair(n));
        of_antennas.unwrap_or_else(|| Pair::at(self.element_x_metres(n)))
    }
}

impl BuiltArray {
    /// [`Radar::pair`], where the element really stands: both antennas are off by as much.
    pub fn pair(&self, radar: &Radar, n: usize) -> Pair {
        if radar.is_monostatic() {
            return Pair::at(self.element_x_metres(radar, n));
        }
        let (pair, off) = (radar.pair(n), self.element(n).position_millimetres * 1e-3);
        Pair { transmitter_x_metres: pair.transmitter_x_metres + off, receiver_x_metres: pair.receiver_x_metres + off }
    }
}
