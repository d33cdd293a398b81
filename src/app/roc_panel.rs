//! Detection against false alarm of the scene on screen, over every threshold.

use super::application::App;
use eframe::egui::{Color32, Ui};
use egui_plot::{Line, Plot, PlotPoints, Points};

/// P_FA below this is drawn at this: a logarithmic axis has no zero.
const SMALLEST: f64 = 1e-5;

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(roc) = app.pipeline.result.as_ref().and_then(|r| r.roc.clone()) else {
        ui.centered_and_justified(|ui| ui.weak("No ROC: the target has no cell above 0.9."));
        return;
    };
    let log = |false_alarm: f64| false_alarm.max(SMALLEST).log10();
    let curve: PlotPoints<'_> = roc.iter().map(|p| [log(p.false_alarm), p.detection]).collect();
    let eta = app.output_eta();
    let now = roc.iter().min_by(|a, b| (a.eta - eta).abs().total_cmp(&(b.eta - eta).abs())).copied();
    let name = app.method().map_or("output", |m| m.name());
    Plot::new("roc")
        .x_axis_label("P_FA")
        .y_axis_label("P_D")
        .x_axis_formatter(|mark, _| power_of_ten(mark.value))
        .default_x_bounds(SMALLEST.log10(), 0.0)
        .default_y_bounds(0.0, 1.02)
        .y_axis_min_width(28.0)
        .allow_scroll(false)
        .show(ui, |plot| {
            plot.line(Line::new(name, curve).color(Color32::from_rgb(255, 170, 40)).width(1.8));
            if let Some(p) = now {
                let at = vec![[log(p.false_alarm), p.detection]];
                plot.points(
                    Points::new(format!("η = {eta:.2}"), at).radius(5.0).color(Color32::from_rgb(64, 156, 255)),
                );
            }
        });
}

fn power_of_ten(exponent: f64) -> String {
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    match exponent as i32 {
        0 => "100 %".to_owned(),
        -1 => "10 %".to_owned(),
        -2 => "1 %".to_owned(),
        -3 => "0.1 %".to_owned(),
        -4 => "0.01 %".to_owned(),
        _ => "≤0.001 %".to_owned(),
    }
}
