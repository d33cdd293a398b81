//! Numbers of what is selected, with units.

use crate::app::state::{Command, NewObject};
use crate::app::widgets::entry::button;
use crate::interact::Editor;
use crate::radar::Radar;
use crate::scene::{Object, Scene};
use eframe::egui;
use eframe::egui::{DragValue, Grid, ScrollArea, Ui};

/// What the numbers are turned into.
pub struct Input<'a> {
    /// The radar.
    pub radar: &'a Radar,
}

/// Draws the panel; numbers that are edited go straight to the editor, each as a step that can be undone.
pub fn show(ui: &mut Ui, input: Input<'_>, editor: &mut Editor) -> Vec<Command> {
    let mut asked = Vec::new();
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| match editor.selection().len() {
            0 => nothing(ui, editor.scene(), &mut asked),
            1 => single(ui, input.radar, editor, &mut asked),
            count => many(ui, editor, count, &mut asked),
        });
    });
    asked
}

fn nothing(ui: &mut Ui, scene: &Scene, asked: &mut Vec<Command>) {
    if scene.objects.is_empty() {
        ui.weak("The scene is empty.");
        if ui.button("Add a point").clicked() {
            asked.push(Command::Add(NewObject::Point, None));
        }
        return;
    }
    if !scene.name.is_empty() {
        ui.strong(&scene.name);
    }
    if !scene.notes.is_empty() {
        ui.label(&scene.notes);
    }
    ui.add_space(4.0);
    ui.weak("Click an object to see and edit its numbers; drag a box around several.");
}

fn many(ui: &mut Ui, editor: &Editor, count: usize, asked: &mut Vec<Command>) {
    ui.strong(format!("{count} objects selected"));
    let selected = editor.selection().iter().filter_map(|i| editor.scene().objects.get(i));
    let reflectors: usize = selected.map(Object::reflector_count).sum();
    ui.label(format!("{reflectors} reflectors"));
    buttons(ui, asked);
}

fn buttons(ui: &mut Ui, asked: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        button(ui, "Duplicate", Command::Duplicate, true, asked);
        button(ui, "Delete", Command::Delete, true, asked);
    });
}

/// How a number is shown and edited.
struct Field {
    name: &'static str,
    tooltip: &'static str,
    unit: &'static str,
    speed: f64,
    low: f64,
    high: f64,
    digits: usize,
}

const fn metres(name: &'static str, tooltip: &'static str) -> Field {
    Field { name, tooltip, unit: " m", speed: 0.02, low: -1e4, high: 1e4, digits: 3 }
}

const REFLECTIVITY: Field = Field {
    name: "reflectivity",
    tooltip: "σ of each reflector; the thesis uses 1",
    unit: "",
    speed: 0.01,
    low: -1e6,
    high: 1e6,
    digits: 3,
};

const DIRECTION: Field = Field {
    name: "direction",
    tooltip: "Where the line leads from its first reflector: 0° along the array, 90° straight ahead",
    unit: "°",
    speed: 0.5,
    low: -360.0,
    high: 360.0,
    digits: 2,
};

fn number(ui: &mut Ui, field: &Field, value: &mut f64) {
    let label = ui.label(field.name).on_hover_text(field.tooltip);
    let drag = DragValue::new(value)
        .range(field.low..=field.high)
        .clamp_existing_to_range(false)
        .speed(field.speed)
        .max_decimals(6)
        .min_decimals(field.digits)
        .suffix(field.unit);
    ui.add(drag).labelled_by(label.id).on_hover_text(field.tooltip);
    ui.end_row();
}

fn count(ui: &mut Ui, value: &mut usize) {
    let label = ui.label("count").on_hover_text("Number of reflectors");
    ui.add(DragValue::new(value).range(1..=10_000).speed(0.2)).labelled_by(label.id);
    ui.end_row();
}

