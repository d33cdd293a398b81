//! The document under undo, saving, a kill and a restart.

use crate::session::*;
use apertura::scene::file::SceneFile;
use apertura::scene::{file, presets};
use eframe::egui::{ViewportCommand, ViewportEvent, ViewportId};

fn undo(s: &mut Session) {
    s.press(Modifiers::COMMAND, Key::Z);
}

fn title(s: &Session) -> String {
    s.state().editor().document().title()
}

/// A file of `points` reflectors before a radar of 64 elements.
fn write(s: &Session, name: &str, points: usize) -> PathBuf {
    let path = s.folder.path().join(name);
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
    let (a, b) = (s.folder.path().join("scene.toml"), write(&s, "b.toml", 5));
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::OpenPath(b.clone()));
    assert_eq!((title(&s).as_str(), s.state().editor().radar().elements), ("b.toml", 64));
    undo(&mut s);
    assert_eq!((title(&s).as_str(), s.state().editor().radar().elements), ("scene.toml •", 128));
    s.ask(DocumentCommand::Save);
    assert_eq!((title(&s).as_str(), points(&a), points(&b)), ("scene.toml", 3, 5));
}

#[test]
fn new_and_presets_keep_the_radar_unless_they_have_one() {
    let mut s = Session::start();
    s.ask(DocumentCommand::New);
    assert_eq!((title(&s).as_str(), s.state().editor().radar().elements), ("untitled", 128));
    undo(&mut s);
    let preset = |id: &str| {
        let index = presets::ALL.iter().position(|preset| preset.id == id).unwrap();
        DocumentCommand::Preset(index)
    };
    for (id, elements) in [("four-reflectors", 128), ("failure-live-wrong-tooth", Radar::default().elements)] {
        s.ask(preset(id));
        assert_eq!(s.state().editor().radar().elements, elements, "{id}");
        undo(&mut s);
    }
    undo(&mut s);
    assert_eq!((title(&s).as_str(), s.state().editor().radar().elements), ("scene.toml", 128));
}

#[test]
fn a_change_of_the_radar_is_an_edit() {
    let mut s = Session::start();
    s.ask(RadarCommand::SetCarrier(Carrier::TwoWay));
    assert_eq!(title(&s), "scene.toml •");
    s.ask(RadarCommand::SetWindow(WindowFunction::Hamming));
    undo(&mut s);
    undo(&mut s);
    assert_eq!((title(&s).as_str(), s.state().editor().radar().carrier), ("scene.toml", Carrier::OneWay));
    s.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    s.ask(DocumentCommand::Save);
    let saved = Document::read(&s.folder.path().join("scene.toml")).unwrap();
    assert_eq!(saved.radar().carrier, Carrier::TwoWay);
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
        let told = s.app.query_all_by_label_contains("one line or cluster").next().is_some();
        assert!(told, "it says what would be lost");
        assert_eq!(std::fs::read(&path).unwrap(), before, "and has written nothing");
        s.app.get_by_label(button).click();
        s.settle();
    };
    answer(&mut s, "Cancel");
    assert_eq!((title(&s).as_str(), points(&path)), ("points.npz •", 2));
    answer(&mut s, "Save anyway");
    assert_eq!((title(&s).as_str(), points(&path)), ("points.npz •", 77), "a copy in points; the line is unsaved");
    assert!(matches!(s.state().editor().scene().objects.last(), Some(Object::Line(_))));
    std::fs::write(&path, &before).unwrap();
    answer(&mut s, "Save as TOML");
    let whole = path.with_extension("toml");
    assert_eq!((title(&s).as_str(), points(&path), points(&whole)), ("points.toml", 2, 3));
}

/// Opens a scene with a line, saved as TOML, and writes it as points as well.
fn save_as_points_too(s: &mut Session) {
    s.ask(EditCommand::Add(NewObject::Line, None));
    s.ask(DocumentCommand::Save);
    s.ask(DocumentCommand::SaveTo(s.folder.path().join("points.npz")));
    s.app.get_by_label("Save anyway").click();
    s.settle();
}

#[test]
fn a_saved_scene_stays_saved_when_a_second_format_is_written() {
    let mut s = Session::start();
    // The second format holds no other radar either.
    save_as_points_too(&mut s);
    assert_eq!(title(&s), "scene.toml");
    assert!(s.app.query_by_label_contains("The scene itself is saved in").is_some());
    assert!(s.app.query_by_label_contains("still unsaved").is_none());
}

#[test]
fn an_unsaved_scene_stays_so_when_a_second_format_is_written() {
    let mut s = Session::start();
    save_as_points_too(&mut s);
    s.ask(WindowCommand::CloseMessages);
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::SaveTo(s.folder.path().join("again.npz")));
    s.app.get_by_label("Save anyway").click();
    s.settle();
    assert_eq!(title(&s), "scene.toml •");
    assert!(s.app.query_by_label_contains("still unsaved").is_some());
}

