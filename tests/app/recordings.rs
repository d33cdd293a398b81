//! Recordings in the place of a scene: opened, looked at, explained, exported, and undone.

use crate::session::*;
use apertura::app::Way;
use apertura::radar::{BuiltArray, ElementError};
use apertura::scene::{Interferer, Mirror};

const CASCADE: usize = 0;
const CHIP: usize = 1;

fn with_iaa() -> Session {
    Session::with_methods(vec![Arc::new(IAA), Arc::new(Baseline)])
}

fn copied(s: &Session, name: &str) -> PathBuf {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/recordings");
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, s.folder.path().join(path.file_name().unwrap())).unwrap();
    }
    s.path(name)
}

#[test]
fn the_scene_before_a_recording_is_one_undo_away() {
    let mut s = Session::start();
    s.ask(EditCommand::Add(NewObject::Point, None));
    s.ask(DocumentCommand::OpenPath(copied(&s, "chip-8.toml")));
    assert_eq!(s.editor().document().title(), "chip-8.toml");
    assert_eq!(s.editor().left().len(), 1, "the unsaved scene is kept");
    s.undo();
    assert_eq!(s.editor().document().title(), "scene.toml •");
    assert_eq!((s.state().radar().elements, s.objects().len()), (128, 3));
    assert!(s.editor().document().recording().is_none());
    s.redo();
    assert!(s.editor().document().recording().is_some());
}

#[test]
fn reflectors_laid_over_a_recording_explain_part_of_it() {
    let mut s = with_iaa();
    s.ask(DocumentCommand::Recording(CHIP));
    s.ask(WindowCommand::OpenPanel(Panel::Map(MapKind::Unexplained)));
    assert_eq!(s.state().explained(), Some(0.0));
    let at = s.state().found().unwrap()[0].reflector();
    s.ask(EditCommand::Add(NewObject::Point, Some(Place::new(at.x_metres, at.y_metres))));
    let one = s.state().explained().unwrap();
    assert!(one > 1e-3 && one < 1.0, "{one}");
    s.undo();
    assert_eq!(s.state().explained(), Some(0.0));
    s.redo();
    let path = s.path("post.toml");
    s.ask(DocumentCommand::SaveTo(path.clone()));
    assert_eq!(Document::read(&path).unwrap().scene().objects.len(), 1);
    assert!(s.editor().document().recording().is_some(), "it stays on screen");
}

#[test]
fn what_is_laid_over_a_recording_never_replaces_it() {
    let mut s = Session::start();
    let path = copied(&s, "chip-8.toml");
    let data = path.with_extension("npz");
    let kept = || [&path, &data].map(|p| std::fs::read(p).unwrap());
    let before = kept();
    s.ask(DocumentCommand::OpenPath(path.clone()));
    s.press(Modifiers::COMMAND, Key::S);
    assert_eq!(s.state().notices.list.len(), 1, "told that there is nothing to save, and not asked for a file");
    s.ask(EditCommand::Add(NewObject::Point, Some(Place::new(0.5, 3.0))));
    s.ask(DocumentCommand::SaveTo(path.clone()));
    assert!(s.state().notices.list.len() == 2 && s.editor().is_modified());
    let refused = Editor::of(Document::read_recording(&path).unwrap()).save(&data).unwrap_err().to_string();
    assert!(refused.contains("chip-8.npz: holds a recording"), "{refused}");
    assert_eq!(kept(), before);
    let post = s.path("post.toml");
    s.ask(DocumentCommand::SaveTo(post.clone()));
    assert_eq!(s.editor().document().title(), "post.toml");
    s.ask(EditCommand::Add(NewObject::Point, Some(Place::new(-0.5, 4.0))));
    s.press(Modifiers::COMMAND, Key::S);
    assert_eq!(s.editor().document().title(), "post.toml");
    let text = std::fs::read_to_string(&post).unwrap();
    assert!(text.contains("recording = \"chip-8.toml\""), "{text}");
    s.ask(DocumentCommand::New);
    s.ask(DocumentCommand::OpenPath(post.clone()));
    assert_eq!(s.objects().len(), 2);
    assert_eq!(s.editor().document().recording().map(|r| r.radar.elements), Some(8));
    assert_eq!(apertura::scene::file::load(&post).unwrap().radar.elements, 8, "commands see a scene");
    std::fs::write(&post, text.replace("chip-8.toml", "cascade-86.toml")).unwrap();
    let error = Document::read(&post).unwrap_err().to_string();
    assert!(error.contains("its radar is another"), "{error}");
    std::fs::write(&post, text.replace("chip-8.toml", "gone.toml")).unwrap();
    let error = Document::read(&post).unwrap_err().to_string();
    assert!(error.contains("post.toml") && error.contains("gone.toml"), "{error}");
    assert_eq!(kept(), before);
}

