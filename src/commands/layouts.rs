//! `apertura layouts`: the two ends compared with as many elements at random places, and with other layouts.

use super::arguments::whole;
use super::figure::save;
use super::progress::ProgressArg;
use super::{CommandError, print, print_json};
use crate::bounds::{Lobes, cut, lobes};
use crate::evaluate::{Estimate, Roc, squared_error};
use crate::maps::LogMaps;
use crate::picture::{Drawing, Painted, PanelArea};
use crate::radar::{Layout, LayoutKind, Polar, Radar, counted};
use crate::reconstruct::{Request, layout_matched_filter};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::{Floor, simulate};
use ndarray::Axis;
use plotters::prelude::*;
use serde::Serialize;
use std::path::PathBuf;

/// Compare element layouts: side lobes of one reflector, and the squared error of the matched filter on random scenes
///
/// Every layout sees the same scenes over the same floor. The same near-field matched filter draws its map. A layout's elements must stand on the
/// radar's half-wavelength grid. P_D is at a false-alarm rate of 1 %.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "two-ends,random=24:0,random=24:1,random=64:0",
          help = format!("Layouts: {}", LayoutKind::NAMES))]
    layout: Vec<LayoutKind>,

    /// Scenes of each test set
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = whole(1..=10_000u32))]
    count: u32,

    #[command(flatten)]
    progress: ProgressArg,

    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,

    /// Folder for the cuts through the ambiguity functions, layouts.svg and layouts.png; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

const FALSE_ALARM_RATE: f64 = 0.01;

/// Place of the reflector whose side lobes are measured: 20 m ahead.
const REFLECTOR_PLACE: Polar = Polar { range_metres: 20.0, cos_theta: 0.0 };

const DRAWN_COLUMNS: f64 = 60.0;

#[derive(Debug, Serialize)]
struct Row {
    layout: String,
    elements: usize,
    lobes: Option<Lobes>,
    squared_error: Vec<Estimate>,
    detection: Vec<Option<f64>>,
    #[serde(skip)]
    cut: (Vec<f64>, Vec<f64>),
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let radar = Radar::default();
        let of = |kind: &LayoutKind| Ok((kind.layout(&radar)?, kind.numbers(&radar)?));
        let layouts: Vec<(Layout, Vec<usize>)> =
            self.layout.iter().map(of).collect::<Result<_, String>>().map_err(CommandError)?;
        let mut rows: Vec<Row> = self.layout.iter().zip(&layouts).map(|(k, (l, _))| Row::new(&radar, k, l)).collect();
        let mut progress = self.progress.of(u64::from(self.count) * 3 * layouts.len() as u64, "maps");
        let generator = Generator::new(&radar, Reading::Program, Purpose::Test, 0);
        let request = Request::default();
        for kind in Kind::TEST_SETS {
            let mut errors = vec![Vec::new(); layouts.len()];
            let mut rocs = vec![Roc::default(); layouts.len()];
            for number in 0..self.count {
                let scene = generator.scene(kind, number);
                let signal = simulate(&radar, &scene, Floor::Thesis, scene.noise_seed)?;
                let target = LogMaps::of_signal(&radar, &signal).full.normalise(request.normalisation);
                for (i, (layout, numbers)) in layouts.iter().enumerate() {
                    let samples = signal.samples.select(Axis(0), numbers);
                    let map = layout_matched_filter(&radar, layout, samples.view(), &request)?;
                    errors[i].push(squared_error(&target, &map));
                    rocs[i].add(&target, &map);
                    progress.step(format_args!("now set {kind}, {}", self.layout[i]));
                }
            }
            for ((row, errors), roc) in rows.iter_mut().zip(&errors).zip(&rocs) {
                row.squared_error.push(Estimate::of(errors));
                row.detection.push(roc.at_false_alarm(FALSE_ALARM_RATE).map(|p| p.detection));
            }
        }
        progress.finish();
        if let Some(folder) = &self.output {
            save(&CutFigure { radar: &radar, rows: &rows }, folder, "layouts")?;
        }
        if self.json {
            return print_json(&rows);
        }
        print_table(&radar, self.count, &rows)
    }
}

