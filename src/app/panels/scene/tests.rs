use super::*;
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::interact::grips;
use crate::radar::Radar;
use crate::scene::{Block, GaussianCluster, Line, Object, Point, Scene, Wall};

mod answers;

struct Held {
    state: State,
    asked: Vec<Command>,
}

/// Input of a canvas where nothing is found or wrong.
fn input() -> Input<'static> {
    Input { tells_maps: true, ..Input::default() }
}

fn panel(scene: Scene) -> Harness<'static, Held> {
    let draw = |ui: &mut Ui, held: &mut Held| {
        let commands = show(ui, Input { error: Some("too far"), ..input() }, &mut held.state);
        held.asked.extend(commands);
    };
    let held = Held { state: State::of(Radar::default(), scene), asked: Vec::new() };
    let mut panel = Harness::builder().with_size([600.0, 400.0]).with_step_dt(0.02).build_ui_state(draw, held);
    panel.step();
    panel
}

#[test]
fn a_drag_moves_the_object_and_tells_the_place_of_the_pointer() {
    let mut scene = panel(Scene::of_points([(0.0, 20.0)]));
    let from = scene.get_by_label("point 1: move").rect().center();
    scene.drags(&[from, from + vec2(40.0, 0.0)]);
    let held = scene.state();
    let moved = held.state.editor.scene().objects[0].centre_metres()[0];
    assert!((moved - 40.0 * held.state.scene_view.metres_per_point).abs() < 1e-6, "{moved}");
    assert!(held.asked.iter().all(|c| matches!(c, Command::View(ViewCommand::Hover(_)))) && !held.asked.is_empty());
}

#[test]
fn ghosts_stand_where_the_radar_hears_them() {
    let mut mirrored = Scene::of_points([(3.0, 20.0)]);
    mirrored.disturbances.mirror = Some(crate::scene::Mirror::default());
    let rings = |scene: &Harness<'static, Held>| {
        let (rect, view) = (scene.get_by_label("Scene").rect(), scene.state().state.scene_view);
        let shapes = scene.output().shapes.iter();
        let hollow = shapes.filter_map(|clipped| match &clipped.shape {
            egui::Shape::Circle(circle) if circle.fill == egui::Color32::TRANSPARENT => Some(circle.center),
            _ => None,
        });
        hollow.map(|at| view.to_scene(rect, at)).collect::<Vec<Place>>()
    };
    let without = rings(&panel(Scene::of_points([(3.0, 20.0)]))).len();
    let rings = rings(&panel(mirrored.clone()));
    assert_eq!(rings.len(), without + 3);
    for ghost in &mirrored.echoing(&Radar::default())[1..] {
        let is_there = |place: &Place| (place.x_metres - ghost.x_metres).hypot(place.y_metres - ghost.y_metres) < 1e-3;
        assert!(rings.iter().any(is_there), "{ghost:?} of {rings:?}");
    }
}

#[test]
fn labels_stand_around_the_half_disc_from_straight_ahead() {
    // The last cases also show a point behind the array and its note.
    for (size, y_metres) in [
        ([280.0, 170.0], 20.0),
        ([480.0, 300.0], 20.0),
        ([1400.0, 800.0], 20.0),
        ([490.0, 170.0], -30.0),
        ([432.0, 265.0], -8.0),
    ] {
        let mut state = State::of(Radar::default(), Scene::default());
        let draw = |ui: &mut Ui, state: &mut State| _ = show(ui, input(), state);
        state.editor.add(Object::Point(Point::new(-12.0, y_metres)));
        let scene = Harness::builder().with_size(size).build_ui_state(draw, state);
        seen::assert_readable(scene.output());
        let texts = seen::texts(scene.output());
        let middle = |label: &str| texts.iter().find(|t| t.text == label).map(|t| t.rect.center().x);
        let spokes = ["−60°", "−30°", "0°", "30°", "60°"].map(middle);
        assert!(spokes[0].is_some() && spokes.is_sorted(), "from straight ahead: {texts:?}");
        let (rect, view) = (scene.get_by_label("Scene").rect(), scene.state().scene_view);
        let radius = Radar::default().max_range_metres() / view.metres_per_point;
        let origin = view.to_screen(rect, Place::new(0.0, 0.0));
        assert!(f64::from(origin.x - rect.left()) > radius + 10.0, "the disc doesn't touch the panel at {size:?}");
        for text in texts.iter().filter(|t| t.text.ends_with('°')) {
            let outside = text.rect.distance_to_pos(origin) >= radius as f32;
            assert!(outside, "{} is on the arc at {size:?}", text.text);
        }
    }
}

