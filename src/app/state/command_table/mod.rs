//! The list of commands with their names, tooltips and keys, for menus, tooltips, shortcuts and the palette.

mod entry;
mod scenes;
mod views;

pub use entry::Entry;

use super::command::{Command, DocumentCommand, EditCommand, ExportCommand, RadarCommand, WindowCommand};
use super::help::HelpPage;
use super::page_commands::{on_a_desktop, on_a_page};
use super::panel::{MapKind, Panel};
use super::task_layouts::Task;
use crate::platform;
use crate::radar::presets::{self as radar_presets, RadarPreset};
use crate::recording::presets as recordings;
use crate::scene::generate::Kind;
use crate::scene::presets;
use eframe::egui::{Key, KeyboardShortcut};
use entry::{alt, command, key, named};
use std::sync::OnceLock;

/// Keys of [`Task::ALL`], pressed with Alt.
const TASK_KEYS: [Key; 4] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];

fn arrange(task: Task, digit: Key) -> Entry {
    let name = format!("Arrange for: {}", task.name());
    named(WindowCommand::ArrangeFor(task), name, task.describe(), alt(digit))
}

fn random(kind: Kind) -> Entry {
    let keys = [Key::Num1, Key::Num2, Key::Num3];
    let (tooltip, key) = match kind.test_set() {
        Some(set) => ("A scene of this test set of the thesis", command(keys[set - 1])),
        None if kind == Kind::Noise => ("An empty scene over thermal noise of a level of its own", None),
        None => ("A scene of a kind that the thesis' sets leave out", None),
    };
    let name = format!("Random scene: {}", kind.description());
    named(DocumentCommand::RandomScene(kind), name, tooltip, key)
}

/// Commands that show and hide each panel, open pages of help, maximise a panel, and copy a map.
fn of_panels() -> Vec<Entry> {
    let toggle = |panel: Panel| {
        let name = format!("Show or hide: {}", panel.title());
        named(WindowCommand::TogglePanel(panel), name, panel.describe(), panel.key().and_then(key))
    };
    let maximise = |panel: Panel| {
        let name = format!("Maximise: {}", panel.title());
        named(WindowCommand::Maximise(panel), name, panel.describe(), None)
    };
    let help = |page: HelpPage| named(WindowCommand::Help(page), page.name(), page.describe(), None);
    let copy = |kind: MapKind| {
        let tooltip = "Copy the whole map to the clipboard as a picture, a pixel a cell";
        named(ExportCommand::CopyMap(kind), format!("Copy picture: {}", kind.title()), tooltip, None)
    };
    let panels = || Panel::all().into_iter();
    let listed = panels().map(toggle).chain(HelpPage::ALL.map(help)).chain(panels().map(maximise));
    listed.chain(MapKind::ALL.map(copy)).collect()
}

fn preset((index, preset): (usize, &presets::Preset)) -> Entry {
    let name = format!("Preset: {}", preset.id.replace('-', " "));
    let tooltip = match preset.is_failure() {
        true => "Open a scene on which a method fails, with the reason in its notes",
        false => "Open a scene the thesis talks about",
    };
    named(DocumentCommand::Preset(index), name, tooltip, None)
}

/// Every command that the program offers on this desktop or page, in the order of the palette. Methods are not in it: each app has its own.
pub fn listed() -> &'static [Entry] {
    static LISTED: OnceLock<Vec<Entry>> = OnceLock::new();
    LISTED.get_or_init(|| listed_where(if platform::IN_A_BROWSER { on_a_page } else { on_a_desktop }))
}

/// The commands that a page in a browser offers, also in a desktop program.
pub fn listed_on_a_page() -> Vec<Entry> {
    listed_where(on_a_page)
}

/// The commands of [`everything`] for which `keys` returns `Some`, each with the key inside.
fn listed_where(keys: impl Fn(&Command, Option<KeyboardShortcut>) -> Option<Option<KeyboardShortcut>>) -> Vec<Entry> {
    everything()
        .into_iter()
        .filter_map(|entry| Some(Entry { key: keys(&entry.command, entry.key)?, ..entry }))
        .collect()
}

