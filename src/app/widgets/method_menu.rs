//! A menu in which several methods are chosen.

use crate::reconstruct::Reconstructor;
use eframe::egui::Ui;
use std::collections::BTreeSet;
use std::sync::Arc;

/// More methods than this are counted, not named.
const MOST_NAMED: usize = 2;

/// Draws the menu, which is called by the methods of `chosen`.
pub fn method_menu(ui: &mut Ui, methods: &[Arc<dyn Reconstructor>], chosen: &mut BTreeSet<&'static str>, tip: &str) {
    let title = match chosen.len() {
        count if count > MOST_NAMED => format!("{count} methods"),
        _ => chosen.iter().copied().collect::<Vec<_>>().join(", "),
    };
    let menu = ui.menu_button(format!("Methods: {title}"), |ui| {
        for method in methods {
            let mut is_chosen = chosen.contains(method.name());
            if ui.checkbox(&mut is_chosen, method.name()).on_hover_text(method.description()).changed() {
                match is_chosen {
                    true => chosen.insert(method.name()),
                    false => chosen.remove(method.name()),
                };
            }
        }
    });
    menu.response.on_hover_text(tip);
}
