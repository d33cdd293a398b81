//! The run-time/error front as SVG and PNG.

use crate::benchmark::front::{Entrant, Front, FrontRow, FrontTask};
use crate::commands::CommandError;
use crate::commands::figure::tick;
use crate::picture;
use crate::radar::counted;
use crate::signal::Algorithm;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

const SIZE: (u32, u32) = (1000, 640);
/// Errors below this are drawn on the axis.
const LEAST_ERROR: f64 = 1e-16;
const MOST_ERROR: f64 = 1e-2;
/// Radius of the dot of the fewest reflectors, pixels.
const LEAST_DOT: i32 = 4;
const RING: i32 = 3;
const LEGEND_DOT: i32 = 5;

/// Draws `bench.svg` and `bench.png` into `folder`, which is made where it is missing.
pub fn draw(folder: &Path, measured: &Front) -> Result<(), CommandError> {
    std::fs::create_dir_all(folder).map_err(|source| CommandError::File { path: folder.to_owned(), source })?;
    let svg = folder.join("bench.svg");
    picture::register_fonts().map_err(|e| failed(&svg, &e))?;
    front(&SVGBackend::new(&svg, SIZE).into_drawing_area(), measured).map_err(|e| failed(&svg, &e))?;
    let png = folder.join("bench.png");
    front(&BitMapBackend::new(&png, SIZE).into_drawing_area(), measured).map_err(|e| failed(&png, &e))
}

fn failed(path: &Path, error: &dyn std::error::Error) -> CommandError {
    CommandError::File { path: path.to_owned(), source: std::io::Error::other(error.to_string()) }
}

fn colour(entrant: Entrant) -> RGBColor {
    match entrant {
        Entrant::Planned => BLACK,
        Entrant::Forced(Algorithm::Split) => RGBColor(30, 100, 200),
        Entrant::Forced(Algorithm::Gridded) => RGBColor(210, 90, 20),
        Entrant::Forced(Algorithm::ClosedForm) => RGBColor(200, 40, 60),
        Entrant::Forced(Algorithm::Exact) => RGBColor(40, 140, 60),
        Entrant::Forced(Algorithm::Direct) => RGBColor(150, 60, 160),
    }
}

/// The planner's choices are rings around the algorithm it chose.
fn style(entrant: Entrant) -> ShapeStyle {
    match entrant {
        Entrant::Planned => colour(entrant).stroke_width(2),
        Entrant::Forced(_) => colour(entrant).filled(),
    }
}

fn sizes(counts: &[usize]) -> String {
    let numbers = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    match counts {
        [count] => counted(*count, "reflector", "reflectors"),
        _ => format!("{numbers} reflectors, from the smallest to the largest dot"),
    }
}

/// Where `row` is drawn: a choice of the planner's at the dot of the algorithm that it chose, where that took part too, as the two were timed
/// one after the other and differ by chance.
fn dot_of<'a>(row: &'a FrontRow, rows: &[&'a FrontRow]) -> &'a FrontRow {
    if row.algorithm != Entrant::Planned {
        return row;
    }
    let same = |r: &&&FrontRow| {
        r.algorithm == Entrant::Forced(row.chosen)
            && (r.reflectors, r.precision, r.tolerance) == (row.reflectors, row.precision, row.tolerance)
    };
    rows.iter().find(same).copied().unwrap_or(row)
}

fn front<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    measured: &Front,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let scratch: Vec<&FrontRow> = measured.rows.iter().filter(|r| r.task == FrontTask::Scratch).collect();
    let times = scratch.iter().map(|r| r.median_ms).chain([measured.bare_fft_ms]);
    let (low, high) = times.fold((f64::INFINITY, 0.0f64), |(a, b), t| (a.min(t), b.max(t)));
    let mut counts: Vec<usize> = scratch.iter().map(|r| r.reflectors).collect();
    counts.sort_unstable();
    counts.dedup();
    let area = area.titled("Three Lambda maps from scratch: run time against error", ("sans-serif", 22))?;
    let mut chart = ChartBuilder::on(&area)
        .caption(sizes(&counts), ("sans-serif", 14))
        .margin(10)
        .margin_right(24)
        .x_label_area_size(46)
        .y_label_area_size(64)
        .build_cartesian_2d((LEAST_ERROR..MOST_ERROR).log_scale(), (low / 1.5..high * 1.5).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("largest error of a range cell, relative to the peak")
        .y_desc("median time, ms")
        .x_label_formatter(&|v| format!("{v:.0e}"))
        .y_label_formatter(&tick)
        .draw()?;
    let bare = measured.bare_fft_ms;
    chart
        .draw_series(LineSeries::new([(LEAST_ERROR, bare), (MOST_ERROR, bare)], BLACK.mix(0.4)))?
        .label("bare 2-D transform, one thread")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLACK.mix(0.4)));
    let forced = Algorithm::ALL.into_iter().rev().map(Entrant::Forced);
    for entrant in std::iter::once(Entrant::Planned).chain(forced) {
        let points = scratch.iter().filter(|r| r.algorithm == entrant).map(|r| {
            let rank = counts.iter().position(|c| *c == r.reflectors).unwrap_or(0) as i32;
            let ring = if entrant == Entrant::Planned { RING } else { 0 };
            let dot = dot_of(r, &scratch);
            let at = (dot.signal_error.clamp(LEAST_ERROR, MOST_ERROR), dot.median_ms);
            Circle::new(at, LEAST_DOT + 2 * rank + ring, style(entrant))
        });
        let label = if entrant == Entrant::Planned { "plan: a ring around what it chose" } else { entrant.name() };
        chart
            .draw_series(points)?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 9, y), LEGEND_DOT, style(entrant)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    area.present()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row as `bench.json` has it.
    fn row(algorithm: &str, chosen: &str, tolerance: f64, median_ms: f64) -> FrontRow {
        serde_json::from_value(serde_json::json!({
            "task": "scratch", "reflectors": 10, "algorithm": algorithm, "chosen": chosen, "precision": "f64", "tolerance": tolerance,
            "floor": "thesis", "normalisation": "min-max", "median_ms": median_ms, "spread_ms": 0.0, "fastest_ms": median_ms, "repeats": 1,
            "signal_error": 1e-13, "lambda_error": 0.0, "lambda_rms_error": 0.0, "lambda": [], "peak_bytes": null,
        }))
        .unwrap()
    }

    #[test]
    fn a_ring_stands_on_the_dot_of_what_the_planner_chose() {
        let [plan, alone] = [row("plan", "split", 1e-9, 5.0), row("plan", "direct", 1e-9, 6.0)];
        let [other, chosen] = [row("split", "split", 1e-12, 1.0), row("split", "split", 1e-9, 2.0)];
        let rows = [&plan, &alone, &other, &chosen];
        assert_eq!(dot_of(&plan, &rows).median_ms, 2.0);
        assert_eq!(dot_of(&other, &rows).median_ms, 1.0);
        assert_eq!(dot_of(&alone, &rows).median_ms, 6.0, "its own place where the algorithm took no part");
    }

    #[test]
    fn one_size_of_dots_is_not_explained() {
        assert_eq!(sizes(&[1]), "1 reflector");
        assert_eq!(sizes(&[1, 75]), "1, 75 reflectors, from the smallest to the largest dot");
    }
}
