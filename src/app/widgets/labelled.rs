//! Fields and menus with a name before them, and the format of numbers.

use super::entry::tipped;
use super::number_field::NumberField;
use eframe::egui::{ComboBox, Response, Ui, Widget, WidgetText};

/// A widget after its name, which labels it for screen readers. Both have the tooltip, unless that is empty.
pub fn labelled(ui: &mut Ui, name: impl Into<WidgetText>, tooltip: &str, widget: impl Widget) -> Response {
    let label = ui.label(name);
    let response = ui.add(widget).labelled_by(label.id);
    tipped(label, tooltip);
    tipped(response, tooltip)
}

/// A menu after its name, for choosing one of `values`; `told` makes their names and their tooltips.
pub fn choice<T: PartialEq>(
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

/// Name, unit and range of a number, for its field.
#[derive(Clone, Copy)]
pub struct Quantity {
    pub name: &'static str,
    pub tooltip: &'static str,
    /// Unit, with the space before it.
    pub unit: &'static str,
    pub range: [f64; 2],
    /// Change for each point of a drag, in the unit.
    pub speed: f64,
    pub decimals: usize,
}

impl Quantity {
    pub const fn metres(name: &'static str, tooltip: &'static str) -> Self {
        Quantity { name, tooltip, unit: " m", range: [-1e4, 1e4], speed: 0.02, decimals: 3 }
    }

    /// The number with another unit, range, speed and number of decimals.
    pub const fn with(self, unit: &'static str, range: [f64; 2], speed: f64, decimals: usize) -> Self {
        Quantity { unit, range, speed, decimals, ..self }
    }

    /// A field for the number; a value out of range stays until it is edited.
    pub fn field<'a>(&self, value: &'a mut f64) -> NumberField<'a> {
        let [low, high] = self.range;
        let field = NumberField::new(value).range(low..=high).clamp_existing_to_range(false);
        field.speed(self.speed).max_decimals(self.decimals).suffix(self.unit)
    }
}
