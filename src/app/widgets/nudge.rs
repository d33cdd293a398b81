//! Arrow keys that move the selection or a grip, and pan and zoom a view, as dragging does.

use crate::app::state::{Command, EditCommand};
use eframe::egui::{Context, EventFilter, Key, Modifiers, Response, Vec2, vec2};

/// Ratio of a view that an arrow key pans by.
const PAN_RATIO: f32 = 0.1;

/// Steps to the right and upwards by arrow keys; with Shift ten times as far, with Alt a tenth.
fn steps(ctx: &Context) -> Option<(f64, f64)> {
    let (mut dx, mut dy) = (0.0, 0.0);
    ctx.input_mut(|input| {
        for (modifiers, step) in [(Modifiers::SHIFT, 10.0), (Modifiers::ALT, 0.1), (Modifiers::NONE, 1.0)] {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as f64 * step;
            dx += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            dy += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        }
    });
    ((dx, dy) != (0.0, 0.0)).then_some((dx, dy))
}

/// The command of arrow keys that move the selection by one range bin, with Shift by ten, with Alt by a tenth.
pub fn nudge(ctx: &Context, bin_metres: f64) -> Option<Command> {
    let (dx, dy) = steps(ctx)?;
    Some(EditCommand::Nudge { dx_metres: dx * bin_metres, dy_metres: dy * bin_metres }.into())
}

/// Steps to the right and upwards by arrow keys for a widget with the focus.
pub fn focused_steps(response: &Response) -> Option<(f64, f64)> {
    if !response.has_focus() {
        return None;
    }
    keep_arrows(response, [true; 2]);
    steps(&response.ctx)
}

/// Ratios of a view's width and height that arrow keys pan it by while it has the focus: with Ctrl, or without where they are `free`.
pub fn pan_keys(response: &Response, free: bool) -> Option<Vec2> {
    if !response.has_focus() {
        return None;
    }
    keep_arrows(response, [true; 2]);
    let by = response.ctx.input_mut(|input| {
        let mut by = Vec2::ZERO;
        for modifiers in [Modifiers::COMMAND, Modifiers::NONE].into_iter().take(if free { 2 } else { 1 }) {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as f32;
            by.x += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            by.y += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        }
        PAN_RATIO * by
    });
    (by != vec2(0.0, 0.0)).then_some(by)
}

/// Zoom factor of `+` and `-` for a view with the focus. Its arrow keys then don't move the focus.
pub fn zoom_keys(response: &Response) -> Option<f32> {
    if !response.has_focus() {
        return None;
    }
    keep_arrows(response, [true; 2]);
    let steps = response.ctx.input_mut(|input| {
        let mut pressed = |key| input.count_and_consume_key(Modifiers::NONE, key) as i32;
        pressed(Key::Plus) + pressed(Key::Equals) - pressed(Key::Minus)
    });
    (steps != 0).then(|| 1.25f32.powi(steps))
}

/// Keeps horizontal and vertical arrow keys from moving the focus away from a widget that uses them.
pub fn keep_arrows(response: &Response, [horizontal_arrows, vertical_arrows]: [bool; 2]) {
    let filter = EventFilter { vertical_arrows, horizontal_arrows, ..EventFilter::default() };
    response.ctx.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
}

/// Where arrow keys, Page Up and Down, Home and End with `modifiers` lead in a list of `count` rows from the row `now`, if they are pressed.
pub fn list_keys(
    list: &Response,
    modifiers: Modifiers,
    now: Option<usize>,
    count: usize,
    rows_a_page: usize,
) -> Option<usize> {
    keep_arrows(list, [false, true]);
    let (by, end) = list.ctx.input_mut(|i| {
        let mut times = |key| i.count_and_consume_key(modifiers, key) as isize;
        let lines = times(Key::ArrowDown) - times(Key::ArrowUp);
        let pages = times(Key::PageDown) - times(Key::PageUp);
        (lines + rows_a_page as isize * pages, times(Key::End) - times(Key::Home))
    });
    let last = count.checked_sub(1)?;
    match (end.signum(), now) {
        (1, _) => Some(last),
        (-1, _) => Some(0),
        _ if by == 0 => None,
        (_, Some(now)) => Some(now.saturating_add_signed(by).min(last)),
        (_, None) if by > 0 => Some(0),
        (_, None) => Some(last),
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
