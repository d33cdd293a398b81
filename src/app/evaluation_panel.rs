//! Methods on the tables' test scenes, beside what the thesis prints.

use super::application::App;
use super::evaluation::{Evaluation, PRINTED, Plan};
use super::jobs;
use crate::evaluate::campaign::Campaign;
use crate::evaluate::tables::{Estimate, PRINTED_EXPERIMENT_2};
use crate::radar::Radar;
use eframe::egui;
use eframe::egui::{DragValue, Grid, ScrollArea, Ui};
use std::collections::BTreeSet;

/// What is chosen, and the worker.
pub(super) struct EvaluationPanel {
    pub evaluation: Evaluation,
    methods: BTreeSet<&'static str>,
    sets: [bool; 3],
    count: u32,
    seed: u64,
}

impl EvaluationPanel {
    pub fn new(evaluation: Evaluation) -> Self {
        EvaluationPanel { evaluation, methods: BTreeSet::new(), sets: [true; 3], count: 10, seed: 0 }
    }
}

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            choices(app, ui);
            ui.separator();
            if app.evaluation.evaluation.rows.is_empty() {
                ui.weak("Tables 4.1 to 4.3 of the thesis for the chosen methods. Scenes are random, but the same for the same seed.");
            }
            tables(&app.evaluation, ui);
        });
    });
}

fn choices(app: &mut App, ui: &mut Ui) {
    let all = app.pipeline.methods.clone();
    let shown = app.method().map(|m| m.name());
    let panel = &mut app.evaluation;
    let known = |name: &&'static str| all.iter().any(|m| m.name() == *name);
    panel.methods.retain(known);
    if panel.methods.is_empty() {
        panel.methods.extend(shown);
    }
    let running = panel.evaluation.progress();
    ui.add_enabled_ui(running.is_none(), |ui| {
        ui.horizontal_wrapped(|ui| {
            let names = panel.methods.iter().copied().collect::<Vec<_>>().join(", ");
            let title = if panel.methods.len() > 3 { format!("{} methods", panel.methods.len()) } else { names };
            ui.menu_button(format!("Methods: {title}"), |ui| {
                for method in &all {
                    let mut chosen = panel.methods.contains(method.name());
                    if ui.checkbox(&mut chosen, method.name()).on_hover_text(method.description()).changed() {
                        if chosen {
                            panel.methods.insert(method.name());
                        } else {
                            panel.methods.remove(method.name());
                        }
                    }
                }
            })
            .response
            .on_hover_text("Methods to evaluate");
            for (set, chosen) in panel.sets.iter_mut().enumerate() {
                let what = ["one point", "3 to 6 points", "points and lines"][set];
                ui.checkbox(chosen, format!("set {}", set + 1)).on_hover_text(what);
            }
            let label = ui.label("scenes a set");
            ui.add(DragValue::new(&mut panel.count).range(1..=1000)).labelled_by(label.id);
            let label = ui.label("seed");
            ui.add(DragValue::new(&mut panel.seed).speed(0.05)).labelled_by(label.id);
        });
    });
    ui.horizontal(|ui| match running {
        Some(part) => {
            if jobs::progress(ui, part, 180.0, "Stop after this map; the rows that are finished stay") {
                panel.evaluation.cancel();
            }
        }
        None => {
            let sets: Vec<usize> = (1..=3).filter(|set| panel.sets[set - 1]).collect();
            let ready = !sets.is_empty() && !panel.methods.is_empty();
            let start = ui.add_enabled(ready, egui::Button::new("Evaluate"));
            let start = start.on_hover_text("Run the chosen methods over the chosen sets, in the background");
            if start.on_disabled_hover_text("Choose a method and a set first").clicked() {
                let campaign = Campaign {
                    radar: Radar { carrier: app.radar.carrier, window: app.radar.window, ..Radar::default() },
                    count: panel.count,
                    seed: panel.seed,
                    floor: app.settings.floor,
                    normalisation: app.settings.normalisation,
                    ..Campaign::default()
                };
                let methods = all.iter().filter(|m| panel.methods.contains(m.name())).cloned().collect();
                panel.evaluation.begin(Plan { campaign, sets, methods });
            }
            if !panel.evaluation.rows.is_empty()
                && ui.button("Copy as CSV").on_hover_text("Copy the rows to the clipboard").clicked()
            {
                ui.copy_text(panel.evaluation.to_csv());
            }
        }
    });
    if let Some(ended) = &panel.evaluation.ended {
        ui.colored_label(ui.visuals().warn_fg_color, ended);
    }
}

fn tables(panel: &EvaluationPanel, ui: &mut Ui) {
    let rows = &panel.evaluation.rows;
    for set in 1..=3 {
        if !rows.iter().any(|r| r.set == set) {
            continue;
        }
        ui.strong(format!("Table 4.{set}: {}", ["one point", "3 to 6 points", "points and lines"][set - 1]));
        Grid::new(("table", set)).num_columns(6).striped(true).spacing([14.0, 3.0]).show(ui, |ui| {
            let at = format!("P_D % at P_FA {:.2} %", 100.0 * PRINTED_EXPERIMENT_2[set - 1].false_alarm);
            for title in ["", "SE", "P_D %", "P_FA %", &at, "ms a map"] {
                ui.weak(title);
            }
            ui.end_row();
            for (name, columns) in PRINTED {
                let printed = columns[set - 1];
                ui.weak(name);
                ui.monospace(format!("{:.2}", printed.squared_error));
                ui.monospace(format!("{:.2}", 100.0 * printed.detection));
                ui.monospace(format!("{:.2}", 100.0 * printed.false_alarm));
                ui.end_row();
            }
            for row in rows.iter().filter(|r| r.set == set) {
                ui.strong(format!("{} (η {:.2})", row.method, row.eta))
                    .on_hover_text(format!("{} scenes; mean ± standard error", row.scenes));
                ui.monospace(with_error(row.squared_error, 1.0, 0));
                ui.monospace(with_error(row.detection, 100.0, 2));
                ui.monospace(with_error(row.false_alarm, 100.0, 2));
                ui.monospace(row.detection_at_printed.map_or("–".to_owned(), |d| format!("{:.2}", 100.0 * d)));
                ui.monospace(format!("{:.1}", row.median_milliseconds));
                ui.end_row();
            }
        });
        ui.add_space(8.0);
    }
}

fn with_error(estimate: Estimate, scale: f64, digits: usize) -> String {
    format!("{:.digits$} ± {:.digits$}", scale * estimate.mean, scale * estimate.standard_error)
}
