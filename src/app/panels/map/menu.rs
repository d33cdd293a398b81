//! What a map offers at the pointer: overlays, views, pictures.

use crate::app::state::{
    Command, DifferenceView, ExportCommand, MapKind, Panel, Projection, Units, ViewCommand, WindowCommand,
};
use crate::app::widgets::entry::{entry, ticked};
use eframe::egui::Ui;

/// What the menu is of.
pub struct Looked {
    /// Which map.
    pub kind: MapKind,
    /// Which of [`ViewCommand::OVERLAYS`] are drawn.
    pub overlays: [bool; 4],
    /// Over which coordinates.
    pub projection: Projection,
    /// What the colour bar counts.
    pub units: Units,
    /// How a difference is drawn.
    pub difference: DifferenceView,
}

/// Draws the menu; what was chosen.
pub fn menu(ui: &mut Ui, looked: &Looked, asked: &mut Vec<Command>) {
    let (kind, difference) = (looked.kind, looked.difference);
    ui.menu_button("Overlays", |ui| {
        for (command, on) in ViewCommand::OVERLAYS.map(Command::from).into_iter().zip(looked.overlays) {
            let name = command.entry().map_or("", |listed| listed.name.as_ref());
            ticked(ui, name, command.clone(), on, asked);
        }
    });
    for (command, on) in [
        (ViewCommand::ToggleProjection, Some(looked.projection == Projection::Cartesian)),
        (ViewCommand::ToggleUnits, Some(looked.units == Units::Decibels)),
        (ViewCommand::ToggleAbsoluteDifference, Some(difference.absolute).filter(|_| kind.is_difference())),
        (ViewCommand::ToggleWholeDifference, Some(!difference.whole).filter(|_| kind.is_difference())),
    ] {
        if let (Some(on), command) = (on, Command::from(command)) {
            let name = command.entry().map_or("", |listed| listed.name.as_ref());
            ticked(ui, name, command.clone(), on, asked);
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
