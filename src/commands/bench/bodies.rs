//! `apertura bench --bodies`: how long scenes of bodies take, how that grows with their number, and run time against error of a face.

use crate::benchmark::bodies::{self, BodyCase, BodyRow, BodyTimes};
use crate::benchmark::faces::{self, FaceFormula, FaceRow};
use crate::benchmark::front::MapConvention;
use crate::commands::figure::{DrawingResult, Plot, save, save_numbers, tick};
use crate::commands::{CommandError, print};
use crate::radar::{Radar, counted};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

const COLOURS: [RGBColor; 5] = [
    RGBColor(210, 90, 20),
    RGBColor(40, 140, 60),
    RGBColor(150, 185, 230),
    RGBColor(80, 130, 210),
    RGBColor(30, 70, 160),
];

const COUNTS: [usize; 6] = [3, 10, 30, 100, 300, 1000];

#[derive(serde::Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    times: &'a BodyTimes,
    faces: &'a [FaceRow],
}

/// Measures, prints, and draws `bodies.svg`, `faces.svg`, the same as PNG, and `bodies.json` into `output`.
pub fn run(repeats: usize, json: bool, output: Option<&Path>) -> Result<(), CommandError> {
    let cases: Vec<BodyCase> =
        BodyCase::street().into_iter().chain(COUNTS.map(BodyCase::crowd)).chain(COUNTS.map(BodyCase::points)).collect();
    let bar = indicatif::ProgressBar::new(cases.len() as u64 * MapConvention::BOTH.len() as u64);
    let times = bodies::measure(&Radar::default(), &cases, repeats, |_| bar.inc(1)).map_err(CommandError::failed)?;
    bar.finish_and_clear();
    let (chart, faces) = (Chart { times }, FaceChart { rows: faces::measure(&Radar::default()) });
    let report = Report { times: &chart.times, faces: &faces.rows };
    if let Some(folder) = output {
        save(&chart, folder, "bodies")?;
        save(&faces, folder, "faces")?;
        save_numbers(&report, folder, "bodies")?;
    }
    if json {
        return print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?);
    }
    print(&heading(&chart.times))?;
    chart.times.rows.iter().try_for_each(|row| print(&line(row, chart.times.bare_fft_ms)))?;
    print(
        "\none face: largest error of a sample over the largest sample, and time of an element's 32 samples on one thread",
    )?;
    faces.rows.iter().try_for_each(|row| print(&face_line(row)))
}

fn face_line(row: &FaceRow) -> String {
    format!("{:36} {:20} {:>9.1e} {:>10.1} us", row.face, row.way, row.error, row.microseconds)
}

fn heading(times: &BodyTimes) -> String {
    format!(
        "three maps on {}, {}; in brackets multiples of the bare transform on one thread, {:.3} ms in this run\n\
         {:8} {:>7} {:>6}  {:16} {:>20} {:>20}  {}",
        counted(times.threads, "thread", "threads"),
        times.simd,
        times.bare_fft_ms,
        "scene",
        "objects",
        "echoes",
        "drawn by",
        "from scratch, ms",
        "one dragged, ms",
        "computed for a move"
    )
}

fn line(row: &BodyRow, bare_fft_ms: f64) -> String {
    let time = |ms: f64| format!("{ms:.3} ({:.1})", ms / bare_fft_ms);
    format!(
        "{:8} {:>7} {:>6}  {:16} {:>20} {:>20}  {}",
        row.scene,
        row.objects,
        row.echoes,
        row.convention.to_string(),
        time(row.scratch_ms),
        time(row.drag_ms),
        row.computed
    )
}

struct Chart {
    times: BodyTimes,
}

type Line = (&'static str, RGBColor, Vec<(f64, f64)>);

impl Chart {
    fn lines(&self) -> Vec<Line> {
        let of = |scene: &'static str, time: fn(&BodyRow) -> f64| {
            let rows = self.times.rows.iter().filter(move |r| r.scene == scene);
            let rows = rows.filter(|r| r.convention == MapConvention::FIXED_RANGE);
            rows.map(|r| (r.objects as f64, time(r) / self.times.bare_fft_ms)).collect()
        };
        vec![
            ("bodies from scratch", RGBColor(210, 90, 20), of("crowd", |r| r.scratch_ms)),
            ("one body dragged", RGBColor(30, 100, 200), of("crowd", |r| r.drag_ms)),
            ("points from scratch", RGBColor(235, 175, 130), of("points", |r| r.scratch_ms)),
            ("one point dragged", RGBColor(150, 185, 230), of("points", |r| r.drag_ms)),
        ]
    }
}

impl Plot for Chart {
    fn size(&self) -> (u32, u32) {
        (1000, 640)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let lines = self.lines();
        let all = lines.iter().flat_map(|(.., line)| line.iter());
        let (low, high) = all.fold((f64::INFINITY, 0.0f64), |(a, b), (_, t)| (a.min(*t), b.max(*t)));
        let (from, to) = (COUNTS[0] as f64, COUNTS[COUNTS.len() - 1] as f64);
        let mut chart = ChartBuilder::on(area)
            .caption("Three Lambda maps of a crowd of bodies: time over their number", ("sans-serif", 22))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(64)
            .build_cartesian_2d((0.8 * from..1.3 * to).log_scale(), (low / 1.5..high * 1.5).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("objects")
            .y_desc("median time, bare transforms")
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        for (name, colour, line) in lines {
            chart
                .draw_series(LineSeries::new(line.iter().copied(), colour.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
            chart.draw_series(line.into_iter().map(|at| Circle::new(at, 5, colour.filled())))?;
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

struct FaceChart {
    rows: Vec<FaceRow>,
}

impl Plot for FaceChart {
    fn size(&self) -> (u32, u32) {
        (1000, 640)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B> {
        let span = |of: fn(&FaceRow) -> f64| {
            let (low, high) = self.rows.iter().map(of).fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
            (low.max(f64::MIN_POSITIVE) / 2.0..high * 2.0).log_scale()
        };
        let mut chart = ChartBuilder::on(area)
            .caption("A face's samples: run time against error, one mark a face", ("sans-serif", 22))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(74)
            .build_cartesian_2d(span(|r| r.microseconds), span(|r| r.error))?;
        chart
            .configure_mesh()
            .x_desc("time of an element's 32 samples, us")
            .y_desc("largest error over the largest sample")
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        for (i, way) in FaceFormula::ALL.iter().enumerate() {
            let (colour, name) = (COLOURS[i % COLOURS.len()], way.to_string());
            let rows: Vec<_> = self.rows.iter().filter(|r| r.way == name).map(|r| (r.microseconds, r.error)).collect();
            chart
                .draw_series(rows.into_iter().map(|at| Circle::new(at, 6, colour.filled())))?
                .label(name)
                .legend(move |(x, y)| Circle::new((x + 9, y), 5, colour.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    }
}
