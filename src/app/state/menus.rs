//! Commands of the menus in groups, for the menu bar and for the paths in the palette.

use super::command::{Command, DocumentCommand, EditCommand, ExportCommand, Purpose, ViewCommand, WindowCommand};
use super::panel::Panel;
use crate::recording::card::USUAL_PORT;
use crate::scene::presets;
use Command::{AskFile, Document, Edit, Export, View, Window};

/// *File*: open, listen, save and share, export, quit.
pub const FILE: [&[Command]; 5] = [
    &[Document(DocumentCommand::New), AskFile(Purpose::Open)],
    &[AskFile(Purpose::Listen(USUAL_PORT))],
    &[
        Document(DocumentCommand::Save),
        AskFile(Purpose::SaveScene),
        Export(ExportCommand::CopyShared),
        Export(ExportCommand::CopyLink),
    ],
    &[AskFile(Purpose::ExportPicture), AskFile(Purpose::ExportMaps)],
    &[Window(WindowCommand::Quit)],
];

/// *Edit*: undo and redo, then the rest.
pub const EDIT: [&[Command]; 2] = [
    &[Edit(EditCommand::Undo), Edit(EditCommand::Redo)],
    &[
        Edit(EditCommand::Cut),
        Edit(EditCommand::Copy),
        Edit(EditCommand::Paste),
        Edit(EditCommand::Duplicate),
        Edit(EditCommand::Delete),
        Edit(EditCommand::SelectAll),
        Edit(EditCommand::SelectNext),
        Edit(EditCommand::SelectPrevious),
        Window(WindowCommand::Escape),
    ],
];

/// *View*, below its menus: the layout, the maps, the window.
pub const VIEW: [&[Command]; 3] = [
    &[Window(WindowCommand::ResetLayout)],
    &[
        View(ViewCommand::ToggleProjection),
        View(ViewCommand::ToggleUnits),
        View(ViewCommand::ToggleOneScale),
        View(ViewCommand::ToggleFineColumns),
        View(ViewCommand::ToggleFieldsOfView),
        View(ViewCommand::ResetMaps),
        View(ViewCommand::NextMethod),
    ],
    &[
        Window(WindowCommand::Present),
        Window(WindowCommand::ToggleTheme),
        Window(WindowCommand::ZoomIn),
        Window(WindowCommand::ZoomOut),
        Window(WindowCommand::ZoomReset),
        Window(WindowCommand::Palette),
    ],
];

pub const HELP: [Panel; 2] = [Panel::Guide, Panel::Lesson];

/// Path of menus to a command, from the bar on; empty for a command in no menu.
pub fn menu_path(command: &Command) -> &'static [&'static str] {
    match command {
        Document(DocumentCommand::Preset(index)) if presets::ALL.get(*index).is_some_and(|p| p.is_failure()) => {
            &["Tools", "Failures explained"]
        }
        Document(DocumentCommand::Preset(_)) => &["Scene", "Presets"],
        Document(DocumentCommand::Recording(_)) => &["Scene", "Recordings"],
        Document(DocumentCommand::RandomScene(_)) => &["Scene", "Random scene"],
        Edit(EditCommand::Add(..)) | View(ViewCommand::FitScene) => &["Scene"],
        View(ViewCommand::Colours(_)) => &["View", "Colours"],
        View(overlay) if ViewCommand::OVERLAYS.contains(overlay) => &["View", "Overlays"],
        View(ViewCommand::Flip | ViewCommand::ToggleDeveloper) => &["Tools"],
        Window(WindowCommand::ArrangeFor(_)) => &["View", "Arrangement"],
        Window(WindowCommand::Help(_) | WindowCommand::ToggleCaptions) => &["Help"],
        Window(WindowCommand::TogglePanel(panel)) if HELP.contains(panel) => &["Help"],
        // A shared tile is in the menu under its own name.
        Window(WindowCommand::TogglePanel(panel)) if panel.title() != panel.tile_title() => &[],
        Window(WindowCommand::TogglePanel(panel)) if panel.is_tool() => &["Tools"],
        Window(WindowCommand::TogglePanel(_)) => &["View", "Panels"],
        _ => {
            let menus: [(&[&[Command]], &[&str]); 3] = [(&FILE, &["File"]), (&EDIT, &["Edit"]), (&VIEW, &["View"])];
            let stands_in = |(groups, _): &(&[&[Command]], _)| groups.iter().any(|group| group.contains(command));
            menus.into_iter().find(stands_in).map_or(&[], |(_, path)| path)
        }
    }
}
