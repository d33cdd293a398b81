//! Range profile and angle cut of all maps through the cursor.

use super::application::App;
use super::pictures::MapKind;
use super::view::Cursor;
use crate::maps::RangeAngleMap;
use eframe::egui;
use eframe::egui::{Color32, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints, VLine};
use std::sync::Arc;

/// Which way the cut goes.
#[derive(Clone, Copy, PartialEq)]
enum Cut {
    Angle,
    Range,
}

/// Draws the panel: angle cut above (or left), range profile below (or right).
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let place = app.cut_cursor();
    let maps = maps(app);
    // Where there is little room a legend inside the plot would cover it.
    let roomy = ui.available_height() > 320.0;
    if !roomy {
        ui.horizontal(|ui| {
            ui.add_space(8.0);
            for (kind, colour, _) in &maps {
                ui.colored_label(*colour, kind.title());
            }
        });
    }
    let size = ui.available_size();
    let wide = size.x > 1.6 * size.y;
    let half = if wide { egui::vec2(size.x / 2.0 - 4.0, size.y) } else { egui::vec2(size.x, size.y / 2.0 - 4.0) };
    let both = |ui: &mut Ui| {
        for cut in [Cut::Angle, Cut::Range] {
            ui.allocate_ui(half, |ui| draw(app, ui, cut, &maps, &place, roomy));
        }
    };
    if wide { ui.horizontal(both).inner } else { ui.vertical(both).inner }
}

/// The maps that can be cut, with their colours.
fn maps(app: &App) -> Vec<(MapKind, Color32, Arc<RangeAngleMap>)> {
    let Some(result) = &app.pipeline.result else { return Vec::new() };
    let frame = &result.frame;
    let lambda = |m: &Option<crate::engine::ReadyMap>| m.as_ref().map(|m| m.lambda.clone());
    [
        (MapKind::Input0, Color32::from_rgb(64, 156, 255), lambda(&frame.first)),
        (MapKind::Input1, Color32::from_rgb(240, 96, 128), lambda(&frame.last)),
        (MapKind::Target, Color32::from_rgb(140, 150, 165), lambda(&frame.full)),
        (MapKind::Output, Color32::from_rgb(255, 170, 40), app.pipeline.output.as_ref().map(|o| o.lambda.clone())),
    ]
    .into_iter()
    .filter_map(|(kind, colour, map)| Some((kind, colour, map?)))
    .collect()
}

fn draw(
    app: &App,
    ui: &mut Ui,
    cut: Cut,
    maps: &[(MapKind, Color32, Arc<RangeAngleMap>)],
    cursor: &Cursor,
    legend: bool,
) {
    let radar = &app.radar;
    let Some((bin, column)) = cursor.cell(radar) else { return };
    let (title, at, low, high) = match cut {
        Cut::Angle => {
            let title = format!("cos θ, at range {:.2} m", radar.range_of_bin_metres(bin as f64));
            (title, cursor.cos_theta, -1.0, 1.0)
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
        for (kind, colour, map) in maps {
            let points: PlotPoints<'_> = match cut {
                Cut::Angle => map
                    .lambda
                    .row(bin)
                    .iter()
                    .enumerate()
                    .map(|(k, v)| [radar.cos_of_column(k as f64), f64::from(*v)])
                    .collect(),
                Cut::Range => map
                    .lambda
                    .column(column)
                    .iter()
                    .enumerate()
                    .map(|(k, v)| [radar.range_of_bin_metres(k as f64), f64::from(*v)])
                    .collect(),
            };
            plot.line(Line::new(kind.title(), points).color(*colour).width(1.4));
        }
        plot.vline(VLine::new("cursor", at).color(Color32::GRAY).width(1.0));
    });
}
