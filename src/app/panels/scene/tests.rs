use super::*;
use crate::app::widgets::seen;
use crate::scene::Scene;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

struct Held {
    editor: Editor,
    view: SceneView,
    asked: Vec<Command>,
}

fn panel(scene: Scene) -> Harness<'static, Held> {
    let radar = Radar::default();
    let draw = move |ui: &mut Ui, held: &mut Held| {
        let input = Input {
            radar: &radar,
            snapshot_range_metres: None,
            snap: Snap::Off,
            fields_of_view: false,
            found: &[],
            trails: &[],
            cursor: None,
            error: Some("too far"),
            numbers: true,
        };
        let commands = show(ui, input, &mut held.editor, &mut held.view);
        held.asked.extend(commands);
    };
    let held = Held { editor: Editor::new(scene), view: SceneView::default(), asked: Vec::new() };
    let mut panel = Harness::builder().with_size([600.0, 400.0]).with_step_dt(0.02).build_ui_state(draw, held);
    panel.step();
    panel
}

#[test]
fn a_drag_moves_the_object_and_the_pointer_is_told() {
    let mut scene = panel(Scene::of_points([(0.0, 20.0)]));
    let from = scene.get_by_label("point 1: move").rect().center();
    scene.hover_at(from);
    scene.step();
    scene.drag_at(from);
    scene.step();
    scene.hover_at(from + vec2(40.0, 0.0));
    scene.step();
    scene.drop_at(from + vec2(40.0, 0.0));
    scene.step();
    let held = scene.state();
    let moved = held.editor.scene().objects[0].centre_metres()[0];
    assert!((moved - 40.0 * held.view.metres_per_point).abs() < 1e-6, "{moved}");
    assert!(held.asked.iter().all(|c| matches!(c, Command::Hover(_))) && !held.asked.is_empty());
}

