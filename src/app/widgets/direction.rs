//! Directions as text: degrees from straight ahead, positive to the right, with cos θ.
//!
//! θ is the angle to the array's axis, so cos θ is the sine of the angle from straight ahead.

use super::numbers::signed;

/// Zero and sign of the degrees, for tooltips.
pub const CONVENTION: &str = "0° is straight ahead, positive to the right";

/// Degrees from straight ahead, -90 to 90, of a direction with this cosine to the array's axis.
pub fn angle_degrees(cos_theta: f64) -> f64 {
    cos_theta.clamp(-1.0, 1.0).asin().to_degrees()
}

/// Degrees from straight ahead of a place: beyond -90 and 90 behind the array.
pub fn angle_of_place_degrees(x_metres: f64, y_metres: f64) -> f64 {
    x_metres.atan2(y_metres).to_degrees()
}

/// A direction like "+6.9° · cos θ +0.120": the angle has `digits` decimals, the cosine two more.
pub fn direction(cos_theta: f64, digits: usize) -> String {
    format!("{}° · cos θ {}", signed(angle_degrees(cos_theta), digits), signed(cos_theta, digits + 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_ahead_is_0_degrees_and_the_right_positive() {
        assert_eq!((angle_degrees(0.0), angle_of_place_degrees(0.0, 3.0)), (0.0, 0.0));
        assert_eq!(direction(0.0, 1), "±0.0° · cos θ ±0.000");
        assert!((angle_degrees(0.5) - 30.0).abs() < 1e-12);
        assert!((angle_of_place_degrees(-1.0, 1.0) + 45.0).abs() < 1e-12);
        assert_eq!(direction(-0.5, 1), "−30.0° · cos θ −0.500");
        assert!((angle_of_place_degrees(1.0, -1.0) - 135.0).abs() < 1e-12, "behind the array");
    }
}
