//! The pictures of `apertura bounds`.

use super::report::{Bound, BoundRow, BoundsReport, columns_to_cos};
use crate::bounds::Ambiguity;
use crate::commands::line_chart::{ChartAxis, ChartLine, LineChart, span, widened};
use crate::evaluate::Placement;
use crate::picture::{ColourMap, Drawing, Painted, PanelArea};
use crate::radar::{Polar, Radar, counted};
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

fn over_snr(caption: &str, snr_db: Range<f64>, millimetres: Range<f64>, y: &str, lines: Vec<ChartLine>) -> LineChart {
    LineChart {
        caption: caption.to_owned(),
        size: (1000, 600),
        x: ChartAxis::new("signal-to-noise ratio of a sample, dB", snr_db),
        is_x_log: false,
        y: ChartAxis::new(y, widened(millimetres, 1.5)),
        legend: SeriesLabelPosition::UpperRight,
        lines,
    }
}

/// Bound over signal-to-noise ratio, a line a layout.
pub fn of_bounds(report: &BoundsReport) -> LineChart {
    let rows = || report.layouts.iter().flat_map(|l| &l.bounds);
    let values = rows().flat_map(|b| [b.alone, b.beside_another]).flatten().map(|b| b.position_millimetres);
    let lines = report.layouts.iter().zip(COLOURS.iter().cycle()).flat_map(|(layout, colour)| {
        let line = |bound: fn(&BoundRow) -> Option<Bound>| {
            layout.bounds.iter().filter_map(move |b| Some((b.snr_db, bound(b)?.position_millimetres)))
        };
        let name = format!("{} ({})", layout.layout, counted(layout.elements, "element", "elements"));
        let beside = ChartLine::new(colour.mix(0.35), line(|b| b.beside_another));
        [beside, ChartLine::new(*colour, line(|b| b.alone)).named(name)]
    });
    over_snr(
        "No unbiased estimate places a reflector better than this",
        span_of_snr(rows().map(|b| b.snr_db)),
        span(values),
        "position error, mm (pale: with a neighbour)",
        lines.collect(),
    )
}

/// Error of the Newton search over signal-to-noise ratio, beside the bound.
pub fn of_placement(placements: &[Placement]) -> LineChart {
    let bound = placements.iter().map(|p| (p.snr_db, 1e3 * p.bound_metres));
    let found = placements.iter().map(|p| (p.snr_db, 1e3 * p.error_metres)).filter(|(_, e)| e.is_finite());
    let trials = placements.first().map_or(0, |p| p.trials);
    let name = format!("Newton search, {} each", counted(trials, "draw of noise", "draws of noise"));
    let dots = ChartLine::new(COLOURS[0], found.clone()).named(name);
    over_snr(
        "One reflector from the two ends: the Newton search against the bound",
        span_of_snr(placements.iter().map(|p| p.snr_db)),
        span(bound.clone().chain(found).map(|(_, error)| error)),
        "position error, mm (root mean square)",
        vec![
            ChartLine::new(COLOURS[4], bound).named("Cramér-Rao bound"),
            ChartLine { is_joined: false, dot: 5, ..dots },
        ],
    )
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

impl Drawing for AmbiguityFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1000, 60 + 230 * self.patches.len().max(1) as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
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

fn span_of_snr(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    low - 1.0..high + 1.0
}
