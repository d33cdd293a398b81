//! Walls, boxes, posts and polygons in the window: added, changed while the maps follow, and listed.

use crate::session::*;

fn empty() -> Session {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::Delete);
    s
}

fn last(s: &Session) -> Object {
    s.objects().last().cloned().unwrap()
}

#[test]
fn the_maps_follow_the_sliders_of_radius_and_roughness() {
    let mut s = empty();
    s.ask(EditCommand::Add(NewObject::Post, Some(Place::new(0.0, 12.0))));
    s.select(0);
    let depth = s.editor().history().depth();
    for (name, value) in [
        ("radius slider", (|o| if let Object::Post(p) = o { p.radius_metres } else { f64::NAN }) as fn(&Object) -> f64),
        ("roughness slider", |o| if let Object::Post(p) = o { p.roughness_millimetres } else { f64::NAN }),
    ] {
        let before = value(&last(&s));
        let (_, painted) = s.state().work_done();
        let slider = s.app.get_by_role_and_label(Role::Slider, name).rect();
        let middle = slider.center();
        s.hold(middle);
        let mut during = Vec::new();
        for step in 1..=10 {
            s.app.hover_at(middle + vec2(2.0 * step as f32, 0.0));
            s.app.step();
            during.push(value(&last(&s)));
        }
        step_until(&mut s, "the maps follow before the slider is let go", |s| s.state().work_done().1 > painted);
        s.app.drop_at(middle + vec2(20.0, 0.0));
        s.settle();
        assert!(during.windows(2).all(|w| w[0] <= w[1]) && during[0] < during[9], "{name}: {during:?}");
        assert!(value(&last(&s)) > before, "{name}");
    }
    assert_eq!(s.editor().history().depth(), depth + 2, "each slide is one step");
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
