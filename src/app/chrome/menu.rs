//! The menu bar and the buttons beside it.

use super::column::MAX_COLUMN_WIDTH_POINTS;
use super::unsaved;
use crate::app::state::menus::{EDIT, FILE, HELP, VIEW};
use crate::app::state::{
    Command, DocumentCommand, EditCommand, HelpPage, MapKind, NewObject, Panel, Projection, Settings, State, Task,
    ViewCommand, WindowCommand,
};
use crate::app::widgets::{NumberField, button, choices, entry, entry_called, item, labelled, ticked, tooltip};
use crate::picture::ColourMap;
use crate::platform;
use crate::recording::presets as recordings;
use crate::scene::generate::Kind;
use crate::scene::presets;
use eframe::egui::containers::menu::{MenuConfig, SubMenuButton};
use eframe::egui::{self, PopupCloseBehavior, Ui};
use std::sync::LazyLock;

struct Listed {
    name: String,
    is_failure: bool,
    notes: String,
}

/// The presets, read once.
static PRESETS: LazyLock<Vec<Listed>> = LazyLock::new(|| {
    let listed = |preset: &presets::Preset| {
        let scene = preset.load().map(|f| f.scene).unwrap_or_default();
        let name = if scene.name.is_empty() { preset.id.to_owned() } else { scene.name };
        Listed { name, is_failure: preset.is_failure(), notes: scene.notes }
    };
    presets::ALL.iter().map(listed).collect()
});

pub fn show(ui: &mut Ui, state: &State) -> Vec<Command> {
    let mut asked = Vec::new();
    egui::Panel::top("menu").show(ui, |ui| {
        let width = ui.available_width();
        let is_narrow = width < MAX_COLUMN_WIDTH_POINTS;
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| file(ui, state, &mut asked));
            ui.menu_button("Edit", |ui| edit(ui, state, &mut asked));
            ui.menu_button("Scene", |ui| scene(ui, state, &mut asked));
            ui.menu_button("View", |ui| view(ui, state, &mut asked));
            ui.menu_button("Tools", |ui| tools(ui, state, &mut asked));
            ui.menu_button("Help", |ui| help(ui, state, &mut asked));
            // In a narrow window they would reach past its edge; the menus have all of them.
            if !is_narrow {
                buttons(ui, state, width, &mut asked);
            }
            if state.is_presenting() {
                button(ui, "End presentation", WindowCommand::Present, true, &mut asked);
            }
            let right = egui::Layout::right_to_left(egui::Align::Center);
            ui.with_layout(right, |ui| self::right(ui, state.settings.projection, &mut asked));
        });
    });
    asked
}

/// Least width of a window with a button for each kind of body, points.
const MIN_BUTTONS_WIDTH_POINTS: f32 = 1150.0;
/// Least width of a window with a menu of bodies, points.
const MIN_BODY_MENU_WIDTH_POINTS: f32 = 950.0;

fn buttons(ui: &mut Ui, state: &State, width: f32, asked: &mut Vec<Command>) {
    let (heaps, bodies) = NewObject::ALL.split_at(3);
    let mut add = |ui: &mut Ui, kinds: &[NewObject]| {
        for kind in kinds {
            button(ui, &format!("+ {}", kind.name()), EditCommand::Add(*kind, None), true, asked);
        }
    };
    ui.separator();
    add(ui, heaps);
    if width >= MIN_BUTTONS_WIDTH_POINTS {
        add(ui, bodies);
    } else if width >= MIN_BODY_MENU_WIDTH_POINTS {
        let of_bodies = bodies.iter().map(|kind| Command::Edit(EditCommand::Add(*kind, None)));
        ui.menu_button("+ Body", |ui| entries(ui, of_bodies, asked))
            .response
            .on_hover_text("Add a wall, a box, a post or a polygon");
    }
    ui.separator();
    button(ui, "Undo", EditCommand::Undo, state.can_undo(), asked);
    button(ui, "Redo", EditCommand::Redo, state.can_redo(), asked);
    ui.separator();
    button(ui, "Lessons", WindowCommand::OpenPanel(Panel::Lesson), true, asked);
}

fn right(ui: &mut Ui, shown: Projection, asked: &mut Vec<Command>) {
    // In a narrow window the button would overlap others; its key stays.
    if ui.available_width() < 90.0 {
        return;
    }
    button(ui, "Commands", WindowCommand::Palette, true, asked);
    if ui.available_width() < 180.0 {
        return;
    }
    ui.separator();
    let tip = tooltip(ui, &ViewCommand::ToggleProjection.into());
    let of = [(Projection::Cartesian, "Cartesian", &*tip), (Projection::RangeAngle, "Range–angle", &*tip)];
    choices(ui, shown, of, ViewCommand::SetProjection, asked);
}

fn entries(ui: &mut Ui, commands: impl IntoIterator<Item = Command>, asked: &mut Vec<Command>) {
    for command in commands {
        entry(ui, command, true, asked);
    }
}

fn file(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(220.0);
    let [open, listen, save, export, end] = FILE;
    entries(ui, open.iter().cloned(), asked);
    ui.add_enabled_ui(!state.recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in &state.recent {
                let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    asked.push(DocumentCommand::OpenPath(path.clone()).into());
                    ui.close();
                }
            }
        });
    });
    if !platform::IN_A_BROWSER {
        entries(ui, listen.iter().cloned(), asked);
    }
    unsaved::show(ui, state.editor.left(), asked);
    for group in [save, export, end] {
        ui.separator();
        entries(ui, group.iter().cloned(), asked);
    }
}

