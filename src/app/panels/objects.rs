//! The objects panel: a list of the scene's objects, with place and reflectivity. A click selects an object.

use crate::app::content::Content;
use crate::app::state::{Command, EditCommand, State};
use crate::app::widgets::{axes, focus_after_click, list_keys};
use crate::interact::{Coordinates, Field, SelectionMode};
use crate::scene::Object;
use eframe::egui::style::ScrollAnimation;
use eframe::egui::{self, Align2, FontId, Modifiers, Rect, Response, ScrollArea, Sense, Stroke, Ui, pos2, vec2};

#[derive(Default)]
pub struct ObjectsMemory {
    /// The object that was selected last, at the last drawing.
    latest: Option<usize>,
    /// Whether a row was clicked, so that the list takes the keyboard focus.
    was_clicked: bool,
}

const ROW_HEIGHT: f32 = 20.0;

const ROWS_PER_PAGE: usize = 10;

pub const PANEL: Content<ObjectsMemory> = Content::drawn(|ui, cx| show(ui, cx.state, cx.memory));

pub fn show(ui: &mut Ui, state: &State, memory: &mut ObjectsMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    if state.editor.scene().objects.is_empty() {
        egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| ui.weak("The scene is empty."));
        return asked;
    }
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(6, 4)).show(ui, |ui| {
        let (area, id) = (ui.available_rect_before_wrap(), ui.scope_id().with("objects"));
        let list = ui.interact(area, id, Sense::focusable_noninteractive());
        list.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ListBox, true, "Objects"));
        focus_after_click(&list, &mut memory.was_clicked);
        if list.has_focus() {
            asked.extend(keys(&list, state));
        }
        heading(ui, state.settings.coordinates);
        rows(ui, state, memory, &mut asked);
    });
    asked
}

/// Handles the arrow keys: an arrow selects the next object, with Shift the objects between, too.
fn keys(list: &Response, state: &State) -> Option<Command> {
    let (now, count) = (state.editor.selection().latest(), state.editor.scene().objects.len());
    let modes = [(Modifiers::SHIFT, SelectionMode::Range), (Modifiers::NONE, SelectionMode::Replace)];
    let asked = modes.map(|(modifiers, mode)| {
        let to = list_keys(list, modifiers, now, count, ROWS_PER_PAGE)?;
        Some(Command::Edit(EditCommand::Select(vec![to], mode)))
    });
    asked.into_iter().flatten().last()
}

/// Right ends of the columns, as parts of the width.
const COLUMN_ENDS: [f32; 4] = [0.34, 0.56, 0.78, 1.0];

fn place_fields(coordinates: Coordinates) -> [(Field, &'static str); 2] {
    match coordinates {
        Coordinates::Cartesian => [(Field::X, "x, m"), (Field::Y, "y, m")],
        Coordinates::Polar => [(Field::Range, "range, m"), (Field::AngleDegrees, "angle, °")],
    }
}

fn heading(ui: &mut Ui, coordinates: Coordinates) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::hover());
    let ink = ui.visuals().weak_text_color();
    let [x, y] = place_fields(coordinates).map(|(_, name)| name);
    cells(ui, rect, ["object", x, y, "σ"].map(str::to_owned), ink);
    let stroke = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    ui.painter().hline(rect.x_range(), rect.bottom(), stroke);
}

fn cells(ui: &Ui, rect: Rect, texts: [String; 4], ink: egui::Color32) {
    for (column, text) in texts.into_iter().enumerate() {
        let (at, align) = match column {
            0 => (pos2(rect.left() + 6.0, rect.center().y), Align2::LEFT_CENTER),
            _ => (pos2(rect.left() + COLUMN_ENDS[column] * rect.width() - 8.0, rect.center().y), Align2::RIGHT_CENTER),
        };
        ui.painter().text(at, align, text, FontId::proportional(12.5), ink);
    }
}

