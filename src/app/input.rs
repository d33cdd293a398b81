//! Keys and clipboard events, turned into commands.

use super::state::{Command, EditCommand, WindowCommand, shortcuts};
use super::widgets::nudge;
use eframe::egui::{Context, Event, Key, Modifiers, Popup, RawInput};

/// Events of one frame that wait for the next.
///
/// A field takes typed letters when it is drawn. Tab, Enter, a press of the mouse and the palette's key move the focus before that. Letters that come in one
/// frame with them would reach another field or none, or run commands.
#[derive(Default)]
pub struct Later(Vec<Event>);

impl Later {
    /// Leaves the waiting events in `input`, then those of this frame that may follow them; keeps the others. True where some are kept.
    pub fn sort(&mut self, input: &mut RawInput) -> bool {
        let mut events = std::mem::take(&mut self.0);
        events.append(&mut input.events);
        let moves = |e: &Event| match e {
            // Ctrl+K and Ctrl+Shift+P open the palette, whose field takes the letters after them.
            Event::Key { key: Key::K | Key::P, pressed, modifiers, .. } => *pressed && modifiers.command,
            Event::Key { key, pressed, .. } => *pressed && matches!(key, Key::Tab | Key::Enter),
            Event::PointerButton { pressed, .. } => *pressed,
            _ => false,
        };
        let typed = |e: &Event| matches!(e, Event::Text(_) | Event::Paste(_));
        let from_first =
            |is: &dyn Fn(&Event) -> bool, from: usize| events[from..].iter().position(is).map(|i| i + from);
        let pressed = |e: &Event| typed(e) || matches!(e, Event::Key { pressed: true, .. });
        let first_typed = from_first(&typed, 0).unwrap_or(events.len());
        let first_move = from_first(&moves, 0).unwrap_or(events.len());
        // Letters, then a move: the move waits. A move, then any key: the key waits.
        let end = match first_typed < first_move {
            true => first_move,
            false => from_first(&pressed, (first_move + 1).min(events.len())).unwrap_or(events.len()),
        };
        self.0 = events.split_off(end);
        input.events = events;
        !self.0.is_empty()
    }
}

/// State on which the meaning of keys depends.
pub struct Input {
    /// Whether the palette or a dialog is open and takes all keys.
    pub keys_taken: bool,
    /// Whether a field had the focus at the end of the last frame and takes Escape.
    pub in_a_field: bool,
    /// Whether objects are selected that arrow keys can move.
    pub selected: bool,
    /// Step of an arrow key: a range bin of the radar, metres.
    pub bin_metres: f64,
}