/// Every command of desktops and pages.
fn everything() -> Vec<Entry> {
    let radar = |(index, preset): (usize, &RadarPreset)| {
        named(RadarCommand::Preset(index), format!("Radar: {}", preset.name), preset.about, None)
    };
    let recording = |(index, preset): (usize, &recordings::Preset)| {
        let name = format!("Recording: {}", preset.id.replace('-', " "));
        let tooltip = "Open samples that a radar measured";
        named(DocumentCommand::Recording(index), name, tooltip, None)
    };
    let mut all = [scenes::COMMANDS, views::COMMANDS].concat();
    all.extend(Kind::all().map(random));
    all.extend(Task::ALL.into_iter().zip(TASK_KEYS).map(|(task, digit)| arrange(task, digit)));
    all.extend(of_panels());
    all.extend(presets::ALL.iter().enumerate().map(preset));
    all.extend(recordings::ALL.iter().enumerate().map(recording));
    all.extend(radar_presets::ALL.iter().enumerate().map(radar));
    all
}

/// The commands with a key, those with Shift or Alt first: Ctrl+Shift+Z would also match Ctrl+Z.
pub fn shortcuts() -> &'static [(KeyboardShortcut, Command)] {
    static SHORTCUTS: OnceLock<Vec<(KeyboardShortcut, Command)>> = OnceLock::new();
    SHORTCUTS.get_or_init(|| {
        let mut all: Vec<_> = listed().iter().filter_map(|e| Some((e.key?, e.command.clone()))).collect();
        all.sort_by_key(|(key, _)| !(key.modifiers.shift || key.modifiers.alt));
        all
    })
}

impl Command {
    /// The command's line of the list, where it has one. Adding at a place has the line of adding anywhere; opening or closing a panel has its switch's.
    pub fn entry(&self) -> Option<&'static Entry> {
        let like = match self {
            Command::Edit(EditCommand::Add(kind, _)) => Command::Edit(EditCommand::Add(*kind, None)),
            Command::Window(
                WindowCommand::OpenPanel(panel) | WindowCommand::OpenView(panel) | WindowCommand::ClosePanel(panel),
            ) => Command::Window(WindowCommand::TogglePanel(*panel)),
            other => other.clone(),
        };
        listed().iter().find(|e| e.command == like)
    }
}

#[cfg(test)]
mod tests {
    use super::super::command::ViewCommand;
    use super::*;
    use crate::picture::ColourMap;
    use crate::radar::WindowFunction;
    use std::collections::BTreeMap;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        let (mut keys, mut names) = (BTreeMap::new(), BTreeMap::new());
        for entry in listed() {
            assert!(names.insert(entry.name.clone(), ()).is_none(), "{} twice", entry.name);
            assert!(!entry.tooltip.is_empty());
            if let Some(key) = entry.key {
                let text = format!("{key:?}");
                assert!(keys.insert(text, entry.name.clone()).is_none(), "{} shares its key", entry.name);
            }
        }
    }

    #[test]
    fn no_command_of_a_page_has_a_key_of_the_browser() {
        let mut keys = BTreeMap::new();
        for entry in listed_on_a_page() {
            let Some(KeyboardShortcut { modifiers, logical_key: key }) = entry.key else { continue };
            let of_the_browser = matches!(key, Key::F5 | Key::F11 | Key::F12)
                || modifiers.command && !modifiers.shift && matches!(key, Key::T | Key::W | Key::N);
            assert!(!of_the_browser, "{}", entry.name);
            let before = keys.insert(format!("{modifiers:?} {key:?}"), entry.name.clone());
            assert!(before.is_none(), "{} shares its key with {before:?}", entry.name);
        }
    }

    #[test]
    fn a_page_offers_a_link_in_place_of_closing_the_window() {
        let [link, quit] = [Command::Export(ExportCommand::CopyLink), Command::Window(WindowCommand::Quit)];
        let offers = |list: &[Entry], command: &Command| list.iter().any(|entry| entry.command == *command);
        let (page, desktop) = (listed_on_a_page(), listed_where(on_a_desktop));
        assert!(offers(&page, &link) && !offers(&page, &quit));
        assert!(!offers(&desktop, &link) && offers(&desktop, &quit));
    }

    #[test]
    fn every_choice_of_a_window_and_of_colours_is_listed() {
        for window in WindowFunction::ALL {
            assert!(Command::Radar(RadarCommand::SetWindow(window)).entry().is_some(), "{window:?}");
        }
        for colours in ColourMap::ALL {
            assert!(Command::View(ViewCommand::Colours(colours)).entry().is_some(), "{colours:?}");
        }
        let map = Panel::Map(MapKind::Target);
        let [close, toggle] = [WindowCommand::ClosePanel(map), WindowCommand::TogglePanel(map)].map(Command::Window);
        assert_eq!(close.entry(), toggle.entry(), "closing a panel is listed as its switch");
    }
}
