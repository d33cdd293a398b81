//! `apertura bench --growth`: how the time from scratch grows with the number of reflectors.

use super::measured::measured;
use crate::benchmark::front::{Entrant, Front, FrontRequest, FrontRow, FrontTask};
use crate::commands::figure::{Drawing, DrawingResult, save, tick};
use crate::commands::{CommandError, print};
use crate::files::write_bytes;
use crate::radar::counted;
use crate::signal::Precision;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

const COUNTS: [usize; 9] = [1, 3, 10, 30, 100, 300, 1000, 3000, 10_000];
const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-12];
const COLOURS: [RGBColor; 3] = [RGBColor(40, 140, 60), RGBColor(30, 100, 200), RGBColor(210, 90, 20)];

/// Measures, prints, and draws `growth.svg`, `growth.png` and `growth.json` into `output`.
pub fn run(repeats: usize, json: bool, output: Option<&Path>) -> Result<(), CommandError> {
    let request = FrontRequest {
        reflectors: COUNTS.to_vec(),
        tolerances: TOLERANCES.to_vec(),
        entrants: vec![Entrant::Planned],
        tasks: vec![FrontTask::Scratch],
        repeats,
    };
    let growth = Growth { front: measured(&request)? };
    let text = serde_json::to_string_pretty(&growth.front).map_err(CommandError::failed)?;
    if let Some(folder) = output {
        save(&growth, folder, "growth")?;
        let path = folder.join("growth.json");
        write_bytes(&path, text.as_bytes()).map_err(|source| CommandError::File { path, source })?;
    }
    if json { print(&text) } else { growth.print() }
}

struct Growth {
    front: Front,
}

impl Growth {
    /// The rows of one tolerance.
    fn rows(&self, tolerance: f64) -> Vec<&FrontRow> {
        self.front.rows.iter().filter(|r| r.tolerance == tolerance).collect()
    }

    fn print(&self) -> Result<(), CommandError> {
        print(&format!(
            "three maps from scratch on {}, {}; bare transform {:.3} ms\n{:>10} {:>9} {:11} {:4} {:>10} {:>14} {:>8}",
            counted(self.front.threads, "thread", "threads"),
            self.front.simd,
            self.front.bare_fft_ms,
            "reflectors",
            "tolerance",
            "algorithm",
            "",
            "median ms",
            "us a reflector",
            "signal"
        ))?;
        for tolerance in TOLERANCES {
            for r in self.rows(tolerance) {
                let each = 1e3 * r.median_ms / r.reflectors as f64;
                print(&format!(
                    "{:>10} {:>9.0e} {:11} {:4} {:>10.3} {each:>14.2} {:>8.1e}",
                    r.reflectors, r.tolerance, r.chosen, r.precision, r.median_ms, r.signal_error
                ))?;
            }
        }
        Ok(())
    }
}

impl Drawing for Growth {
    fn size(&self) -> (u32, u32) {
        (1000, 640)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let times = self.front.rows.iter().map(|r| r.median_ms);
        let (low, high) = times.fold((f64::INFINITY, 0.0f64), |(a, b), t| (a.min(t), b.max(t)));
        let most = COUNTS[COUNTS.len() - 1] as f64;
        let mut chart = ChartBuilder::on(area)
            .caption(
                "Three Lambda maps from scratch: time over reflectors (rings: f32, discs: f64)",
                ("sans-serif", 22),
            )
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(64)
            .build_cartesian_2d((0.8..1.3 * most).log_scale(), (low / 1.5..high * 1.5).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("reflectors")
            .y_desc(format!("median time on {}, ms", counted(self.front.threads, "thread", "threads")))
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        for (tolerance, colour) in TOLERANCES.into_iter().zip(COLOURS) {
            let rows = self.rows(tolerance);
            let at = |r: &&FrontRow| (r.reflectors as f64, r.median_ms);
            chart
                .draw_series(LineSeries::new(rows.iter().map(at), colour.stroke_width(2)))?
                .label(format!("{tolerance:.0e}"))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
            // Rings are f32, discs f64.
            chart.draw_series(rows.iter().map(|r| {
                let style = if r.precision == Precision::F32 { colour.stroke_width(2) } else { colour.filled() };
                Circle::new(at(r), 6, style)
            }))?;
        }
        // What a straight line through the origin would look like, from the last point of the coarsest tolerance.
        if let Some(last) = self.rows(TOLERANCES[0]).last() {
            let each = last.median_ms / last.reflectors as f64;
            let from = low / 1.5 / each;
            chart
                .draw_series(LineSeries::new([(from, from * each), (most, most * each)], BLACK.mix(0.3)))?
                .label(format!("{:.2} us a reflector", 1e3 * each))
                .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLACK.mix(0.3)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    }
}
