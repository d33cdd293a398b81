//! Context menu of a map: overlays, views, pictures.

use super::input::Input;
use crate::app::state::{Command, ExportCommand, Panel, Projection, Units, ViewCommand, WindowCommand};
use crate::app::widgets::{entry, ticked};
use eframe::egui::Ui;

/// Draws the menu.
pub fn menu(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let Input { kind, look, .. } = *input;
    let mut tick = |ui: &mut Ui, command: ViewCommand, on: bool| {
        let command = Command::from(command);
        let name = command.entry().map_or("", |listed| listed.name.as_ref());
        ticked(ui, name, command.clone(), on, asked);
    };
    ui.menu_button("Overlays", |ui| {
        for (command, on) in ViewCommand::OVERLAYS.into_iter().zip([
            look.show_reflectors,
            look.show_found,
            look.show_theory,
            look.show_kinds,
        ]) {
            tick(ui, command, on);
        }
    });
    for (command, on) in [
        (ViewCommand::ToggleProjection, Some(look.projection == Projection::Cartesian)),
        (ViewCommand::ToggleUnits, Some(look.units == Units::Decibels)),
        (ViewCommand::ToggleAbsoluteDifference, Some(look.difference.absolute).filter(|_| kind.is_difference())),
        (ViewCommand::ToggleWholeDifference, Some(!look.difference.whole).filter(|_| kind.is_difference())),
    ] {
        if let Some(on) = on {
            tick(ui, command, on);
        }
    }
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
