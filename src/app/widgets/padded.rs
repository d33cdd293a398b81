//! Layouts: the margin of panels with scroll bars, rows of settings, and groups that fold.

use super::entry::tipped;
use crate::app::state::Command;
use eframe::egui::{
    Align, Align2, CollapsingHeader, FontId, Frame, Layout, Margin, Rect, Response, RichText, ScrollArea, Ui, vec2,
};

/// Draws a panel's content with a margin; returns its commands.
pub fn padded(ui: &mut Ui, content: impl FnOnce(&mut Ui, &mut Vec<Command>)) -> Vec<Command> {
    within(ui, Margin::symmetric(10, 6), content)
}

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

pub fn right_aligned(ui: &mut Ui, content: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.with_layout(Layout::right_to_left(Align::Center), content).inner
}

/// The computed value of a panel, or the reason why there is none; `None` before the first.
pub type Computed<'a, T> = Option<Result<&'a T, &'a str>>;

/// The computed value of a panel. Without a value it draws the error, or that the value is being computed.
pub fn computed<'a, T>(ui: &mut Ui, value: Computed<'a, T>) -> Option<&'a T> {
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

const NAME_WIDTH_POINTS: f32 = 78.0;

const NAME_GAP_POINTS: f32 = 8.0;

/// A row: its name, then its widget. The name labels the widget for screen readers.
pub fn row(ui: &mut Ui, name: &str, tooltip: &str, widget: impl FnOnce(&mut Ui) -> Response) {
    named(ui, name, tooltip, |ui, label| {
        widget(ui).labelled_by(label.id).on_hover_text(tooltip);
    });
}

/// A row of several choices, whose own texts are their names; wraps into more lines where there is no room.
pub fn row_of(ui: &mut Ui, name: &str, tooltip: &str, widgets: impl FnOnce(&mut Ui)) {
    named(ui, name, tooltip, |ui, _| widgets(ui));
}

fn named(ui: &mut Ui, name: &str, tooltip: &str, widgets: impl FnOnce(&mut Ui, &Response)) {
    let height = ui.spacing().interact_size.y;
    ui.horizontal_top(|ui| {
        let line = Layout::left_to_right(Align::Center);
        let label = ui.allocate_ui_with_layout(vec2(NAME_WIDTH_POINTS, height), line, |ui| {
            ui.set_min_size(vec2(NAME_WIDTH_POINTS, height));
            ui.label(name).on_hover_text(tooltip)
        });
        ui.add_space(NAME_GAP_POINTS - ui.spacing().item_spacing.x);
        let room = vec2(ui.available_width(), height);
        ui.allocate_ui_with_layout(room, line.with_main_wrap(true), |ui| widgets(ui, &label.inner));
    });
}

/// A group with a title, open by default.
pub fn group(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    fold(ui, RichText::new(title).strong(), title, true, content);
    ui.add_space(4.0);
}

/// Settings that are rarely changed, folded by default under a title that names them.
pub fn rarely(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    fold(ui, RichText::new(title).weak(), title, false, content);
}

fn fold(ui: &mut Ui, text: RichText, salt: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(text).id_salt(salt).default_open(open).show_unindented(ui, content);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    #[test]
    fn a_row_grows_with_its_choices() {
        let draw = |ui: &mut Ui| {
            row_of(ui, "Normalise", "", |ui| {
                for choice in ["Min–max", "40 dB", "60 dB", "100 dB", "any other"] {
                    _ = ui.selectable_label(false, choice);
                }
            });
            row_of(ui, "Floor", "", |ui| _ = ui.selectable_label(false, "Thesis"));
        };
        for width in [200.0, 260.0, 420.0] {
            let rows = Harness::builder().with_size([width, 300.0]).build_ui(draw);
            let (above, below) = (rows.get_by_label("any other").rect(), rows.get_by_label("Thesis").rect());
            assert!(above.bottom() <= below.top(), "{width}: {above:?}, {below:?}");
            assert!(above.right() <= width);
            seen::assert_readable(rows.output());
        }
    }

    #[test]
    fn what_is_rarely_changed_is_folded() {
        let draw = |ui: &mut Ui| rarely(ui, "Noise seed and carrier", |ui| _ = ui.label("Two-way"));
        let mut folded = Harness::builder().with_size([260.0, 200.0]).build_ui(draw);
        assert!(folded.query_by_label("Two-way").is_none());
        folded.clicks(&["Noise seed and carrier"]);
        let _open = folded.get_by_label("Two-way");
    }
}
