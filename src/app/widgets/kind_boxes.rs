//! Kinds of random scenes to choose from, in a menu that stays open while boxes are ticked.

use crate::scene::generate::Kind;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, Grid, Label, PopupCloseBehavior, Response, RichText, Ui, vec2};
use std::collections::BTreeSet;

/// Width of a kind's description, points.
const SENTENCE_WIDTH: f32 = 420.0;
/// Least width of a button with a ticking menu, points.
const TITLE_WIDTH: f32 = 160.0;

fn name(kind: &Kind) -> String {
    if kind.test_set().is_some() { format!("set {kind}") } else { kind.to_string() }
}

/// A button with a menu that stays open at clicks into it; returns the button's response.
pub fn ticking_menu(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) -> Response {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    // A tall menu opens beside its button. A button of constant width keeps it in place while the title grows.
    let button = Button::new(title).min_size(vec2(TITLE_WIDTH.min(0.2 * ui.available_width()), 0.0));
    MenuButton::from_button(button).config(config).ui(ui, contents).0
}

/// A box that is ticked while `value` is in `chosen`.
pub fn member_box<T: Ord>(ui: &mut Ui, name: impl Into<String>, value: T, chosen: &mut BTreeSet<T>) -> Response {
    let mut ticked = chosen.contains(&value);
    let response = ui.checkbox(&mut ticked, name.into());
    if response.changed() {
        match ticked {
            true => chosen.insert(value),
            false => chosen.remove(&value),
        };
    }
    response
}

/// A box for each of `kinds` with its description; `chosen` has the ticked ones.
pub fn kind_boxes(ui: &mut Ui, kinds: impl IntoIterator<Item = Kind>, chosen: &mut Vec<Kind>) {
    let room = SENTENCE_WIDTH.min((ui.ctx().content_rect().width() - 220.0).max(120.0));
    let mut ticked: BTreeSet<Kind> = chosen.iter().copied().collect();
    Grid::new("kinds").num_columns(2).spacing([10.0, 3.0]).show(ui, |ui| {
        for kind in kinds {
            member_box(ui, name(&kind), kind, &mut ticked);
            ui.scope(|ui| {
                ui.set_width(room);
                ui.add(Label::new(RichText::new(kind.description()).weak().small()).wrap().selectable(false));
            });
            ui.end_row();
        }
    });
    *chosen = ticked.into_iter().collect();
}

/// The names of `chosen` kinds and of the set `beside` them, or their number where there are more than four.
pub fn kind_names(chosen: &[Kind], beside: Option<&str>) -> String {
    // A number alone could be read as a count.
    let of = |kind: &Kind| if chosen.len() == 1 { name(kind) } else { kind.to_string() };
    let names: Vec<String> = chosen.iter().map(of).chain(beside.map(str::to_owned)).collect();
    if names.len() > 4 { format!("{} kinds", names.len()) } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::User;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_menu_with_ticks_stays_open_and_each_kind_has_its_sentence() {
        let draw = |ui: &mut Ui, chosen: &mut Vec<Kind>| {
            ticking_menu(ui, "Scenes", |ui| kind_boxes(ui, Kind::all(), chosen));
        };
        let mut menu = Harness::builder().with_size([800.0, 900.0]).build_ui_state(draw, Vec::new());
        menu.clicks(&["Scenes"]);
        for kind in ["walls", "clusters"] {
            menu.clicks(&[kind]);
        }
        assert_eq!(menu.state().len(), 2, "two boxes were ticked in one opening");
        for kind in Kind::all() {
            assert!(menu.query_all_by_label(kind.description()).next().is_some(), "{kind}");
        }
    }
}
