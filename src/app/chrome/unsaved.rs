//! The menu of unsaved scenes that another one replaced on screen, to bring back or discard.

use crate::app::state::{Command, DocumentCommand};
use crate::interact::Document;
use crate::radar::counted;
use eframe::egui::Ui;

/// Draws the menu's entry; grey where nothing is unsaved.
pub fn show(ui: &mut Ui, left: &[Document], asked: &mut Vec<Command>) {
    ui.add_enabled_ui(!left.is_empty(), |ui| {
        ui.menu_button("Unsaved scenes", |ui| {
            // The latest first, as among recent files.
            for document in left.iter().rev() {
                one(ui, document, asked);
            }
        });
    });
}

fn one(ui: &mut Ui, document: &Document, asked: &mut Vec<Command>) {
    let scene = document.scene();
    let is_named_by_scene = scene.name.is_empty() || scene.name == document.name();
    let name = if is_named_by_scene { document.name() } else { format!("{}: {}", document.name(), scene.name) };
    let text = format!("{name} ({})", counted(scene.objects.len(), "object", "objects"));
    ui.push_id(document.id(), |ui| {
        ui.menu_button(text, |ui| {
            let back =
                ("Bring back", "Put it on screen; undo takes that back", DocumentCommand::Recover(document.id()));
            let discard = ("Discard", "Give it up: no copy of it is kept", DocumentCommand::Discard(document.id()));
            for (name, tooltip, command) in [back, discard] {
                if ui.button(name).on_hover_text(tooltip).clicked() {
                    asked.push(command.into());
                    ui.close();
                }
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::scene::Scene;
    use crate::scene::file::SceneFile;

    fn left() -> [Document; 2] {
        [1u8, 2].map(|points| {
            let scene = Scene::of_points((0..points).map(|i| (f64::from(i), 9.0)));
            Document::unsaved(None, SceneFile { scene, ..SceneFile::default() })
        })
    }

    fn menu(left: [Document; 2]) -> Harness<'static, Vec<Command>> {
        let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| show(ui, &left, asked);
        Harness::builder().with_size([700.0, 400.0]).build_ui_state(draw, Vec::new())
    }

    #[test]
    fn the_latest_scene_is_first_and_each_can_be_brought_back() {
        let left = left();
        let ids = [left[0].id(), left[1].id()];
        let mut menu = menu(left);
        menu.clicks(&["Unsaved scenes"]);
        let [latest, first] =
            ["untitled (2 objects)", "untitled (1 object)"].map(|name| menu.get_by_label_contains(name).rect());
        assert!(latest.bottom() <= first.top(), "{latest:?} {first:?}");
        menu.clicks(&["Unsaved scenes"]);
        for (scene, entry) in [("untitled (2 objects)", "Bring back"), ("untitled (1 object)", "Discard")] {
            for label in ["Unsaved scenes", scene, entry] {
                menu.get_by_label_contains(label).click();
                menu.run();
            }
        }
        let asked = [DocumentCommand::Recover(ids[1]), DocumentCommand::Discard(ids[0])].map(Command::Document);
        assert_eq!(menu.state(), &asked);
    }
}