/// The commands of keys and clipboard since the last frame.
pub fn read(ctx: &Context, input: Input) -> Vec<Command> {
    let mut commands = Vec::new();
    // Enter and Tab end an entry in a field as releasing the pointer ends a drag. Each is an undo step.
    if ctx.input(|i| i.pointer.any_released() || i.key_pressed(Key::Enter) || i.key_pressed(Key::Tab)) {
        commands.push(EditCommand::Seal.into());
    }
    let escapes_a_field = input.in_a_field && ctx.input(|i| i.key_pressed(Key::Escape));
    // An open menu takes all keys, too: Escape closes it.
    if input.keys_taken || escapes_a_field || Popup::is_any_open(ctx) || ctx.text_edit_focused() {
        return commands;
    }
    let events = ctx.input(|i| i.events.clone());
    commands.extend(events.into_iter().filter_map(|event| match event {
        Event::Copy => Some(Command::Edit(EditCommand::Copy)),
        Event::Cut => Some(Command::Edit(EditCommand::Cut)),
        Event::Paste(text) => Some(Command::Edit(EditCommand::PasteText(text))),
        _ => None,
    }));
    ctx.input_mut(|keys| {
        for (shortcut, command) in shortcuts() {
            // The system turns these three keys into events of their own.
            if !matches!(
                command,
                Command::Edit(EditCommand::Copy) | Command::Edit(EditCommand::Cut) | Command::Edit(EditCommand::Paste)
            ) && keys.consume_shortcut(shortcut)
            {
                commands.push(command.clone());
            }
        }
        for (modifiers, key, command) in [
            (Modifiers::NONE, Key::Backspace, Command::Edit(EditCommand::Delete)),
            (Modifiers::COMMAND, Key::Y, Command::Edit(EditCommand::Redo)),
            (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::P, Command::Window(WindowCommand::Palette)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::Task;
    use crate::app::widgets::seen;

    #[test]
    fn keys_mean_what_the_list_says() {
        let mut keys = seen::asking([800.0, 600.0], |ui| {
            read(ui.ctx(), Input { keys_taken: false, in_a_field: false, selected: true, bin_metres: 0.5 })
        });
        let shift = Modifiers::COMMAND | Modifiers::SHIFT;
        for (modifiers, key) in [
            (Modifiers::ALT, Key::Num1),
            (Modifiers::COMMAND, Key::Z),
            (shift, Key::Z),
            (Modifiers::SHIFT, Key::ArrowUp),
        ] {
            keys.key_press_modifiers(modifiers, key);
            keys.step();
        }
        let nudge = Command::Edit(EditCommand::Nudge { dx_metres: 0.0, dy_metres: 5.0 });
        let explore = Command::Window(WindowCommand::ArrangeFor(Task::Explore));
        let [undo, redo] = [EditCommand::Undo, EditCommand::Redo].map(Command::Edit);
        assert_eq!(keys.state(), &[explore, undo, redo, nudge], "a digit with Alt makes no scene");
    }

    fn press(key: Key) -> Event {
        pressed(key, Modifiers::NONE)
    }

    fn pressed(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    /// The events by the frame in which they are handled.
    fn frames(events: Vec<Event>) -> Vec<Vec<Event>> {
        let (mut later, mut frames) = (Later::default(), Vec::new());
        let mut input = RawInput { events, ..RawInput::default() };
        loop {
            let more = later.sort(&mut input);
            frames.push(std::mem::take(&mut input.events));
            if !more {
                return frames;
            }
        }
    }

    fn text(t: &str) -> Event {
        Event::Text(t.to_owned())
    }

    #[test]
    fn a_key_that_moves_the_focus_has_a_frame_of_its_own() {
        let fast = vec![text("1"), text("2"), press(Key::Tab), text("5"), press(Key::Enter), text("p")];
        let slow = [
            vec![text("1"), text("2")],
            vec![press(Key::Tab)],
            vec![text("5")],
            vec![press(Key::Enter)],
            vec![text("p")],
        ];
        assert_eq!(frames(fast), slow);
        let harmless = vec![text("1"), press(Key::ArrowUp), text("2")];
        assert_eq!(frames(harmless.clone()), [harmless]);
    }

    #[test]
    fn letters_after_the_palettes_key_wait_for_the_palette() {
        let open = pressed(Key::K, Modifiers::COMMAND);
        let letters = [press(Key::T), text("t")];
        let typed = [vec![open.clone()], letters.to_vec()].concat();
        assert_eq!(frames(typed), [vec![open.clone()], letters.to_vec()]);
        assert_eq!(frames(vec![text("t"), open.clone()]), [vec![text("t")], vec![open]]);
    }

    #[test]
    fn a_click_has_a_frame_of_its_own() {
        let (at, primary) = (eframe::egui::pos2(1.0, 1.0), eframe::egui::PointerButton::Primary);
        let modifiers = Modifiers::NONE;
        let button = |pressed| Event::PointerButton { pos: at, button: primary, pressed, modifiers };
        let click = vec![text("b"), Event::PointerMoved(at), button(true), button(false), text("c")];
        let apart = [vec![text("b"), Event::PointerMoved(at)], vec![button(true), button(false)], vec![text("c")]];
        assert_eq!(frames(click), apart, "what was typed before a click stays");
    }
}
