//! Derivatives of a point's range and amplitude by its position.

use crate::radar::{Pair, Pattern};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The coordinate of a derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarCoordinate {
    /// The point's range from the array's centre, in metres, in the same direction.
    Range,
    /// cos(theta) of the point as the array's centre sees it, at the same range.
    CosTheta,
}

/// Derivative of an echo's range and amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathChange {
    pub range_metres: f64,
    /// Relative change of the amplitude.
    pub amplitude: f64,
}

impl PathChange {
    /// The derivative for a point at (`x_metres`, `y_metres`), for any reflectivity.
    pub fn of_point(pair: Pair, [x_metres, y_metres]: [f64; 2], by: PolarCoordinate) -> Self {
        let range_metres = x_metres.hypot(y_metres);
        let [there, back] = pair.places_metres().map(|[antenna_x, antenna_y]| {
            let leg = (x_metres - antenna_x).hypot(y_metres - antenna_y);
            // Half the square of the leg is (range^2 - 2 range (cos(theta) antenna_x + sin(theta) antenna_y) + antenna_x^2 + antenna_y^2) / 2.
            let half_square = match by {
                PolarCoordinate::Range if range_metres == 0.0 => 0.0,
                PolarCoordinate::Range if antenna_y == 0.0 => range_metres - antenna_x * (x_metres / range_metres),
                PolarCoordinate::Range => range_metres - (antenna_x * x_metres + antenna_y * y_metres) / range_metres,
                PolarCoordinate::CosTheta if antenna_y == 0.0 => -range_metres * antenna_x,
                PolarCoordinate::CosTheta => range_metres * (antenna_y * x_metres / y_metres - antenna_x),
            };
            let change = half_square / leg;
            [change, -change / leg]
        });
        PathChange { range_metres: (there[0] + back[0]) / 2.0, amplitude: there[1] + back[1] }
    }

    /// The derivative between elements with a pattern.
    pub fn through(
        self,
        pattern: Option<Pattern>,
        pair: Pair,
        [x_metres, y_metres]: [f64; 2],
        by: PolarCoordinate,
    ) -> Self {
        let Some(pattern) = pattern else { return self };
        let square = x_metres * x_metres + y_metres * y_metres;
        // Change of the logarithm of the point's distance ahead of each antenna; the cosine off broadside is its quotient by the leg.
        let of_log_y = |antenna_y: f64| {
            let of_y = match by {
                PolarCoordinate::Range => y_metres / square.sqrt(),
                PolarCoordinate::CosTheta => -x_metres * square.sqrt() / y_metres,
            };
            of_y / (y_metres - antenna_y)
        };
        // PathChange::amplitude is the change of minus the logarithms of both legs.
        let of_log_cos = of_log_y(pair.transmitter_y_metres)
            + of_log_y(pair.receiver_y_metres)
            + PathChange::of_point(pair, [x_metres, y_metres], by).amplitude;
        PathChange { amplitude: self.amplitude + pattern.relative_change(of_log_cos), ..self }
    }

    /// Relative derivative of a sample, where the echo's phase changes by `turns_per_metre` of range.
    pub fn of_sample(&self, turns_per_metre: f64) -> Complex64 {
        Complex64::new(self.amplitude, TAU * turns_per_metre * self.range_metres)
    }
}
