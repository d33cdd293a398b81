use super::*;
use crate::interact::Document;
use crate::scene::file::{self, SceneFile};
use crate::scene::{Object, Point, Scene, presets};

fn edited(document: Document) -> Editor {
    let mut editor = Editor::of(document);
    editor.add(Object::Point(Point::new(1.0, 2.0)));
    editor
}

fn street() -> Document {
    Document::shipped(presets::default_scene())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = entries.filter(|n| !n.ends_with(".lock")).collect();
    names.sort();
    names
}

/// The documents that the next window restores.
fn found(folder: &Path) -> Restored {
    Autosave::claim(folder).restore()
}

#[test]
fn two_windows_keep_two_copies() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = Autosave::claim(folder.path());
    let mut second = Autosave::claim(folder.path());
    first.keep_now(&edited(street())).unwrap();
    second.keep_now(&Editor::of(Document::unsaved(None, SceneFile::default()))).unwrap();
    assert_eq!(names(folder.path()), ["autosave-2.toml", "autosave.toml"]);
    drop(second);
    let again = Autosave::claim(folder.path());
    let empty = again.restore().on_screen.unwrap();
    assert!(empty.scene().objects.is_empty(), "the second's, the first is still open");
    drop(first);
    let other = Autosave::claim(folder.path());
    assert_eq!(other.restore().on_screen.unwrap().scene(), edited(street()).scene());
    assert!(found(folder.path()).on_screen.is_none());
}

#[test]
fn copies_wait_but_not_for_a_close_or_another_document() {
    let folder = tempfile::tempdir().unwrap();
    let mut autosave = Autosave::claim(folder.path());
    let mut editor = edited(street());
    assert_eq!(autosave.keep(&editor), None);
    editor.add(Object::Point(Point::new(2.0, 2.0)));
    assert!(autosave.keep(&editor).is_some());
    editor.open(Document::default());
    assert_eq!(autosave.keep(&editor), None);
    assert!(autosave.is_busy());
    autosave.keep_now(&editor).unwrap();
    assert_eq!(names(folder.path()), ["autosave.behind-1.toml"]);
    assert!(!autosave.is_busy() && autosave.poll().is_empty());
}

#[test]
fn a_named_document_comes_back_under_its_name_with_its_radar() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    file::save(&path, &presets::default_scene()).unwrap();
    let mut editor = edited(Document::read(&path).unwrap());
    editor.edit_radar(None, |r| r.elements = 64).unwrap();
    let mut autosave = Autosave::claim(&folder.path().join("data"));
    autosave.keep_now(&editor).unwrap();
    drop(autosave);
    let back = found(&folder.path().join("data")).on_screen.unwrap();
    assert_eq!(back.title(), "a.toml •");
    assert_eq!((back.scene(), back.radar().elements), (editor.scene(), 64));
    let mut editor = Editor::of(back);
    editor.save(&path).unwrap();
    assert_eq!(Document::read(&path).unwrap().radar().elements, 64);
}

#[test]
fn a_start_with_a_file_keeps_the_unsaved_scene() {
    let folder = tempfile::tempdir().unwrap();
    let (data, path) = (folder.path().join("data"), folder.path().join("asked.toml"));
    file::save(&path, &SceneFile { scene: Scene::of_points([(5.0, 5.0)]), ..SceneFile::default() }).unwrap();
    let unsaved = edited(street());
    Autosave::claim(&data).keep_now(&unsaved).unwrap();
    // Three starts with the file, each closed as a window is.
    for _ in 0..3 {
        let mut autosave = Autosave::claim(&data);
        let mut editor = Editor::start(autosave.restore(), Some(Document::read(&path).unwrap()), street());
        assert_eq!(editor.document().title(), "asked.toml");
        assert_eq!(editor.left().len(), 1);
        autosave.keep_now(&editor).unwrap();
        assert_eq!(names(&data), ["autosave.behind-1.toml"]);
        if editor.undo() {
            assert_eq!((editor.scene(), editor.is_modified()), (unsaved.scene(), true));
        }
    }
    let mut autosave = Autosave::claim(&data);
    let mut editor = Editor::start(autosave.restore(), None, street());
    let id = editor.left()[0].id();
    assert!(editor.recover(id) && editor.is_modified() && editor.scene() == unsaved.scene());
    autosave.keep_now(&editor).unwrap();
    assert_eq!(names(&data), ["autosave.toml"], "on screen again");
    editor.save(&path).unwrap();
    autosave.keep_now(&editor).unwrap();
    assert_eq!(names(&data), [""; 0], "saved");
}

#[test]
fn unreadable_copies_are_set_aside() {
    let folder = tempfile::tempdir().unwrap();
    Autosave::claim(folder.path()).keep_now(&edited(street())).unwrap();
    std::fs::write(folder.path().join("autosave.behind-7.toml"), "neither").unwrap();
    let restored = found(folder.path());
    assert!(restored.on_screen.is_some() && restored.left.is_empty());
    assert_eq!(restored.problems.len(), 1);
    assert_eq!(names(folder.path()), ["autosave.behind-7.broken-1.txt", "autosave.toml"]);
}

#[test]
fn a_scene_that_cannot_be_simulated_comes_back_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut editor = Editor::of(Document::default());
    editor.add(Object::Point(Point::new(editor.radar().element_x_metres(3), 0.0)));
    assert!(editor.scene().validate(editor.radar()).is_err());
    Autosave::claim(folder.path()).keep_now(&editor).unwrap();
    assert_eq!(found(folder.path()).on_screen.unwrap().scene(), editor.scene());
}

#[test]
fn a_folder_that_cannot_be_written_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let message = Autosave::claim(&file).keep_now(&edited(street())).unwrap_err();
    assert!(message.contains("file"), "{message}");
}