#[test]
fn a_snapshot_is_drawn_out_to_where_it_heard_something() {
    let radar = Radar { samples: 1, elements: 86, ..Radar::default() };
    let found = [Reflector { x_metres: 0.0, y_metres: 15.0, reflectivity: 1.0 }];
    let draw = move |ui: &mut Ui, state: &mut State| _ = show(ui, Input { found: &found, ..input() }, state);
    let signal = crate::signal::BeatSignal::silence(&radar);
    let recording = crate::recording::Recording::of_signal(radar, signal);
    let state = State::recorded(crate::recording::Recording { range_metres: Some(15.0), ..recording });
    let scene = Harness::builder().with_size([480.0, 300.0]).build_ui_state(draw, state);
    seen::assert_readable(scene.output());
    let rect = scene.get_by_label("Scene").rect();
    let found = scene.state().scene_view.to_screen(rect, Place::new(0.0, 15.0));
    assert!(rect.contains(found), "it is in sight");
}

fn selected(object: Object) -> Harness<'static, Held> {
    let mut scene = panel(Scene { objects: vec![object], ..Scene::default() });
    scene.state_mut().state.editor.select_all();
    scene.step();
    scene
}

fn wall() -> Harness<'static, Held> {
    selected(Object::Line(Line::vertical(0.0, 10.0, 0.5, 21)))
}

fn line(scene: &Harness<'static, Held>) -> Line {
    match &scene.state().state.editor.scene().objects[0] {
        Object::Line(line) => line.clone(),
        other => panic!("{other:?}"),
    }
}

/// Drags a handle in several steps. Returns metres per point.
fn drag(scene: &mut Harness<'static, Held>, handle: &str, by: egui::Vec2) -> f64 {
    let from = scene.get_by_label(handle).rect().center();
    scene.drags(&[0.0, 0.3, 0.7, 1.0].map(|part| from + by * part));
    scene.state().state.scene_view.metres_per_point
}

#[test]
fn an_end_of_a_line_stretches_it_in_one_step_of_undo() {
    let mut scene = wall();
    let before = line(&scene);
    let metres = drag(&mut scene, "line 1: move the far end: more or fewer reflectors", vec2(50.0, 40.0));
    let shorter = line(&scene);
    assert_eq!((shorter.direction_degrees, shorter.x_metres, shorter.y_start_metres), (90.0, 0.0, 10.0));
    let wanted = before.end_metres()[1] - 40.0 * metres;
    assert!((shorter.end_metres()[1] - wanted).abs() <= 0.25, "{shorter:?} ends at {wanted}");
    assert!(scene.state_mut().state.editor.undo() && line(&scene) == before && !scene.state_mut().state.editor.undo());
}

