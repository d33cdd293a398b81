//! What lists of rows of one height share: scrolling to a row, the colours behind one, and the keys after a click on one.

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

/// Gives `list` the keys once the click on one of its rows is over, if one `was_clicked`. Not at once: egui takes the focus from what
/// a click did not hit, once more in a frame that is laid out anew, and what the click brings up may have moved the rows away.
pub fn focus_after_click(list: &Response, was_clicked: &mut bool) {
    if *was_clicked {
        if list.ctx.input(|i| i.pointer.any_click()) {
            list.ctx.request_repaint();
        } else {
            list.request_focus();
            *was_clicked = false;
        }
    }
}
