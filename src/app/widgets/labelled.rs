//! Fields and menus behind their names, and how a number is shown.

use super::entry::tipped;
use super::number_field::NumberField;
use eframe::egui::{ComboBox, Response, Ui, Widget, WidgetText};

/// A widget behind its name, which labels it for screen readers. The tooltip is that of both; an empty one is none.
pub fn labelled(ui: &mut Ui, name: impl Into<WidgetText>, tooltip: &str, widget: impl Widget) -> Response {
    let label = ui.label(name);
    let response = ui.add(widget).labelled_by(label.id);
    tipped(label, tooltip);
    tipped(response, tooltip)
}

/// A menu behind its name, in which one of several values is chosen. `text` is what a value is called.
pub fn choice<T: PartialEq>(
    ui: &mut Ui,
    name: &str,
    tooltip: &str,
    chosen: &mut T,
    values: impl IntoIterator<Item = T>,
    text: impl Fn(&T) -> String,
) {
    choice_told(ui, name, tooltip, chosen, values, |value| (text(value), ""));
}

/// The same, of values that have a tooltip each.
pub fn choice_told<T: PartialEq>(
    ui: &mut Ui,
    name: &str,
    tooltip: &str,
    chosen: &mut T,
    values: impl IntoIterator<Item = T>,
    told: impl Fn(&T) -> (String, &'static str),
) {
    labelled(ui, name, tooltip, |ui: &mut Ui| {
        let menu = ComboBox::from_id_salt(name).selected_text(told(chosen).0).show_ui(ui, |ui| {
            for value in values {
                let (text, tip) = told(&value);
                tipped(ui.selectable_value(chosen, value, text), tip);
            }
        });
        menu.response
    });
}

/// How a number is called, shown and edited.
#[derive(Clone, Copy)]
pub struct Quantity {
    pub name: &'static str,
    /// What it is.
    pub tooltip: &'static str,
    /// Its unit, with the space before it.
    pub unit: &'static str,
    /// The smallest and the largest that are taken.
    pub range: [f64; 2],
    /// Change for each point of a drag.
    pub speed: f64,
    /// Decimals that are shown.
    pub decimals: usize,
}

impl Quantity {
    /// A number of this name, with this tooltip; in metres.
    pub const fn metres(name: &'static str, tooltip: &'static str) -> Self {
        Quantity { name, tooltip, unit: " m", range: [-1e4, 1e4], speed: 0.02, decimals: 3 }
    }

    /// The same in another unit, with other ends, changed faster or slower, and with other decimals.
    pub const fn with(self, unit: &'static str, range: [f64; 2], speed: f64, decimals: usize) -> Self {
        Quantity { unit, range, speed, decimals, ..self }
    }

    /// A field for it; a value out of range stays until it is edited.
    pub fn field<'a>(&self, value: &'a mut f64) -> NumberField<'a> {
        let [low, high] = self.range;
        let field = NumberField::new(value).range(low..=high).clamp_existing_to_range(false);
        field.speed(self.speed).max_decimals(self.decimals).suffix(self.unit)
    }
}
