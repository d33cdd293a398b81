//! The report of `apertura bounds`.

use crate::bounds::{Lobes, PositionBound};
use crate::commands::{CommandError, print};
use crate::evaluate::Placement;
use crate::radar::{Radar, counted};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub struct BoundsReport {
    pub x_metres: f64,
    pub y_metres: f64,
    pub apart_columns: f64,
    pub layouts: Vec<LayoutReport>,
    /// The Newton search on the two ends.
    pub monte_carlo: Vec<Placement>,
}

#[derive(Debug, Serialize)]
pub struct LayoutReport {
    pub layout: String,
    pub elements: usize,
    pub lobes: Option<Lobes>,
    pub bounds: Vec<BoundRow>,
}

/// Bounds at one signal-to-noise ratio; `None` where the samples don't determine the positions.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct BoundRow {
    pub snr_db: f64,
    pub alone: Option<Bound>,
    pub beside_another: Option<Bound>,
    /// The bound of the reflector alone, with one unknown complex gain for either half of the layout, where that was asked for.
    pub gain_per_end: Option<Bound>,
}

/// Least standard deviations of any unbiased estimate.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Bound {
    pub range_millimetres: f64,
    pub columns: f64,
    pub position_millimetres: f64,
    /// Of the reflector's amplitude, decibels.
    pub amplitude_db: f64,
}

/// cos(theta) from one column of the whole array's map to the next.
pub fn columns_to_cos(radar: &Radar) -> f64 {
    (radar.cos_of_column(1.0) - radar.cos_of_column(0.0)).abs()
}

impl Bound {
    pub fn of(radar: &Radar, bound: &PositionBound) -> Self {
        Bound {
            range_millimetres: 1e3 * bound.range_metres,
            columns: bound.cos_theta / columns_to_cos(radar),
            position_millimetres: 1e3 * bound.position_metres(),
            amplitude_db: bound.amplitude_db(),
        }
    }
}

const HEADINGS: &str = " range, mm    columns position, mm amplitude, dB";

fn cells(bound: Option<Bound>) -> String {
    match bound {
        Some(b) => format!(
            "{:>10.4} {:>10.5} {:>12.4} {:>13.4}",
            b.range_millimetres, b.columns, b.position_millimetres, b.amplitude_db
        ),
        None => format!("{:>10} {:>10} {:>12} {:>13}", "-", "-", "-", "-"),
    }
}

impl BoundsReport {
    pub fn print(&self) -> Result<(), CommandError> {
        let (x, y, apart) = (self.x_metres, self.y_metres, counted(self.apart_columns, "column", "columns"));
        print(&format!("One reflector at ({x}, {y}) m, and another {apart} beside it"))?;
        print(&format!(
            "\n{:12} {:>8} {:>16} {:>18} {:>16} {:>16}",
            "ambiguity", "elements", "main lobe, cols", "side lobe, dB", "at, columns", "rms side, dB"
        ))?;
        let column = columns_to_cos(&Radar::default());
        let db = |v: f64| 20.0 * v.max(1e-9).log10();
        for (LayoutReport { layout, elements, .. }, lobes) in self.layouts.iter().filter_map(|l| Some((l, l.lobes?))) {
            let [main, offset] = [lobes.main_lobe_cos, lobes.highest_side_lobe_offset].map(|cos| cos / column);
            let [highest, rms] = [lobes.highest_side_lobe, lobes.side_lobe_rms].map(db);
            print(&format!("{layout:12} {elements:>8} {main:>16.2} {highest:>18.2} {offset:>16.2} {rms:>16.2}"))?;
        }
        print(&format!("\n{:12} {:>7} | {HEADINGS} | {HEADINGS}", "bound", "SNR, dB"))?;
        let rows = || self.layouts.iter().flat_map(|l| l.bounds.iter().map(move |b| (&l.layout, b)));
        for (layout, b) in rows() {
            print(&format!("{layout:12} {:>7} | {} | {}", b.snr_db, cells(b.alone), cells(b.beside_another)))?;
        }
        if rows().any(|(_, b)| b.gain_per_end.is_some()) {
            print("\nAlone, with one unknown complex gain for either half of the layout")?;
            print(&format!("{:12} {:>7} | {HEADINGS}", "bound", "SNR, dB"))?;
            for (layout, b) in rows() {
                print(&format!("{layout:12} {:>7} | {}", b.snr_db, cells(b.gain_per_end)))?;
            }
        }
        print("\nNo unbiased estimator has smaller standard deviations. One that knows scenes beforehand may.")?;
        self.print_monte_carlo()
    }

    fn print_monte_carlo(&self) -> Result<(), CommandError> {
        if !self.monte_carlo.is_empty() {
            print(&format!(
                "\n{:7} {:>9} {:>10} {:>10} {:>13} {:>11} {:>11}",
                "SNR, dB", "trials", "bound, mm", "error, mm", "error / bound", "other tooth", "miscounted"
            ))?;
        }
        for p in &self.monte_carlo {
            let Placement { snr_db, trials, off_by_a_tooth, miscounted, .. } = p;
            let (bound, error, ratio) = (1e3 * p.bound_metres, 1e3 * p.error_metres, p.ratio());
            print(&format!(
                "{snr_db:7} {trials:>9} {bound:>10.4} {error:>10.4} {ratio:>13.3} {off_by_a_tooth:>11} {miscounted:>11}"
            ))?;
        }
        Ok(())
    }
}
