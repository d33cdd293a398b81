//! The inspector panel: the numbers of a selected object with their units, or those that several selected objects share.

mod number;

use crate::app::content::Content;
use crate::app::state::{Command, EditCommand, NewObject, State};
use crate::app::widgets::{angle_of_place_degrees, button, choices, press, scrolled, signed};
use crate::interact::Coordinates;
use crate::radar::{Radar, capitalised, counted};
use crate::scene::{MAX_NAME_CHARACTERS, Object, Scene};
use eframe::egui::{self, Grid, TextEdit, Ui};
use number::number;

pub const PANEL: Content = Content { tells_answers: true, ..Content::drawn(|ui, cx| show(ui, cx.state)) };

pub fn show(ui: &mut Ui, state: &State) -> Vec<Command> {
    scrolled(ui, |ui, asked| match state.editor.selection().is_empty() {
        true => nothing(ui, state.editor.scene(), asked),
        false => selected(ui, state, asked),
    })
}

fn nothing(ui: &mut Ui, scene: &Scene, asked: &mut Vec<Command>) {
    if !scene.name.is_empty() {
        ui.strong(&scene.name);
    }
    if !scene.notes.is_empty() {
        ui.label(&scene.notes);
    }
    if scene.objects.is_empty() {
        ui.weak("The scene is empty.");
        press(ui, "Add a point", "", EditCommand::Add(NewObject::Point, None), asked);
    } else {
        ui.add_space(4.0);
        ui.weak("Click an object to see and edit its numbers; drag a box around several.");
    }
}

fn selected(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    let (editor, coordinates) = (&state.editor, state.settings.coordinates);
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
                let change = number(ui, &shared, state.scene_view.metres_per_point);
                asked.extend(change.map(|change| Command::Edit(EditCommand::SetField(shared.field, change))));
            }
        });
    });
    if let Some(object) = object {
        seen(ui, state.radar(), object.centre_metres(), coordinates);
    }
    ui.horizontal(|ui| {
        button(ui, "Duplicate", EditCommand::Duplicate, true, asked);
        button(ui, "Delete", EditCommand::Delete, true, asked);
    });
}

