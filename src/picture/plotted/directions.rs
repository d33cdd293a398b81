//! A snapshot as curves over direction: of all elements, of one end, and of a method.

use super::canvas::{Drawing, FAINT_INK, HAIRLINE, INK, Painted, PanelArea};
use super::text::{self, Weight};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Power over direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub name: String,
    /// Angle from broadside in degrees, positive towards +x, rising; and decibels below the curve's own strongest.
    pub points: Vec<(f64, f64)>,
    pub colour: RGBColor,
}

/// A direction with a detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    pub angle_degrees: f64,
    pub below_strongest_db: f64,
}

/// The contents of the picture of a snapshot.
#[derive(Debug, Clone)]
pub struct DirectionAxis<'a> {
    pub name: &'a str,
    pub about: &'a str,
    /// The curves, the most important one last.
    pub curves: &'a [Curve],
    pub found: &'a [Mark],
}

const WIDTH: u32 = 1400;
const HEIGHT: u32 = 640;
const LOWEST_DB: f64 = -40.0;

impl Drawing for DirectionAxis<'_> {
    fn size(&self) -> (u32, u32) {
        (WIDTH, HEIGHT)
    }

    fn draw<B: DrawingBackend>(&self, root: &PanelArea<B>) -> Painted {
        let name = text::fitted(root, self.name, 32, Weight::Bold, WIDTH - 60)?;
        text::line(root, (30, 18), &name, 32, Weight::Bold, &INK)?;
        let about = text::fitted(root, self.about, 18, Weight::Normal, WIDTH - 60)?;
        text::line(root, (30, 58), &about, 18, Weight::Normal, &FAINT_INK)?;
        let (left, right) = self.span_degrees();
        let area = root.clone().shrink((16, 124), (WIDTH - 46, HEIGHT - 134));
        let mut chart = ChartBuilder::on(&area)
            .x_label_area_size(52)
            .y_label_area_size(66)
            .build_cartesian_2d(left..right, LOWEST_DB..1.5)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(HAIRLINE)
            .x_labels(12)
            .y_labels(5)
            .x_label_formatter(&|v| format!("{v:.0}\u{b0}"))
            .y_label_formatter(&|v| format!("{v:.0}"))
            .x_desc("direction from broadside")
            .y_desc("dB below the strongest")
            .label_style(text::style(17, Weight::Normal, &FAINT_INK))
            .axis_desc_style(text::style(18, Weight::Normal, &INK))
            .axis_style(HAIRLINE)
            .draw()?;
        self.draw_marks(&mut chart)?;
        self.draw_curves(root, &mut chart)
    }
}

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl DirectionAxis<'_> {
    fn draw_marks<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>) -> Painted {
        let (left, right) = self.span_degrees();
        for mark in self.found.iter().filter(|m| m.below_strongest_db > LOWEST_DB) {
            let stem = [(mark.angle_degrees, LOWEST_DB), (mark.angle_degrees, mark.below_strongest_db)];
            chart.draw_series(LineSeries::new(stem, INK.mix(0.5)))?;
            let shown = if mark.angle_degrees.abs() < 0.005 { 0.0 } else { mark.angle_degrees };
            let style = text::style(18, Weight::Bold, &INK);
            let place = (mark.angle_degrees + (right - left) * 0.006, LOWEST_DB + 3.0);
            let label = Text::new(format!("{shown:.2}\u{b0}"), place, style);
            chart.draw_series(std::iter::once(label))?;
        }
        Ok(())
    }

    fn draw_curves<B: DrawingBackend>(&self, root: &PanelArea<B>, chart: &mut Chart<'_, B>) -> Painted {
        let (left, right) = self.span_degrees();
        let mut at = 30;
        for (number, curve) in self.curves.iter().enumerate() {
            let width = if number + 1 == self.curves.len() { 3 } else { 2 };
            let points = curve.points.iter().map(|(x, y)| (*x, y.max(LOWEST_DB)));
            let points: Vec<(f64, f64)> = points.filter(|(x, _)| (left..=right).contains(x)).collect();
            chart.draw_series(LineSeries::new(points, curve.colour.stroke_width(width)))?;
            let swatch = Rectangle::new([(at, 97), (at + 26, 101)], curve.colour.filled());
            root.draw(&swatch)?;
            text::line(root, (at + 34, 88), &curve.name, 18, Weight::Normal, &INK)?;
            let style = text::style(18, Weight::Normal, &INK);
            at += 34 + root.estimate_text_size(&curve.name, &style)?.0 as i32 + 36;
        }
        Ok(())
    }

    /// The directions of the first curve, and a margin.
    fn span_degrees(&self) -> (f64, f64) {
        let loud = self.curves.first().into_iter().flat_map(|c| &c.points).filter(|(_, db)| *db > -12.0);
        let ends = |(low, high): (f64, f64), (x, _): &(f64, f64)| (low.min(*x), high.max(*x));
        let (low, high) = loud.fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        if low > high { (-90.0, 90.0) } else { ((low - 18.0).max(-90.0), (high + 18.0).min(90.0)) }
    }
}
