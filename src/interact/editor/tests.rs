use super::*;
use crate::radar::{Carrier, WindowFunction};
use crate::scene::{Line, MAX_REFLECTORS, Point};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn editor() -> Editor {
    Editor::new(Scene::of_points([(0.0, 10.0), (3.0, 12.0)]))
}

fn place_of(editor: &Editor, index: usize) -> [f64; 2] {
    editor.scene().objects[index].centre_metres()
}

#[test]
fn a_drag_keeps_the_distance_to_the_pointer() {
    let mut e = editor();
    let pointer = Place::new(0.3, 10.2);
    let hit = e.hit(pointer, 0.1).unwrap();
    e.begin_drag(hit, pointer);
    for i in 1..=300 {
        assert!(e.drag_to(Place::new(0.3 + 0.01 * f64::from(i), 10.2), Snap::Off));
    }
    e.end_drag();
    let [x, y] = place_of(&e, 0);
    assert!((x - 3.0).abs() < 1e-12 && (y - 10.0).abs() < 1e-12);
    assert_eq!(e.history().depth(), 1);
    assert!(e.undo() && place_of(&e, 0) == [0.0, 10.0] && e.redo() && (place_of(&e, 0)[0] - 3.0).abs() < 1e-12);
}

#[test]
fn a_click_that_moves_nothing_leaves_no_step() {
    let mut e = editor();
    let hit = e.hit(Place::new(0.0, 10.0), 0.1).unwrap();
    e.begin_drag(hit, Place::new(0.0, 10.0));
    e.end_drag();
    assert_eq!((e.history().depth(), e.selection().single()), (0, Some(0)));
    assert!(!e.is_modified());
}

#[test]
fn a_selection_moves_together() {
    let mut e = editor();
    e.select_all();
    let hit = e.hit(Place::new(3.0, 12.0), 0.1).unwrap();
    e.begin_drag(hit, Place::new(3.0, 12.0));
    e.drag_to(Place::new(4.0, 11.0), Snap::Off);
    assert_eq!(place_of(&e, 0), [1.0, 9.0]);
    e.cancel_drag();
    assert_eq!(place_of(&e, 0), [0.0, 10.0]);
    assert_eq!(e.history().depth(), 0);
}

#[test]
fn everything_can_be_undone() {
    let mut e = editor();
    let start = e.scene().clone();
    e.add(Object::Point(Point::new(5.0, 5.0)));
    e.duplicate_selected().unwrap();
    e.nudge(0.1, 0.0);
    e.nudge(0.1, 0.0);
    let text = e.copy().unwrap();
    e.paste(&text).unwrap();
    e.select([0, 1], SelectionMode::Replace);
    e.delete_selected();
    e.open(Document::default());
    assert_eq!(e.history().depth(), 6, "add, duplicate, nudges, paste, delete, open");
    while e.undo() {}
    assert_eq!(*e.scene(), start);
    while e.redo() {}
    assert!(e.scene().objects.is_empty());
}

#[test]
fn an_edit_after_undo_forgets_what_was_undone() {
    let mut e = editor();
    e.nudge(1.0, 0.0);
    assert_eq!(e.history().depth(), 0, "nothing selected, nothing moved");
    e.select([0], SelectionMode::Replace);
    e.nudge(1.0, 0.0);
    e.seal();
    e.nudge(1.0, 0.0);
    assert_eq!(e.history().depth(), 2, "sealed: a new step");
    e.undo();
    e.nudge(0.0, 1.0);
    assert!(!e.redo());
}

/// A folder with `a.toml` (one point) and `b.toml` (two points before 64 elements), and their whole paths.
fn two_files() -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let whole = std::fs::canonicalize(folder.path()).unwrap();
    let (a, b) = (whole.join("a.toml"), whole.join("b.toml"));
    let of = |points: &[(f64, f64)], elements| SceneFile {
        scene: Scene::of_points(points.iter().copied()),
        radar: Radar { elements, ..Radar::default() },
    };
    crate::scene::file::save(&a, &of(&[(1.0, 5.0)], 1024)).unwrap();
    crate::scene::file::save(&b, &of(&[(1.0, 5.0), (2.0, 6.0)], 64)).unwrap();
    (folder, a, b)
}

fn count(path: &Path) -> usize {
    Document::read(path).unwrap().scene().objects.len()
}

#[test]
fn the_radar_is_part_of_the_document() {
    let (_folder, a, _) = two_files();
    let mut e = Editor::of(Document::read(&a).unwrap());
    assert_eq!(e.edit_radar(None, |r| r.carrier = Carrier::TwoWay), Ok(true));
    assert_eq!(e.edit_radar(None, |r| r.window = WindowFunction::Hamming), Ok(true));
    assert_eq!(e.edit_radar(None, |r| r.window = WindowFunction::Hamming), Ok(false));
    assert!(e.is_modified() && e.edit_radar(None, |r| (r.elements, r.samples) = (65536, 65536)).is_err());
    assert_eq!(e.history().depth(), 2);
    e.save(&a).unwrap();
    assert!(!e.is_modified());
    assert_eq!(Document::read(&a).unwrap().radar(), e.radar());
    e.undo();
    assert_eq!((e.radar().window, e.is_modified()), (WindowFunction::Hann, true), "the file has the other window");
    e.redo();
    assert!(!e.is_modified());
    e.open(Document::default());
    assert_eq!(**e.radar(), Radar::default());
    e.undo();
    assert_eq!(e.radar().carrier, Carrier::TwoWay);
}