#[test]
fn the_handle_of_a_line_turns_it_in_one_step_of_undo() {
    let mut scene = wall();
    let (before, middle) = (line(&scene), [0.0, 15.0]);
    let handle = "line 1: turn the line about its middle";
    let rect = scene.get_by_label("Scene").rect();
    let place = scene.state().state.scene_view.to_scene(rect, scene.get_by_label(handle).rect().center());
    let metres = drag(&mut scene, handle, vec2(60.0, 30.0));
    let turned = line(&scene);
    let [dx, dy] = [place.x_metres + 60.0 * metres - middle[0], place.y_metres - 30.0 * metres - middle[1]];
    let wanted = 90.0 - dx.atan2(dy).to_degrees();
    assert!((turned.direction_degrees - wanted).abs() < 0.1, "{turned:?}, not {wanted}");
    assert_eq!((turned.count, turned.spacing_metres), (before.count, before.spacing_metres));
    let [x, y] = turned.place_metres(10.0);
    assert!((x - middle[0]).hypot(y - middle[1]) < 1e-9, "the middle stays: {x}, {y}");
    assert!(scene.state_mut().state.editor.undo() && line(&scene) == before && !scene.state_mut().state.editor.undo());
}

#[test]
fn what_stands_beyond_the_maximum_range_is_warned_of() {
    let sentence = "point 2 stands beyond the maximum range of 38.4 m: the maps show it at 21.6 m.";
    let mut scene = panel(Scene::of_points([(0.0, 20.0), (0.0, 60.0)]));
    let _told = scene.get_by_label(sentence);
    assert!(scene.reads(sentence), "it is seen, too");
    let view = &mut scene.state_mut().state.scene_view;
    (view.centre, view.metres_per_point, view.fit) = (Place::new(0.0, 18.0), 0.1, false);
    view.fitted = None;
    scene.step();
    let (canvas, sign) =
        (scene.get_by_label("Scene").rect(), scene.get_by_label("point 2 beyond the maximum range").rect());
    assert!((sign.center().y - canvas.top()).abs() < 20.0, "at the upper edge, where it would be: {sign:?}");
    assert!((sign.center().x - canvas.center().x).abs() < 1.0);
    let near = panel(Scene::of_points([(0.0, 20.0), (0.0, 38.0)]));
    assert!(near.query_by_label_contains("maximum range").is_none());
}

#[test]
fn a_wall_that_reaches_beyond_the_maximum_range_says_so() {
    let line = Object::Line(Line::vertical(0.0, 30.0, 0.5, 21));
    let scene = panel(Scene { objects: vec![line.clone()], ..Scene::default() });
    let _told =
        scene.get_by_label("line 1 reaches beyond the maximum range of 38.4 m: its far part wraps around in the maps.");
    let two = panel(Scene { objects: vec![line.clone(), line], ..Scene::default() });
    let _told = two.get_by_label("2 objects reach beyond the maximum range of 38.4 m: they wrap around in the maps.");
}

#[test]
fn notes_and_hints_stay_in_a_narrow_canvas() {
    for width in [205.0, 275.0] {
        let line = Object::Line(Line::vertical(0.0, 30.0, 0.5, 21));
        let scene = Scene { objects: vec![line], ..Scene::default() };
        let hint = Hint { text: "Drag the post along its ring, to the wall".to_owned(), way: Vec::new() };
        let draw = move |ui: &mut Ui, state: &mut State| {
            _ = show(ui, Input { hint: Some(hint.clone()), ..input() }, state);
        };
        let state = State::of(Radar::default(), scene);
        let mut panel = Harness::builder().with_size([width, 200.0]).build_ui_state(draw, state);
        panel.run_steps(3);
        let texts = seen::texts(panel.output());
        let of = |start: &str| texts.iter().find(|t| t.text.starts_with(start)).unwrap_or_else(|| panic!("{texts:?}"));
        for told in [of("line 1 reaches"), of("Drag the post")] {
            assert!(told.clip.contains_rect(told.rect), "{told:?} in {width}");
        }
        assert!(width < 250.0 || !of("Drag the post").rect.expand(4.0).intersects(of("0°").rect), "{texts:?}");
    }
}

