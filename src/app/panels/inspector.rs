//! The inspector panel: the numbers of a selected object with their units, or those that several selected objects share.

mod look;
mod number;
mod slider;

use crate::app::content::{Content, Cx, Nothing};
use crate::app::state::{Command, EditCommand, NewObject};
use crate::app::widgets::{angle_of_place_degrees, button, press, scrolled, signed};
use crate::interact::{Coordinates, Editor};
use crate::radar::{Radar, counted};
use crate::scene::{MAX_NAME_CHARACTERS, Object, Scene};
use eframe::egui::{self, Grid, TextEdit, Ui};
use number::number;

/// The selected objects, and how their numbers are shown.
pub struct Input<'a> {
    /// The scene with its selection.
    pub editor: &'a Editor,
    pub radar: &'a Radar,
    /// Coordinates in which places are shown.
    pub coordinates: Coordinates,
    /// Length in the scene that a point of the canvas covers; shown lengths are rounded to it.
    pub metres_per_point: f64,
}

pub struct InspectorPanel;

impl Content for InspectorPanel {
    type Asks = Nothing;
    type Remembers = ();
    const TELLS_ANSWERS: bool = true;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (editor, coordinates) = (&cx.state.editor, cx.state.settings.coordinates);
        let metres_per_point = cx.state.scene_view.metres_per_point;
        show(ui, Input { editor, radar: editor.radar(), coordinates, metres_per_point })
    }
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    scrolled(ui, |ui, asked| match input.editor.selection().is_empty() {
        true => nothing(ui, input.editor.scene(), asked),
        false => selected(ui, &input, asked),
    })
}

fn nothing(ui: &mut Ui, scene: &Scene, asked: &mut Vec<Command>) {
    if scene.objects.is_empty() {
        named(ui, scene);
        ui.weak("The scene is empty.");
        press(ui, "Add a point", "", || EditCommand::Add(NewObject::Point, None), asked);
        return;
    }
    named(ui, scene);
    ui.add_space(4.0);
    ui.weak("Click an object to see and edit its numbers; drag a box around several.");
}

/// Draws the name and the notes of the scene, or of the recording under it.
fn named(ui: &mut Ui, scene: &Scene) {
    if !scene.name.is_empty() {
        ui.strong(&scene.name);
    }
    if !scene.notes.is_empty() {
        ui.label(&scene.notes);
    }
}

fn selected(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let Input { editor, radar, coordinates, metres_per_point } = *input;
    let single = editor.selection().single();
    let object = single.and_then(|index| editor.scene().objects.get(index));
    ui.horizontal(|ui| {
        match (object, single) {
            (Some(object), Some(index)) => title(ui, object, index, asked),
            _ => {
                ui.strong(counted(editor.selection().len(), "object", "objects"));
                ui.weak(counted(editor.selected_reflectors(), "reflector", "reflectors"));
            }
        }
        toggle(ui, coordinates, asked);
    });
    // Another selection has fields of its own: text typed for one is never taken for the other.
    ui.push_id((editor.selection().latest(), editor.selection().len()), |ui| {
        Grid::new("numbers").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
            for shared in editor.shared_fields(coordinates) {
                let change = number(ui, &shared, metres_per_point);
                asked.extend(change.map(|change| Command::Edit(EditCommand::SetField(shared.field, change))));
            }
        });
    });
    if let Some(object) = object {
        seen(ui, radar, object.centre_metres(), coordinates);
    }
    ui.horizontal(|ui| {
        button(ui, "Duplicate", EditCommand::Duplicate, true, asked);
        button(ui, "Delete", EditCommand::Delete, true, asked);
    });
}

/// Draws the field of the object's name, with kind and number as its hint.
fn title(ui: &mut Ui, object: &Object, index: usize, asked: &mut Vec<Command>) {
    let (mut name, kind) = (object.name().to_owned(), format!("{} {}", capital(object.noun()), index + 1));
    let hint = egui::RichText::new(&kind).strong();
    let edit = TextEdit::singleline(&mut name).id_salt(index).char_limit(MAX_NAME_CHARACTERS).hint_text(hint);
    let response = ui.add(edit.desired_width(130.0).font(egui::FontSelection::Default));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, &kind));
    if response.on_hover_text("Its name in lists and verdicts").changed() {
        asked.push(EditCommand::Name(name).into());
    }
}

fn toggle(ui: &mut Ui, shown: Coordinates, asked: &mut Vec<Command>) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        for (coordinates, label, tip) in [
            (Coordinates::Polar, "R, angle", "Enter places as range and direction"),
            (Coordinates::Cartesian, "x, y", "Enter places as x and y"),
        ] {
            if ui.selectable_label(shown == coordinates, label).on_hover_text(tip).clicked() {
                asked.push(EditCommand::SetCoordinates(coordinates).into());
            }
        }
    });
}

