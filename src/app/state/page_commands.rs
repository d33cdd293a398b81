//! The list of commands as a page in a browser has it: some keys belong to the browser, and some commands to a desktop.

use super::command::{Command, DocumentCommand, ExportCommand, LessonCommand, Purpose, WindowCommand};
use super::panel::Panel;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// What a page can't do: train, list a folder, close itself.
fn needs_a_desktop(command: &Command) -> bool {
    matches!(
        command,
        Command::Window(
            WindowCommand::Quit
                | WindowCommand::TogglePanel(Panel::Training)
                | WindowCommand::Maximise(Panel::Training)
        ) | Command::AskFile(Purpose::OpenLog | Purpose::OwnScenes | Purpose::Listen(_))
    )
}

/// What only a page can do: it has an address.
fn needs_a_page(command: &Command) -> bool {
    matches!(command, Command::Export(ExportCommand::CopyLink))
}

/// Keys that a browser keeps for itself (reload, whole screen, its tools, tabs and windows), and the commands' keys in their place.
fn free_key(command: &Command) -> Option<Key> {
    Some(match command {
        Command::Document(DocumentCommand::New) => Key::N,
        Command::Window(WindowCommand::ToggleTheme) => Key::T,
        Command::Window(WindowCommand::TogglePanel(Panel::Lesson)) => Key::L,
        Command::Window(WindowCommand::Present) => Key::P,
        Command::Lesson(LessonCommand::Present) => Key::F,
        _ => return None,
    })
}

/// The key that a command has on a page, where it has one; `None` where a page can't do it.
pub fn on_a_page(command: &Command, key: Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>> {
    let free = free_key(command).map(|key| KeyboardShortcut::new(Modifiers::SHIFT, key));
    (!needs_a_desktop(command)).then_some(free.or(key))
}

/// The same on a desktop; `None` where only a page can do it.
pub fn on_a_desktop(command: &Command, key: Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>> {
    (!needs_a_page(command)).then_some(key)
}
