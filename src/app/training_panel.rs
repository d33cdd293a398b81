//! A training watched: its loss, and how far it is.

use super::application::App;
use super::command::Command;
use super::jobs;
use super::training::EVERY;
use eframe::egui;
use eframe::egui::{Color32, Grid, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 6)).show(ui, |ui| {
        choices(app, ui);
        let training = &mut app.training;
        training.look();
        if training.path().is_some() {
            ui.request_repaint_after(EVERY);
        }
        if let Some(note) = &training.note {
            ui.colored_label(ui.visuals().warn_fg_color, note);
        }
        let Some(log) = training.log.as_ref().filter(|l| !l.loss.is_empty()) else {
            ui.weak(match training.path() {
                Some(path) => format!("Waiting for the first line of {}…", path.display()),
                None => "Open the log.csv of a run of `apertura train`, and watch its loss while it learns.".to_owned(),
            });
            return;
        };
        Grid::new("last").num_columns(8).spacing([10.0, 2.0]).show(ui, |ui| {
            for (i, (name, value)) in log.last.iter().enumerate() {
                ui.weak(name.replace('_', " "));
                ui.monospace(value.parse::<f64>().map_or_else(|_| value.clone(), short));
                if i % 4 == 3 {
                    ui.end_row();
                }
            }
        });
        let log10 = |points: &[[f64; 2]]| -> PlotPoints<'static> {
            points.iter().filter(|p| p[1] > 0.0).map(|p| [p[0], p[1].log10()]).collect()
        };
        Plot::new("loss")
            .x_axis_label("step")
            .y_axis_label("loss, powers of ten")
            .legend(Legend::default().background_alpha(0.7))
            .allow_scroll(false)
            .y_axis_min_width(36.0)
            .show(ui, |plot| {
                plot.line(Line::new("loss", log10(&log.loss)).color(Color32::GRAY).width(1.0));
                plot.line(
                    Line::new("smoothed", log10(&log.smoothed)).color(Color32::from_rgb(255, 170, 40)).width(1.8),
                );
            });
    });
}

/// A number with as many digits as one looks at.
fn short(value: f64) -> String {
    if value == value.trunc() && value.abs() < 1e9 { format!("{value}") } else { format!("{value:.4e}") }
}

fn choices(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let spec = Command::OpenLog.spec();
        if ui.button(spec.name).on_hover_text(spec.tooltip).clicked() {
            app.commands.push(Command::OpenLog);
        }
        if app.training.is_running() {
            let part = app.training.progress().unwrap_or(0.0);
            if jobs::progress(ui, part, 140.0, "Stop the training; its last checkpoint stays") {
                app.training.cancel();
            }
        } else {
            start(app, ui);
        }
    });
}

/// A menu of the recipes that can be started.
#[cfg(feature = "network")]
fn start(app: &mut App, ui: &mut Ui) {
    use crate::network::recipe::{Recipe, SHIPPED};
    ui.menu_button("Train…", |ui| {
        ui.weak("Starts a training on this machine's processor, which it will keep busy for long.");
        for (name, text) in SHIPPED {
            let Ok(recipe) = Recipe::parse(name, text) else { continue };
            if ui.button(name).on_hover_text(&recipe.description).clicked() {
                ui.close();
                let steps = recipe.training_scenes().len() / recipe.batch.max(1) * recipe.epochs as usize;
                let Some(folder) = app.files.new_run(name) else {
                    app.error("There is no folder to train in; start it with `apertura train` instead.");
                    return;
                };
                match app.training.begin(name, &folder, Some(steps as u64)) {
                    Ok(()) => app.info(format!("Training {name} in {}", folder.display())),
                    Err(error) => app.error(format!("{}: the training can't be started: {error}", folder.display())),
                }
            }
        }
    })
    .response
    .on_hover_text("Start a training by a recipe and watch it");
}

#[cfg(not(feature = "network"))]
fn start(_: &mut App, ui: &mut Ui) {
    ui.weak("This build can't train.");
}
