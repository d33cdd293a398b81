//! Objects under the pointer, the keys and the clipboard, and files that are damaged.

use crate::session::*;

#[test]
fn a_drag_moves_one_object_from_its_first_pixel() {
    let mut s = Session::start();
    let (requests, painted) = s.state().work_done();
    let (a, b) = (s.handle("point 1: move"), s.handle("point 2: move"));
    let metres_per_point = 8.0 / f64::from((b - a).x);
    s.drag(a, vec2(30.0, 12.0), 60);
    let [x, y] = s.place(0);
    assert!((x - 30.0 * metres_per_point).abs() < 0.02, "{x}: no pixel is lost");
    assert!((y - 20.0 + 12.0 * metres_per_point).abs() < 0.02, "{y}");
    assert_eq!(s.place(1), [8.0, 12.0]);
    let (requests_after, painted_after) = s.state().work_done();
    assert!(requests_after > requests + 5 && painted_after >= painted + 6, "every map followed");
    let depth = s.editor().history().depth();
    s.undo();
    assert_eq!(s.place(0), [0.0, 20.0], "a drag is one step");
    assert_eq!(s.editor().history().depth(), depth - 1);
    s.redo();
    assert!((s.place(0)[0] - x).abs() < 1e-12);
}

#[test]
fn keys_edit_what_a_box_selected() {
    let mut s = Session::start();
    let (a, b) = (s.handle("point 1: move"), s.handle("point 2: move"));
    let (corner, far) = (a.min(b) - vec2(25.0, 25.0), a.max(b) + vec2(25.0, 25.0));
    s.drag(corner, far - corner, 8);
    assert_eq!(s.editor().selection().len(), 2);
    s.press(Modifiers::NONE, Key::ArrowRight);
    assert!(s.place(0)[0] > 0.0 && s.place(1)[0] > 8.0);
    s.press(Modifiers::COMMAND, Key::D);
    assert_eq!(s.objects().len(), 4);
    s.press(Modifiers::NONE, Key::Delete);
    assert_eq!(s.objects().len(), 2);
}

#[test]
fn objects_travel_through_the_clipboard_as_toml() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.app.event(Event::Cut);
    s.settle();
    assert!(s.objects().is_empty());
    s.undo();
    let text = s.editor().copy().unwrap();
    assert!(text.contains("[[object]]") && text.contains("kind = \"point\""));
    for (text, notices) in [(text, 0), ("not a scene".to_owned(), 1)] {
        s.app.event(Event::Paste(text));
        s.settle();
        assert_eq!((s.objects().len(), s.state().notices.list.len()), (4, notices));
    }
}

#[test]
fn a_bad_file_loses_nothing() {
    let mut s = Session::start();
    let scene = s.editor().scene().clone();
    for (name, text) in [
        ("broken.toml", "[[object]]\nkind = \"ghost\"\n"),
        ("nan.toml", "[[object]]\nkind = \"point\"\nx_metres = nan\ny_metres = 1.0\n"),
        ("not.npz", "PK?"),
        ("missing.toml", ""),
    ] {
        let path = s.path(name);
        if name != "missing.toml" {
            std::fs::write(&path, text).unwrap();
        }
        let before = s.state().notices.list.len();
        s.ask(DocumentCommand::OpenPath(path));
        assert!(Arc::ptr_eq(&scene, s.editor().scene()), "{name}");
        assert_eq!(s.state().notices.list.len(), before + 1, "{name}");
    }
    let before = s.state().notices.list.len();
    s.app.get_all_by_label("Close this message").last().unwrap().click();
    s.settle();
    assert_eq!(s.state().notices.list.len(), before - 1);
}

#[test]
fn a_double_click_adds_a_point_where_it_was() {
    let mut s = Session::start();
    let at = s.handle("point 1: move") + vec2(-60.0, 0.0);
    for _ in 0..2 {
        s.app.hover_at(at);
        s.app.drag_at(at);
        s.app.drop_at(at);
        s.app.step();
    }
    s.settle();
    assert_eq!(s.objects().len(), 3);
    assert!(s.place(2)[0] < 0.0 && (s.place(2)[1] - 20.0).abs() < 0.2);
}

#[test]
fn the_status_bar_names_the_echo_under_the_pointer() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::Delete);
    s.ask(EditCommand::Add(NewObject::Post, Some(Place::new(6.0, 20.0))));
    s.ask(EditCommand::Add(NewObject::Wall, Some(Place::new(0.0, 12.0))));
    for (handle, points_below, echo, is_told) in [
        ("wall 2: move", 0.0, "glint of wall 2", true),
        ("post 1: move", 0.0, "post of post 1", true),
        ("wall 2: move", 80.0, "glint of wall 2", false),
    ] {
        s.app.hover_at(s.handle(handle) + vec2(0.0, points_below));
        s.app.run_steps(3);
        assert_eq!(s.shows(echo), is_told, "{echo}, {points_below} points below {handle}");
    }
}
