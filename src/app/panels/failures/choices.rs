//! Choice of the methods and scenes of a run, and of the files of rows.

use super::input::Input;
use crate::app::state::{Command, FailureChoice, Purpose, RowsCommand};
use crate::app::widgets::{
    NumberField, bar, kind_boxes, kind_names, labelled, method_menu, press, start_or_cancel, ticking_menu, warning,
};
use crate::evaluate::campaign::MethodFailure;
use crate::radar::counted;
use crate::scene::generate::Kind;
use eframe::egui::{self, Ui};

pub struct ChoicesMemory(FailureChoice);

impl Default for ChoicesMemory {
    fn default() -> Self {
        ChoicesMemory(FailureChoice { methods: Vec::new(), kinds: vec![Kind::Set2], own: false, count: 20, seed: 0 })
    }
}

pub fn show(ui: &mut Ui, input: &Input<'_>, ChoicesMemory(choice): &mut ChoicesMemory, asked: &mut Vec<Command>) {
    choice.methods.retain(|name| input.state.methods.all.iter().any(|m| m.name() == *name));
    if choice.methods.is_empty() {
        choice.methods.extend(input.state.method().map(|method| method.name()));
    }
    ui.horizontal_wrapped(|ui| {
        ui.add_enabled_ui(input.job.run.progress().is_none(), |ui| choose(ui, input, choice, asked));
        start(ui, input, choice, asked);
        ui.separator();
        files(ui, input, asked);
        bar(ui, input.job.run.progress(), 140.0);
    });
    warning(ui, input.job.run.note());
    unfit(ui, input.job.run.end().map_or(&[], Vec::as_slice));
}

fn unfit(ui: &mut Ui, unfit: &[MethodFailure]) {
    for MethodFailure { method, set, scenes, reason } in unfit {
        let reason = reason.strip_prefix(&format!("{method}: ")).unwrap_or(reason);
        let text = format!("{method}: no rows of {} of {set}: {reason}", counted(*scenes as usize, "scene", "scenes"));
        ui.add(egui::Label::new(egui::RichText::new(text).color(ui.visuals().warn_fg_color)).wrap());
    }
}

fn choose(ui: &mut Ui, input: &Input<'_>, choice: &mut FailureChoice, asked: &mut Vec<Command>) {
    method_menu(ui, input.state, &mut choice.methods, "Methods to try");
    let menu = ticking_menu(ui, &format!("Kinds: {}", kind_names(&choice.kinds, choice.own.then_some("own"))), |ui| {
        kind_boxes(ui, &mut choice.kinds);
        ui.separator();
        let folder = input.own.map_or_else(|| "none is chosen".to_owned(), |path| path.display().to_string());
        ui.checkbox(&mut choice.own, "own scenes").on_hover_text(format!("The folder of your own scenes: {folder}"));
        if ui.button("Another folder…").on_hover_text("Pick any scene of the folder").clicked() {
            asked.push(Purpose::OwnScenes.into());
            ui.close();
        }
    });
    menu.on_hover_text("Kinds of scenes to try them on");
    labelled(ui, "of each", "", NumberField::new(&mut choice.count).range(1..=100_000));
    labelled(ui, "seed", "", NumberField::new(&mut choice.seed).speed(0.05));
}

/// Draws the button Try, or Cancel during a run.
fn start(ui: &mut Ui, input: &Input<'_>, choice: &FailureChoice, asked: &mut Vec<Command>) {
    let ready = !choice.methods.is_empty() && (choice.own || !choice.kinds.is_empty());
    let tip = "Try the methods on the scenes, in the background, with the floor, normalisation and radar in use. Rows made with \
               the same stay; those made with others make room";
    let tips = [if ready { tip } else { "Choose a method and scenes first" }, "Stop after this map; the rows stay"];
    if start_or_cancel(ui, ("Try", RowsCommand::CancelTrying), input.job.run.progress().is_some(), ready, tips, asked) {
        asked.push(RowsCommand::Try(choice.clone()).into());
    }
}

fn files(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let has_rows = !input.job.table.rows().is_empty();
    let mut button = |name: &str, tip: &str, enabled: bool, command: Command| {
        ui.add_enabled_ui(enabled, |ui| press(ui, name, tip, command, asked));
    };
    let tip = "Show rows that were saved, or written by apertura evaluate --rows";
    button("Open…", tip, true, Command::AskFile(Purpose::OpenRows));
    button("Save…", "Save the rows as CSV", has_rows, Command::AskFile(Purpose::SaveRows));
    button("Clear", "Forget every row", has_rows, Command::Rows(RowsCommand::Clear));
    if let Some(count) = input.job.before() {
        let name = format!("Bring back {}", counted(count, "row", "rows"));
        button(&name, "The rows that others took the place of", true, Command::Rows(RowsCommand::BringBack));
    }
}
