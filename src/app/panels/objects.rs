//! The list of the scene's objects: what each is, where it stands, how strongly it reflects; a click selects it.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::state::{Command, EditCommand};
use crate::app::widgets::axes;
use crate::app::widgets::list_rows::focus_after_click;
use crate::app::widgets::padded::padded;
use crate::interact::{Coordinates, Field, Selection, SelectionMode};
use crate::scene::{Object, Scene};
use eframe::egui;
use eframe::egui::{Align, EventFilter, Key, Label, Layout, Modifiers, Response, RichText, Sense, Ui};
use egui_extras::{Column as TableColumn, TableBuilder, TableRow};

/// What is listed.
pub struct Input<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What of it is selected.
    pub selection: &'a Selection,
    /// In which numbers places are told.
    pub coordinates: Coordinates,
}

/// What the list remembers from frame to frame.
#[derive(Default)]
pub struct ObjectsMemory {
    /// The object that was picked last, when it was last drawn.
    latest: Option<usize>,
    /// Whether a row was clicked, so that the list is to have the keys.
    was_clicked: bool,
}

const ROW_HEIGHT: f32 = 20.0;

/// Draws [`Panel::Objects`](crate::app::state::Panel::Objects).
pub struct ObjectsPanel;

impl Content for ObjectsPanel {
    type Asks = Nothing;
    type Remembers = ObjectsMemory;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (editor, coordinates) = (&cx.state.editor, cx.state.settings.coordinates);
        let input = Input { scene: editor.scene(), selection: editor.selection(), coordinates };
        show(ui, input, cx.memory)
    }
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut ObjectsMemory) -> Vec<Command> {
    padded(ui, |ui, asked| {
        if input.scene.objects.is_empty() {
            ui.weak("The scene is empty.");
            return;
        }
        let (area, id) = (ui.available_rect_before_wrap(), ui.scope_id().with("objects"));
        let list = ui.interact(area, id, Sense::focusable_noninteractive());
        list.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ListBox, true, "Objects"));
        focus_after_click(&list, &mut memory.was_clicked);
        if list.has_focus() {
            asked.extend(keys(ui, &list, &input));
        }
        rows(ui, &input, memory, asked);
    })
}

/// Arrow keys walk along the list, with shift they take along what lies between.
fn keys(ui: &Ui, list: &Response, input: &Input<'_>) -> Option<Command> {
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|m| m.set_focus_lock_filter(list.id, filter));
    let last = input.scene.objects.len() - 1;
    ui.input_mut(|i| {
        let mut asked = None;
        for (modifiers, mode) in [(Modifiers::SHIFT, SelectionMode::Range), (Modifiers::NONE, SelectionMode::Replace)] {
            let mut steps = |key| i.count_and_consume_key(modifiers, key);
            let (down, up) = (steps(Key::ArrowDown), steps(Key::ArrowUp));
            if down == up {
                continue;
            }
            let to = match input.selection.latest() {
                Some(from) => (from + down).saturating_sub(up).min(last),
                None if down > up => 0,
                None => last,
            };
            asked = Some(Command::Edit(EditCommand::Select(vec![to], mode)));
        }
        asked
    })
}

/// Part of the width that a number has.
const NUMBER: f32 = 0.21;

