//! `apertura bench --methods`: run time against squared error of every reconstruction method, and times of the searches on crowds.

use crate::commands::CommandError;
use crate::commands::figure::{save, save_numbers, tick};
use crate::commands::line_chart::{span, widened};
use crate::commands::{print, print_json};
use crate::evaluate::campaign::Campaign;
use crate::evaluate::sets::SceneSet;
use crate::evaluate::tables::Tally;
use crate::evaluate::trial::Trial;
use crate::evaluate::{Estimate, upper_median};
use crate::methods;
use crate::picture::{Drawing, Painted, PanelArea};
use crate::radar::{Radar, counted};
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::Floor;
use crate::task::Task;
use plotters::prelude::*;
use serde::Serialize;
use std::path::Path;

/// The time of a crowded scene depends on how close its reflectors are; a few scenes give no median.
const FEWEST_CROWDS: u32 = 20;

const SEARCHERS: [&str; 3] = ["hybrid", "iaa", "sbl"];

#[derive(Debug, Serialize)]
struct Report {
    threads: usize,
    scenes: u32,
    methods: Vec<MethodRow>,
    crowds: Vec<Crowd>,
}

#[derive(Debug, Serialize)]
struct MethodRow {
    method: &'static str,
    squared_error: [Estimate; 3],
    median_milliseconds: [f64; 3],
}

impl MethodRow {
    fn mean(&self) -> (f64, f64) {
        let error = self.squared_error.iter().map(|e| e.mean).sum::<f64>() / 3.0;
        (self.median_milliseconds.iter().sum::<f64>() / 3.0, error)
    }
}

#[derive(Debug, Clone, Serialize)]
struct Crowd {
    method: &'static str,
    reflectors: usize,
    what: &'static str,
    scenes: u32,
    median_milliseconds: f64,
    worst_milliseconds: f64,
    squared_error: Estimate,
}

/// Measures on `count` test scenes of each set, prints, and draws `methods.svg` and `methods.png` into `output`.
pub fn run(count: u32, json: bool, output: Option<&Path>) -> Result<(), CommandError> {
    let all = methods::all();
    let crowds = count.max(FEWEST_CROWDS);
    let of_crowds = 2 * u64::from(crowds) * SEARCHERS.len() as u64;
    let maps = 3 * u64::from(count) * all.len() as u64 + of_crowds;
    let bar = indicatif::ProgressBar::new(maps);
    let report = Report {
        threads: rayon::current_num_threads(),
        scenes: count,
        methods: method_rows(count, &all.iter().map(AsRef::as_ref).collect::<Vec<_>>(), || bar.inc(1))?,
        crowds: [
            crowds_of(crowds, Kind::Points(10), 10, "points", || bar.inc(1))?,
            crowds_of(crowds, Kind::Mixed(4), 300, "four lines of 75", || bar.inc(1))?,
        ]
        .concat(),
    };
    bar.finish_and_clear();
    if let Some(folder) = output {
        save(&report, folder, "methods")?;
        save_numbers(&report, folder, "methods")?;
    }
    if json {
        return print_json(&report);
    }
    let scenes = counted(count, "test scene a set", "test scenes a set");
    print(&format!("{scenes}, {}", counted(report.threads, "thread", "threads")))?;
    print(&format!("{:26} {:>24} {:>24}", "method", "SE, set 1 / 2 / 3", "ms a map, set 1 / 2 / 3"))?;
    for row in &report.methods {
        let [a, b, c] = row.squared_error.map(|e| e.mean);
        let [t, u, v] = row.median_milliseconds;
        let errors = format!("{a:.0} / {b:.0} / {c:.0}");
        print(&format!("{:26} {errors:>24} {:>24}", row.method, format!("{t:.0} / {u:.0} / {v:.0}")))?;
    }
    for c in &report.crowds {
        let Crowd { method, reflectors, what, median_milliseconds, worst_milliseconds, squared_error, .. } = c;
        let Estimate { mean, standard_error, .. } = squared_error;
        let scenes = counted(c.scenes, "scene", "scenes");
        print(&format!(
            "{method}, {reflectors} reflectors ({what}): {median_milliseconds:.0} ms a map, {worst_milliseconds:.0} ms at worst, SE {mean:.0} ± \
             {standard_error:.0} ({scenes})"
        ))?;
    }
    Ok(())
}

fn method_rows(count: u32, methods: &[&dyn Reconstructor], on_map: impl Fn()) -> Result<Vec<MethodRow>, CommandError> {
    let campaign = Campaign { count, ..Campaign::default() };
    let sets = Kind::TEST_SETS.map(SceneSet::Generated);
    let rows = campaign.run(&sets, methods, &Task::default(), |_| on_map())?;
    let row = |method: &&dyn Reconstructor| {
        let tally = |set: &SceneSet| {
            let set = set.to_string();
            Tally::of(rows.iter().filter(|row| row.method == method.name() && *row.set == *set))
        };
        let tallies = sets.each_ref().map(tally);
        MethodRow {
            method: method.name(),
            squared_error: tallies.each_ref().map(Tally::squared_error),
            median_milliseconds: tallies.each_ref().map(Tally::median_milliseconds),
        }
    };
    Ok(methods.iter().map(row).collect())
}

