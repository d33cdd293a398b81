//! Context menu of a map: overlays, views, pictures.

use super::input::Input;
use crate::app::state::{Command, ExportCommand, Panel, ViewCommand, WindowCommand};
use crate::app::widgets::{entry, item};
use eframe::egui::Ui;

/// Draws the menu.
pub fn menu(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let Input { kind, state, .. } = *input;
    ui.menu_button("Overlays", |ui| {
        ViewCommand::OVERLAYS.into_iter().for_each(|command| item(ui, state, command, asked));
    });
    let of_all = [ViewCommand::ToggleProjection, ViewCommand::ToggleUnits];
    let of_difference = [ViewCommand::ToggleAbsoluteDifference, ViewCommand::ToggleWholeDifference];
    let of_difference = of_difference.into_iter().filter(|_| kind.is_difference());
    of_all.into_iter().chain(of_difference).for_each(|command| item(ui, state, command, asked));
    ui.separator();
    for command in [
        Command::Window(WindowCommand::Maximise(Panel::Map(kind))),
        Command::View(ViewCommand::ResetMaps),
        Command::Export(ExportCommand::CopyMap(kind)),
        Command::Window(WindowCommand::ClosePanel(Panel::Map(kind))),
    ] {
        entry(ui, command, true, asked);
    }
}
