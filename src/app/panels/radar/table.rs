//! Rows of the radar panel: name, value and consequence of a constant.

use crate::app::widgets::labelled::Quantity;
use eframe::egui::{Color32, Id, Label, TextStyle, Ui};

/// Gap between two columns, points.
pub(super) const GAP: f32 = 12.0;

/// Width of the widest value, two names of windows beside each other, points.
const VALUE_WIDTH: f32 = 170.0;

/// Least width of a column of consequences, points: in a narrower one, sentences break into single words.
const LEAST_CONSEQUENCE_WIDTH: f32 = 150.0;

/// Layout of the rows.
#[derive(Clone, Copy)]
pub(super) struct Table {
    /// Width of the longest name of a constant, points.
    pub name_width: f32,
    /// Width of the column of consequences; `None` where it has no room, and each consequence stands below its constant.
    pub consequence_width: Option<f32>,
}

impl Table {
    /// The table whose constants have these names.
    pub fn that_fits<const N: usize>(ui: &Ui, names: [&str; N]) -> Table {
        let font = TextStyle::Body.resolve(ui.style());
        let width =
            |name: &str| ui.painter().layout_no_wrap(name.to_owned(), font.clone(), Color32::PLACEHOLDER).size().x;
        let name_width = names.into_iter().map(width).fold(0.0, f32::max);
        let left = ui.available_width() - name_width - VALUE_WIDTH - 2.0 * GAP;
        Table { name_width, consequence_width: Some(left).filter(|left| *left >= LEAST_CONSEQUENCE_WIDTH) }
    }

    /// Draws a row: the name, the widget that `value` draws, and the consequence.
    pub fn row<T>(
        self,
        ui: &mut Ui,
        (name, tooltip): (&str, &str),
        consequence: &str,
        value: impl FnOnce(&mut Ui, Id) -> T,
    ) -> T {
        let consequence = Label::new(consequence).wrap();
        let Some(width) = self.consequence_width else {
            let value = ui.horizontal(|ui| {
                let label = ui.label(name).on_hover_text(tooltip);
                ui.add_space((self.name_width - label.rect.width()).max(0.0) + GAP);
                value(ui, label.id)
            });
            ui.indent(("consequence", name), |ui| ui.add(consequence));
            return value.inner;
        };
        let label = ui.label(name).on_hover_text(tooltip);
        let value = value(ui, label.id);
        ui.vertical(|ui| {
            ui.set_max_width(width);
            ui.add(consequence);
        });
        ui.end_row();
        value
    }
}

/// Draws a row: name, number with its unit, and consequence. Returns the number after an edit.
pub(super) fn number(
    ui: &mut Ui,
    table: Table,
    field: &Quantity,
    value: f64,
    consequence: &str,
    is_free: bool,
) -> Option<f64> {
    let mut edited = value;
    let changed = table.row(ui, (field.name, field.tooltip), consequence, |ui, label| {
        let number = field.field(&mut edited);
        ui.add_enabled(is_free, number).labelled_by(label).on_hover_text(field.tooltip).changed()
    });
    let step = 10f64.powi(-(field.decimals as i32));
    (changed && (edited - value).abs() >= 0.5 * step).then_some(edited)
}