fn crowds_of(
    count: u32,
    kind: Kind,
    reflectors: usize,
    what: &'static str,
    on_map: impl Fn(),
) -> Result<Vec<Crowd>, CommandError> {
    let methods = SEARCHERS.map(methods::by_name).into_iter().collect::<Result<Vec<_>, _>>()?;
    let (radar, request) = (Radar::default(), Request::default());
    let generator = Generator::new(&radar, Reading::Program, Purpose::Test, 0);
    let scenes = (0..).map(|number| generator.scene(kind, number)).filter(|s| s.reflector_count() == reflectors);
    let mut times = vec![Vec::new(); methods.len()];
    let mut errors = vec![Vec::new(); methods.len()];
    for (number, scene) in scenes.take(count as usize).enumerate() {
        let trial = Trial::new(&radar, &scene, Floor::Thesis, request.normalisation)?;
        for (method, (times, errors)) in methods.iter().zip(times.iter_mut().zip(&mut errors)) {
            if number == 0 {
                // The method is warmed up here, as the methods above were.
                trial.ask(&**method, &request)?;
            }
            let answer = trial.ask(&**method, &request)?;
            times.push(answer.milliseconds);
            errors.push(answer.metrics.squared_error);
            on_map();
        }
    }
    let crowd = |method: usize| Crowd {
        method: methods[method].name(),
        reflectors,
        what,
        scenes: count,
        worst_milliseconds: times[method].iter().copied().fold(0.0, f64::max),
        median_milliseconds: upper_median(times[method].clone()).unwrap_or_default(),
        squared_error: Estimate::of(&errors[method]),
    };
    Ok((0..methods.len()).map(crowd).collect())
}

const LABEL: i32 = 15;

#[derive(Clone, Copy)]
struct Spot {
    x: i32,
    y: i32,
    width: i32,
}

impl Spot {
    fn overlaps(&self, other: &Spot) -> bool {
        let across = self.x < other.x + other.width && other.x < self.x + self.width;
        across && (self.y - other.y).abs() < LABEL
    }
}

impl Drawing for Report {
    fn size(&self) -> (u32, u32) {
        (1000, 640)
    }

    fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
        let dots: Vec<(f64, f64)> = self.methods.iter().map(MethodRow::mean).collect();
        let times = widened(span(dots.iter().map(|d| d.0)), 1.7);
        let errors = widened(span(dots.iter().map(|d| d.1)), 1.7);
        let mut chart = ChartBuilder::on(area)
            .caption("Reconstruction from the two ends: run time against error", ("sans-serif", 22))
            .margin(14)
            .margin_right(40)
            .x_label_area_size(46)
            .y_label_area_size(70)
            // Room on the right for the names of the slowest.
            .build_cartesian_2d((times.start..times.end * 3.0).log_scale(), errors.log_scale())?;
        chart
            .configure_mesh()
            .x_desc(format!("median time of a map on {}, ms", counted(self.threads, "thread", "threads")))
            .y_desc(format!("SE, mean over the three test sets ({} each)", counted(self.scenes, "scene", "scenes")))
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .draw()?;
        let rows: Vec<(&str, (f64, f64))> = self.methods.iter().map(|m| m.method).zip(dots).collect();
        let places: Vec<(i32, i32)> = rows.iter().map(|(_, dot)| chart.backend_coord(dot)).collect();
        let top = chart.plotting_area().get_pixel_range().1.start;
        // Names stand beside their dots, moved up or down, with a line to the dot, where they would cover a name, a dot or the title.
        let mut taken: Vec<Spot> = places.iter().map(|(x, y)| Spot { x: x - 6, y: y - LABEL / 2, width: 12 }).collect();
        for (i, ((name, dot), (x, y))) in rows.iter().zip(&places).enumerate() {
            let hue = HSLColor(i as f64 / rows.len() as f64, 0.75, 0.4);
            let beside = Spot { x: x + 10, y: y - LABEL / 2, width: 8 * name.len() as i32 };
            let steps = (0..40).map(|k| if k % 2 == 0 { k / 2 } else { -(k + 1) / 2 });
            let moved = steps.map(|k| Spot { y: beside.y + k * LABEL, ..beside });
            let spot = moved.into_iter().find(|s| s.y >= top && !taken.iter().any(|t| t.overlaps(s))).unwrap_or(beside);
            if spot.y != beside.y {
                let line = vec![(*x, *y), (spot.x - 2, spot.y + LABEL / 2)];
                area.draw(&PathElement::new(line, BLACK.mix(0.35)))?;
            }
            chart.draw_series([Circle::new(*dot, 5, hue.filled())])?;
            area.draw(&Text::new(*name, (spot.x, spot.y), ("sans-serif", 14).into_font().color(&BLACK.mix(0.85))))?;
            taken.push(spot);
        }
        Ok(())
    }
}
