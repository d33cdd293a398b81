//! `apertura bounds`: the Cramer-Rao bound and the ambiguity function of any element layout.

mod chart;
mod report;

use super::arguments::{decibels, usable, whole};
use super::figure::{save, save_bitmap, save_numbers};
use super::progress::ProgressArg;
use super::{CommandError, print_json};
use crate::bounds::{Ambiguity, Gains, PositionBound, ambiguity, cramer_rao_of, cut, lobes, noise_variance};
use crate::evaluate::{Placement, placement};
use crate::radar::{Decibels, Layout, LayoutKind, Polar, Radar};
use crate::reconstruct::ReconstructError;
use crate::scene::Reflector;
use crate::task::Task;
use chart::{AmbiguityFigure, of_bounds, of_placement};
use report::{Bound, BoundRow, BoundsReport, LayoutReport, columns_to_cos};
use std::path::PathBuf;

/// Bound the error of any unbiased position estimate, and show which places are nearly indistinguishable, for several element layouts
///
/// Prints the Cramer-Rao bound of one reflector's place and amplitude, alone and with a second reflector beside it. Prints the lobes of the
/// ambiguity function along cos(theta). Angles are in columns of the whole array's map, 1/512 of cos(theta). With -o DIR draws the bound to
/// bounds.svg and the ambiguity function over range and cos(theta) to ambiguity.png, and writes all numbers to bounds.json. With
/// --monte-carlo also draws the errors of the Newton search to monte-carlo.svg.
///
/// That file and --json are one object: x_metres, y_metres (the reflector), apart_columns (from there to the second), layouts, each with
/// layout (its name), elements, lobes (null where there are none; main_lobe_cos, highest_side_lobe and side_lobe_rms relative to the
/// main lobe's peak, highest_side_lobe_offset in cos(theta)) and bounds, one a ratio: snr_db, alone and beside_another (null where
/// the samples don't determine the positions; range_millimetres, columns, position_millimetres: standard deviations); and monte_carlo, one
/// a ratio: snr_db, bound_metres, error_metres and near_error_metres (root mean square; the second without draws on another tooth; null where
/// no draw counts), trials, miscounted, off_by_a_tooth (numbers of draws).
#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "two-ends,one-end,random=24,mimo=3x4,full",
          help = format!("Layouts: {}", LayoutKind::NAMES))]
    layout: Vec<LayoutKind>,

    /// Place of the reflector, metres along the array and ahead of it
    #[arg(long, value_name = "X,Y", default_value = "5,18", value_parser = place, allow_hyphen_values = true)]
    at: Reflector,

    /// Columns from the reflector to the second one, at the same range
    #[arg(long, value_name = "COLUMNS", default_value_t = 8.0, value_parser = apart, allow_hyphen_values = true)]
    apart: f64,

    /// Signal-to-noise ratios a sample, dB
    #[arg(long, value_name = "DB,..", value_delimiter = ',', default_value = "-10,-5,0,5,10,20,30,40", value_parser = decibels,
          allow_hyphen_values = true)]
    snr: Vec<Decibels>,

    /// Also bound the error with unknown phase between the ends: one complex gain for each half of a layout
    #[arg(long)]
    gain_per_end: bool,

    /// Also run the Newton search on this many draws of noise at every ratio
    #[arg(long, value_name = "N", value_parser = whole(1..=100_000u64))]
    monte_carlo: Option<u64>,

    #[command(flatten)]
    progress: ProgressArg,

    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,

    /// Folder for the pictures and bounds.json; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

fn place(text: &str) -> Result<Reflector, String> {
    let expected = "expected X,Y in metres with Y above 0, as in 5,18";
    let (x, y) = text.split_once(',').ok_or(expected)?;
    let (x_metres, y_metres) = (usable(x, f64::is_finite, expected)?, usable(y, f64::is_finite, expected)?);
    if y_metres > 0.0 { Ok(Reflector { x_metres, y_metres, reflectivity: 1.0 }) } else { Err(expected.to_owned()) }
}

