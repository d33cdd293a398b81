//! Everything can be reached and done without a pointer.

use crate::session::Session;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use std::collections::BTreeMap;

/// Whether a person does something with it. A button that tells where an object's handle is stands for what the arrow keys and the
/// inspector do.
fn is_control(role: Role, name: &str) -> bool {
    let control = matches!(
        role,
        Role::Button
            | Role::CheckBox
            | Role::RadioButton
            | Role::SpinButton
            | Role::Slider
            | Role::ComboBox
            | Role::TextInput
            | Role::Link
    );
    control && !["point ", "line ", "gaussian "].iter().any(|kind| name.starts_with(kind) && name.contains(": "))
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
fn one_key_goes_from_object_to_object_and_arrows_move_what_it_found() {
    let mut s = Session::start();
    let selected = |s: &Session| s.state().editor().selection().single();
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