#[test]
fn saving_under_another_name_moves_the_document() {
    let (folder, a, b) = two_files();
    let mut e = Editor::of(Document::read(&a).unwrap());
    e.add(Object::Point(Point::new(5.0, 5.0)));
    let c = folder.path().join("c.toml");
    e.save(&c).unwrap();
    assert_eq!(e.document().name(), "c.toml");
    e.undo();
    assert_eq!(e.document().title(), "c.toml •", "c.toml holds the added point");
    e.redo();
    assert_eq!(e.document().title(), "c.toml");
    // Over the file of a document that undo may bring back.
    e.open(Document::read(&b).unwrap());
    e.save(&a).unwrap();
    e.open(Document::read(&a).unwrap());
    assert_eq!((count(&a), e.document().title()), (2, "a.toml".to_owned()));
}

#[test]
fn a_copy_that_loses_something_saves_nothing() {
    let (folder, a, _) = two_files();
    let mut e = editor();
    let line = Line { reflectivity: 0.05, ..Line::vertical(0.0, 9.0, 0.1, 40) };
    e.add(Object::Line(line));
    let npz = folder.path().join("s.npz");
    let losses =
        ["the reflectivity of one object", "one line or cluster, which becomes 40 points"].map(str::to_owned).to_vec();
    assert_eq!(e.losses(&npz).unwrap(), losses);
    assert_eq!(e.save(&npz).unwrap(), Saved::Copy(losses));
    assert_eq!((count(&npz), e.document().title()), (42, "untitled •".to_owned()));
    e.undo();
    assert_eq!(e.save(&npz).unwrap(), Saved::Whole);
    assert_eq!(e.document().title(), "s.npz");
    e.open(Document::read(&a).unwrap());
    e.add(Object::Line(Line::vertical(0.0, 9.0, 0.1, 40)));
    e.save(&npz).unwrap();
    e.undo();
    e.undo();
    assert_eq!(e.document().title(), "s.npz •", "its file holds a copy of another scene now");
    assert!(e.losses(&folder.path().join("s.yaml")).is_err());
}

#[test]
fn a_failed_save_changes_nothing() {
    let (folder, a, _) = two_files();
    let mut e = Editor::of(Document::read(&a).unwrap());
    e.add(Object::Point(Point::new(5.0, 5.0)));
    assert!(e.save(&folder.path().join("no/where.toml")).is_err());
    assert_eq!(e.document().title(), "a.toml •");
}

#[test]
fn an_unsaved_document_stays_until_saved_or_discarded() {
    let (_folder, a, b) = two_files();
    let mut e = Editor::of(Document::read(&a).unwrap());
    e.add(Object::Point(Point::new(5.0, 5.0)));
    e.open(Document::read(&b).unwrap());
    let left = |e: &Editor| e.left().iter().map(Document::title).collect::<Vec<_>>();
    assert_eq!(left(&e), ["a.toml •"]);
    e.add(Object::Point(Point::new(5.0, 5.0)));
    e.undo();
    e.undo();
    assert_eq!(left(&e), [""; 0], "a is on screen, b was as its file is");
    e.redo();
    e.redo();
    assert_eq!((left(&e), e.document().title()), (vec!["a.toml •".to_owned()], "b.toml •".to_owned()));
    let id = e.left()[0].id();
    assert!(e.recover(id));
    assert_eq!((left(&e), e.document().title()), (vec!["b.toml •".to_owned()], "a.toml •".to_owned()));
    e.save(&a).unwrap();
    e.undo();
    assert_eq!((left(&e), e.document().title()), (vec![], "b.toml •".to_owned()));
    e.open(Document::default());
    let id = e.left()[0].id();
    e.discard(id);
    assert!(e.left().is_empty() && !e.recover(id));
    assert!(e.undo() && e.is_modified(), "the history still has it");
}

#[test]
fn crowds_are_not_made_by_copying() {
    let mut e = editor();
    let line = Line::vertical(0.0, 9.0, 1e-4, MAX_REFLECTORS / 2);
    e.add(Object::Line(line));
    let before = e.scene().clone();
    assert!(e.duplicate_selected().unwrap_err().to_string().contains("200002 reflectors"));
    let text = e.copy().unwrap();
    assert!(e.paste(&text).unwrap_err().to_string().contains("reflectors") && Arc::ptr_eq(&before, e.scene()));
}
