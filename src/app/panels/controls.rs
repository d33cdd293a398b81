//! The settings panel: reconstruction with its current figures, maps, and display.

mod settings;

use crate::app::content::{Content, Cx};
use crate::app::jobs::{Refusal, Scores};
use crate::app::panels::map;
use crate::app::state::{Command, MethodSlot, State, Units, ViewCommand, WorkCommand};
use crate::app::widgets::{
    LIST_HEIGHT, NumberField, group, level, method_list, percent, progress, row, scrolled, with_unit,
};
use crate::evaluate::eta_text;
use crate::lesson::Uses;
use crate::reconstruct::Reconstructor;
use eframe::egui::{self, ComboBox, Grid, Slider, SliderClamping, Ui};
use std::time::Duration;

const FIGURE_GAP_POINTS: f32 = 20.0;

/// Settings, and the state of the reconstruction.
pub struct Input<'a> {
    pub state: &'a State,
    pub eta: f32,
    /// Decibels that the target's Lambda spans, where its scale is known.
    pub range_db: Option<f64>,
    pub run: Run<'a>,
    /// Settings that the current lesson uses; the others are hidden.
    pub uses: Uses,
}

#[derive(Default)]
pub struct Run<'a> {
    /// Completed part of the reconstruction, 0 to 1, while it runs.
    pub progress: Option<f32>,
    pub refusal: Option<&'a Refusal>,
    pub output: Option<(&'static str, Duration)>,
    /// Figures of that output against the target of the same scene.
    pub scores: Option<Scores>,
    /// Text with the number of echoes found, where the output is of a recording.
    pub echoes: Option<String>,
    /// Whether the output is of an earlier scene or of another method.
    pub outdated: bool,
    /// Whether a visible panel needs an output.
    pub wanted: bool,
    pub detector_error: Option<&'a str>,
}

pub const PANEL: Content = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let (state, jobs) = (&*cx.state, cx.jobs);
    let pipeline = &jobs.pipeline;
    let run = Run {
        progress: pipeline.method(MethodSlot::First).progress(),
        refusal: pipeline.method(MethodSlot::First).refusal(),
        output: pipeline.output().map(|o| (o.method(), o.took)),
        // Hidden while a question is open: the number of blobs answers many questions.
        scores: map::scores(state, jobs, MethodSlot::First),
        echoes: map::echoes_found(state, jobs, MethodSlot::First),
        outdated: pipeline.output_is_outdated(),
        wanted: pipeline.maps.wants_ends(),
        detector_error: pipeline.detector_error(),
    };
    let input = Input {
        state,
        eta: pipeline.eta(state, MethodSlot::First),
        range_db: pipeline.range_db(),
        run,
        uses: state.uses(),
    };
    show(ui, &input)
}

pub fn show(ui: &mut Ui, input: &Input<'_>) -> Vec<Command> {
    scrolled(ui, |ui, asked| {
        if input.uses.output {
            group(ui, "Reconstruction", |ui| reconstruction(ui, input, asked));
        } else if input.uses.threshold {
            group(ui, "Threshold", |ui| thresholds(ui, input, None, asked));
        }
        group(ui, "Maps", |ui| settings::maps(ui, input.state, asked));
        group(ui, "Display", |ui| settings::display(ui, &input.state.settings, asked));
    })
}

fn reconstruction(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let Some(method) = input.state.method().map(AsRef::as_ref) else {
        ui.weak("This build has no reconstruction method.");
        return;
    };
    row(ui, "Method", method.description(), |ui| {
        let combo = ComboBox::from_id_salt("method").width(150.0).height(LIST_HEIGHT).selected_text(method.name());
        let listed = combo.show_ui(ui, |ui| {
            method_list(ui, input.state, method.name(), |v| Command::View(ViewCommand::Method(v)), asked);
        });
        listed.response
    });
    if input.uses.threshold {
        thresholds(ui, input, Some(method), asked);
    }
    figures(ui, method, &input.run, asked);
}

/// Draws the choice between thresholds for the whole map and a detector, with their fields.
fn thresholds(ui: &mut Ui, input: &Input<'_>, method: Option<&dyn Reconstructor>, asked: &mut Vec<Command>) {
    settings::detector(ui, &input.state.settings, asked);
    match &input.state.settings.cfar {
        Some(cfar) => settings::detector_cells(ui, cfar, input.run.detector_error, asked),
        None => {
            if let Some(method) = method {
                output_eta(ui, input, method, asked);
            }
            target_eta(ui, input, asked);
        }
    }
}