#[test]
fn every_grip_is_dragged_by_arrow_keys_while_it_has_the_focus() {
    let cluster = GaussianCluster { seed: 1, ..GaussianCluster::new([-4.0, 18.0], [1.0, 1.0], 20) };
    for (object, key) in [
        (Object::Line(Line::vertical(4.0, 10.0, 0.5, 20)), egui::Key::ArrowUp),
        (Object::Gaussian(cluster.clone()), egui::Key::ArrowRight),
        (Object::Gaussian(cluster), egui::Key::ArrowUp),
    ] {
        let mut scene = selected(object.clone());
        let metres_per_point = scene.state().state.scene_view.metres_per_point;
        let mut changed = 0;
        let names: Vec<String> = grips(&object, metres_per_point)
            .into_iter()
            .filter(|g| g.grip != Grip::Body)
            .map(|g| format!("{} 1: {}", object.noun(), g.grip.describe()))
            .collect();
        for name in &names {
            let before = scene.state().state.editor.scene().objects[0].clone();
            scene.get_by_label(name).focus();
            scene.run_steps(2);
            scene.key_press_modifiers(egui::Modifiers::SHIFT, key);
            scene.run_steps(2);
            assert!(scene.get_by_label(name).is_focused(), "{name}: the arrow doesn't take the focus away");
            changed += usize::from(scene.state().state.editor.scene().objects[0] != before);
        }
        // Each of a cluster's two grips follows one of the arrows; the grip that turns a line may rest where it is for one along it.
        assert!(changed >= names.len() / 2, "{changed} of {names:?}");
        assert_eq!(scene.state().state.editor.history().depth(), changed, "each is one undo step");
    }
}

#[test]
fn arrow_keys_pan_the_scene_while_nothing_is_selected() {
    let mut scene = panel(Scene::of_points([(0.0, 20.0)]));
    scene.get_by_label("Scene").focus();
    scene.run_steps(2);
    let centre = |scene: &Harness<'static, Held>| scene.state().state.scene_view.centre;
    let before = centre(&scene);
    scene.presses(&[egui::Key::ArrowRight]);
    let panned = centre(&scene);
    assert!(panned.x_metres > before.x_metres && panned.y_metres == before.y_metres);
    scene.state_mut().state.editor.select([0], SelectionMode::Replace);
    scene.presses(&[egui::Key::ArrowRight]);
    assert_eq!(centre(&scene), panned, "arrows are the selection's");
    let is_nudge = |c: &Command| matches!(c, Command::Edit(crate::app::state::EditCommand::Nudge { .. }));
    assert!(scene.state().asked.iter().any(is_nudge));
    scene.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::ArrowUp);
    scene.run_steps(2);
    assert!(centre(&scene).y_metres > panned.y_metres, "with Ctrl they pan whatever is selected");
}

#[test]
fn a_corner_resizes_a_box_and_the_round_handle_turns_a_wall() {
    let object = Object::Box(Block::new([4.0, 12.0], [4.0, 2.0], 0.0));
    let mut scene = selected(object.clone());
    let metres = drag(&mut scene, "box 1: move corner 3", vec2(40.0, -30.0));
    let Object::Box(after) = scene.state().state.editor.scene().objects[0].clone() else { panic!() };
    assert!((after.length_metres - 4.0 - 40.0 * metres).abs() < 0.3, "{after:?}");
    assert!((after.width_metres - 2.0 - 30.0 * metres).abs() < 0.3, "{after:?}");
    let [x, y] = after.corners_metres()[0];
    assert!((x - 2.0).hypot(y - 11.0) < 1e-9, "the opposite corner stays: {x}, {y}");
    assert!(scene.state_mut().state.editor.undo() && scene.state().state.editor.scene().objects[0] == object);
    let mut scene = selected(Object::Wall(Wall::new(0.0, 15.0, 6.0, 0.0)));
    drag(&mut scene, "wall 1: turn it about its middle", vec2(0.0, -40.0));
    let Object::Wall(after) = scene.state().state.editor.scene().objects[0].clone() else { panic!() };
    assert!(after.angle_degrees > 5.0 && (after.x_metres, after.y_metres) == (0.0, 15.0), "{after:?}");
    assert_eq!(after.length_metres, 6.0);
}