/// Writes an object's place in the other coordinates with its bin and column, and a warning where the maps show it elsewhere.
fn seen(ui: &mut Ui, radar: &Radar, [x, y]: [f64; 2], coordinates: Coordinates) {
    let polar = radar.polar_of(x, y);
    let blob = radar.blob_of(0.0, x, y);
    let (bin, column) = (radar.bin_of_range(polar.range_metres), radar.column_of_cos(blob.cos_theta));
    let other = match coordinates {
        Coordinates::Cartesian => {
            let angle = signed(angle_of_place_degrees(x, y), 2);
            format!("range {:.3} m · {angle}° · cos θ {}", polar.range_metres, signed(polar.cos_theta, 4))
        }
        Coordinates::Polar => format!("x {x:.3} m · y {y:.3} m"),
    };
    let has_ranges = radar.samples > 1;
    let bin = if has_ranges { format!(" · bin {bin:.1}") } else { String::new() };
    ui.weak(format!("{other}{bin} · column {column:.1}"));
    if has_ranges && polar.range_metres > radar.max_range_metres() {
        ui.colored_label(ui.visuals().warn_fg_color, "Beyond the maximum range: it wraps around in the maps.");
    } else if y < 0.0 {
        ui.colored_label(ui.visuals().warn_fg_color, "Behind the array: it appears mirrored in front of it.");
    }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|c| c.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::SelectionMode;
    use crate::scene::Line;
    use eframe::egui::{Event, Key};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    struct Held {
        editor: Editor,
        coordinates: Coordinates,
        asked: Vec<Command>,
    }

    /// The panel, with an editor that executes its commands.
    fn panel(editor: Editor, coordinates: Coordinates) -> Harness<'static, Held> {
        let draw = |ui: &mut Ui, held: &mut Held| {
            let input = Input {
                editor: &held.editor,
                radar: &Radar::default(),
                coordinates: held.coordinates,
                metres_per_point: 0.05,
            };
            for command in show(ui, input) {
                match &command {
                    Command::Edit(EditCommand::SetField(field, change)) => {
                        held.editor.set_field(*field, *change).unwrap()
                    }
                    Command::Edit(EditCommand::Name(name)) => held.editor.name_selected(name),
                    _ => {}
                }
                held.asked.push(command);
            }
        };
        Harness::new_ui_state(draw, Held { editor, coordinates, asked: Vec::new() })
    }

    fn of(points: &[(f64, f64)]) -> Editor {
        let mut editor = Editor::new(Scene::of_points(points.iter().copied()));
        editor.select_all();
        editor
    }

    fn enter(inspector: &mut Harness<'static, Held>, name: &str, text: &str) {
        inspector.get_by_label(name).click();
        inspector.run();
        for letter in text.chars() {
            inspector.event(Event::Text(letter.to_string()));
            inspector.step();
        }
        inspector.key_press(Key::Enter);
        inspector.run();
    }

    fn places(inspector: &Harness<'static, Held>) -> Vec<[f64; 2]> {
        inspector.state().editor.scene().objects.iter().map(Object::anchor_metres).collect()
    }

    #[test]
    fn an_empty_scene_offers_a_point() {
        let mut inspector = panel(Editor::new(Scene::default()), Coordinates::Cartesian);
        inspector.get_by_label("Add a point").click();
        inspector.step();
        assert_eq!(inspector.state().asked, [Command::Edit(EditCommand::Add(NewObject::Point, None))]);
    }

    #[test]
    fn a_number_that_is_typed_is_one_step() {
        let mut inspector = panel(of(&[(1.0, 10.0)]), Coordinates::Cartesian);
        enter(&mut inspector, "y", "12.5");
        assert_eq!(places(&inspector), [[1.0, 12.5]]);
        assert_eq!(inspector.state().editor.history().depth(), 1);
    }

    #[test]
    fn a_number_that_is_only_looked_at_stays_as_it_was() {
        let mut inspector = panel(of(&[(1.0, 1.0 / 3.0)]), Coordinates::Cartesian);
        enter(&mut inspector, "y", "");
        assert_eq!((places(&inspector), inspector.state().asked.len()), (vec![[1.0, 1.0 / 3.0]], 0));
    }

    const THREE: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 12.0], [3.0, 12.0]];

    /// The panel with all three points selected.
    fn panel_of_three() -> Harness<'static, Held> {
        let inspector = panel(of(&THREE.map(|[x, y]| (x, y))), Coordinates::Cartesian);
        assert!(inspector.query_by_label("3 objects").is_some());
        inspector
    }

    #[test]
    fn what_is_typed_goes_to_every_selected_object() {
        let mut inspector = panel_of_three();
        enter(&mut inspector, "x", "2.5");
        assert_eq!(places(&inspector), [[2.5, 10.0], [2.5, 12.0], [2.5, 12.0]]);
        enter(&mut inspector, "reflectivity", "0.5");
        let editor = &mut inspector.state_mut().editor;
        assert!(editor.scene().objects.iter().all(|o| o.reflectivity() == 0.5));
        enter(&mut inspector, "cross section", "20");
        let editor = &mut inspector.state_mut().editor;
        assert!(editor.scene().objects.iter().all(|o| (o.reflectivity() - 10.0).abs() < 1e-12), "100 square metres");
    }

    #[test]
    fn numbers_that_differ_stay_as_they_were_when_looked_at() {
        let mut inspector = panel_of_three();
        enter(&mut inspector, "y", "");
        assert_eq!(places(&inspector), THREE);
    }

    #[test]
    fn undo_takes_back_what_was_typed_for_all() {
        let mut inspector = panel_of_three();
        enter(&mut inspector, "x", "2.5");
        assert!(inspector.state_mut().editor.undo());
        assert_eq!(places(&inspector), THREE);
    }

    #[test]
    fn a_drag_of_a_number_that_differs_moves_all_by_the_same() {
        let mut inspector = panel(of(&[(1.0, 10.0), (2.0, 12.0)]), Coordinates::Cartesian);
        let at = inspector.get_by_label("y").rect().center();
        inspector.drag_at(at);
        inspector.step();
        for step in 1..=4 {
            inspector.hover_at(at + egui::vec2(20.0 * step as f32, 0.0));
            inspector.step();
        }
        inspector.drop_at(at + egui::vec2(80.0, 0.0));
        inspector.run();
        let places = places(&inspector);
        assert!(places[0][1] > 10.5 && (places[1][1] - places[0][1] - 2.0).abs() < 1e-9, "{places:?}");
    }

    #[test]
    fn places_are_entered_as_range_and_direction() {
        let mut inspector = panel(of(&[(3.0, 4.0)]), Coordinates::Polar);
        enter(&mut inspector, "range", "10");
        assert_eq!(places(&inspector), [[6.0, 8.0]]);
        enter(&mut inspector, "cos θ", "-0.8");
        let [x, y] = places(&inspector)[0];
        assert!((x + 8.0).abs() < 1e-9 && (y - 6.0).abs() < 1e-9, "{x}, {y}");
        enter(&mut inspector, "angle", "0");
        let [x, y] = places(&inspector)[0];
        assert!(x == 0.0 && (y - 10.0).abs() < 1e-9, "{x}, {y}");
        inspector.get_by_label("x, y").click();
        inspector.step();
        assert_eq!(
            inspector.state().asked.last(),
            Some(&Command::Edit(EditCommand::SetCoordinates(Coordinates::Cartesian)))
        );
    }

    #[test]
    fn a_length_that_is_shown_rounded_keeps_all_its_digits() {
        let mut inspector = panel(of(&[(1.0, 3.041_35)]), Coordinates::Cartesian);
        inspector.run();
        assert!(crate::app::widgets::seen::texts(inspector.output()).iter().any(|t| t.text == "3.04 m"));
        enter(&mut inspector, "y", "");
        assert_eq!((places(&inspector), inspector.state().asked.len()), (vec![[1.0, 3.041_35]], 0));
    }

    #[test]
    fn a_cluster_is_called_a_cluster() {
        let cluster = crate::scene::GaussianCluster::new([0.0, 20.0], [1.0, 1.0], 40);
        let mut editor = Editor::new(Scene { objects: vec![Object::Gaussian(cluster)], ..Scene::default() });
        editor.select_all();
        let inspector = panel(editor, Coordinates::Cartesian);
        let _called = inspector.get_by_label("Cluster 1");
    }

    #[test]
    fn an_object_is_named_where_its_kind_stands() {
        let mut inspector = panel(of(&[(1.0, 10.0)]), Coordinates::Cartesian);
        enter(&mut inspector, "Point 1", "post");
        let editor = &inspector.state().editor;
        assert_eq!((editor.scene().objects[0].name(), editor.history().depth()), ("post", 1));
    }

    #[test]
    fn a_line_has_its_own_numbers() {
        let line = Object::Line(Line::vertical(1.0, 10.0, 0.5, 11));
        let mut editor = Editor::new(Scene { objects: vec![line], ..Scene::default() });
        editor.select([0], SelectionMode::Replace);
        let mut inspector = panel(editor, Coordinates::Cartesian);
        enter(&mut inspector, "count", "7");
        assert_eq!(inspector.state().editor.scene().objects[0].reflector_count(), 7);
    }

    #[test]
    fn a_wall_has_its_own_numbers() {
        let wall = Object::Wall(crate::scene::Wall::new(1.0, 10.0, 5.0, 0.0));
        let mut editor = Editor::new(Scene { objects: vec![wall], ..Scene::default() });
        editor.select([0], SelectionMode::Replace);
        let mut inspector = panel(editor, Coordinates::Cartesian);
        let _called = inspector.get_by_label("Wall 1");
        enter(&mut inspector, "length", "7");
        enter(&mut inspector, "angle of the length", "30");
        enter(&mut inspector, "roughness", "0.5");
        let Object::Wall(wall) = inspector.state().editor.scene().objects[0].clone() else { panic!() };
        assert_eq!((wall.length_metres, wall.angle_degrees, wall.roughness_millimetres), (7.0, 30.0, 0.5));
    }
}
