//! The list of commands as a page in a browser has it: some keys belong to the browser, and some commands to a desktop.

use super::command::{Command, DocumentCommand, ExportCommand, RowsCommand, WindowCommand, WorkCommand};
use super::command_table::Entry;
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
        ) | Command::Work(WorkCommand::OpenLog)
            | Command::Rows(RowsCommand::ChooseOwnScenes)
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
        Command::Lesson(super::command::LessonCommand::Present) => Key::F,
        _ => return None,
    })
}

/// The entry as a page has it; `None` where a page can't do it.
pub fn on_a_page(entry: Entry) -> Option<Entry> {
    if needs_a_desktop(&entry.command) {
        return None;
    }
    let free = free_key(&entry.command).map(|key| KeyboardShortcut::new(Modifiers::SHIFT, key));
    Some(Entry { key: free.or(entry.key), ..entry })
}

/// The entry as a desktop has it; `None` where only a page can do it.
pub fn on_a_desktop(entry: Entry) -> Option<Entry> {
    (!needs_a_page(&entry.command)).then_some(entry)
}

#[cfg(test)]
mod tests {
    use super::super::command_table::everything;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_command_of_a_page_has_a_key_of_the_browser() {
        let mut keys = BTreeSet::new();
        for entry in everything().into_iter().filter_map(on_a_page) {
            let Some(KeyboardShortcut { modifiers, logical_key: key }) = entry.key else { continue };
            let of_the_browser = matches!(key, Key::F5 | Key::F11 | Key::F12)
                || modifiers.command && !modifiers.shift && matches!(key, Key::T | Key::W | Key::N);
            assert!(!of_the_browser, "{}", entry.name);
            assert!(keys.insert(format!("{modifiers:?} {key:?}")), "{} shares its key", entry.name);
        }
    }

    #[test]
    fn a_page_offers_a_link_in_place_of_closing_the_window() {
        let offers = |filter: fn(Entry) -> Option<Entry>, command: Command| {
            everything().into_iter().filter_map(filter).any(|entry| entry.command == command)
        };
        let [link, quit] = [Command::Export(ExportCommand::CopyLink), Command::Window(WindowCommand::Quit)];
        assert!(offers(on_a_page, link.clone()) && !offers(on_a_page, quit.clone()));
        assert!(!offers(on_a_desktop, link) && offers(on_a_desktop, quit));
    }
}