fn title(ui: &mut Ui, object: &Object, index: usize, asked: &mut Vec<Command>) {
    let (mut name, kind) = (object.name().to_owned(), format!("{} {}", capitalised(object.noun()), index + 1));
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
        let of = [
            (Coordinates::Polar, "R, angle", "Enter places as range and direction"),
            (Coordinates::Cartesian, "x, y", "Enter places as x and y"),
        ];
        choices(ui, shown, of, EditCommand::SetCoordinates, asked);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::interact::Editor;
    use crate::scene::Line;
    use eframe::egui::{Event, Key};

    type Held = (State, Vec<Command>);

    /// The panel, with an editor that executes its commands.
    fn panel(editor: Editor, coordinates: Coordinates) -> Harness<'static, Held> {
        let draw = |ui: &mut Ui, (state, asked): &mut Held| {
            for command in show(ui, state) {
                match &command {
                    Command::Edit(EditCommand::SetField(field, change)) => {
                        state.editor.set_field(*field, *change).unwrap()
                    }
                    Command::Edit(EditCommand::Name(name)) => state.editor.name_selected(name),
                    _ => {}
                }
                asked.push(command);
            }
        };
        let mut state = State { editor, ..State::new(Vec::new()) };
        state.settings.coordinates = coordinates;
        state.scene_view.metres_per_point = 0.05;
        Harness::new_ui_state(draw, (state, Vec::new()))
    }

    fn panel_of(object: Object) -> Harness<'static, Held> {
        let mut editor = Editor::new(Scene { objects: vec![object], ..Scene::default() });
        editor.select_all();
        panel(editor, Coordinates::Cartesian)
    }

    fn of(points: &[[f64; 2]]) -> Editor {
        let mut editor = Editor::new(Scene::of_points(points.iter().map(|[x, y]| (*x, *y))));
        editor.select_all();
        editor
    }

    fn enter(inspector: &mut Harness<'static, Held>, name: &str, text: &str) {
        inspector.clicks(&[name]);
        for letter in text.chars() {
            inspector.event(Event::Text(letter.to_string()));
            inspector.step();
        }
        inspector.presses(&[Key::Enter]);
    }

    fn places(inspector: &Harness<'static, Held>) -> Vec<[f64; 2]> {
        inspector.state().0.editor.scene().objects.iter().map(Object::anchor_metres).collect()
    }

    #[test]
    fn an_empty_scene_offers_a_point() {
        let mut inspector = panel(Editor::new(Scene::default()), Coordinates::Cartesian);
        inspector.clicks(&["Add a point"]);
        assert_eq!(inspector.state().1, [Command::Edit(EditCommand::Add(NewObject::Point, None))]);
    }

    const THREE: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 12.0], [3.0, 12.0]];

    fn panel_of_three() -> Harness<'static, Held> {
        let inspector = panel(of(&THREE), Coordinates::Cartesian);
        assert!(inspector.query_by_label("3 objects").is_some());
        inspector
    }

    #[test]
    fn what_is_typed_goes_to_every_selected_object() {
        let mut inspector = panel_of_three();
        enter(&mut inspector, "x", "2.5");
        assert_eq!(places(&inspector), [[2.5, 10.0], [2.5, 12.0], [2.5, 12.0]]);
        assert!(inspector.state_mut().0.editor.undo());
        assert_eq!(places(&inspector), THREE, "one step back");
        enter(&mut inspector, "reflectivity", "0.5");
        let editor = &mut inspector.state_mut().0.editor;
        assert!(editor.scene().objects.iter().all(|o| o.reflectivity() == 0.5));
        enter(&mut inspector, "cross section", "20");
        let editor = &mut inspector.state_mut().0.editor;
        assert!(editor.scene().objects.iter().all(|o| (o.reflectivity() - 10.0).abs() < 1e-12), "100 square metres");
    }

    #[test]
    fn a_drag_of_a_number_that_differs_moves_all_by_the_same() {
        let mut inspector = panel(of(&[[1.0, 10.0], [2.0, 12.0]]), Coordinates::Cartesian);
        let at = inspector.get_by_label("y").rect().center();
        inspector.drags(&[0.0, 20.0, 40.0, 60.0, 80.0].map(|x| at + egui::vec2(x, 0.0)));
        let places = places(&inspector);
        assert!(places[0][1] > 10.5 && (places[1][1] - places[0][1] - 2.0).abs() < 1e-9, "{places:?}");
    }

    #[test]
    fn places_are_entered_as_range_and_direction() {
        let mut inspector = panel(of(&[[3.0, 4.0]]), Coordinates::Polar);
        enter(&mut inspector, "range", "10");
        assert_eq!(places(&inspector), [[6.0, 8.0]]);
        enter(&mut inspector, "cos θ", "-0.8");
        let [x, y] = places(&inspector)[0];
        assert!((x + 8.0).abs() < 1e-9 && (y - 6.0).abs() < 1e-9, "{x}, {y}");
        enter(&mut inspector, "angle", "0");
        let [x, y] = places(&inspector)[0];
        assert!(x == 0.0 && (y - 10.0).abs() < 1e-9, "{x}, {y}");
        inspector.clicks(&["x, y"]);
        let asked = Command::Edit(EditCommand::SetCoordinates(Coordinates::Cartesian));
        assert_eq!(inspector.state().1.last(), Some(&asked));
    }

    #[test]
    fn an_object_is_named_where_its_kind_stands() {
        let mut inspector = panel(of(&[[1.0, 10.0]]), Coordinates::Cartesian);
        enter(&mut inspector, "Point 1", "post");
        let editor = &inspector.state().0.editor;
        assert_eq!((editor.scene().objects[0].name(), editor.history().depth()), ("post", 1));
    }

    #[test]
    fn numbers_that_are_only_looked_at_stay_as_they_were() {
        for (points, shown) in [(&[[1.0, 3.041_35]][..], Some("3.04 m")), (&[[1.0, 1.0 / 3.0]], None), (&THREE, None)] {
            let mut inspector = panel(of(points), Coordinates::Cartesian);
            inspector.run();
            assert!(shown.is_none_or(|text| inspector.reads(text)), "{shown:?}");
            enter(&mut inspector, "y", "");
            assert_eq!((places(&inspector), inspector.state().1.len()), (points.to_vec(), 0));
        }
    }

    #[test]
    fn every_kind_of_object_has_its_name_and_numbers() {
        let cluster = crate::scene::GaussianCluster::new([0.0, 20.0], [1.0, 1.0], 40);
        let inspector = panel_of(Object::Gaussian(cluster));
        let _called = inspector.get_by_label("Cluster 1");
        let mut inspector = panel_of(Object::Line(Line::vertical(1.0, 10.0, 0.5, 11)));
        enter(&mut inspector, "count", "7");
        assert_eq!(inspector.state().0.editor.scene().objects[0].reflector_count(), 7);
        let mut inspector = panel_of(Object::Wall(crate::scene::Wall::new(1.0, 10.0, 5.0, 0.0)));
        let _called = inspector.get_by_label("Wall 1");
        for (name, text) in [("length", "7"), ("angle of the length", "30"), ("roughness", "0.5")] {
            enter(&mut inspector, name, text);
        }
        let Object::Wall(wall) = inspector.state().0.editor.scene().objects[0].clone() else { panic!() };
        assert_eq!((wall.length_metres, wall.angle_degrees, wall.roughness_millimetres), (7.0, 30.0, 0.5));
    }
}