fn single(ui: &mut Ui, radar: &Radar, editor: &mut Editor, asked: &mut Vec<Command>) {
    let Some(index) = editor.selection().single() else { return };
    let Some(object) = editor.scene().objects.get(index) else { return };
    let mut edited = object.clone();
    ui.strong(format!("{} {}", capital(object.kind()), index + 1));
    Grid::new("object").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| fields(ui, &mut edited));
    let [x, y] = edited.centre_metres();
    let polar = radar.polar_of(x, y);
    let seen = radar.blob_of(0.0, x, y);
    let (bin, column) = (radar.bin_of_range(polar.range_metres), radar.column_of_cos(seen.cos_theta));
    ui.weak(format!(
        "range {:.3} m · cos θ {:.4} · bin {bin:.1} · column {column:.1}",
        polar.range_metres, polar.cos_theta
    ));
    if polar.range_metres > radar.max_range_metres() {
        ui.colored_label(ui.visuals().warn_fg_color, "Beyond the maximum range: it wraps around in the maps.");
    } else if y < 0.0 {
        ui.colored_label(ui.visuals().warn_fg_color, "Behind the array: it appears mirrored in front of it.");
    }
    if edited != editor.scene().objects[index] {
        let key = format!("inspector {index}");
        editor.edit("edit numbers", Some(&key), |scene: &mut Scene, _| scene.objects[index] = edited);
    }
    buttons(ui, asked);
}

fn fields(ui: &mut Ui, object: &mut Object) {
    match object {
        Object::Point(p) => {
            number(ui, &metres("x", "Along the array"), &mut p.x_metres);
            number(ui, &metres("y", "Ahead of the array"), &mut p.y_metres);
            number(ui, &REFLECTIVITY, &mut p.reflectivity);
        }
        Object::Line(l) => {
            number(ui, &metres("x of the first", "Along the array"), &mut l.x_metres);
            number(ui, &metres("y of the first", "Ahead of the array"), &mut l.y_start_metres);
            let spacing =
                Field { speed: 0.001, low: 1e-3, high: 100.0, digits: 4, ..metres("spacing", "Between neighbours") };
            number(ui, &spacing, &mut l.spacing_metres);
            number(ui, &DIRECTION, &mut l.direction_degrees);
            count(ui, &mut l.count);
            number(ui, &REFLECTIVITY, &mut l.reflectivity);
        }
        Object::Gaussian(g) => {
            number(ui, &metres("x", "Of its centre, along the array"), &mut g.x_metres);
            number(ui, &metres("y", "Of its centre, ahead of the array"), &mut g.y_metres);
            let spread = |name| Field { low: 0.0, ..metres(name, "Standard deviation") };
            number(ui, &spread("spread in x"), &mut g.x_std_metres);
            number(ui, &spread("spread in y"), &mut g.y_std_metres);
            count(ui, &mut g.count);
            let label = ui.label("seed").on_hover_text("Another seed scatters the reflectors otherwise");
            ui.add(DragValue::new(&mut g.seed).speed(0.05)).labelled_by(label.id);
            ui.end_row();
            number(ui, &REFLECTIVITY, &mut g.reflectivity);
        }
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
    use eframe::egui::{Event, Key};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(editor: Editor) -> Harness<'static, (Editor, Vec<Command>)> {
        let draw = |ui: &mut Ui, state: &mut (Editor, Vec<Command>)| {
            let commands = show(ui, Input { radar: &Radar::default() }, &mut state.0);
            state.1.extend(commands);
        };
        Harness::new_ui_state(draw, (editor, Vec::new()))
    }

    #[test]
    fn an_empty_scene_offers_a_point() {
        let mut inspector = panel(Editor::new(Scene::default()));
        inspector.get_by_label("Add a point").click();
        inspector.step();
        assert_eq!(inspector.state().1, [Command::Add(NewObject::Point, None)]);
    }

    #[test]
    fn a_number_that_is_typed_is_one_step() {
        let mut editor = Editor::new(Scene::of_points([(1.0, 10.0)]));
        editor.select([0], SelectionMode::Replace);
        let mut inspector = panel(editor);
        inspector.get_by_label("y").click();
        inspector.run();
        inspector.event(Event::Text("12.5".to_owned()));
        inspector.key_press(Key::Enter);
        inspector.run();
        let (editor, asked) = inspector.state();
        assert_eq!(editor.scene().objects[0].centre_metres(), [1.0, 12.5]);
        assert_eq!((editor.history().depth(), asked.len()), (1, 0));
    }
}
