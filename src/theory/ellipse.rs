//! The Cramer-Rao bound as an ellipse on the ground.

use crate::bounds::PositionBound;

/// The ellipse of one standard deviation of an efficient unbiased estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half the longer axis, metres.
    pub major_metres: f64,
    /// Half the shorter axis, metres.
    pub minor_metres: f64,
    /// Angle from the x axis to the longer axis, in (-pi/2, pi/2].
    pub angle_radians: f64,
}

impl Ellipse {
    /// The ellipse of a bound ([`crate::bounds::cramer_rao`]); `None` on the array's axis, where y is not bounded.
    pub fn of(bound: &PositionBound) -> Option<Ellipse> {
        let (x, y, both) = (bound.x_metres.powi(2), bound.y_metres.powi(2), bound.xy_covariance_metres2);
        if !(x + y).is_finite() {
            return None;
        }
        let spread = ((x - y) / 2.0).hypot(both);
        let major = (x + y) / 2.0 + spread;
        let minor = ((x * y - both * both) / major).max(0.0);
        Some(Ellipse {
            major_metres: major.sqrt(),
            minor_metres: minor.sqrt(),
            angle_radians: (2.0 * both).atan2(x - y) / 2.0,
        })
    }

    /// `points` points around the ellipse relative to its middle, (x, y) in metres.
    pub fn outline(&self, points: usize) -> Vec<[f64; 2]> {
        let (sin, cos) = self.angle_radians.sin_cos();
        let at = |i: usize| {
            let (b, a) = (std::f64::consts::TAU * i as f64 / points as f64).sin_cos();
            let (along, across) = (a * self.major_metres, b * self.minor_metres);
            [along * cos - across * sin, along * sin + across * cos]
        };
        (0..points).map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::blob::tests::at;
    use super::*;
    use crate::bounds::{cramer_rao, noise_variance};
    use crate::radar::{Decibels, Layout, Radar};

    #[test]
    fn the_ellipse_is_the_bound_in_both_directions() {
        let radar = Radar { samples: 64, ..Radar::default() };
        let layout = Layout::two_ends(&radar);
        for (range, cos) in [(20.0, 0.3), (3.0, -0.8), (1.5, 0.0)] {
            let r = at(range, cos);
            let variance = noise_variance(&radar, &layout, &r, Decibels(0.0));
            let bound = cramer_rao(&radar, &layout, &[r], variance).unwrap()[0];
            let ellipse = Ellipse::of(&bound).unwrap();
            let outline = ellipse.outline(3600);
            let reach = |x: f64, y: f64| outline.iter().map(|p| p[0] * x + p[1] * y).fold(0.0f64, f64::max);
            let (x, y) = (r.x_metres / range, r.y_metres / range);
            // The standard deviation in any direction is how far the ellipse reaches there.
            assert!((reach(x, y) / bound.range_metres - 1.0).abs() < 1e-3, "{range} {cos}: {bound:?} {ellipse:?}");
            assert!((reach(1.0, 0.0) / bound.x_metres - 1.0).abs() < 1e-3);
            assert!((reach(0.0, 1.0) / bound.y_metres - 1.0).abs() < 1e-3);
        }
    }
}
