//! Commands that add, open, save, export and edit.

use super::super::command::{Command, DocumentCommand, EditCommand, ExportCommand, NewObject, Purpose, WindowCommand};
use super::entry::{Entry, command, command_shift, entries, entry, key, shift};
use crate::interact::Coordinates;
use crate::recording::card::USUAL_PORT;
use eframe::egui::Key;

/// The commands, in the order of the palette.
pub(super) const COMMANDS: &[Entry] = {
    use Command::*;
    entries! {
        Edit(EditCommand::Add(NewObject::Point, None)), "Add point", "Add one reflector", key(Key::P);
        Edit(EditCommand::Add(NewObject::Line, None)), "Add line", "Add a vertical line of 75 reflectors", key(Key::L);
        Edit(EditCommand::Add(NewObject::Cluster, None)), "Add cluster", "Add a Gaussian cluster of 40 reflectors", key(Key::G);
        Edit(EditCommand::Add(NewObject::Wall, None)), "Add wall",
            "Add a wall of 5 m: it shines where it faces the array, and hides what stands behind it", None;
        Edit(EditCommand::Add(NewObject::Box, None)), "Add box", "Add a box of a car's size, 4.5 m by 1.8 m", None;
        Edit(EditCommand::Add(NewObject::Post, None)), "Add post", "Add a round post of 0.2 m radius", None;
        Edit(EditCommand::Add(NewObject::Polygon, None)), "Add polygon",
            "Add an outline with an inner corner, whose corners can be dragged", None;
        Document(DocumentCommand::New), "New scene", "Start with an empty scene; undo brings this one back", command(Key::N);
        AskFile(Purpose::Open), "Open…", "Open a scene (.toml or .npz) or a recording (.toml)", command(Key::O);
        Document(DocumentCommand::Save), "Save", "Save the scene as TOML", command(Key::S);
        AskFile(Purpose::SaveScene), "Save as…", "Save the scene under another name (.toml or .npz)", command_shift(Key::S);
        AskFile(Purpose::Listen(USUAL_PORT)), "Listen to a capture card…",
            "Show the frames that a capture card sends to a UDP port of this machine, by the .cfg of its radar", None;
        AskFile(Purpose::OpenLog), "Open training log…", "Watch the loss of a training (its log.csv)", None;
        AskFile(Purpose::OpenRows), "Open rows…", "Show the rows of an evaluation (.csv of evaluate --rows)", None;
        AskFile(Purpose::SaveRows), "Save rows…", "Save the rows of the panel Evaluate as CSV", None;
        AskFile(Purpose::OwnScenes), "Folder of own scenes…", "Choose where Keep puts scenes: pick any scene of the folder", None;
        AskFile(Purpose::ExportPicture), "Export picture…",
            "Save the maps of this scene with scene and figures, as PNG or SVG", command(Key::E);
        AskFile(Purpose::ExportMaps), "Export maps…", "Save samples and maps as NumPy arrays (.npz)", None;
        Edit(EditCommand::Undo), "Undo", "Undo the last change of the scene", command(Key::Z);
        Edit(EditCommand::Redo), "Redo", "Redo what was undone", command_shift(Key::Z);
        Edit(EditCommand::Cut), "Cut", "Move the selected objects to the clipboard, as TOML", command(Key::X);
        Edit(EditCommand::Copy), "Copy", "Copy the selected objects to the clipboard, as TOML", command(Key::C);
        Export(ExportCommand::CopyShared), "Copy all as text",
            "Copy scene, radar, view, method and lesson step as one line; paste it into another apertura, or start one with it", None;
        Export(ExportCommand::CopyLink), "Copy link",
            "Copy an address that opens this page with scene, radar, view, method and lesson step", None;
        Edit(EditCommand::Paste), "Paste", "Add the objects on the clipboard, or open what was copied as text", command(Key::V);
        Edit(EditCommand::Duplicate), "Duplicate", "Copy the selected objects a metre aside", command(Key::D);
        Edit(EditCommand::Delete), "Delete", "Delete the selected objects", key(Key::Delete);
        Edit(EditCommand::SelectAll), "Select all", "Select every object", command(Key::A);
        Edit(EditCommand::SelectNext), "Select next object", "Select the object after the one that was picked last", key(Key::O);
        Edit(EditCommand::SelectPrevious), "Select previous object", "Select the object before it", shift(Key::O);
        Edit(EditCommand::SetCoordinates(Coordinates::Cartesian)), "Places: x and y", "Tell and enter places as x and y", None;
        Edit(EditCommand::SetCoordinates(Coordinates::Polar)), "Places: range and angle",
            "Tell and enter places as range and direction", None;
        Window(WindowCommand::Escape), "Deselect", "Cancel a drag, show all panels, select nothing", key(Key::Escape);
    }
};