fn output_eta(ui: &mut Ui, input: &Input<'_>, method: &dyn Reconstructor, asked: &mut Vec<Command>) {
    row(ui, "η", "Cells of the output above this count as detections", |ui| {
        let mut eta = input.eta;
        let slider = threshold(ui, "η in numbers", &mut eta);
        asked.extend(moved(input.eta, eta).map(|v| Command::View(ViewCommand::SetMethodEta(method.name(), Some(v)))));
        let own = input.state.settings.method_eta.contains_key(method.name());
        let reset = ui.add_enabled(own, egui::Button::new("Reset").small());
        let back = match method.reads_eta() {
            true => "Back to the η that fits each output".to_owned(),
            false => format!("Back to the method's own η = {}", eta_text(method.eta())),
        };
        if reset.on_hover_text(back).clicked() {
            asked.push(ViewCommand::SetMethodEta(method.name(), None).into());
        }
        in_decibels(ui, input, input.eta);
        slider
    });
}

fn target_eta(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    row(ui, "η'", "Cells of the target above this are drawn in the panel Target > η'", |ui| {
        let mut eta = input.state.settings.target_eta;
        let slider = threshold(ui, "η' in numbers", &mut eta);
        asked.extend(moved(input.state.settings.target_eta, eta).map(|v| Command::View(ViewCommand::SetTargetEta(v))));
        in_decibels(ui, input, input.state.settings.target_eta);
        slider
    });
}

/// Writes a threshold in decibels relative to the target's peak, where decibels are chosen and the scale is known.
fn in_decibels(ui: &mut Ui, input: &Input<'_>, eta: f32) {
    if let Some(range_db) = input.range_db.filter(|_| input.state.settings.units == Units::Decibels) {
        ui.weak(with_unit(&level(range_db * (f64::from(eta) - 1.0), range_db)));
    }
}

fn moved(before: f32, after: f32) -> Option<f32> {
    (before != after).then_some(after)
}

/// A slider, and beside it a field called `name` that shows every digit, so that P_FA can be reproduced.
fn threshold(ui: &mut Ui, name: &str, eta: &mut f32) -> egui::Response {
    let slider = Slider::new(eta, 0.0..=1.0).clamping(SliderClamping::Edits).show_value(false);
    let slider = ui.add(slider);
    let text = eta_text(*eta);
    let field = NumberField::new(eta).range(0.0..=1.0).clamp_existing_to_range(false).speed(0.005).standing_for(&text);
    let field = ui.add(field);
    ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(name));
    slider
}

/// Draws P_D, P_FA and SE, or the reason why there are none.
fn figures(ui: &mut Ui, method: &dyn Reconstructor, run: &Run<'_>, asked: &mut Vec<Command>) {
    // The height is the same with and without the progress bar, so that the rows below don't jump when a reconstruction begins.
    ui.horizontal(|ui| {
        ui.set_min_height(ui.spacing().interact_size.y);
        if let Some(part) = run.progress {
            if progress(ui, part, 150.0, "Stop this reconstruction; the last output stays") {
                asked.push(WorkCommand::CancelMethod.into());
            }
        } else if let Some(refusal) = run.refusal {
            let reason = egui::RichText::new(&refusal.reason).color(ui.visuals().error_fg_color);
            ui.add(egui::Label::new(reason).wrap());
        } else if let Some((name, took)) = run.output {
            ui.weak(format!("{name} took {:.1} ms", took.as_secs_f64() * 1e3));
        } else if run.wanted {
            ui.weak("Waiting for the maps…");
        } else {
            ui.weak("Show an output panel to reconstruct.");
        }
    });
    if let Some(echoes) = &run.echoes {
        ui.label(echoes).on_hover_text("The panel Found has their places, levels and how much each is needed");
    }
    let Some(scores) = run.scores else { return };
    if scores.output_blobs == 0 {
        ui.weak(format!("Nothing is detected. {}: {}.", method.name(), method.description()));
    }
    let m = scores.metrics;
    // Figures of an earlier scene or method are dimmed as their maps are.
    let is_current = !run.outdated || run.progress.is_none();
    ui.add_enabled_ui(is_current, |ui| {
        Grid::new("figures").num_columns(3).spacing([FIGURE_GAP_POINTS, 2.0]).show(ui, |ui| {
            let detection = m.detection.map_or("–".to_owned(), percent);
            for (name, value, tooltip) in [
                ("P_D", detection, "Part of the target's cells above 0.9 that the output finds"),
                ("P_FA", percent(m.false_alarm), "Part of the other cells where the output exceeds η"),
                ("SE", format!("{:.0}", m.squared_error), "Sum of squared differences over all cells"),
            ] {
                // A name stands nearer to its own value than to the value before.
                ui.horizontal(|ui| {
                    ui.weak(name).on_hover_text(tooltip);
                    ui.monospace(value).on_hover_text(tooltip);
                });
            }
            ui.end_row();
        });
        let plural = if scores.target_blobs == 1 { "" } else { "s" };
        ui.weak(format!("{} blob{plural} in the target, {} in the output", scores.target_blobs, scores.output_blobs))
            .on_hover_text("Regions of touching cells above η' and η");
    });
}

#[cfg(test)]
mod tests;
