//! The document under undo, saving, a kill and a restart.

use crate::session::*;
use apertura::scene::file::SceneFile;
use apertura::scene::{file, presets};
use eframe::egui::{ViewportCommand, ViewportEvent, ViewportId};

fn title(s: &Session) -> String {
    s.editor().document().title()
}

/// A file of `points` reflectors before a radar of 64 elements.
fn write(s: &Session, name: &str, points: usize) -> PathBuf {
    let path = s.path(name);
    let scene = Scene::of_points((0..points).map(|i| (i as f64, 10.0)));
    let radar =
        if name.ends_with("npz") { Radar::default() } else { Radar { elements: 64, samples: 64, ..Radar::default() } };
    file::save(&path, &SceneFile { scene, radar }).unwrap();
    path
}

fn points(path: &Path) -> usize {
    Document::read(path).unwrap().scene().objects.len()
}

#[test]
fn each_scene_is_saved_into_its_own_file() {
    let mut s = Session::start();
    let (a, b) = (s.path("scene.toml"), write(&s, "b.toml", 5));
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::OpenPath(b.clone()));
    assert_eq!((title(&s).as_str(), s.editor().radar().elements), ("b.toml", 64));
    s.undo();
    assert_eq!((title(&s).as_str(), s.editor().radar().elements), ("scene.toml •", 128));
    s.ask(DocumentCommand::Save);
    assert_eq!((title(&s).as_str(), points(&a), points(&b)), ("scene.toml", 3, 5));
}

#[test]
fn new_and_presets_keep_the_radar_unless_they_have_one() {
    let mut s = Session::start();
    s.ask(DocumentCommand::New);
    assert_eq!((title(&s).as_str(), s.editor().radar().elements), ("untitled", 128));
    s.undo();
    let preset = |id: &str| {
        let index = presets::ALL.iter().position(|preset| preset.id == id).unwrap();
        DocumentCommand::Preset(index)
    };
    for (id, elements) in [("four-reflectors", 128), ("failure-live-wrong-tooth", Radar::default().elements)] {
        s.ask(preset(id));
        assert_eq!(s.editor().radar().elements, elements, "{id}");
        s.undo();
    }
    s.undo();
    assert_eq!((title(&s).as_str(), s.editor().radar().elements), ("scene.toml", 128));
}

#[test]
fn what_a_format_cannot_hold_is_asked_before_it_is_written() {
    let mut s = Session::start();
    let path = write(&s, "points.npz", 2);
    s.ask(DocumentCommand::OpenPath(path.clone()));
    s.ask(EditCommand::Add(NewObject::Line, None));
    let before = std::fs::read(&path).unwrap();
    let answer = |s: &mut Session, button: &str| {
        s.ask(DocumentCommand::Save);
        let told = s.shows("one line or cluster");
        assert!(told, "it says what would be lost");
        assert_eq!(std::fs::read(&path).unwrap(), before, "and has written nothing");
        s.click(button);
    };
    answer(&mut s, "Cancel");
    assert_eq!((title(&s).as_str(), points(&path)), ("points.npz •", 2));
    answer(&mut s, "Save anyway");
    assert_eq!((title(&s).as_str(), points(&path)), ("points.npz •", 77), "a copy in points; the line is unsaved");
    assert!(matches!(s.objects().last(), Some(Object::Line(_))));
    std::fs::write(&path, &before).unwrap();
    answer(&mut s, "Save as TOML");
    let whole = path.with_extension("toml");
    assert_eq!((title(&s).as_str(), points(&path), points(&whole)), ("points.toml", 2, 3));
}

#[test]
fn what_another_program_wrote_is_replaced_after_a_question() {
    let mut s = Session::start();
    let path = s.path("scene.toml");
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::Save);
    assert_eq!((title(&s).as_str(), points(&path)), ("scene.toml", 3), "no other program was there");
    write(&s, "scene.toml", 7);
    let answer = |s: &mut Session, button: &str| {
        s.ask(EditCommand::Add(NewObject::Point, None));
        s.ask(DocumentCommand::Save);
        assert!(s.app.query_by_label("scene.toml has changed").is_some());
        assert_eq!(points(&path), 7, "nothing is written yet");
        s.click(button);
    };
    answer(&mut s, "Cancel");
    assert_eq!((title(&s).as_str(), points(&path)), ("scene.toml •", 7));
    answer(&mut s, "Save as…");
    assert_eq!(points(&path), 7);
    s.enter("Name", "mine.toml");
    s.click("Save");
    let mine = s.path("mine.toml");
    assert_eq!((title(&s).as_str(), points(&mine), points(&path)), ("mine.toml", 5, 7));
    write(&s, "mine.toml", 7);
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::Save);
    s.click("Replace it");
    assert_eq!((title(&s).as_str(), points(&mine)), ("mine.toml", 6));
}

#[test]
fn a_start_with_a_file_loses_neither_file_nor_unsaved_scene() {
    let mut s = Session::start();
    let b = write(&s, "b.toml", 5);
    s.ask(EditCommand::Add(NewObject::Point, None));
    let unsaved = s.editor().scene().clone();
    s.wait_for_autosave();
    // Twice: closing the window with the file on screen must not lose it either.
    for _ in 0..2 {
        s = s.reopened(Some("b.toml"), baseline());
        assert_eq!((title(&s).as_str(), points(&b)), ("b.toml", 5));
        let [left] = s.editor().left() else { panic!("one unsaved scene") };
        assert_eq!((left.title().as_str(), left.scene()), ("scene.toml •", &unsaved));
    }
    for label in ["File", "Unsaved scenes", "scene.toml (3 objects)", "Bring back"] {
        s.click(label);
    }
    assert_eq!((title(&s).as_str(), s.objects().len()), ("scene.toml •", 3));
    assert!(s.editor().left().is_empty(), "b.toml was not touched");
}

#[test]
fn a_window_with_a_scene_not_kept_closes_at_the_second_try() {
    let folder = tempdir().unwrap();
    // A file where the folder of the autosave would be takes no files of any user.
    std::fs::write(folder.path().join("data"), "").unwrap();
    let mut s = Session::opened(folder, None, baseline(), USUAL_SIZE);
    assert!(!stays_open(&mut s), "nothing is unsaved");
    s.ask(EditCommand::Add(NewObject::Point, None));
    assert!(stays_open(&mut s));
    s.app.get_by_label_contains("can't be autosaved");
    assert!(!stays_open(&mut s), "closed again, it is meant");
}

fn stays_open(s: &mut Session) -> bool {
    let window = s.app.input_mut().viewports.entry(ViewportId::ROOT).or_default();
    window.events.push(ViewportEvent::Close);
    s.app.step();
    let stays = s.app.output().viewport_output[&ViewportId::ROOT].commands.contains(&ViewportCommand::CancelClose);
    s.app.input_mut().viewports.entry(ViewportId::ROOT).or_default().events.clear();
    s.app.step();
    stays
}
