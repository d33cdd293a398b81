//! Menu entries and buttons of commands, with name, tooltip and key from the list of commands.

use crate::app::state::{Command, Entry, State};
use eframe::egui::{Atom, Button, IdSalt, Response, Role, Stroke, Ui, WidgetInfo, WidgetText, vec2};

/// A menu entry; a click sends the command and closes the menu.
pub fn entry(ui: &mut Ui, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    let name = command.entry().map_or("", |listed| listed.name.as_ref());
    entry_called(ui, name, command, enabled, asked);
}

/// A menu entry with its own name, for a menu whose title has the rest of it.
pub fn entry_called(ui: &mut Ui, name: &str, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    let Some(listed) = command.entry() else { return };
    if ui.add_enabled(enabled, with_key(ui, Button::new(name), listed)).on_hover_text(listed.tooltip).clicked() {
        asked.push(command);
        ui.close();
    }
}

fn with_key<'a>(ui: &Ui, button: Button<'a>, listed: &Entry) -> Button<'a> {
    match &listed.key {
        Some(key) => button.shortcut_text(ui.ctx().format_shortcut(key)),
        None => button,
    }
}

/// Side of the place for a tick, points.
const TICK_SIDE_POINTS: f32 = 12.0;

/// A menu entry of a switch, with a tick while it is `on`.
pub fn ticked(ui: &mut Ui, name: &str, command: impl Into<Command>, on: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    let Some(listed) = command.entry() else { return };
    let place = IdSalt::new("tick");
    let button =
        with_key(ui, Button::new((Atom::custom(place, vec2(TICK_SIDE_POINTS, TICK_SIDE_POINTS)), name)), listed);
    let drawn = button.atom_ui(ui);
    if let Some(rect) = drawn.rect(place).filter(|_| on) {
        let [left, low, right] = [vec2(1.0, 6.0), vec2(4.5, 9.5), vec2(11.0, 2.0)].map(|at| rect.min + at);
        ui.painter().line(vec![left, low, right], Stroke::new(1.8, ui.visuals().text_color()));
    }
    let response = drawn.response;
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), on, name));
    if response.on_hover_text(listed.tooltip).clicked() {
        asked.push(command);
        ui.close();
    }
}

/// A menu entry, with a tick where its switch is on.
pub fn item(ui: &mut Ui, state: &State, command: impl Into<Command>, asked: &mut Vec<Command>) {
    let command = command.into();
    let name = command.entry().map_or("", |listed| listed.name.as_ref());
    match state.is_on(&command) {
        Some(on) => ticked(ui, name, command, on, asked),
        None => entry(ui, command, true, asked),
    }
}

/// A button with a label shorter than the command's name; its tooltip has the key.
pub fn button(ui: &mut Ui, label: &str, command: impl Into<Command>, enabled: bool, asked: &mut Vec<Command>) {
    let command = command.into();
    if ui.add_enabled(enabled, Button::new(label)).on_hover_text(tooltip(ui, &command)).clicked() {
        asked.push(command);
    }
}

/// A button for a command that no menu lists.
pub fn press<C: Into<Command>>(
    ui: &mut Ui,
    name: impl Into<WidgetText>,
    tooltip: &str,
    command: C,
    asked: &mut Vec<Command>,
) {
    if tipped(ui.button(name.into()), tooltip).clicked() {
        asked.push(command.into());
    }
}

/// A box that is ticked while a switch is `on`; a click sends the `command` with the opposite value.
pub fn tick<C: Into<Command>>(
    ui: &mut Ui,
    mut on: bool,
    name: &str,
    tooltip: &str,
    command: impl FnOnce(bool) -> C,
    asked: &mut Vec<Command>,
) {
    if tipped(ui.checkbox(&mut on, name), tooltip).changed() {
        asked.push(command(on).into());
    }
}

/// Draws a row of labels, one for each choice. `of` yields the choice, its name and its tooltip. A click on another choice sends its `command`.
pub fn choices<'a, T: PartialEq + Copy, C: Into<Command>>(
    ui: &mut Ui,
    chosen: T,
    of: impl IntoIterator<Item = (T, &'a str, &'a str)>,
    command: impl Fn(T) -> C,
    asked: &mut Vec<Command>,
) {
    for (choice, name, tooltip) in of {
        if tipped(ui.selectable_label(choice == chosen, name), tooltip).clicked() && choice != chosen {
            asked.push(command(choice).into());
        }
    }
}

pub fn tipped(response: Response, tooltip: &str) -> Response {
    if tooltip.is_empty() { response } else { response.on_hover_text(tooltip) }
}

pub fn tooltip(ui: &Ui, command: &Command) -> String {
    let Some(listed) = command.entry() else { return String::new() };
    let key = listed.key.map(|key| format!(" ({})", ui.ctx().format_shortcut(&key))).unwrap_or_default();
    format!("{}{key}", listed.tooltip)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::ViewCommand;
    use crate::app::widgets::seen::{Harness, NodeT, Queryable, User};
    use eframe::egui::Shape;

    #[test]
    fn an_entry_that_is_on_has_a_tick_and_its_key() {
        let entry = |on| {
            let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
                ticked(ui, "Mark true reflectors", ViewCommand::ToggleReflectors, on, asked);
            };
            Harness::new_ui_state(draw, Vec::new())
        };
        for on in [true, false] {
            let mut menu = entry(on);
            let ticks = menu.output().shapes.iter().filter(|s| matches!(s.shape, Shape::Path(_))).count();
            assert_eq!(ticks, usize::from(on));
            let node = menu.get_by_role_and_label(Role::CheckBox, "Mark true reflectors");
            let toggled = eframe::egui::accesskit::Toggled::from(on);
            assert_eq!(node.accesskit_node().toggled(), Some(toggled), "screen readers hear it");
            assert!(menu.reads("R"), "its key stands beside it");
            node.click();
            menu.step();
            assert_eq!(menu.state(), &[ViewCommand::ToggleReflectors.into()]);
        }
    }
}
