//! Bodies in the window.

use crate::session::*;

fn empty() -> Session {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::Delete);
    s
}

#[test]
fn the_status_bar_names_the_echo_under_the_pointer() {
    let mut s = empty();
    s.ask(EditCommand::Add(NewObject::Post, Some(Place::new(6.0, 20.0))));
    s.ask(EditCommand::Add(NewObject::Wall, Some(Place::new(0.0, 12.0))));
    let over = |s: &mut Session, handle: &str, by| {
        let at = s.handle(handle) + by;
        s.app.hover_at(at);
        s.app.run_steps(3);
    };
    over(&mut s, "wall 2: move", vec2(0.0, 0.0));
    let _told = s.app.get_by_label_contains("glint of wall 2");
    over(&mut s, "post 1: move", vec2(0.0, 0.0));
    let _told = s.app.get_by_label_contains("post of post 1");
    over(&mut s, "wall 2: move", vec2(0.0, 80.0));
    assert!(!s.shows("glint of wall 2"), "nothing echoes there");
}
