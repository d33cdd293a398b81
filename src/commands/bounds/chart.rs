//! The pictures of `apertura bounds`.

use super::report::{Bound, BoundRow, BoundsReport, columns_to_cos};
use crate::bounds::Ambiguity;
use crate::commands::figure::{DrawingResult, Plot, tick};
use crate::evaluate::Placement;
use crate::picture::ColourMap;
use crate::radar::{Polar, Radar, counted};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use std::ops::Range;

const COLOURS: [RGBColor; 7] = [
    RGBColor(210, 90, 20),
    RGBColor(30, 100, 200),
    RGBColor(40, 140, 60),
    RGBColor(150, 60, 160),
    RGBColor(20, 20, 20),
    RGBColor(170, 130, 0),
    RGBColor(0, 150, 160),
];

/// Position error over signal-to-noise ratio.
type ErrorChart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, LogCoord<f64>>>;

struct ErrorAxes {
    caption: &'static str,
    snr_db: Range<f64>,
    millimetres: Range<f64>,
    vertical: &'static str,
}

impl ErrorAxes {
    fn draw<'a, B: DrawingBackend>(
        self,
        area: &'a DrawingArea<B, Shift>,
    ) -> Result<ErrorChart<'a, B>, DrawingAreaErrorKind<B::ErrorType>> {
        let millimetres = self.millimetres.start / 1.5..self.millimetres.end * 1.5;
        let mut chart = ChartBuilder::on(area)
            .caption(self.caption, ("sans-serif", 22))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(80)
            .build_cartesian_2d(self.snr_db, millimetres.log_scale())?;
        chart
            .configure_mesh()
            .x_desc("signal-to-noise ratio of a sample, dB")
            .y_desc(self.vertical)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        Ok(chart)
    }
}

fn legend<'a, B: DrawingBackend + 'a>(chart: &mut ErrorChart<'a, B>) -> DrawingResult<B> {
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()
}

/// Bound over signal-to-noise ratio, a line a layout.
pub struct BoundsFigure<'a>(pub &'a BoundsReport);

impl Plot for BoundsFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1000, 600)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let report = self.0;
        let rows = || report.layouts.iter().flat_map(|l| &l.bounds);
        let values = rows().flat_map(|b| [b.alone, b.beside_another]).flatten().map(|b| b.position_millimetres);
        let (low, high) = span(values);
        let (from, to) = span_of_snr(rows().map(|b| b.snr_db));
        let axes = ErrorAxes {
            caption: "No unbiased estimate places a reflector better than this",
            snr_db: from..to,
            millimetres: low..high,
            vertical: "position error, mm (pale: with a neighbour)",
        };
        let mut chart = axes.draw(area)?;
        for (layout, colour) in report.layouts.iter().zip(COLOURS.iter().cycle()) {
            let line = |bound: fn(&BoundRow) -> Option<Bound>| {
                layout.bounds.iter().filter_map(move |b| Some((b.snr_db, bound(b)?.position_millimetres)))
            };
            let beside = line(|b| b.beside_another);
            chart.draw_series(LineSeries::new(beside, colour.mix(0.35).stroke_width(2)))?;
            let colour = *colour;
            chart
                .draw_series(LineSeries::new(line(|b| b.alone), colour.stroke_width(2)))?
                .label(format!("{} ({})", layout.layout, counted(layout.elements, "element", "elements")))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        }
        legend(&mut chart)
    }
}

/// Error of the Newton search over signal-to-noise ratio, beside the bound.
pub struct PlacementFigure<'a>(pub &'a [Placement]);

