//! Scrolling, colours and keyboard focus of lists with rows of equal height.

use eframe::egui::{Color32, Response, ScrollArea, Visuals};

/// The visible part of a list.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Window {
    /// Height above the first visible row, points.
    pub offset: f32,
    /// Height of the visible part, points.
    pub room: f32,
}

/// Scrolls until `row` is in sight, where each row is `height` points high.
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

/// The colour behind a row that is selected or under the pointer.
pub fn colour_behind(visuals: &Visuals, response: &Response, is_selected: bool) -> Option<Color32> {
    if is_selected {
        Some(visuals.selection.bg_fill)
    } else {
        response.hovered().then_some(visuals.widgets.hovered.weak_bg_fill)
    }
}

/// Gives `list` the keyboard's focus after a click on one of its rows, if one `was_clicked`. It waits for the frame after the click: egui takes the focus away
/// from a widget that the click did not hit, and the click may have moved the rows.
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
