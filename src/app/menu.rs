//! The menu bar and the buttons beside it.

use super::application::App;
use super::command::{Command, NewObject};
use super::layout::Panel;
use super::settings::Projection;
use crate::picture::ColourMap;
use crate::scene::generate::Kind;
use crate::scene::presets;
use eframe::egui;
use eframe::egui::{Button, Ui};

/// A menu entry or button for a command: name, tooltip and key come from its [`Spec`](super::command::Spec).
pub(super) fn entry(app: &mut App, ui: &mut Ui, command: Command, enabled: bool) {
    let spec = command.spec();
    let mut button = Button::new(spec.name);
    if let Some(shortcut) = &spec.shortcut {
        button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
    }
    if ui.add_enabled(enabled, button).on_hover_text(spec.tooltip).clicked() {
        app.commands.push(command);
        ui.close();
    }
}

/// Draws the bar.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Panel::top("menu").show(ui, |ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| file(app, ui));
            ui.menu_button("Edit", |ui| edit(app, ui));
            ui.menu_button("Scene", |ui| scene(app, ui));
            ui.menu_button("View", |ui| view(app, ui));
            ui.menu_button("Tools", |ui| tools(app, ui));
            ui.separator();
            for (kind, label) in
                [(NewObject::Point, "+ Point"), (NewObject::Line, "+ Line"), (NewObject::Cluster, "+ Cluster")]
            {
                let command = Command::Add(kind, None);
                if ui.button(label).on_hover_text(tip(ui, &command)).clicked() {
                    app.commands.push(command);
                }
            }
            ui.separator();
            for (command, label, enabled) in [
                (Command::Undo, "Undo", app.editor.history().undo_label().is_some()),
                (Command::Redo, "Redo", app.editor.history().redo_label().is_some()),
            ] {
                let tip = tip(ui, &command);
                if ui.add_enabled(enabled, Button::new(label)).on_hover_text(tip).clicked() {
                    app.commands.push(command);
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| right(app, ui));
        });
    });
}

fn right(app: &mut App, ui: &mut Ui) {
    let command = Command::Palette;
    if ui.button("Commands").on_hover_text(tip(ui, &command)).clicked() {
        app.commands.push(command);
    }
    if ui.available_width() < 180.0 {
        return;
    }
    ui.separator();
    for (projection, label) in [(Projection::Cartesian, "Cartesian"), (Projection::RangeAngle, "Range–angle")] {
        let response = ui.selectable_label(app.settings.projection == projection, label);
        if response.on_hover_text(tip(ui, &Command::ToggleProjection)).clicked() {
            app.settings.projection = projection;
        }
    }
}

/// Tooltip with the key.
fn tip(ui: &Ui, command: &Command) -> String {
    let spec = command.spec();
    let key = spec.shortcut.map(|s| format!(" ({})", ui.ctx().format_shortcut(&s))).unwrap_or_default();
    format!("{}{key}", spec.tooltip)
}

fn file(app: &mut App, ui: &mut Ui) {
    ui.set_min_width(220.0);
    for command in [Command::New, Command::Open] {
        entry(app, ui, command, true);
    }
    let recent = app.files.recent.clone();
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    app.commands.push(Command::OpenPath(path));
                    ui.close();
                }
            }
        });
    });
    ui.separator();
    for command in [Command::Save, Command::SaveAs] {
        entry(app, ui, command, true);
    }
    ui.separator();
    for command in [Command::ExportPicture, Command::ExportMaps, Command::ExportMetrics] {
        entry(app, ui, command, true);
    }
    ui.separator();
    entry(app, ui, Command::Quit, true);
}

fn edit(app: &mut App, ui: &mut Ui) {
    ui.set_min_width(220.0);
    entry(app, ui, Command::Undo, app.editor.history().undo_label().is_some());
    entry(app, ui, Command::Redo, app.editor.history().redo_label().is_some());
    ui.separator();
    let selected = !app.editor.selection().is_empty();
    for (command, enabled) in [
        (Command::Cut, selected),
        (Command::Copy, selected),
        (Command::Paste, true),
        (Command::Duplicate, selected),
        (Command::Delete, selected),
        (Command::SelectAll, true),
        (Command::Escape, selected),
    ] {
        entry(app, ui, command, enabled);
    }
}

fn scene(app: &mut App, ui: &mut Ui) {
    ui.set_min_width(260.0);
    for kind in [NewObject::Point, NewObject::Line, NewObject::Cluster] {
        entry(app, ui, Command::Add(kind, None), true);
    }
    ui.separator();
    ui.menu_button("Presets", |ui| {
        for (index, preset) in presets::ALL.iter().enumerate() {
            let scene = preset.load().map(|f| f.scene).unwrap_or_default();
            let name = if scene.name.is_empty() { preset.id } else { &scene.name };
            if ui.button(name).on_hover_text(&scene.notes).clicked() {
                app.commands.push(Command::Preset(index));
                ui.close();
            }
        }
    });
    ui.separator();
    for kind in Kind::all() {
        entry(app, ui, Command::RandomScene(kind), true);
    }
    ui.horizontal(|ui| {
        let label = ui.label("Seed of the next random scene");
        ui.add(egui::DragValue::new(&mut app.settings.random_seed))
            .labelled_by(label.id)
            .on_hover_text("The same set and seed always give the same scene; it rises by one each time");
    });
    ui.separator();
    entry(app, ui, Command::FitScene, true);
}

fn tools(app: &mut App, ui: &mut Ui) {
    ui.set_min_width(240.0);
    for panel in Panel::TOOLS {
        let mut open = app.layout.is_open(panel);
        if ui.checkbox(&mut open, panel.title()).on_hover_text(panel.describe()).clicked() {
            app.commands.push(if open { Command::OpenPanel(panel) } else { Command::ClosePanel(panel) });
            ui.close();
        }
    }
}

fn view(app: &mut App, ui: &mut Ui) {
    ui.set_min_width(240.0);
    ui.menu_button("Panels", |ui| {
        for panel in Panel::all() {
            let mut open = app.layout.is_open(panel);
            if ui.checkbox(&mut open, panel.title()).on_hover_text(panel.describe()).clicked() {
                app.commands.push(if open { Command::OpenPanel(panel) } else { Command::ClosePanel(panel) });
            }
        }
    });
    ui.menu_button("Colours", |ui| {
        for colours in ColourMap::ALL {
            ui.radio_value(&mut app.settings.colours, colours, colours.name());
        }
    });
    entry(app, ui, Command::ResetLayout, true);
    ui.separator();
    for command in [
        Command::ToggleProjection,
        Command::ResetMaps,
        Command::ToggleReflectors,
        Command::ToggleFieldsOfView,
        Command::NextMethod,
    ] {
        entry(app, ui, command, true);
    }
    ui.separator();
    for command in [Command::ToggleTheme, Command::ZoomIn, Command::ZoomOut, Command::ZoomReset, Command::Palette] {
        entry(app, ui, command, true);
    }
}
