//! The chart of run time against error.

use crate::benchmark::front::{Entrant, Front, FrontRow, FrontTask};
use crate::commands::line_chart::{ChartAxis, ChartLine, LineChart, span, widened};
use crate::radar::counted;
use crate::signal::Algorithm;
use plotters::prelude::{BLACK, Color, RGBColor, SeriesLabelPosition, ShapeStyle};

/// Errors below this are drawn on the axis.
const MIN_ERROR: f64 = 1e-16;
const MAX_ERROR: f64 = 1e-2;
/// Radius of the dot of the fewest reflectors, pixels.
const MIN_DOT_PIXELS: i32 = 4;
const RING_PIXELS: i32 = 3;

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

fn sizes(counts: &[usize]) -> String {
    let numbers = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    match counts {
        [count] => counted(*count, "reflector", "reflectors"),
        _ => format!("{numbers} reflectors, from the smallest to the largest dot"),
    }
}

/// The row at whose dot `row` is drawn. A choice of the planner's stands at the dot of the algorithm that it chose, where that took part too: the two
/// were timed one after the other and differ by chance.
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

/// Run time against error of three maps from scratch.
pub fn front(measured: &Front) -> LineChart {
    let scratch: Vec<&FrontRow> = measured.rows.iter().filter(|r| r.task == FrontTask::Scratch).collect();
    let bare = measured.bare_fft_ms;
    let mut counts: Vec<usize> = scratch.iter().map(|r| r.reflectors).collect();
    counts.sort_unstable();
    counts.dedup();
    let errors = MIN_ERROR..MAX_ERROR;
    let across = [(errors.start, bare), (errors.end, bare)];
    let mut lines = vec![ChartLine::new(BLACK.mix(0.4), across.into_iter()).named("bare 2-D transform, one thread")];
    let forced = Algorithm::ALL.into_iter().rev().map(Entrant::Forced);
    for entrant in std::iter::once(Entrant::Planned).chain(forced) {
        let is_plan = entrant == Entrant::Planned;
        for (rank, count) in counts.iter().enumerate() {
            let rows = scratch.iter().filter(|r| r.algorithm == entrant && r.reflectors == *count);
            let dots = rows.map(|r| dot_of(r, &scratch));
            let points = dots.map(|dot| (dot.signal_error.clamp(MIN_ERROR, MAX_ERROR), dot.median_ms)).collect();
            let name = if is_plan { "plan: a ring around what it chose" } else { entrant.name() };
            lines.push(ChartLine {
                name: (rank == 0).then(|| name.to_owned()),
                style: ShapeStyle { color: colour(entrant).to_rgba(), filled: !is_plan, stroke_width: 2 },
                points,
                is_joined: false,
                dot: MIN_DOT_PIXELS + 2 * rank as i32 + if is_plan { RING_PIXELS } else { 0 },
            });
        }
    }
    LineChart {
        caption: "Three Lambda maps from scratch: run time against error".to_owned(),
        size: (1000, 640),
        x: ChartAxis::new(format!("largest error of a range cell, relative to the peak ({})", sizes(&counts)), errors),
        is_x_log: true,
        y: ChartAxis::new("median time, ms", widened(span(scratch.iter().map(|r| r.median_ms).chain([bare])), 1.5)),
        legend: SeriesLabelPosition::UpperRight,
        lines,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::front::MapConvention;
    use crate::signal::Precision;

    fn row(algorithm: &str, chosen: Algorithm, tolerance: f64, median_ms: f64) -> FrontRow {
        FrontRow {
            task: FrontTask::Scratch,
            reflectors: 10,
            algorithm: algorithm.parse().unwrap(),
            chosen,
            precision: Precision::F64,
            tolerance,
            convention: MapConvention::THESIS,
            median_ms,
            spread_ms: 0.0,
            fastest_ms: median_ms,
            repeats: 1,
            signal_error: 1e-13,
            lambda: Vec::new(),
        }
    }

    #[test]
    fn a_ring_stands_on_the_dot_of_what_the_planner_chose() {
        let [plan, alone] = [row("plan", Algorithm::Split, 1e-9, 5.0), row("plan", Algorithm::Direct, 1e-9, 6.0)];
        let [other, chosen] =
            [(1e-12, 1.0), (1e-9, 2.0)].map(|(tolerance, ms)| row("split", Algorithm::Split, tolerance, ms));
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
