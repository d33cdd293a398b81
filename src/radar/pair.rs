//! Pairs of antennas: a transmitter, and the receiver of its echoes.

use super::{BuiltArray, Radar};

/// A transmitter and a receiver. One element that does both is a pair whose antennas stand at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// x of the transmitter, metres.
    pub transmitter_x_metres: f64,
    /// x of the receiver, metres.
    pub receiver_x_metres: f64,
    /// Distance of the transmitter from the array's line, towards the scene, metres.
    pub transmitter_y_metres: f64,
    /// Distance of the receiver from the array's line, towards the scene, metres.
    pub receiver_y_metres: f64,
}

impl Pair {
    /// Both antennas at `x_metres` of the array's line.
    pub fn at(x_metres: f64) -> Self {
        Pair::on_line(x_metres, x_metres)
    }

    /// Antennas at these places of the array's line, metres.
    pub const fn on_line(transmitter_x_metres: f64, receiver_x_metres: f64) -> Self {
        Pair { transmitter_x_metres, receiver_x_metres, transmitter_y_metres: 0.0, receiver_y_metres: 0.0 }
    }

    /// Places (x, y) of the transmitter and of the receiver, metres.
    pub fn places_metres(&self) -> [[f64; 2]; 2] {
        [[self.transmitter_x_metres, self.transmitter_y_metres], [self.receiver_x_metres, self.receiver_y_metres]]
    }

    /// Whether both antennas stand on the array's line.
    pub fn is_on_line(&self) -> bool {
        self.transmitter_y_metres == 0.0 && self.receiver_y_metres == 0.0
    }

    /// Whether both antennas stand at one place.
    pub fn is_one(&self) -> bool {
        let [transmitter, receiver] = self.places_metres();
        transmitter == receiver
    }

    /// Distance of the middle between both antennas from the array's line, towards the scene, metres.
    pub fn forward_metres(&self) -> f64 {
        (self.transmitter_y_metres + self.receiver_y_metres) / 2.0
    }

    /// Range of the point at (`x_metres`, `y_metres`): half the path from the transmitter over the point to the receiver.
    pub fn range_metres(&self, x_metres: f64, y_metres: f64) -> f64 {
        let [there, back] = self.places_metres().map(|[x, y]| (x_metres - x).hypot(y_metres - y));
        (there + back) / 2.0
    }
}

impl Radar {
    /// The antennas of element `n`: one that sends and hears, or a transmitter and a receiver. Beyond the last element the line goes on.
    pub fn pair(&self, n: usize) -> Pair {
        let of_antennas = self.antennas.as_ref().and_then(|antennas| antennas.pair(n));
        of_antennas.unwrap_or_else(|| Pair::at(self.element_x_metres(n)))
    }
}

impl BuiltArray {
    /// [`Radar::pair`] at the element's true place, along the line and off it: both antennas have its offset.
    pub fn pair(&self, radar: &Radar, n: usize) -> Pair {
        let (pair, along, forward) =
            (radar.pair(n), self.element(n).position_millimetres * 1e-3, self.forward_metres(n));
        Pair {
            transmitter_x_metres: pair.transmitter_x_metres + along,
            receiver_x_metres: pair.receiver_x_metres + along,
            transmitter_y_metres: pair.transmitter_y_metres + forward,
            receiver_y_metres: pair.receiver_y_metres + forward,
        }
    }
}
