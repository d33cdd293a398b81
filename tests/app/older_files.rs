//! An unsaved scene and rows of version 0.1.0 are there in this window. `tests/data/program-0.1.0` must never be rewritten.

use crate::session::*;
use apertura::evaluate::rows::FORMAT;

fn session(files: &[(&str, &str)]) -> Session {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("data")).unwrap();
    for (name, to) in files {
        let from = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/program-0.1.0")).join(name);
        std::fs::copy(from, folder.path().join("data").join(to)).unwrap();
    }
    Session::opened(folder, None, baseline(), USUAL_SIZE)
}

#[test]
fn an_unsaved_scene_comes_back() {
    let s = session(&[("autosave.toml", "autosave.toml")]);
    let scene = s.editor().scene();
    assert_eq!((scene.name.as_str(), scene.objects.len()), ("Worse than Every \"kind\"", 4));
    assert_eq!((s.state().radar().elements, s.state().radar().bandwidth_hz), (64, 1.5e9));
    assert!(s.editor().is_modified());
    assert_eq!(s.place(0), [-1.1145950794045416, 4.968054565416139]);
}

#[test]
fn rows_of_format_1_are_shown_and_make_room_for_newer_ones() {
    let mut s = session(&[("rows-shard-0.csv", "failures.csv")]);
    let kept = s.state().rows().to_vec();
    assert_eq!((kept.len(), kept[1].squared_error), (4, 47666.1896749522));
    assert!(kept.iter().all(|row| row.version == Some(1)));
    assert!(s.shows("is 1.8 dB quieter from format 2 on"), "their floor is said");
    s.ask(WindowCommand::OpenPanel(Panel::Failures));
    let choice = FailureChoice { methods: vec!["baseline"], kinds: vec![Kind::Set1], own: false, count: 1, seed: 0 };
    s.ask_and_wait(Command::Rows(RowsCommand::Try(choice)));
    assert_eq!(s.state().rows().len(), 1, "older rows don't stand beside newer ones");
    assert_eq!(s.state().rows()[0].version, Some(FORMAT));
    s.ask(RowsCommand::BringBack);
    assert_eq!(s.state().rows(), kept);
}
