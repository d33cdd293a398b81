//! Keys, clipboard events, dropped files and closed dialogs become commands.

use super::jobs::Dialogs;
use super::state::{Command, shortcuts};
use eframe::egui::{Context, Event, Key, Modifiers};

/// What the keys mean depends on this.
pub struct Input<'a> {
    /// File dialogs that may have been closed.
    pub dialogs: &'a Dialogs,
    /// Whether the palette is open: then the keys are its own.
    pub palette: bool,
    /// Whether something is selected that arrow keys can move.
    pub selected: bool,
    /// A range bin of the radar: what an arrow key moves by.
    pub bin_metres: f64,
}

/// Everything that was asked for since the last frame, but for what panels will be asked in this one.
pub fn read(ctx: &Context, input: Input<'_>) -> Vec<Command> {
    let mut commands: Vec<Command> = std::iter::from_fn(|| input.dialogs.answer()).collect();
    let dropped = ctx.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
    commands.extend(dropped.map(|path| match path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
        true => Command::WatchLog(path),
        false => Command::OpenPath(path),
    }));
    if ctx.input(|i| i.pointer.any_released()) {
        commands.push(Command::Seal);
    }
    if input.palette || ctx.text_edit_focused() {
        return commands;
    }
    let events = ctx.input(|i| i.events.clone());
    commands.extend(events.into_iter().filter_map(|event| match event {
        Event::Copy => Some(Command::Copy),
        Event::Cut => Some(Command::Cut),
        Event::Paste(text) => Some(Command::PasteText(text)),
        _ => None,
    }));
    ctx.input_mut(|keys| {
        for (shortcut, command) in shortcuts() {
            // The system turns these three into events of their own.
            if !matches!(command, Command::Copy | Command::Cut | Command::Paste) && keys.consume_shortcut(shortcut) {
                commands.push(command.clone());
            }
        }
        for (modifiers, key, command) in [
            (Modifiers::NONE, Key::Backspace, Command::Delete),
            (Modifiers::COMMAND, Key::Y, Command::Redo),
            (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::P, Command::Palette),
        ] {
            if keys.consume_key(modifiers, key) {
                commands.push(command);
            }
        }
    });
    if input.selected && ctx.memory(|m| m.focused().is_none()) {
        commands.extend(nudge(ctx, input.bin_metres));
    }
    commands
}

/// Arrow keys move the selection by one range bin, with Shift by ten, with Alt by a tenth.
fn nudge(ctx: &Context, bin_metres: f64) -> Option<Command> {
    let (mut dx, mut dy) = (0.0, 0.0);
    ctx.input_mut(|input| {
        for (modifiers, step) in [(Modifiers::SHIFT, 10.0), (Modifiers::ALT, 0.1), (Modifiers::NONE, 1.0)] {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as f64 * step;
            dx += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            dy += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        }
    });
    ((dx, dy) != (0.0, 0.0)).then(|| Command::Nudge { dx_metres: dx * bin_metres, dy_metres: dy * bin_metres })
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;

    #[test]
    fn keys_mean_what_the_list_says_and_digits_alone_nothing() {
        let dialogs = Dialogs::default();
        let draw = |ui: &mut eframe::egui::Ui, asked: &mut Vec<Command>| {
            let input = Input { dialogs: &dialogs, palette: false, selected: true, bin_metres: 0.5 };
            asked.extend(read(ui.ctx(), input));
        };
        let mut keys = Harness::new_ui_state(draw, Vec::new());
        let shift = Modifiers::COMMAND | Modifiers::SHIFT;
        for (modifiers, key) in [
            (Modifiers::NONE, Key::Num1),
            (Modifiers::COMMAND, Key::Z),
            (shift, Key::Z),
            (Modifiers::SHIFT, Key::ArrowUp),
        ] {
            keys.key_press_modifiers(modifiers, key);
            keys.step();
        }
        let nudge = Command::Nudge { dx_metres: 0.0, dy_metres: 5.0 };
        assert_eq!(keys.state(), &[Command::Undo, Command::Redo, nudge]);
    }
}
