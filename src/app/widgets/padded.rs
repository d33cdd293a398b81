//! The margin of panels, and scroll bars where the content is too large.

use super::entry::tipped;
use crate::app::state::Command;
use eframe::egui::{Align, Align2, FontId, Frame, Layout, Margin, Rect, Response, ScrollArea, Ui};

/// Draws a panel's content with a margin; returns its commands.
pub fn padded(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    within(ui, Margin::symmetric(10, 6), content)
}

/// The same with vertical scrolling.
pub fn scrolled(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    scrolled_by(ScrollArea::vertical(), ui, content)
}

/// The same with scrolling in both directions.
pub fn scrolled_both(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    scrolled_by(ScrollArea::both(), ui, content)
}

/// A text in the colour of warnings, if there is one.
pub fn warning(ui: &mut Ui, said: Option<&str>) {
    if let Some(said) = said {
        ui.colored_label(ui.visuals().warn_fg_color, said);
    }
}

/// A weak text in the middle of an area that would be empty.
pub fn empty_text(ui: &Ui, area: Rect, text: &str) {
    let ink = ui.visuals().weak_text_color();
    ui.painter().text(area.center(), Align2::CENTER_CENTER, text, FontId::proportional(14.0), ink);
}

/// The headings of a table with their tooltips, as a row of a grid.
pub fn headings<'a>(ui: &mut Ui, headings: impl IntoIterator<Item = (&'a str, &'a str)>) {
    for (heading, tooltip) in headings {
        tipped(ui.strong(heading), tooltip);
    }
    ui.end_row();
}

/// A cell of a table, aligned to the right.
pub fn right_aligned(ui: &mut Ui, content: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.with_layout(Layout::right_to_left(Align::Center), content).inner
}

/// The computed value of a panel. Without a value it draws the error, or that the value is being computed.
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
