//! The run-time/error front as SVG and PNG.

use super::CommandError;
use super::measure::Row;
use crate::picture;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

const SIZE: (u32, u32) = (1000, 640);

/// Draws `bench.svg` and `bench.png` into `folder`.
pub fn draw(folder: &Path, rows: &[Row], bare_fft_ms: f64) -> Result<(), CommandError> {
    std::fs::create_dir_all(folder).map_err(|source| CommandError::File { path: folder.to_owned(), source })?;
    let svg = folder.join("bench.svg");
    picture::register_fonts().map_err(|e| failed(&svg, &e))?;
    front(&SVGBackend::new(&svg, SIZE).into_drawing_area(), rows, bare_fft_ms).map_err(|e| failed(&svg, &e))?;
    let png = folder.join("bench.png");
    front(&BitMapBackend::new(&png, SIZE).into_drawing_area(), rows, bare_fft_ms).map_err(|e| failed(&png, &e))
}

fn failed(path: &Path, error: &dyn std::error::Error) -> CommandError {
    CommandError::File { path: path.to_owned(), source: std::io::Error::other(error.to_string()) }
}

fn front<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    rows: &[Row],
    bare_fft_ms: f64,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let scratch: Vec<&Row> = rows.iter().filter(|r| r.task == "scratch" && r.signal_error > 0.0).collect();
    let times = scratch.iter().map(|r| r.median_ms);
    let (low, high) = times.fold((f64::INFINITY, 0.0f64), |(a, b), t| (a.min(t), b.max(t)));
    let mut chart = ChartBuilder::on(area)
        .caption("Three Lambda maps from scratch: run time against error", ("sans-serif", 22))
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(64)
        .build_cartesian_2d((1e-16f64..1e-2).log_scale(), (low / 1.5..high * 1.5).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("largest error of a sample, relative to the peak")
        .y_desc("median time, ms")
        .x_label_formatter(&|v| format!("{v:.0e}"))
        .y_label_formatter(&|v| format!("{v}"))
        .draw()?;
    chart
        .draw_series(LineSeries::new([(1e-16, bare_fft_ms), (1e-2, bare_fft_ms)], BLACK.mix(0.4)))?
        .label("bare 2-D transform, one thread")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLACK.mix(0.4)));
    let mut counts: Vec<usize> = scratch.iter().map(|r| r.reflectors).collect();
    counts.sort_unstable();
    counts.dedup();
    for algorithm in ["plan", "split", "gridded", "exact", "direct"] {
        let colour = match algorithm {
            "plan" => RGBColor(0, 0, 0),
            "split" => RGBColor(30, 100, 200),
            "gridded" => RGBColor(210, 90, 20),
            "exact" => RGBColor(40, 140, 60),
            _ => RGBColor(150, 60, 160),
        };
        let of_algorithm = scratch.iter().filter(|r| r.algorithm == algorithm);
        // The planner's choices are rings around the algorithm it chose; size grows with the number of reflectors.
        let points = of_algorithm.map(|r| {
            let rank = counts.iter().position(|c| *c == r.reflectors).unwrap_or(0) as i32;
            let (size, style) =
                if algorithm == "plan" { (rank + 6, colour.stroke_width(1)) } else { (rank + 2, colour.filled()) };
            Circle::new((r.signal_error.max(1e-16), r.median_ms), size, style)
        });
        chart.draw_series(points)?.label(algorithm).legend(move |(x, y)| Circle::new((x + 9, y), 4, colour.filled()));
    }
    let label = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    chart.draw_series(std::iter::once(Text::new(
        format!("larger dots: more reflectors ({label})"),
        (2e-16, high * 1.2),
        ("sans-serif", 14).into_font(),
    )))?;
    chart.configure_series_labels().background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.3)).draw()?;
    area.present()
}
