//! Detection against false alarm of the scene on screen, over every threshold.

use crate::app::state::Command;
use crate::evaluate::RocPoint;
use eframe::egui::{Color32, Ui};
use egui_plot::{Line, Plot, PlotPoints, Points};

/// P_FA below this is drawn at this: a logarithmic axis has no zero.
const SMALLEST: f64 = 1e-5;

/// What is drawn.
pub struct Input<'a> {
    /// Every threshold's rates, if there are any.
    pub points: Option<&'a [RocPoint]>,
    /// The method whose output it is.
    pub method: &'a str,
    /// The threshold in use.
    pub eta: f32,
    /// Why there is no output.
    pub refusal: Option<&'a str>,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    let Some(roc) = input.points else {
        ui.centered_and_justified(|ui| ui.weak(input.refusal.unwrap_or("No ROC: the target has no cell above 0.9.")));
        return Vec::new();
    };
    let log = |false_alarm: f64| false_alarm.max(SMALLEST).log10();
    let curve: PlotPoints<'_> = roc.iter().map(|p| [log(p.false_alarm), p.detection]).collect();
    let eta = input.eta;
    let now = roc.iter().min_by(|a, b| (a.eta - eta).abs().total_cmp(&(b.eta - eta).abs())).copied();
    Plot::new("roc")
        .x_axis_label("P_FA")
        .y_axis_label("P_D")
        .x_axis_formatter(|mark, _| power_of_ten(mark.value))
        .default_x_bounds(SMALLEST.log10(), 0.0)
        .default_y_bounds(0.0, 1.02)
        .y_axis_min_width(28.0)
        .allow_scroll(false)
        .show(ui, |plot| {
            plot.line(Line::new(input.method, curve).color(Color32::from_rgb(255, 170, 40)).width(1.8));
            if let Some(p) = now {
                let at = vec![[log(p.false_alarm), p.detection]];
                plot.points(
                    Points::new(format!("η = {eta:.2}"), at).radius(5.0).color(Color32::from_rgb(64, 156, 255)),
                );
            }
        });
    Vec::new()
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

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_scene_without_a_characteristic_is_told() {
        let draw = |ui: &mut Ui, asked: &mut Vec<Command>| {
            asked.extend(show(ui, Input { points: None, method: "baseline", eta: 0.5, refusal: None }));
        };
        let roc = Harness::new_ui_state(draw, Vec::new());
        let _told = roc.get_by_label_contains("No ROC");
        assert!(roc.state().is_empty());
        assert_eq!((power_of_ten(-2.0), power_of_ten(-2.5)), ("1 %".to_owned(), String::new()));
    }
}
