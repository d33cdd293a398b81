//! Kinds of random scenes to choose from.

use crate::scene::generate::Kind;
use eframe::egui::Ui;
use std::collections::BTreeSet;

/// A box to tick for each of `kinds`; what is ticked is in `chosen`.
pub fn kind_boxes(ui: &mut Ui, kinds: impl IntoIterator<Item = Kind>, chosen: &mut BTreeSet<Kind>) {
    for kind in kinds {
        let mut ticked = chosen.contains(&kind);
        let name = if kind.test_set().is_some() { format!("set {kind}") } else { kind.to_string() };
        if ui.checkbox(&mut ticked, name).on_hover_text(kind.description()).changed() {
            match ticked {
                true => chosen.insert(kind),
                false => chosen.remove(&kind),
            };
        }
    }
}

/// The names of `chosen` kinds and of what stands beside them, or how many they are where they are many.
pub fn kind_names(chosen: &BTreeSet<Kind>, beside: Option<&str>) -> String {
    let names: Vec<String> = chosen.iter().map(Kind::to_string).chain(beside.map(str::to_owned)).collect();
    if names.len() > 4 { format!("{} kinds", names.len()) } else { names.join(", ") }
}