fn edit(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(220.0);
    let [back, rest] = EDIT;
    let is_selected = !state.editor.selection().is_empty();
    for (command, is_enabled) in back.iter().zip([state.can_undo(), state.can_redo()]) {
        entry(ui, command.clone(), is_enabled, asked);
    }
    ui.separator();
    for command in rest {
        use EditCommand::{Paste, SelectAll, SelectNext, SelectPrevious};
        let is_free = matches!(command, Command::Edit(Paste | SelectAll | SelectNext | SelectPrevious));
        entry(ui, command.clone(), is_free || is_selected, asked);
    }
}

fn scene(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(260.0);
    entries(ui, NewObject::ALL.map(|kind| Command::Edit(EditCommand::Add(kind, None))), asked);
    ui.separator();
    ui.menu_button("Presets", |ui| presets_of(ui, false, asked));
    ui.menu_button("Recordings", |ui| {
        entries(ui, (0..recordings::ALL.len()).map(|v| Command::Document(DocumentCommand::Recording(v))), asked);
    });
    ui.separator();
    // A click into a field of the submenu must not close it.
    let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    SubMenuButton::new("Random scene").config(stays).ui(ui, |ui| random_scenes(ui, &state.settings, asked));
    ui.separator();
    entry(ui, ViewCommand::FitScene, true, asked);
}

/// Entries for every kind of random scene, and fields for seed and number of the next.
fn random_scenes(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    for kind in Kind::all() {
        entry_called(ui, kind.description(), Command::Document(DocumentCommand::RandomScene(kind)), true, asked);
    }
    ui.separator();
    ui.horizontal(|ui| {
        let (mut seed, mut number) = (settings.random_seed, settings.random_number);
        let tip =
            "The same kind, seed and number always give the same scene: that of the tables and of the command line";
        let seeds = labelled(ui, "Next: seed", tip, NumberField::new(&mut seed).speed(0.05));
        let numbers = labelled(ui, "number", "It rises by one each time", NumberField::new(&mut number).speed(0.05));
        if seeds.changed() || numbers.changed() {
            asked.push(DocumentCommand::SetNextRandom { seed, number }.into());
        }
    });
}

fn presets_of(ui: &mut Ui, failures: bool, asked: &mut Vec<Command>) {
    let listed = PRESETS.iter().enumerate().filter(|(_, preset)| preset.is_failure == failures);
    for (index, preset) in listed {
        if ui.button(&preset.name).on_hover_text(&preset.notes).clicked() {
            asked.push(DocumentCommand::Preset(index).into());
            ui.close();
        }
    }
}

fn is_of_use(panel: Panel, state: &State) -> bool {
    let has_content = match panel {
        Panel::Found => state.finds_reflectors(),
        Panel::Map(MapKind::Unexplained) | Panel::Recording => state.is_recorded(),
        _ => true,
    };
    has_content || state.arrangement.has_tile(panel)
}

fn items<C: Into<Command>>(
    ui: &mut Ui,
    commands: impl IntoIterator<Item = C>,
    state: &State,
    asked: &mut Vec<Command>,
) {
    commands.into_iter().for_each(|command| item(ui, state, command, asked));
}

/// Entries of panels with content, each with its key and with a tick where it is open.
fn panels(ui: &mut Ui, panels: impl IntoIterator<Item = Panel>, state: &State, asked: &mut Vec<Command>) {
    for panel in panels.into_iter().filter(|panel| is_of_use(*panel, state)) {
        let open = state.arrangement.has_tile(panel);
        let command = if open { WindowCommand::ClosePanel(panel) } else { WindowCommand::OpenPanel(panel) };
        ticked(ui, panel.tile_title(), command, open, asked);
    }
}

/// Tools and their commands; research tools appear where developer panels are on.
fn tools(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(240.0);
    let tools = Panel::tiles().into_iter().filter(|panel| panel.is_tool() && !HELP.contains(panel));
    let (of_developers, tools): (Vec<Panel>, Vec<Panel>) = tools.partition(|panel| panel.is_developer());
    panels(ui, tools, state, asked);
    ui.separator();
    item(ui, state, ViewCommand::Flip, asked);
    ui.menu_button("Failures explained", |ui| presets_of(ui, true, asked));
    ui.separator();
    item(ui, state, ViewCommand::ToggleDeveloper, asked);
    if state.settings.developer {
        panels(ui, of_developers, state, asked);
    }
}

fn help(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(240.0);
    panels(ui, HELP, state, asked);
    item(ui, state, WindowCommand::ToggleCaptions, asked);
    ui.separator();
    items(ui, HelpPage::ALL.map(WindowCommand::Help), state, asked);
}

fn view(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.set_min_width(240.0);
    ui.menu_button("Panels", |ui| {
        panels(ui, Panel::tiles().into_iter().filter(|panel| !panel.is_tool()), state, asked);
    });
    ui.menu_button("Arrangement", |ui| {
        for task in Task::ALL {
            ticked(ui, task.name(), WindowCommand::ArrangeFor(task), state.arrangement.task == task, asked);
        }
    });
    ui.menu_button("Colours", |ui| {
        for colours in ColourMap::ALL {
            let on = state.settings.colours == colours;
            ticked(ui, colours.name(), ViewCommand::Colours(colours), on, asked);
        }
    });
    ui.menu_button("Overlays", |ui| items(ui, ViewCommand::OVERLAYS, state, asked));
    let [layout, maps, window] = VIEW;
    items(ui, layout.iter().cloned(), state, asked);
    for group in [maps, window] {
        ui.separator();
        items(ui, group.iter().cloned(), state, asked);
    }
}

#[cfg(test)]
mod tests;