fn rows(ui: &mut Ui, state: &State, memory: &mut ObjectsMemory, asked: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let latest = state.editor.selection().latest();
    // An object that was selected elsewhere is scrolled into sight.
    let sought = latest.filter(|_| latest != memory.latest);
    memory.latest = latest;
    let area = ScrollArea::vertical().auto_shrink([false, false]);
    area.show_rows(ui, ROW_HEIGHT, state.editor.scene().objects.len(), |ui, range| {
        if let Some(row) = sought {
            let first = ui.cursor().left_top();
            let at = first + vec2(0.0, (row as f32 - range.start as f32) * ROW_HEIGHT);
            ui.scroll_to_rect_animation(Rect::from_min_size(at, vec2(1.0, ROW_HEIGHT)), None, ScrollAnimation::none());
        }
        for index in range {
            let Some(object) = state.editor.scene().objects.get(index) else { break };
            if let Some(mode) = row(ui, state, index, object) {
                memory.was_clicked = true;
                asked.push(EditCommand::Select(vec![index], mode).into());
            }
        }
    });
}

/// Draws a row. Returns the mode of selection, if it was clicked.
fn row(ui: &mut Ui, state: &State, index: usize, object: &Object) -> Option<SelectionMode> {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::CLICK);
    let selected = state.editor.selection().contains(index);
    let name = object.called(index);
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::ListBoxOption, true, selected, format!("{name} in the list"))
    });
    let visuals = ui.visuals();
    let hovered = response.hovered().then_some(visuals.widgets.hovered.weak_bg_fill);
    if let Some(colour) = selected.then_some(visuals.selection.bg_fill).or(hovered) {
        ui.painter().rect_filled(rect, 2.0, colour);
    }
    let place = |(field, _): (Field, &str)| {
        let digits = if field == Field::AngleDegrees { 0.1 } else { 0.01 };
        field.get(object).map(|v| axes::tick_text(v, digits)).unwrap_or_default()
    };
    let [x, y] = place_fields(state.settings.coordinates).map(place);
    let many = match object.reflector_count() {
        0 | 1 => name,
        n => format!("{name} (×{n})"),
    };
    cells(ui, rect, [many, x, y, format!("{:.2}", object.reflectivity())], visuals.text_color());
    response.clicked().then(|| ui.input(|i| mode_of(i.modifiers)))
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
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::interact::Selection;
    use crate::radar::Radar;
    use crate::scene::Scene;
    use eframe::egui::Key;

    type Held = (State, ObjectsMemory);

    fn panel(points: usize) -> Harness<'static, Held> {
        let draw = |ui: &mut Ui, (state, memory): &mut Held| {
            for command in show(ui, state, memory) {
                let Command::Edit(EditCommand::Select(objects, mode)) = command else { panic!("{command:?}") };
                state.editor.select(objects, mode);
            }
        };
        let state = State::of(Radar::default(), Scene::of_points((0..points).map(|i| (i as f64, 5.0))));
        let mut list =
            Harness::builder().with_size([300.0, 200.0]).build_ui_state(draw, (state, ObjectsMemory::default()));
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
        assert_eq!(*list.state().0.editor.selection(), Selection::of([1]));
        click(&mut list, "point 4 in the list", Modifiers::COMMAND);
        assert_eq!(*list.state().0.editor.selection(), Selection::of([1, 3]));
        click(&mut list, "point 6 in the list", Modifiers::SHIFT);
        assert_eq!(*list.state().0.editor.selection(), Selection::of([3, 4, 5]));
        click(&mut list, "point 1 in the list", Modifiers::NONE);
        assert_eq!(*list.state().0.editor.selection(), Selection::of([0]));
    }

    #[test]
    fn arrow_keys_move_the_selection() {
        let mut list = panel(6);
        click(&mut list, "point 2 in the list", Modifiers::NONE);
        list.presses(&[Key::ArrowDown]);
        list.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        list.run();
        assert_eq!(*list.state().0.editor.selection(), Selection::of([2, 3]));
        list.presses(&[Key::ArrowUp]);
        assert_eq!(*list.state().0.editor.selection(), Selection::of([2]));
    }

    #[test]
    fn the_list_scrolls_to_the_selection() {
        let mut list = panel(1000);
        assert!(list.query_by_label("point 700 in the list").is_none(), "only rows in sight are drawn");
        list.state_mut().0.editor.select([699], SelectionMode::Replace);
        list.run();
        let _in_sight = list.get_by_label("point 700 in the list");
    }
}
