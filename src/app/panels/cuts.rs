//! Range profile and angle cut of all maps through the cursor.

use crate::app::state::{Command, Cursor, MapKind};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use eframe::egui;
use eframe::egui::{Color32, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints, VLine};

/// What is cut, and where.
pub struct Input<'a> {
    /// The radar.
    pub radar: &'a Radar,
    /// Where the cuts cross.
    pub cursor: Cursor,
    /// The maps that can be cut.
    pub maps: Vec<(MapKind, &'a RangeAngleMap)>,
}

/// Which way the cut goes.
#[derive(Clone, Copy, PartialEq)]
enum Cut {
    Angle,
    Range,
}

/// Draws the panel: angle cut above (or left), range profile below (or right).
pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    // Where there is little room a legend inside the plot would cover it.
    let roomy = ui.available_height() > 320.0;
    if !roomy {
        ui.horizontal(|ui| {
            ui.add_space(8.0);
            for (kind, _) in &input.maps {
                ui.colored_label(colour(*kind), kind.title());
            }
        });
    }
    let size = ui.available_size();
    let wide = size.x > 1.6 * size.y;
    let half = if wide { egui::vec2(size.x / 2.0 - 4.0, size.y) } else { egui::vec2(size.x, size.y / 2.0 - 4.0) };
    let both = |ui: &mut Ui| {
        for cut in [Cut::Angle, Cut::Range] {
            ui.allocate_ui(half, |ui| draw(ui, &input, cut, roomy));
        }
    };
    if wide {
        ui.horizontal(both).inner
    } else {
        ui.vertical(both).inner
    }
    Vec::new()
}

fn colour(kind: MapKind) -> Color32 {
    match kind {
        MapKind::Input0 => Color32::from_rgb(64, 156, 255),
        MapKind::Input1 => Color32::from_rgb(240, 96, 128),
        MapKind::Target => Color32::from_rgb(140, 150, 165),
        _ => Color32::from_rgb(255, 170, 40),
    }
}

fn draw(ui: &mut Ui, input: &Input<'_>, cut: Cut, legend: bool) {
    let (radar, cursor) = (input.radar, &input.cursor);
    let Some((bin, column)) = cursor.cell(radar) else { return };
    let (title, at, low, high) = match cut {
        Cut::Angle => {
            let title = format!("cos θ, at range {:.2} m", radar.range_of_bin_metres(bin as f64));
            (title, radar.cos_of_column(cursor.column), -1.0, 1.0)
        }
        Cut::Range => {
            let title = format!("range in m, at cos θ {:.3}", radar.cos_of_column(column as f64));
            (title, cursor.range_metres, 0.0, radar.max_range_metres())
        }
    };
    let mut plot = Plot::new(("cut", cut == Cut::Angle))
        .x_axis_label(title)
        .y_axis_label("Λ")
        .default_x_bounds(low, high)
        .default_y_bounds(0.0, 1.05)
        .allow_scroll(false)
        .y_axis_min_width(28.0);
    if cut == Cut::Angle && legend {
        plot = plot.legend(Legend::default().background_alpha(0.7));
    }
    plot.show(ui, |plot| {
        for (kind, map) in &input.maps {
            // The radar may have changed since the map was made.
            let (rows, columns) = map.lambda.dim();
            let points: PlotPoints<'_> = match cut {
                Cut::Angle if bin < rows => {
                    let cells = map.lambda.row(bin);
                    cells.iter().enumerate().map(|(k, v)| [radar.cos_of_column(k as f64), f64::from(*v)]).collect()
                }
                Cut::Range if column < columns => {
                    let cells = map.lambda.column(column);
                    let place = |k: usize| radar.range_of_bin_metres(k as f64);
                    cells.iter().enumerate().map(|(k, v)| [place(k), f64::from(*v)]).collect()
                }
                _ => continue,
            };
            plot.line(Line::new(kind.title(), points).color(colour(*kind)).width(1.4));
        }
        plot.vline(VLine::new("cursor", at).color(Color32::GRAY).width(1.0));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use ndarray::Array2;

    #[test]
    fn maps_of_another_radar_are_left_out_and_nothing_is_asked() {
        let radar = Radar::default();
        let map = |rows, columns| RangeAngleMap { lambda: Array2::zeros((rows, columns)) };
        let (whole, small) = (map(radar.samples, radar.elements), map(8, 8));
        let draw = |ui: &mut Ui, asked: &mut Vec<Command>| {
            let maps = vec![(MapKind::Target, &whole), (MapKind::Output, &small)];
            asked.extend(show(ui, Input { radar: &radar, cursor: Cursor::at_cell(&radar, 300.0, 700.0), maps }));
        };
        let mut cuts = Harness::builder().with_size([300.0, 200.0]).build_ui_state(draw, Vec::new());
        cuts.step();
        let _named = cuts.get_by_label("Target");
        assert!(cuts.state().is_empty());
    }
}