#[test]
fn what_another_program_wrote_is_replaced_after_a_question() {
    let mut s = Session::start();
    let path = s.folder.path().join("scene.toml");
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::Save);
    assert_eq!((title(&s).as_str(), points(&path)), ("scene.toml", 3), "nobody else was there");
    write(&s, "scene.toml", 7);
    let answer = |s: &mut Session, button: &str| {
        s.ask(EditCommand::Add(NewObject::Point, None));
        s.ask(DocumentCommand::Save);
        assert!(s.app.query_by_label("scene.toml has changed").is_some());
        assert_eq!(points(&path), 7, "nothing is written yet");
        s.app.get_by_label(button).click();
        s.settle();
    };
    answer(&mut s, "Cancel");
    assert_eq!((title(&s).as_str(), points(&path)), ("scene.toml •", 7));
    answer(&mut s, "Save as…");
    assert_eq!(points(&path), 7);
    let name = s.app.get_by_label("Name");
    name.focus();
    s.app.step();
    s.press(Modifiers::COMMAND, Key::A);
    s.app.event(eframe::egui::Event::Text("mine.toml".to_owned()));
    s.settle();
    s.app.get_by_label("Save").click();
    s.settle();
    let mine = s.folder.path().join("mine.toml");
    assert_eq!((title(&s).as_str(), points(&mine), points(&path)), ("mine.toml", 5, 7));
    write(&s, "mine.toml", 7);
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::Save);
    s.app.get_by_label("Replace it").click();
    s.settle();
    assert_eq!((title(&s).as_str(), points(&mine)), ("mine.toml", 6));
}

#[test]
fn a_start_with_a_file_loses_neither_file_nor_unsaved_scene() {
    let mut s = Session::start();
    let b = write(&s, "b.toml", 5);
    s.ask(EditCommand::Add(NewObject::Point, None));
    let unsaved = s.state().editor().scene().clone();
    let copy = s.folder.path().join("data/autosave.toml");
    step_until(&mut s, "no autosave", |_| copy.exists());
    let Session { app, folder } = s;
    drop(app);
    // Twice: closing the window with the file on screen must not lose it either.
    for _ in 0..2 {
        let app = harness(folder.path(), Some("b.toml"), vec![Arc::new(Baseline)]);
        let mut s = Session { app, folder: tempfile::tempdir().unwrap() };
        s.settle();
        assert_eq!(title(&s), "b.toml");
        assert_eq!(s.state().editor().left().len(), 1);
        assert_eq!(s.state().editor().left()[0].scene(), &unsaved);
    }
    let app = harness(folder.path(), Some("b.toml"), vec![Arc::new(Baseline)]);
    let mut s = Session { app, folder };
    s.settle();
    assert_eq!((s.state().editor().left()[0].title().as_str(), points(&b)), ("scene.toml •", 5));
    for label in ["File", "Unsaved scenes", "scene.toml (3 objects)", "Bring back"] {
        s.app.get_by_label(label).click();
        s.settle();
    }
    assert_eq!((title(&s).as_str(), s.state().editor().scene().objects.len()), ("scene.toml •", 3));
    assert!(s.state().editor().left().is_empty(), "b.toml was not touched");
}

#[test]
fn a_named_scene_comes_back_under_its_name() {
    let mut s = Session::start();
    s.ask(EditCommand::Add(NewObject::Point, None));
    let copy = s.folder.path().join("data/autosave.toml");
    step_until(&mut s, "no autosave", |_| copy.exists());
    let mut s = s.reopened(None, vec![Arc::new(Baseline)]);
    assert_eq!((title(&s).as_str(), s.state().editor().radar().elements), ("scene.toml •", 128));
    s.ask(DocumentCommand::Save);
    assert_eq!((title(&s).as_str(), points(&s.folder.path().join("scene.toml"))), ("scene.toml", 3));
}

#[test]
fn a_window_with_a_scene_not_kept_closes_at_the_second_try() {
    let folder = tempfile::tempdir().unwrap();
    // A file where the folder of the autosave would be takes no files of any user.
    std::fs::write(folder.path().join("data"), "").unwrap();
    let app = harness(folder.path(), None, vec![Arc::new(Baseline)]);
    let mut s = Session { app, folder };
    s.settle();
    assert!(!stays_open(&mut s), "nothing is unsaved");
    s.ask(EditCommand::Add(NewObject::Point, None));
    assert!(stays_open(&mut s));
    s.app.get_by_label_contains("can't be autosaved");
    assert!(!stays_open(&mut s), "whoever closes it again means it");
}

/// Whether the window answers that it stays open when the system asks it to close.
fn stays_open(s: &mut Session) -> bool {
    let window = s.app.input_mut().viewports.entry(ViewportId::ROOT).or_default();
    window.events.push(ViewportEvent::Close);
    s.app.step();
    let stays = s.app.output().viewport_output[&ViewportId::ROOT].commands.contains(&ViewportCommand::CancelClose);
    s.app.input_mut().viewports.entry(ViewportId::ROOT).or_default().events.clear();
    s.app.step();
    stays
}