#[test]
fn ghosts_stand_where_the_radar_hears_them() {
    let mut mirrored = Scene::of_points([(3.0, 20.0)]);
    mirrored.disturbances.mirror = Some(crate::scene::Mirror::default());
    let rings = |scene: &Harness<'static, Held>| {
        let (rect, view) = (scene.get_by_label("Scene").rect(), scene.state().view);
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
fn labels_stand_around_the_half_disc_and_none_is_cut() {
    // The last also shows what stands far behind the array: the half disc is small.
    for (size, y_metres) in
        [([280.0, 170.0], 20.0), ([480.0, 300.0], 20.0), ([1400.0, 800.0], 20.0), ([490.0, 170.0], -30.0)]
    {
        let radar = Radar::default();
        let mut state = (Editor::new(Scene::default()), SceneView::default());
        let draw = move |ui: &mut Ui, (editor, view): &mut (Editor, SceneView)| {
            let (snap, fields_of_view) = (Snap::Off, false);
            let (found, numbers) = (&[], true);
            let (trails, cursor, error, snapshot_range_metres) = (&[], None, None, None);
            let radar = &radar;
            let input = Input {
                radar,
                snapshot_range_metres,
                snap,
                fields_of_view,
                found,
                found_stale: false,
                trails,
                cursor,
                error,
                numbers,
            };
            _ = show(ui, input, editor, view);
        };
        state.0.add(crate::scene::Object::Point(crate::scene::Point::new(-12.0, y_metres)));
        let scene = Harness::builder().with_size(size).build_ui_state(draw, state);
        seen::assert_readable(scene.output());
        let (rect, view) = (scene.get_by_label("Scene").rect(), scene.state().1);
        let radius = Radar::default().max_range_metres() / view.metres_per_point;
        let origin = view.to_screen(rect, Place::new(0.0, 0.0));
        assert!(f64::from(origin.x - rect.left()) > radius + 10.0, "the disc doesn't touch the panel at {size:?}");
        for text in seen::texts(scene.output()).iter().filter(|t| t.text.ends_with('°')) {
            let outside = text.rect.distance_to_pos(origin) >= radius as f32;
            assert!(outside, "{} is on the arc at {size:?}", text.text);
        }
    }
}

#[test]
fn a_snapshot_is_drawn_out_to_where_it_heard_something() {
    let radar = Radar { samples: 1, elements: 86, ..Radar::default() };
    let found = [Reflector { x_metres: 0.0, y_metres: 15.0, reflectivity: 1.0 }];
    let draw = move |ui: &mut Ui, (editor, view): &mut (Editor, SceneView)| {
        let (snap, fields_of_view, numbers) = (Snap::Off, false, true);
        let (radar, found, trails, cursor, error) = (&radar, &found, &[], None, None);
        let snapshot_range_metres = Some(15.0);
        let input = Input {
            radar,
            snapshot_range_metres,
            snap,
            fields_of_view,
            found,
            found_stale: false,
            trails,
            cursor,
            error,
            numbers,
        };
        _ = show(ui, input, editor, view);
    };
    let state = (Editor::new(Scene::default()), SceneView::default());
    let scene = Harness::builder().with_size([480.0, 300.0]).build_ui_state(draw, state);
    seen::assert_readable(scene.output());
    let rect = scene.get_by_label("Scene").rect();
    assert!(rect.contains(scene.state().1.to_screen(rect, Place::new(0.0, 15.0))), "what was found is in sight");
}

#[test]
fn either_end_of_a_line_can_be_dragged_to_any_slant_and_back() {
    use crate::scene::{Line, Object};
    let before = Line::vertical(0.0, 10.0, 0.5, 21);
    let mut scene = panel(Scene { objects: vec![Object::Line(before.clone())], ..Scene::default() });
    scene.state_mut().editor.select_all();
    scene.step();
    let line = |scene: &Harness<'static, Held>| match &scene.state().editor.scene().objects[0] {
        Object::Line(line) => line.clone(),
        other => panic!("{other:?}"),
    };
    let drag = |scene: &mut Harness<'static, Held>, handle: &str, by: egui::Vec2| {
        let from = scene.get_by_label(handle).rect().center();
        scene.hover_at(from);
        scene.step();
        scene.drag_at(from);
        scene.step();
        scene.hover_at(from + by);
        scene.step();
        scene.drop_at(from + by);
        scene.step();
        scene.state().view.metres_per_point
    };
    let metres = drag(&mut scene, "line 1: move the far end: more or fewer reflectors", vec2(50.0, 10.0));
    let turned = line(&scene);
    let wanted = 90.0 - (50.0 * metres).atan2(10.0 - 10.0 * metres).to_degrees();
    assert!((turned.direction_degrees - wanted).abs() < 0.1, "{turned:?}, not {wanted}");
    assert_eq!([turned.x_metres, turned.y_start_metres], [0.0, 10.0], "the other end stays");
    let far = turned.end_metres();
    drag(&mut scene, "line 1: move the near end: more or fewer reflectors", vec2(-60.0, -20.0));
    let [x, y] = line(&scene).end_metres();
    assert!((x - far[0]).hypot(y - far[1]) < 1e-9 && line(&scene).x_metres < -1.0, "{:?}", line(&scene));
    let editor = &mut scene.state_mut().editor;
    assert!(editor.undo() && editor.undo() && !editor.undo());
    assert_eq!(line(&scene), before);
}

#[test]
fn a_double_click_asks_for_a_point_there() {
    let mut scene = panel(Scene::default());
    let at = scene.get_by_label("Scene").rect().center();
    for _ in 0..2 {
        scene.hover_at(at);
        scene.drag_at(at);
        scene.drop_at(at);
        scene.step();
    }
    let held = scene.state();
    let place = held.view.to_scene(scene.get_by_label("Scene").rect(), at);
    assert!(held.asked.contains(&Command::Add(NewObject::Point, Some(place))), "{:?}", held.asked);
}
