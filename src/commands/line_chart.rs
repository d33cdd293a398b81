//! Lines and dots over one pair of axes, with a legend.

use super::figure::tick;
use crate::picture::{Drawing, Painted, PanelArea};
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use std::ops::Range;

/// A chart whose y axis is logarithmic.
pub struct LineChart {
    pub caption: String,
    pub size: (u32, u32),
    pub x: ChartAxis,
    pub is_x_log: bool,
    pub y: ChartAxis,
    pub legend: SeriesLabelPosition,
    pub lines: Vec<ChartLine>,
}

pub struct ChartAxis {
    pub title: String,
    pub range: Range<f64>,
}

impl ChartAxis {
    pub fn new(title: impl Into<String>, range: Range<f64>) -> Self {
        ChartAxis { title: title.into(), range }
    }
}

pub struct ChartLine {
    pub name: Option<String>,
    pub style: ShapeStyle,
    pub points: Vec<(f64, f64)>,
    pub is_joined: bool,
    /// Radius of a point's dot, pixels; 0 for none.
    pub dot: i32,
}

impl ChartLine {
    /// A line without dots.
    pub fn new(colour: impl Color, points: impl Iterator<Item = (f64, f64)>) -> Self {
        let style = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 2 };
        ChartLine { name: None, style, points: points.collect(), is_joined: true, dot: 0 }
    }

    pub fn named(self, name: impl Into<String>) -> Self {
        ChartLine { name: Some(name.into()), ..self }
    }
}

const LEGEND_DOT: i32 = 5;

impl LineChart {
    fn draw_over<B: DrawingBackend, X: AsRangedCoord<Value = f64>>(&self, area: &PanelArea<B>, x: X) -> Painted
    where
        X::CoordDescType: ValueFormatter<f64>,
    {
        let mut chart = ChartBuilder::on(area)
            .caption(&self.caption, ("sans-serif", 22))
            .margin(14)
            .margin_right(24)
            .x_label_area_size(46)
            .y_label_area_size(80)
            .build_cartesian_2d(x, self.y.range.clone().log_scale())?;
        chart
            .configure_mesh()
            .x_desc(&self.x.title)
            .y_desc(&self.y.title)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        for ChartLine { name, style, points, is_joined, dot } in &self.lines {
            let (style, dot, is_joined) = (*style, *dot, *is_joined);
            let joined = points.iter().copied().filter(|_| is_joined);
            chart.draw_series(LineSeries::new(joined, style))?;
            let dots = points.iter().filter(|_| dot > 0);
            let series = chart.draw_series(dots.map(|at| Circle::new(*at, dot, style)))?;
            match name {
                Some(name) if is_joined => {
                    series.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
                }
                Some(name) => {
                    series.label(name).legend(move |(x, y)| Circle::new((x + 9, y), LEGEND_DOT, style));
                }
                None => {}
            }
        }
        chart
            .configure_series_labels()
            .position(self.legend.clone())
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    }
}

impl Drawing for LineChart {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
        let x = self.x.range.clone();
        if self.is_x_log { self.draw_over(area, x.log_scale()) } else { self.draw_over(area, x) }
    }
}

/// Least and largest of numbers above 0; 1 to 10 where there are none.
pub fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    if low <= high && low > 0.0 { low..high } else { 1.0..10.0 }
}

/// The range with a margin by this factor at both ends.
pub fn widened(range: Range<f64>, factor: f64) -> Range<f64> {
    range.start / factor..range.end * factor
}
