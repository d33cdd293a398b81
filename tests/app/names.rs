//! Names for screen readers, and windows at twice the size or as narrow as a telephone.

use crate::session::*;

fn nameless(s: &Session, what: &str) -> Vec<String> {
    let nodes = s.app.root().children_recursive().map(|node| node.accesskit_node()).collect::<Vec<_>>();
    let named = nodes.iter().filter(|n| is_used(n.role()) || matches!(n.role(), Role::Image | Role::Canvas));
    assert!(named.clone().count() > 5, "{what}");
    let silent = named.filter(|n| n.label().is_none_or(|label| label.trim().is_empty()));
    silent.map(|n| format!("{what}: {:?}, value {:?}", n.role(), n.value())).collect()
}

#[test]
fn every_control_has_a_name_in_every_arrangement() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    let mut found = nameless(&s, "at first");
    for panel in Panel::all() {
        s.ask(Command::Window(WindowCommand::OpenPanel(panel)));
        found.extend(nameless(&s, panel.title()));
    }
    s.ask(Command::Window(WindowCommand::ResetLayout));
    for modifiers in [Modifiers::NONE, Modifiers::SHIFT] {
        s.press(modifiers, Key::F11);
        found.extend(nameless(&s, "presentation"));
        s.press(modifiers, Key::F11);
    }
    found.sort();
    found.dedup();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_map_is_described_by_its_peaks() {
    let mut s = Session::start();
    let described = |s: &Session, kind: MapKind| {
        let label = format!("{} map", kind.title());
        s.app.get_by_label(&label).accesskit_node().description().unwrap_or_default()
    };
    let target = described(&s, MapKind::Target);
    assert!(target.starts_with("The map of all elements"), "{target}");
    assert!(target.contains("14.4 m, +3") && target.contains(" m, ±0.0°") && target.contains("eak"), "{target}");
    assert!(described(&s, MapKind::OutputAbove).contains(" hit, "), "{}", described(&s, MapKind::OutputAbove));
    s.ask(Command::Lesson(apertura::app::LessonCommand::Begin(0)));
    let hidden = described(&s, MapKind::Target);
    assert!(!hidden.contains("eak"), "{hidden}");
}

#[test]
fn captions_name_every_map_until_the_first_drag() {
    let mut s = Session::start();
    assert!(!s.state().shows_captions(), "nothing can be kept here");
    s.ask(Command::Window(WindowCommand::ToggleCaptions));
    for wanted in ["Input 0: the first", "Input 1: the last", "Target: all 128", "Output: baseline", "Output > η:"] {
        assert!(s.painted().iter().any(|t| t.starts_with(wanted)), "{wanted}: {:?}", s.painted());
    }
    assert!(s.painted().iter().any(|t| t.starts_with("Drag a reflector")), "{:?}", s.painted());
    s.drag(s.handle("point 1: move"), vec2(30.0, 0.0), 3);
    assert!(!s.state().shows_captions() && !s.painted().iter().any(|t| t.starts_with("Target: all")));
    s.ask(Command::Window(WindowCommand::ToggleCaptions));
    assert!(s.state().shows_captions(), "Help brings them back");
    s.select(0);
    s.press(Modifiers::NONE, Key::ArrowRight);
    assert!(!s.state().shows_captions(), "arrow keys move it as a drag does");
}

#[test]
fn maps_bend_into_cartesian_ones_at_once() {
    let mut s = Session::start();
    s.app.get_by_label("Target: bend into x and y").click();
    s.app.step();
    s.app.step();
    assert!(s.painted().iter().any(|t| t == "x, m"), "the axes are the new ones: {:?}", s.painted());
    s.settle();
    s.click("Target: straighten into cos θ and range");
    assert_eq!(s.state().settings.projection, apertura::app::Projection::RangeAngle);
}

#[test]
fn nothing_is_cut_off_at_twice_the_size() {
    let mut s = Session::opened(tempdir().unwrap(), None, baseline(), [720.0, 450.0]);
    for command in [WindowCommand::ClosePanel(Panel::Controls), WindowCommand::Maximise(Panel::Map(MapKind::Target))] {
        s.ask(command);
        let cut = wider_than_their_place(&s);
        assert!(cut.is_empty(), "{cut:?}");
    }
}

/// Texts that reach beyond the left or the right end of the drawable area: no scrolling brings them into sight.
fn wider_than_their_place(s: &Session) -> Vec<String> {
    let is_cut = |clip: egui::Rect, rect: egui::Rect| {
        (rect.right() > clip.right() + 1.5 || rect.left() < clip.left() - 1.5) && rect.intersects(clip)
    };
    let cut = s.texts().into_iter().filter(|(clip, text)| is_cut(*clip, text.visual_bounding_rect()));
    cut.map(|(_, text)| text.galley.text().to_owned()).filter(|text| !text.trim().is_empty()).collect()
}

#[test]
fn a_narrow_window_has_scene_output_and_target_in_one_column() {
    let Session { app, folder } = Session::start();
    drop(app);
    let s = Session::opened(folder, Some("scene.toml"), baseline(), [390.0, 844.0]);
    let titles = ["Scene", "Output", "Target"].map(|title| s.app.get_by_role_and_label(Role::Label, title).rect());
    assert!(titles.windows(2).all(|pair| pair[1].min.y - pair[0].max.y > 200.0), "{titles:?}");
    assert!(titles[2].max.y + 150.0 < 844.0, "all three are on screen: {titles:?}");
}

#[test]
fn the_first_drag_is_told_in_one_sentence() {
    let mut s = Session::start();
    s.ask(DocumentCommand::Preset(0));
    s.ask(RadarCommand::Set(Box::default()));
    s.ask(WindowCommand::ToggleCaptions);
    let told = |s: &Session, text: &str| s.painted().iter().any(|t| t == text);
    let task = "Drag the post along its ring, to the wall";
    assert!(told(&s, task), "{:?}", s.painted());
    let (from, metres_per_point) = (s.handle("post: move"), s.state().scene_view.metres_per_point);
    let [x, y] = s.place(3);
    let (range, (sin, cos)) = (x.hypot(y), 27f64.to_radians().sin_cos());
    let by = vec2(((range * sin - x) / metres_per_point) as f32, ((y - range * cos) / metres_per_point) as f32);
    s.drag(from, by, 6);
    s.settle();
    let both = "Both inputs now show post and wall as one blob; the target shows two";
    assert!(told(&s, both), "{:?}", s.painted());
    s.ask(EditCommand::Undo);
    assert!(told(&s, task), "nothing is dragged any more");
    s.ask(RadarCommand::Set(Box::new(Radar { elements: 64, samples: 64, ..Radar::default() })));
    assert!(!told(&s, task), "another radar shows the street otherwise");
    s.ask(DocumentCommand::New);
    assert!(!told(&s, both), "it belongs to that scene");
}