fn place_fields(coordinates: Coordinates) -> [(Field, &'static str); 2] {
    match coordinates {
        Coordinates::Cartesian => [(Field::X, "x, m"), (Field::Y, "y, m")],
        Coordinates::Polar => [(Field::Range, "range, m"), (Field::AngleDegrees, "angle, °")],
    }
}

/// The cells of a row: the first from the left, numbers from the right.
fn cells(row: &mut TableRow<'_, '_>, [name, numbers @ ..]: [RichText; 4]) {
    row.col(|ui| _ = ui.add(Label::new(name).selectable(false)));
    for number in numbers {
        row.col(|ui| {
            let layout = Layout::right_to_left(Align::Center);
            ui.with_layout(layout, |ui| ui.add(Label::new(number).selectable(false)));
        });
    }
}

fn rows(ui: &mut Ui, input: &Input<'_>, memory: &mut ObjectsMemory, asked: &mut Vec<Command>) {
    let latest = input.selection.latest();
    let number = TableColumn::exact(NUMBER * ui.available_width()).clip(true);
    let mut table = TableBuilder::new(ui).column(TableColumn::remainder().clip(true)).columns(number, 3);
    table = table.sense(Sense::CLICK).auto_shrink(false).animate_scrolling(false).min_scrolled_height(0.0);
    // What was selected elsewhere comes into sight, where it isn't.
    if let Some(row) = latest.filter(|_| latest != memory.latest) {
        table = table.scroll_to_row(row, None);
    }
    memory.latest = latest;
    let [x, y] = place_fields(input.coordinates).map(|(_, name)| name);
    let table =
        table.header(ROW_HEIGHT, |mut row| cells(&mut row, ["object", x, y, "σ"].map(|t| RichText::new(t).weak())));
    table.body(|body| {
        body.rows(ROW_HEIGHT, input.scene.objects.len(), |mut drawn| {
            let index = drawn.index();
            let Some(object) = input.scene.objects.get(index) else { return };
            if let Some(mode) = row(&mut drawn, input, index, object) {
                memory.was_clicked = true;
                asked.push(EditCommand::Select(vec![index], mode).into());
            }
        });
    });
}

/// Draws a row; how its object is to be selected, if it was clicked.
fn row(drawn: &mut TableRow<'_, '_>, input: &Input<'_>, index: usize, object: &Object) -> Option<SelectionMode> {
    let is_selected = input.selection.contains(index);
    drawn.set_selected(is_selected);
    let name = object.called(index);
    let place = |(field, _): (Field, &str)| {
        let digits = if field == Field::AngleDegrees { 0.1 } else { 0.01 };
        field.get(object).map(|v| axes::tick_text(v, digits)).unwrap_or_default()
    };
    let [x, y] = place_fields(input.coordinates).map(place);
    let many = match object.reflector_count() {
        0 | 1 => name.clone(),
        n => format!("{name} (×{n})"),
    };
    cells(drawn, [many, x, y, format!("{:.2}", object.reflectivity())].map(RichText::new));
    let response = drawn.response();
    let told = format!("{name} in the list");
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::ListBoxOption, true, is_selected, &told));
    response.clicked().then(|| response.ctx.input(|i| mode_of(i.modifiers)))
}

fn mode_of(modifiers: Modifiers) -> SelectionMode {
    match (modifiers.shift, modifiers.command) {
        (true, _) => SelectionMode::Range,
        (_, true) => SelectionMode::Toggle,
        _ => SelectionMode::Replace,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    struct Held {
        scene: Scene,
        selection: Selection,
        memory: ObjectsMemory,
    }

    fn panel(points: usize) -> Harness<'static, Held> {
        let draw = |ui: &mut Ui, held: &mut Held| {
            let input = Input { scene: &held.scene, selection: &held.selection, coordinates: Coordinates::Cartesian };
            for command in show(ui, input, &mut held.memory) {
                let Command::Edit(EditCommand::Select(objects, mode)) = command else { panic!("{command:?}") };
                held.selection.pick(objects, mode);
            }
        };
        let scene = Scene::of_points((0..points).map(|i| (i as f64, 5.0)));
        let held = Held { scene, selection: Selection::default(), memory: ObjectsMemory::default() };
        let mut list = Harness::builder().with_size([300.0, 200.0]).build_ui_state(draw, held);
        list.step();
        list
    }

    fn click(list: &mut Harness<'static, Held>, name: &str, modifiers: Modifiers) {
        list.get_by_label(name).click_modifiers(modifiers);
        list.run();
    }

    #[test]
    fn clicks_select_one_several_and_a_range() {
        let mut list = panel(6);
        click(&mut list, "point 2 in the list", Modifiers::NONE);
        assert_eq!(list.state().selection, Selection::of([1]));
        click(&mut list, "point 4 in the list", Modifiers::COMMAND);
        assert_eq!(list.state().selection, Selection::of([1, 3]));
        click(&mut list, "point 6 in the list", Modifiers::SHIFT);
        assert_eq!(list.state().selection, Selection::of([3, 4, 5]));
        click(&mut list, "point 1 in the list", Modifiers::NONE);
        assert_eq!(list.state().selection, Selection::of([0]));
    }

    #[test]
    fn arrow_keys_move_the_selection() {
        let mut list = panel(6);
        click(&mut list, "point 2 in the list", Modifiers::NONE);
        list.key_press(Key::ArrowDown);
        list.run();
        list.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        list.run();
        assert_eq!(list.state().selection, Selection::of([2, 3]));
        list.key_press(Key::ArrowUp);
        list.run();
        assert_eq!(list.state().selection, Selection::of([2]));
    }

    #[test]
    fn the_list_scrolls_to_the_selection() {
        let mut list = panel(1000);
        assert!(list.query_by_label("point 700 in the list").is_none(), "only rows in sight are drawn");
        list.state_mut().selection.pick([699], SelectionMode::Replace);
        list.run();
        let _in_sight = list.get_by_label("point 700 in the list");
    }
}
