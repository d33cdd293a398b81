//! The opened row: its figures beside the current ones, the search for a worse or a repaired scene, and the button that keeps the scene.

use super::input::{Input, Now};
use crate::app::state::{Command, Purpose, RowsCommand};
use crate::app::widgets::{NumberField, choice, labelled, percent, press, progress, warning};
use crate::evaluate::Metrics;
use crate::evaluate::rows::Row;
use crate::evaluate::worsen::{WorseningGoal, WorseningMeasure, WorseningSearch};
use eframe::egui::{Button, Grid, TextEdit, Ui};

#[derive(Default)]
pub struct OpenedMemory {
    search: WorseningSearch,
    note: String,
}

pub fn show(ui: &mut Ui, input: &Input<'_>, memory: &mut OpenedMemory, asked: &mut Vec<Command>) {
    if let Some(row) = input.row_on_screen() {
        figures(ui, row, input.now.as_ref());
    }
    ui.horizontal_wrapped(|ui| {
        search(ui, input, memory, asked);
        ui.separator();
        let note = TextEdit::singleline(&mut memory.note).hint_text("why it is kept").desired_width(160.0);
        labelled(ui, "Note", "", note);
        let folder = input.own.map_or_else(|| "a folder that you choose first".to_owned(), |f| f.display().to_string());
        let keep = ui.add_enabled(input.own.is_some(), Button::new("Keep"));
        let tip = format!("Add the scene on screen to your own scenes, with the note: {folder}");
        if keep.on_hover_text(tip).clicked() {
            asked.push(RowsCommand::KeepScene(std::mem::take(&mut memory.note)).into());
        }
        if input.own.is_none() {
            press(ui, "Folder…", "", Purpose::OwnScenes, asked);
        }
    });
}

fn figures(ui: &mut Ui, row: &Row, now: Option<&Now>) {
    Grid::new("row and now").num_columns(5).spacing([14.0, 2.0]).show(ui, |ui| {
        ui.label(format!("row: {}", super::cells::name(row)));
        let Row { squared_error, detection, false_alarm, .. } = *row;
        rates(ui, &Metrics { squared_error, detection, false_alarm });
        ui.label(verdicts(row));
        ui.end_row();
        match now {
            Some(Now { method, metrics, verdicts }) => {
                ui.label(format!("now: {method}"));
                rates(ui, metrics);
                ui.label(verdicts.as_deref().unwrap_or_default());
            }
            None => _ = ui.weak("now: …").on_hover_text("As soon as a panel shows the output"),
        }
        ui.end_row();
    });
}

fn rates(ui: &mut Ui, metrics: &Metrics) {
    let detection = metrics.detection.map_or_else(|| "–".to_owned(), percent);
    let error = format!("SE {:.1}", metrics.squared_error);
    for text in [error, format!("P_D {detection}"), format!("P_FA {}", percent(metrics.false_alarm))] {
        ui.label(text);
    }
}

/// Text with the numbers of a row's found, missed, merged and shifted objects, and of its false alarms.
fn verdicts(row: &Row) -> String {
    let maybe = |count: Option<usize>, name: &str| count.filter(|n| *n > 0).map(|n| format!("{n} {name}"));
    let told = [row.found, Some(row.missed), row.merged, row.wrong_tooth].into_iter().sum::<Option<usize>>();
    let parts = [
        maybe(row.found, "found"),
        maybe(Some(row.missed), "missed"),
        maybe(row.merged, "merged"),
        maybe(row.wrong_tooth, "wrong tooth"),
        maybe(told.map(|told| row.objects.saturating_sub(told)), "hidden"),
        maybe(Some(row.ghosts), if row.ghosts == 1 { "false alarm" } else { "false alarms" }),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn search(ui: &mut Ui, input: &Input<'_>, memory: &mut OpenedMemory, asked: &mut Vec<Command>) {
    let searched = &input.job.search;
    if let Some(part) = searched.job.progress() {
        if progress(ui, part, 140.0, "Stop looking; what was found stays") {
            asked.push(RowsCommand::CancelSearch.into());
        }
    } else {
        let named = |measure: &WorseningMeasure| (name(*measure).to_owned(), "");
        choice(ui, "Look by", "", &mut memory.search.measure, WorseningMeasure::ALL, named);
        let within = NumberField::new(&mut memory.search.within_metres).range(0.01..=100.0).speed(0.02).suffix(" m");
        labelled(ui, "within", "", within);
        labelled(ui, "in", "", NumberField::new(&mut memory.search.tries).range(1..=100_000).suffix(" tries"));
        let worse = "Look near the scene on screen for one that the method in use does worse on; the way there is drawn on the scene";
        let repair = "Look for the smallest move of its objects after which the method in use is right";
        for (title, tip, goal) in [("Worse", worse, WorseningGoal::Worsen), ("Repair", repair, WorseningGoal::Repair)] {
            let search = Box::new(WorseningSearch { goal, ..memory.search.clone() });
            press(ui, title, tip, RowsCommand::Search(search), asked);
        }
    }
    if let Some(summary) = searched.summary() {
        ui.label(summary);
    }
    warning(ui, searched.job.note());
    if searched.job.progress().is_none() && searched.job.rows().len() > 1 {
        let tip = "Put what was found on screen; undo brings this scene back";
        press(ui, "Show", tip, RowsCommand::TakeFinding, asked);
        press(ui, "Forget", "Forget the search; its path is no longer drawn", RowsCommand::ForgetSearch, asked);
    }
}

fn name(measure: WorseningMeasure) -> &'static str {
    match measure {
        WorseningMeasure::SquaredError => "squared error",
        WorseningMeasure::Missed => "missed objects",
        WorseningMeasure::Ghosts => "false alarms",
    }
}
