//! Menu entries and buttons of commands: name, tooltip and key come from the one list.

use crate::app::state::{Command, EditCommand};
use crate::interact::{Alignment, Along};
use eframe::egui::{Button, Ui};

/// A menu entry; a click asks for the command and closes the menu.
pub fn entry(ui: &mut Ui, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    let name = command.entry().map_or("", |listed| listed.name.as_ref());
    entry_called(ui, name, command, enabled, asked);
}

/// A menu entry with a name of its own, where the menu's title says the rest.
pub fn entry_called(ui: &mut Ui, name: &str, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    let Some(listed) = command.entry() else { return };
    let mut button = Button::new(name);
    if let Some(key) = &listed.key {
        button = button.shortcut_text(ui.ctx().format_shortcut(key));
    }
    if ui.add_enabled(enabled, button).on_hover_text(listed.tooltip).clicked() {
        asked.push(command);
        ui.close();
    }
}

/// Entries that put several objects in a row.
pub fn arrange(ui: &mut Ui, asked: &mut Vec<Command>) {
    for command in Alignment::ALL
        .map(|v| Command::Edit(EditCommand::Align(v)))
        .into_iter()
        .chain(Along::BOTH.map(|v| Command::Edit(EditCommand::Distribute(v))))
    {
        entry(ui, command, true, asked);
    }
}

/// A button with a label of its own where there is no room for the command's name; its tooltip tells the key.
pub fn button(ui: &mut Ui, label: &str, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    if ui.add_enabled(enabled, Button::new(label)).on_hover_text(tooltip(ui, &command)).clicked() {
        asked.push(command);
    }
}

/// What a command does, and its key.
pub fn tooltip(ui: &Ui, command: &Command) -> String {
    let Some(listed) = command.entry() else { return String::new() };
    let key = listed.key.map(|key| format!(" ({})", ui.ctx().format_shortcut(&key))).unwrap_or_default();
    format!("{}{key}", listed.tooltip)
}
