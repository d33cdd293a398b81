//! What lists of rows of one height share: scrolling to a row, and the colours behind one.

use eframe::egui::{Color32, Response, ScrollArea, Visuals};

/// The part of a list in sight, points: how far it is scrolled, and how much room rows have.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Window {
    /// Above the first row in sight.
    pub offset: f32,
    /// Height of what is in sight.
    pub room: f32,
}

/// Scrolls so far that `row`, of `height` points as all are, is in sight.
pub fn bring_in_sight(area: ScrollArea, row: usize, height: f32, window: Window) -> ScrollArea {
    let (top, bottom) = (row as f32 * height, (row + 1) as f32 * height);
    if top < window.offset {
        area.vertical_scroll_offset(top)
    } else if bottom > window.offset + window.room {
        area.vertical_scroll_offset(bottom - window.room)
    } else {
        area
    }
}

/// What is painted behind a row that is selected or under the pointer.
pub fn colour_behind(visuals: &Visuals, response: &Response, is_selected: bool) -> Option<Color32> {
    if is_selected {
        Some(visuals.selection.bg_fill)
    } else {
        response.hovered().then_some(visuals.widgets.hovered.weak_bg_fill)
    }
}
