//! Lists of methods, each with a line that says what it is: one to choose, or several.

use crate::reconstruct::Reconstructor;
use eframe::egui::{Grid, Label, RichText, Sense, Ui};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Height of a popup that lists methods, points.
pub const LIST_HEIGHT: f32 = 420.0;

/// Width of what is said of each, points: most are one line.
const DESCRIPTION_WIDTH: f32 = 440.0;

/// More methods than this are counted, not named.
const MOST_NAMED: usize = 2;

/// Draws the menu, which is called by the methods of `chosen`.
pub fn method_menu(ui: &mut Ui, methods: &[Arc<dyn Reconstructor>], chosen: &mut BTreeSet<&'static str>, tip: &str) {
    let title = match chosen.len() {
        count if count > MOST_NAMED => format!("{count} methods"),
        _ => chosen.iter().copied().collect::<Vec<_>>().join(", "),
    };
    let menu = ui.menu_button(format!("Methods: {title}"), |ui| {
        method_lines(ui, methods, |ui, method| {
            let mut is_chosen = chosen.contains(method.name());
            if ui.checkbox(&mut is_chosen, method.name()).changed() {
                match is_chosen {
                    true => chosen.insert(method.name()),
                    false => chosen.remove(method.name()),
                };
            }
        });
    });
    menu.response.on_hover_text(tip);
}

/// The contents of a popup in which one of `methods` is chosen; its name where one was clicked.
pub fn method_list(ui: &mut Ui, methods: &[Arc<dyn Reconstructor>], chosen: &str) -> Option<&'static str> {
    let mut clicked = None;
    let described = method_lines(ui, methods, |ui, method| {
        if ui.selectable_label(method.name() == chosen, method.name()).clicked() {
            clicked = Some(method.name());
        }
    });
    let clicked = clicked.or(described);
    if clicked.is_some() {
        ui.close();
    }
    clicked
}

/// A row for each method: what `name` draws of it, and what it is. The method whose description was clicked.
pub fn method_lines(
    ui: &mut Ui,
    methods: &[Arc<dyn Reconstructor>],
    mut name: impl FnMut(&mut Ui, &dyn Reconstructor),
) -> Option<&'static str> {
    let mut clicked = None;
    let room = DESCRIPTION_WIDTH.min((ui.ctx().content_rect().width() - 180.0).max(120.0));
    Grid::new("methods").num_columns(2).spacing([10.0, 3.0]).show(ui, |ui| {
        for method in methods {
            name(ui, method.as_ref());
            ui.scope(|ui| {
                ui.set_width(room);
                let text = RichText::new(method.description()).weak().small();
                if ui.add(Label::new(text).wrap().selectable(false).sense(Sense::click())).clicked() {
                    clicked = Some(method.name());
                }
            });
            ui.end_row();
        }
    });
    clicked
}