fn print_table(radar: &Radar, count: u32, rows: &[Row]) -> Result<(), CommandError> {
    print(&format!(
        "{count} test scenes a set, matched filter; side lobes of a reflector 20 m ahead\n\
         {:12} {:>8} {:>14} {:>14} {:>13} {:>24} {:>22}",
        "layout", "elements", "side lobe, dB", "at, columns", "rms side, dB", "SE, set 1 / 2 / 3", "P_D % at P_FA 1 %"
    ))?;
    let db = |v: f64| 20.0 * v.max(1e-9).log10();
    for r in rows {
        let errors: Vec<String> = r.squared_error.iter().map(|e| format!("{:.0}", e.mean)).collect();
        let rates: Vec<String> =
            r.detection.iter().map(|d| d.map_or("-".to_owned(), |d| format!("{:.1}", 100.0 * d))).collect();
        let lobes = r.lobes.map_or_else(String::new, |l| {
            let columns = l.highest_side_lobe_offset * radar.elements as f64 / 2.0;
            format!("{:>14.2} {columns:>14.2} {:>13.2}", db(l.highest_side_lobe), db(l.side_lobe_rms))
        });
        let (layout, elements, errors, rates) = (&r.layout, r.elements, errors.join(" / "), rates.join(" / "));
        print(&format!("{layout:12} {elements:>8} {lobes:43} {errors:>24} {rates:>22}"))?;
    }
    Ok(())
}

impl Row {
    fn new(radar: &Radar, kind: &LayoutKind, layout: &Layout) -> Self {
        let cut = cut(radar, layout, REFLECTOR_PLACE, 8);
        Row {
            layout: kind.to_string(),
            elements: layout.len(),
            lobes: lobes(&cut.0, &cut.1, REFLECTOR_PLACE.cos_theta),
            squared_error: Vec::new(),
            detection: Vec::new(),
            cut,
        }
    }
}

/// Ambiguity function along cos(theta), a panel a layout (after thesis figures 1-2 and 1-3).
struct CutFigure<'a> {
    radar: &'a Radar,
    rows: &'a [Row],
}

impl Drawing for CutFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1000, 40 + 200 * self.rows.len().max(1) as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
        let area =
            area.margin(8, 0, 0, 0).titled("Which directions sound like a reflector 20 m ahead", ("sans-serif", 22))?;
        for (panel, row) in area.split_evenly((self.rows.len(), 1)).into_iter().zip(self.rows) {
            let mut chart = ChartBuilder::on(&panel)
                .caption(
                    format!("{} ({})", row.layout, counted(row.elements, "element", "elements")),
                    ("sans-serif", 15),
                )
                .margin(4)
                .margin_right(20)
                .x_label_area_size(34)
                .y_label_area_size(60)
                .build_cartesian_2d(-DRAWN_COLUMNS..DRAWN_COLUMNS, -40f64..0.0)?;
            chart
                .configure_mesh()
                .x_desc("columns of the whole array's map")
                .y_desc("dB")
                .light_line_style(WHITE)
                .draw()?;
            let per_column = self.radar.elements as f64 / 2.0;
            let points = row.cut.0.iter().zip(&row.cut.1).map(|(cos, likeness)| {
                ((cos - REFLECTOR_PLACE.cos_theta) * per_column, (20.0 * likeness.max(1e-9).log10()).max(-40.0))
            });
            let drawn = points.filter(|(columns, _)| columns.abs() <= DRAWN_COLUMNS);
            chart.draw_series(LineSeries::new(drawn, RGBColor(30, 100, 200)))?;
        }
        Ok(())
    }
}
