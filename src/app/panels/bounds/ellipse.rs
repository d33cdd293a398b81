//! The Cramer-Rao bound of a place as an ellipse.

use crate::app::widgets::{Axis, Chart, theme};
use crate::bounds::PositionBound;
use eframe::egui::{Sense, Stroke, Ui};
use egui_plot::LineStyle;
use std::f64::consts::TAU;

/// Draws the ellipse of one standard deviation, which holds 39 % of the estimates of the best unbiased estimator.
pub fn ellipse(ui: &mut Ui, bound: &PositionBound) {
    let Some(outline) = outline(bound) else { return };
    let area = ui.available_rect_before_wrap();
    if area.height() < 110.0 {
        return;
    }
    let colour = theme::Inks::of(ui.visuals()).selected;
    let most = |i: usize| outline.iter().map(|p| 1.2 * p[i].abs()).fold(0.0, f64::max);
    let axis = |i: usize, title| Axis::new(-most(i), most(i), title);
    let (x, y) = (axis(0, "error of x, mm"), axis(1, "error of y, mm"));
    let mut chart = Chart::new("Ellipse of one standard deviation", x, y).with_one_scale();
    chart.line(outline, Stroke::new(1.8, colour), LineStyle::Solid);
    chart.dot([0.0, 0.0], 2.5, colour);
    chart
        .show(ui, area, Sense::hover())
        .response
        .on_hover_text("39 % of the estimates of the best unbiased estimator lie within");
}

/// Points of the ellipse in millimetres: a circle through the Cholesky factor of the covariance.
fn outline(bound: &PositionBound) -> Option<Vec<[f64; 2]>> {
    let (x, y) = (bound.x_metres * 1e3, bound.y_metres * 1e3);
    if !(x > 0.0 && y.is_finite()) {
        return None;
    }
    let slanted = bound.xy_covariance_metres2 * 1e6 / x;
    let upright = (y * y - slanted * slanted).max(0.0).sqrt();
    let at = |i: i32| {
        let (sin, cos) = (TAU * f64::from(i) / 96.0).sin_cos();
        [x * cos, slanted * cos + upright * sin]
    };
    Some((0..=96).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ellipse_reaches_one_standard_deviation_in_x_and_y() {
        let bound = PositionBound {
            range_metres: 1e-3,
            cos_theta: 1e-4,
            x_metres: 3e-3,
            y_metres: 1e-3,
            xy_covariance_metres2: -2e-6,
            amplitude: 1e-3,
        };
        let outline = outline(&bound).unwrap();
        let most = |i: usize| outline.iter().map(|p| p[i]).fold(0.0, f64::max);
        assert!((most(0) - 3.0).abs() < 1e-9 && (most(1) - 1.0).abs() < 3e-3, "{} {}", most(0), most(1));
        assert!(outline[0][1] < 0.0, "it leans down to the right");
        assert!(super::outline(&PositionBound { y_metres: f64::INFINITY, ..bound }).is_none());
    }
}