#[test]
fn a_recordings_constants_cannot_be_edited() {
    let mut s = Session::start();
    s.ask(DocumentCommand::Recording(CASCADE));
    let measured = s.state().radar().clone();
    s.ask(RadarCommand::SetCarrier(Carrier::TwoWay));
    s.ask(RadarCommand::Set(Box::new(Radar { elements: 64, ..measured.clone() })));
    assert_eq!((s.state().radar(), s.state().notices.list.len()), (&measured, 1));
    s.ask(RadarCommand::Set(Box::new(Radar { end_elements: 20, ..measured.clone() })));
    s.ask(RadarCommand::SetWindow(WindowFunction::Hamming));
    assert_eq!((s.state().radar().end_elements, s.state().radar().window), (20, WindowFunction::Hamming));
    assert_eq!(s.state().shown_method(), Some("baseline"));
    s.undo();
    s.undo();
    assert_eq!(s.state().radar(), &measured);
}

#[test]
fn an_overlay_comes_back_over_its_recording_after_a_kill() {
    let mut s = Session::start();
    s.ask(DocumentCommand::OpenPath(copied(&s, "chip-8.toml")));
    s.ask(EditCommand::Add(NewObject::Point, Some(Place::new(0.5, 3.0))));
    s.wait_for_autosave();
    let s = s.reopened(None, vec![Arc::new(CAPON)]);
    assert_eq!(s.objects().len(), 1);
    assert_eq!(s.editor().document().recording().map(|r| r.radar.elements), Some(8));
}

#[test]
fn a_recording_is_opened_at_the_start() {
    let mut s = Session::start();
    let text = std::fs::read_to_string(copied(&s, "cascade-86.toml")).unwrap();
    std::fs::write(s.path("broken.toml"), text.replace("cascade-86.mat", "gone.mat")).unwrap();
    s.ask(DocumentCommand::OpenPath(s.path("broken.toml")));
    assert_eq!((s.state().notices.list.len(), s.state().radar().elements), (1, 128));
    let s = s.reopened(Some("cascade-86.toml"), vec![Arc::new(CAPON)]);
    assert_eq!(s.state().radar().elements, 86);
    assert!(s.state().arrangement.is_open(Panel::Found), "what was found is in sight");
}

#[test]
fn disturbances_are_edits_of_the_scene() {
    let mut s = Session::start();
    let before = s.state().metrics();
    let mut elements = BuiltArray { elements: vec![ElementError::default(); 128] };
    elements.elements[3].dead = true;
    s.ask(RadarCommand::SetElements(Arc::new(elements)));
    s.ask(RadarCommand::SetInterferer(Some(Interferer::default())));
    s.ask(RadarCommand::SetMirror(Some(Mirror::default())));
    assert_ne!(s.state().metrics(), before);
    let path = s.path("disturbed.toml");
    s.ask(DocumentCommand::SaveTo(path.clone()));
    let saved = Document::read(&path).unwrap();
    assert_eq!(saved.scene(), s.editor().scene());
    assert!(saved.scene().disturbances.elements.elements[3].dead);
    s.ask(RadarCommand::Set(Box::new(Radar { elements: 64, ..s.state().radar().clone() })));
    assert_eq!(s.editor().scene().disturbances.elements.elements.len(), 64);
    for _ in 0..4 {
        s.undo();
    }
    assert!(s.editor().scene().disturbances.is_none());
    assert_eq!(s.state().metrics(), before);
}

/// A capture of two frames with its `.cfg`, in the session's folder: one transmitter, four receivers, four loops; an echo in range bin 11.
fn captured(s: &Session) -> PathBuf {
    let sample = |n: usize| {
        let turns = std::f64::consts::TAU * (11.0 * (n % 64) as f64 / 64.0 + 0.15 * (n / 64 % 4) as f64);
        let noise = |of: usize| ((n * of) % 23) as f64 / 4.0;
        [(900.0 * turns.cos() + noise(7)) as i16, (900.0 * turns.sin() + noise(13)) as i16]
    };
    let bytes: Vec<u8> = (0..2 * 4 * 4 * 64).flat_map(sample).flat_map(i16::to_le_bytes).collect();
    let cfg = "channelCfg 15 1 0\nadcCfg 2 1\nadcbufCfg -1 0 0 1 1\nprofileCfg 0 77 30 6 60 0 0 50 1 64 4000 0 0 30\n\
               chirpCfg 0 0 0 0 0 0 0 1\nframeCfg 0 0 4 0 100 1 0\n";
    let path = s.path("room.bin");
    std::fs::write(&path, bytes).unwrap();
    std::fs::write(path.with_extension("cfg"), cfg).unwrap();
    path
}

#[test]
fn a_capture_is_opened_and_reread() {
    let mut s = with_iaa();
    s.ask(DocumentCommand::OpenPath(captured(&s)));
    assert!(s.state().arrangement.is_open(Panel::Recording));
    let origin = |s: &Session| s.editor().document().recording().unwrap().origin.clone().unwrap();
    assert_eq!((origin(&s).frames, origin(&s).taken, s.state().radar().elements), (2, 0, 4));
    s.ask(WindowCommand::OpenPanel(Panel::RangeDoppler));
    assert_eq!(s.state().doppler_peak(), Some((11, 2)), "four loops, at rest");
    s.ask(DocumentCommand::Reread(Way::Frame(1)));
    assert_eq!((origin(&s).frame, s.editor().document().title().as_str()), (1, "room.bin"));
    s.ask(DocumentCommand::Reread(Way::Layout(1)));
    assert_eq!(origin(&s).taken, 1);
    s.undo();
    assert_eq!(origin(&s).taken, 0);
}
