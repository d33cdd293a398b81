//! Everything can be reached and done without a pointer.

use crate::session::*;
use std::collections::BTreeMap;

fn is_control(role: Role, name: &str) -> bool {
    let is_of_an_object =
        ["point ", "line ", "cluster "].iter().any(|kind| name.starts_with(kind) && name.contains(": "));
    is_used(role) && !is_of_an_object
}

#[test]
fn tab_comes_to_every_control_in_the_window() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    let mut missing: BTreeMap<String, String> = BTreeMap::new();
    for node in s.app.root().children_recursive() {
        let node = node.accesskit_node();
        let name = node.label().unwrap_or_default();
        if is_control(node.role(), &name) && !node.is_disabled() {
            missing.insert(format!("{:?}", node.id()), format!("{:?} {name:?} {:?}", node.role(), node.value()));
        }
    }
    let all = missing.len();
    assert!(all > 40, "{all} controls");
    let mut stops = 0;
    while !missing.is_empty() && stops < 4 * all {
        s.app.key_press(Key::Tab);
        s.app.step();
        s.app.step();
        stops += 1;
        let focused = s.app.root().children_recursive().find(|n| n.is_focused());
        if let Some(node) = focused {
            missing.remove(&format!("{:?}", node.accesskit_node().id()));
        }
    }
    assert!(missing.is_empty(), "{} of {all} are out of reach: {:#?}", missing.len(), missing.values());
}

#[test]
fn objects_are_reached_by_the_keyboard() {
    let mut s = Session::start();
    s.press(Modifiers::NONE, Key::O);
    assert_eq!(selected(&s), Some(0));
    s.press(Modifiers::NONE, Key::O);
    assert_eq!(selected(&s), Some(1));
    s.press(Modifiers::NONE, Key::O);
    assert_eq!(selected(&s), Some(0), "and round again");
    s.press(Modifiers::SHIFT, Key::O);
    assert_eq!(selected(&s), Some(1));
    let [x, y] = s.place(1);
    s.press(Modifiers::NONE, Key::ArrowLeft);
    assert!(s.place(1)[0] < x && s.place(1)[1] == y);
    // In the canvas arrows are the selection's too: they don't take the focus away.
    let canvas = |s: &Session| s.app.get_by_role_and_label(Role::Canvas, "Scene").is_focused();
    s.app.get_by_role_and_label(Role::Canvas, "Scene").focus();
    s.settle();
    let [x, _] = s.place(1);
    s.press(Modifiers::NONE, Key::ArrowRight);
    assert!(s.place(1)[0] > x && canvas(&s));
}

fn selected(s: &Session) -> Option<usize> {
    s.editor().selection().single()
}

fn with_a_menu() -> Session {
    let mut s = Session::start();
    s.select(0);
    s.click("File");
    assert!(s.app.query_by_label("Unsaved scenes").is_some(), "the menu is open");
    s
}

#[test]
fn escape_closes_a_menu_before_anything_else() {
    let mut s = with_a_menu();
    s.press(Modifiers::NONE, Key::Escape);
    assert!(s.app.query_by_label("Unsaved scenes").is_none() && selected(&s) == Some(0));
    s.press(Modifiers::NONE, Key::Escape);
    assert_eq!(selected(&s), None, "the next one is the scene's");
}

#[test]
fn keys_do_not_reach_the_scene_behind_a_menu() {
    let mut s = with_a_menu();
    let scene = s.editor().scene().clone();
    s.press(Modifiers::COMMAND, Key::A);
    for key in [Key::Delete, Key::P, Key::O, Key::ArrowRight] {
        s.press(Modifiers::NONE, key);
    }
    assert_eq!(selected(&s), Some(0));
    assert!(Arc::ptr_eq(s.editor().scene(), &scene), "nothing was added, deleted or moved");
}

fn enter_x(s: &mut Session, text: &str) {
    s.app.get_by_role_and_label(Role::SpinButton, "x").focus();
    s.settle();
    s.press(Modifiers::COMMAND, Key::A);
    s.app.event(Event::Text(text.to_owned()));
    s.settle();
    s.press(Modifiers::NONE, Key::Enter);
}

#[test]
fn keys_after_a_wrong_entry_stay_in_the_field_until_escape() {
    let mut s = Session::start();
    s.select(1);
    enter_x(&mut s, "abc");
    s.app.event(Event::Text("o".to_owned()));
    s.press(Modifiers::NONE, Key::O);
    assert_eq!(selected(&s), Some(1));
    let field = s.app.get_by_role_and_label(Role::SpinButton, "x");
    assert_eq!((field.is_focused(), field.value().as_deref()), (true, Some("abco")));
    s.press(Modifiers::NONE, Key::Escape);
    assert_eq!((selected(&s), s.place(1)), (Some(1), [8.0, 12.0]), "the entry is given up");
    assert!(!s.shows("Enter a number"));
}

#[test]
fn each_entry_is_one_undo_step() {
    let mut s = Session::start();
    s.select(1);
    for text in ["-3,5", "4"] {
        enter_x(&mut s, text);
    }
    assert_eq!(s.place(1)[0], 4.0);
    for x in [-3.5, 8.0] {
        s.undo();
        assert_eq!(s.place(1)[0], x);
    }
}
