//! The commands of a page in a browser: some keys belong to the browser, and some commands to a desktop.

use super::command::{Command, DocumentCommand, ExportCommand, LessonCommand, Purpose, WindowCommand};
use super::panel::Panel;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// Whether a command needs a desktop: a training log, a folder, a capture card, or a window to close.
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

/// The key of a command whose usual key belongs to the browser (reload, whole screen, tools, tabs and windows), pressed with Shift.
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

/// The key of a command on a page, if any; the outer `None` where a page can't do it.
pub fn on_a_page(command: &Command, key: Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>> {
    let free = free_key(command).map(|key| KeyboardShortcut::new(Modifiers::SHIFT, key));
    (!needs_a_desktop(command)).then_some(free.or(key))
}

/// The key of a command on a desktop, if any; the outer `None` where only a page can do it.
pub fn on_a_desktop(command: &Command, key: Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>> {
    (*command != Command::Export(ExportCommand::CopyLink)).then_some(key)
}
