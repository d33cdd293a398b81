//! `apertura bench --bodies`: times of scenes of bodies, and their growth with the number of bodies.

use crate::benchmark::bodies::{self, BodyCase, BodyRow, BodyTimes};
use crate::benchmark::front::MapConvention;
use crate::commands::figure::{save, save_numbers};
use crate::commands::line_chart::{ChartAxis, ChartLine, LineChart, span, widened};
use crate::commands::progress::ProgressArg;
use crate::commands::{CommandError, print, print_json};
use crate::radar::{Radar, counted};
use plotters::prelude::{RGBColor, SeriesLabelPosition};
use std::path::Path;

const BODY_COUNTS: [usize; 6] = [3, 10, 30, 100, 300, 1000];

/// Measures, prints, and draws `bodies.svg`, the same as PNG, and `bodies.json` into `output`.
pub fn run(repeats: usize, told: ProgressArg, json: bool, output: Option<&Path>) -> Result<(), CommandError> {
    let cases: Vec<BodyCase> = BodyCase::street()
        .into_iter()
        .chain(BODY_COUNTS.map(BodyCase::crowd))
        .chain(BODY_COUNTS.map(BodyCase::points))
        .collect();
    let mut progress = told.of(cases.len() as u64 * MapConvention::BOTH.len() as u64, "times");
    let on_row = |row: &BodyRow| {
        progress.step(format_args!("the last {} of {}", row.scene, counted(row.objects, "object", "objects")));
    };
    let times = bodies::measure(&Radar::default(), &cases, repeats, on_row)?;
    progress.finish();
    if let Some(folder) = output {
        save(&chart(&times), folder, "bodies")?;
        save_numbers(&times, folder, "bodies")?;
    }
    if json {
        return print_json(&times);
    }
    print(&heading(&times))?;
    times.rows.iter().try_for_each(|row| print(&line(row, times.bare_fft_ms)))
}

fn heading(times: &BodyTimes) -> String {
    let threads = counted(times.threads, "thread", "threads");
    format!(
        "three maps on {threads}, {}; in brackets multiples of the bare transform on one thread, {:.3} ms in this run\n\
         scene    objects echoes  drawn by             from scratch, ms      one dragged, ms  computed for a move",
        times.simd, times.bare_fft_ms
    )
}

fn line(row: &BodyRow, bare_fft_ms: f64) -> String {
    let time = |ms: f64| format!("{ms:.3} ({:.1})", ms / bare_fft_ms);
    let (convention, scratch, drag) = (row.convention.to_string(), time(row.scratch_ms), time(row.drag_ms));
    format!(
        "{:8} {:>7} {:>6}  {convention:16} {scratch:>20} {drag:>20}  {}",
        row.scene, row.objects, row.echoes, row.computed
    )
}

fn chart(times: &BodyTimes) -> LineChart {
    let line = |scene: &str, time: fn(&BodyRow) -> f64, colour: RGBColor, name: &str| {
        let rows = times.rows.iter().filter(|r| r.scene == scene && r.convention == MapConvention::FIXED_RANGE);
        let points = rows.map(|r| (r.objects as f64, time(r) / times.bare_fft_ms));
        ChartLine { dot: 5, ..ChartLine::new(colour, points).named(name) }
    };
    let lines = vec![
        line("crowd", |r| r.scratch_ms, RGBColor(210, 90, 20), "bodies from scratch"),
        line("crowd", |r| r.drag_ms, RGBColor(30, 100, 200), "one body dragged"),
        line("points", |r| r.scratch_ms, RGBColor(235, 175, 130), "points from scratch"),
        line("points", |r| r.drag_ms, RGBColor(150, 185, 230), "one point dragged"),
    ];
    let all = lines.iter().flat_map(|line| &line.points).map(|(_, time)| *time);
    LineChart {
        caption: "Three Lambda maps of a crowd of bodies: time over their number".to_owned(),
        size: (1000, 640),
        x: ChartAxis::new("objects", widened(BODY_COUNTS[0] as f64..BODY_COUNTS[BODY_COUNTS.len() - 1] as f64, 1.3)),
        is_x_log: true,
        y: ChartAxis::new("median time, bare transforms", widened(span(all), 1.5)),
        legend: SeriesLabelPosition::UpperLeft,
        lines,
    }
}
