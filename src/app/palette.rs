//! The palette: find any command by typing part of its name.

use super::application::App;
use super::command::Command;
use eframe::egui;
use eframe::egui::{Align2, Button, Context, Key, Modifiers, TextEdit};

/// State of the palette.
#[derive(Default)]
pub(super) struct Palette {
    open: bool,
    text: String,
    chosen: usize,
    just_opened: bool,
}

impl Palette {
    /// Whether it is on screen.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Opens it afresh, or closes it.
    pub fn toggle(&mut self) {
        *self = Palette { open: !self.open, just_opened: !self.open, ..Palette::default() };
    }
}

/// Whether every word of `text` is in `name`, whatever the case.
fn matches(name: &str, text: &str) -> bool {
    let name = name.to_lowercase();
    text.to_lowercase().split_whitespace().all(|word| name.contains(word))
}

/// Draws the palette, if it is open.
pub(super) fn show(app: &mut App, ctx: &Context) {
    if !app.palette.open {
        return;
    }
    let mut run = None;
    let mut close = false;
    let methods = app.pipeline.methods.iter().map(|m| Command::Method(m.name()));
    let found: Vec<Command> = Command::all()
        .into_iter()
        .chain(methods)
        .filter(|c| *c != Command::Palette && matches(&c.spec().name, &app.palette.text))
        .collect();
    let palette = &mut app.palette;
    let (up, down, enter, escape) = ctx.input_mut(|i| {
        (
            i.consume_key(Modifiers::NONE, Key::ArrowUp),
            i.consume_key(Modifiers::NONE, Key::ArrowDown),
            i.consume_key(Modifiers::NONE, Key::Enter),
            i.consume_key(Modifiers::NONE, Key::Escape),
        )
    });
    let last = found.len().saturating_sub(1);
    palette.chosen = match (up, down) {
        (true, _) => palette.chosen.saturating_sub(1),
        (_, true) => palette.chosen + 1,
        _ => palette.chosen,
    }
    .min(last);
    let area = egui::Window::new("Commands")
        .title_bar(false)
        .resizable(false)
        .collapsible(false)
        .anchor(Align2::CENTER_TOP, [0.0, 60.0])
        .fixed_size([420.0, 340.0])
        .show(ctx, |ui| {
            let edit = TextEdit::singleline(&mut palette.text)
                .hint_text("Type part of a command's name")
                .desired_width(f32::INFINITY);
            let response = ui.add(edit);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Find a command"));
            if palette.just_opened {
                response.request_focus();
                palette.just_opened = false;
            }
            if response.changed() {
                palette.chosen = 0;
            }
            ui.separator();
            if found.is_empty() {
                ui.weak("No command has such a name.");
            }
            egui::ScrollArea::vertical().auto_shrink([false, false]).max_height(300.0).show(ui, |ui| {
                for (index, command) in found.iter().enumerate() {
                    let spec = command.spec();
                    // An empty key, too, pushes the name to the left.
                    let key = spec.shortcut.map(|key| ui.ctx().format_shortcut(&key)).unwrap_or_default();
                    let button = Button::selectable(index == palette.chosen, spec.name).shortcut_text(key);
                    let response = ui.add_sized([ui.available_width(), 22.0], button).on_hover_text(spec.tooltip);
                    if index == palette.chosen && (up || down) {
                        response.scroll_to_me(None);
                    }
                    if response.clicked() {
                        run = Some(command.clone());
                    }
                }
            });
        });
    if enter {
        run = run.or_else(|| found.get(palette.chosen).cloned());
    }
    if let Some(area) = area {
        close = area.response.clicked_elsewhere();
    }
    if let Some(command) = run {
        app.commands.push(command);
        close = true;
    }
    if close || escape {
        app.palette.open = false;
    }
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn words_match_in_any_order() {
        assert!(matches("Show or hide: Input 0", "input SHOW"));
        assert!(!matches("Show or hide: Input 0", "input 1"));
        assert!(matches("anything", ""));
    }
}
