//! What each stage of the last update cost, and what was skipped and why.

use super::application::App;
use crate::engine::Outcome;
use eframe::egui;
use eframe::egui::{Grid, ScrollArea, Ui};

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(result) = &app.pipeline.result else {
        ui.weak("No update yet.");
        return;
    };
    egui::Frame::NONE.inner_margin(8).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("stages").num_columns(3).striped(true).show(ui, |ui| {
                ui.strong("stage");
                ui.strong("ms");
                ui.strong("what");
                ui.end_row();
                for stage in &result.frame.report.stages {
                    ui.label(stage.stage.to_string());
                    match &stage.outcome {
                        Outcome::Computed(what) => {
                            ui.monospace(format!("{:.2}", stage.took.as_secs_f64() * 1e3));
                            ui.label(what);
                        }
                        Outcome::Skipped(why) => {
                            ui.weak("–");
                            ui.weak(format!("skipped: {why}"));
                        }
                    }
                    ui.end_row();
                }
                ui.label("engine");
                ui.monospace(format!("{:.2}", result.frame.report.total.as_secs_f64() * 1e3));
                ui.end_row();
                ui.label("with pictures");
                ui.monospace(format!("{:.2}", result.took.as_secs_f64() * 1e3));
                ui.label(format!("{} pictures painted since the start", result.painted));
                ui.end_row();
                if let Some(output) = &app.pipeline.output {
                    ui.label(output.method);
                    ui.monospace(format!("{:.2}", output.took.as_secs_f64() * 1e3));
                    ui.label(if app.pipeline.output_is_stale() {
                        "of an earlier scene"
                    } else {
                        "on a thread of its own"
                    });
                    ui.end_row();
                }
            });
        });
    });
}
