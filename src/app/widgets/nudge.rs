//! Arrow keys that move the selection.

use crate::app::state::{Command, EditCommand};
use eframe::egui::{Context, EventFilter, Key, Modifiers, Response};

/// Arrow keys move the selection by one range bin, with Shift by ten, with Alt by a tenth.
pub fn nudge(ctx: &Context, bin_metres: f64) -> Option<Command> {
    let (mut dx, mut dy) = (0.0, 0.0);
    ctx.input_mut(|input| {
        for (modifiers, step) in [(Modifiers::SHIFT, 10.0), (Modifiers::ALT, 0.1), (Modifiers::NONE, 1.0)] {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as f64 * step;
            dx += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            dy += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        }
    });
    ((dx, dy) != (0.0, 0.0))
        .then_some(Command::Edit(EditCommand::Nudge { dx_metres: dx * bin_metres, dy_metres: dy * bin_metres }))
}

/// Steps in and out that `+` and `-` ask for in a view that has the focus, as a factor; its arrow keys are its own then, and don't move
/// the focus.
pub fn zoom_keys(response: &Response) -> Option<f32> {
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter { vertical_arrows: true, horizontal_arrows: true, ..EventFilter::default() };
    response.ctx.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
    let steps = response.ctx.input_mut(|input| {
        let mut pressed = |key| input.count_and_consume_key(Modifiers::NONE, key) as i32;
        pressed(Key::Plus) + pressed(Key::Equals) - pressed(Key::Minus)
    });
    (steps != 0).then(|| 1.25f32.powi(steps))
}