impl Plot for PlacementFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1000, 600)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let errors = self.0.iter().map(|p| 1e3 * p.error_metres).filter(|e| e.is_finite());
        let (low, high) = span(errors.chain(self.0.iter().map(|p| 1e3 * p.bound_metres)));
        let (from, to) = span_of_snr(self.0.iter().map(|p| p.snr_db));
        let trials = self.0.first().map_or(0, |p| p.trials);
        let axes = ErrorAxes {
            caption: "One reflector from the two ends: the Newton search against the bound",
            snr_db: from..to,
            millimetres: low..high,
            vertical: "position error, mm (root mean square)",
        };
        let mut chart = axes.draw(area)?;
        let (ink, hot) = (COLOURS[4], COLOURS[0]);
        chart
            .draw_series(LineSeries::new(self.0.iter().map(|p| (p.snr_db, 1e3 * p.bound_metres)), ink.stroke_width(2)))?
            .label("Cramér-Rao bound")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], ink.stroke_width(2)));
        let found = self.0.iter().filter(|p| p.error_metres.is_finite());
        chart
            .draw_series(found.map(|p| Circle::new((p.snr_db, 1e3 * p.error_metres), 5, hot.filled())))?
            .label(format!("Newton search, {} each", counted(trials, "draw of noise", "draws of noise")))
            .legend(move |(x, y)| Circle::new((x + 9, y), 5, hot.filled()));
        legend(&mut chart)
    }
}

/// Ambiguity functions over range and cos(theta), a panel a layout.
pub struct AmbiguityFigure<'a> {
    pub radar: &'a Radar,
    pub centre: Polar,
    /// Names and patches around the reflector.
    pub patches: &'a [(String, Ambiguity)],
}

/// Decibels below the reflector's own that are black.
const RANGE_DB: f64 = 30.0;

impl Plot for AmbiguityFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1000, 60 + 230 * self.patches.len().max(1) as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let caption = format!("Which places sound like the reflector in the middle: 0 to -{RANGE_DB} dB");
        let area = area.margin(8, 0, 0, 0).titled(&caption, ("sans-serif", 22))?;
        let bin = self.radar.range_resolution_metres();
        let column = columns_to_cos(self.radar);
        for (panel, (name, patch)) in area.split_evenly((self.patches.len(), 1)).into_iter().zip(self.patches) {
            let columns = |cos: f64| (cos - self.centre.cos_theta) / column;
            let bins = |range: f64| (range - self.centre.range_metres) / bin;
            let (Some(&left), Some(&right)) = (patch.cos_theta.first(), patch.cos_theta.last()) else { continue };
            let (Some(&near), Some(&far)) = (patch.range_metres.first(), patch.range_metres.last()) else { continue };
            let step = (columns(right) - columns(left)) / (patch.cos_theta.len() - 1) as f64;
            let rise = (bins(far) - bins(near)) / (patch.range_metres.len() - 1) as f64;
            let mut chart = ChartBuilder::on(&panel)
                .caption(name, ("sans-serif", 15))
                .margin(4)
                .margin_right(20)
                .x_label_area_size(34)
                .y_label_area_size(60)
                .build_cartesian_2d(columns(left)..columns(right), bins(near)..bins(far))?;
            chart
                .configure_mesh()
                .disable_mesh()
                .x_desc("columns of the whole array's map")
                .y_desc("range bins")
                .draw()?;
            chart.draw_series(patch.likeness.indexed_iter().map(|((row, i), likeness)| {
                let (x, y) = (columns(patch.cos_theta[i]), bins(patch.range_metres[row]));
                let level = 1.0 + 20.0 * likeness.max(1e-9).log10() / RANGE_DB;
                let [r, g, b] = ColourMap::default().colour(level.clamp(0.0, 1.0) as f32);
                let corners = [(x - step / 2.0, y - rise / 2.0), (x + step / 2.0, y + rise / 2.0)];
                Rectangle::new(corners, RGBColor(r, g, b).filled())
            }))?;
        }
        Ok(())
    }
}

fn span(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    if low <= high && low > 0.0 { (low, high) } else { (1.0, 10.0) }
}

fn span_of_snr(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    (low - 1.0, high + 1.0)
}