fn apart(text: &str) -> Result<f64, String> {
    usable(text, |columns| columns.is_finite() && columns != 0.0, "expected a number of columns other than 0")
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let radar = Radar::default();
        let reflector = self.at;
        let centre = radar.polar_of(reflector.x_metres, reflector.y_metres);
        let of = |kind: &LayoutKind| Ok((kind.clone(), kind.layout(&radar).map_err(CommandError)?));
        let layouts: Vec<(LayoutKind, Layout)> = self.layout.iter().map(of).collect::<Result<_, CommandError>>()?;
        let other = self.neighbour(&radar, centre)?;
        let report = BoundsReport {
            x_metres: reflector.x_metres,
            y_metres: reflector.y_metres,
            apart_columns: self.apart,
            layouts: layouts
                .iter()
                .map(|layout| self.layout_report(&radar, layout, reflector, other, centre))
                .collect(),
            monte_carlo: self.monte_carlo(&radar, reflector)?,
        };
        if let Some(folder) = &self.output {
            save(&of_bounds(&report), folder, "bounds")?;
            save_numbers(&report, folder, "bounds")?;
            let patches: Vec<(String, Ambiguity)> =
                layouts.iter().map(|(kind, layout)| (kind.to_string(), patch(&radar, layout, centre))).collect();
            save_bitmap(&AmbiguityFigure { radar: &radar, centre, patches: &patches }, folder, "ambiguity")?;
            if !report.monte_carlo.is_empty() {
                save(&of_placement(&report.monte_carlo), folder, "monte-carlo")?;
            }
        }
        if self.json { print_json(&report) } else { report.print() }
    }

    fn neighbour(&self, radar: &Radar, centre: Polar) -> Result<Reflector, CommandError> {
        let column = columns_to_cos(radar);
        let cos = centre.cos_theta + self.apart * column;
        if cos.abs() >= 1.0 {
            let [least, most] = [-1.0, 1.0].map(|end: f64| ((end - centre.cos_theta) / column).trunc());
            let columns = self.apart;
            return Err(CommandError(format!(
                "--apart {columns} puts the second reflector beyond the array's axis; expected columns from {least} to {most}"
            )));
        }
        Ok(Reflector {
            x_metres: centre.range_metres * cos,
            y_metres: centre.range_metres * (1.0 - cos * cos).sqrt(),
            reflectivity: 1.0,
        })
    }

    fn layout_report(
        &self,
        radar: &Radar,
        (kind, layout): &(LayoutKind, Layout),
        reflector: Reflector,
        other: Reflector,
        centre: Polar,
    ) -> LayoutReport {
        let bound = |reflectors: &[Reflector], snr, gains| {
            let variance = noise_variance(radar, layout, &reflector, snr);
            let of_first = |bounds: Vec<PositionBound>| bounds.first().map(|b| Bound::of(radar, b));
            cramer_rao_of(radar, layout, reflectors, variance, gains).ok().and_then(of_first)
        };
        let rows = self.snr.iter().map(|&snr| BoundRow {
            snr_db: snr.0,
            alone: bound(&[reflector], snr, Gains::One),
            beside_another: bound(&[reflector, other], snr, Gains::One),
            gain_per_end: if self.gain_per_end { bound(&[reflector], snr, Gains::PerEnd) } else { None },
        });
        let (cosines, likeness) = cut(radar, layout, centre, 4);
        LayoutReport {
            layout: kind.to_string(),
            elements: layout.len(),
            lobes: lobes(&cosines, &likeness, centre.cos_theta),
            bounds: rows.collect(),
        }
    }

    fn monte_carlo(&self, radar: &Radar, reflector: Reflector) -> Result<Vec<Placement>, CommandError> {
        let Some(trials) = self.monte_carlo else { return Ok(Vec::new()) };
        let mut progress = self.progress.of(self.snr.len() as u64, "ratios");
        let place = |snr: &Decibels| {
            let placed = placement(radar, reflector, *snr, trials, &Task::default());
            progress.step(format_args!("the last {snr}"));
            placed
        };
        let placed: Result<_, ReconstructError> = self.snr.iter().map(place).collect();
        progress.finish();
        Ok(placed?)
    }
}

/// The ambiguity function around `centre`: four range bins and sixteen columns to each side.
fn patch(radar: &Radar, layout: &Layout, centre: Polar) -> Ambiguity {
    let bin = radar.range_resolution_metres() / 8.0;
    let column = columns_to_cos(radar) / 8.0;
    let ranges: Vec<f64> = (-32..=32).map(|i| centre.range_metres + f64::from(i) * bin).collect();
    let cosines: Vec<f64> = (-128..=128).map(|i| centre.cos_theta + f64::from(i) * column).collect();
    ambiguity(radar, layout, centre, &ranges, &cosines)
}
