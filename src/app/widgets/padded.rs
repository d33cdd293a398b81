//! The margin of panels, and the scroll bars of those that grow with their content.

use crate::app::state::Command;
use eframe::egui::{Frame, Margin, ScrollArea, Ui};

/// Draws a panel's content within a margin; what it asks for.
pub fn padded(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    within(ui, Margin::symmetric(10, 6), content)
}

/// The same, scrolled upwards and downwards where there is little room.
pub fn scrolled(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    scrolled_by(ScrollArea::vertical(), ui, content)
}

/// The same, scrolled to all sides.
pub fn scrolled_both(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    scrolled_by(ScrollArea::both(), ui, content)
}

/// What is to be known, in the colour of warnings; nothing where there is no such thing.
pub fn warning(ui: &mut Ui, said: Option<&str>) {
    if let Some(said) = said {
        ui.colored_label(ui.visuals().warn_fg_color, said);
    }
}

/// What was computed for a panel; where there is nothing, it says why, or that it is under way.
pub fn computed<'a, T>(ui: &mut Ui, value: Option<Result<&'a T, &str>>) -> Option<&'a T> {
    match value {
        None => _ = ui.weak("computing…"),
        Some(Err(error)) => _ = ui.colored_label(ui.visuals().error_fg_color, error),
        Some(Ok(value)) => return Some(value),
    }
    None
}

fn scrolled_by(area: ScrollArea, ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    let scrolled =
        |ui: &mut Ui, asked: &mut Vec<Command>| _ = area.auto_shrink(false).show(ui, |ui| content(ui, asked));
    within(ui, Margin::symmetric(10, 8), scrolled)
}

fn within(ui: &mut Ui, margin: Margin, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    let mut asked = Vec::new();
    Frame::NONE.inner_margin(margin).show(ui, |ui| content(ui, &mut asked));
    asked
}
