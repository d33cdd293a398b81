//! Rows of the radar panel: name, value and consequence of a constant.

use crate::app::widgets::Quantity;
use eframe::egui::{Align, Color32, Grid, Id, Label, Response, TextStyle, Ui};

const COLUMN_GAP_POINTS: f32 = 12.0;

/// Width of the widest value, two names of windows beside each other, points.
const VALUE_WIDTH: f32 = 170.0;

/// Least width of a column of consequences, points: in a narrower one, sentences break into single words.
const MIN_CONSEQUENCE_WIDTH_POINTS: f32 = 150.0;

/// Layout of the rows.
#[derive(Clone, Copy)]
pub(super) struct Table {
    /// Width of the longest name of a constant, points.
    name_width: f32,
    /// Width of the column of consequences; `None` where it has no room, and each consequence stands below its constant.
    pub consequence_width: Option<f32>,
    /// Name of the row or the group that is to be brought into sight.
    pub sought: Option<&'static str>,
}

impl Table {
    /// The table whose constants have these names.
    pub fn that_fits<const N: usize>(ui: &Ui, names: [&str; N], sought: Option<&'static str>) -> Table {
        let font = TextStyle::Body.resolve(ui.style());
        let width =
            |name: &str| ui.painter().layout_no_wrap(name.to_owned(), font.clone(), Color32::PLACEHOLDER).size().x;
        let name_width = names.into_iter().map(width).fold(0.0, f32::max);
        let left = ui.available_width() - name_width - VALUE_WIDTH - 2.0 * COLUMN_GAP_POINTS;
        let consequence_width = Some(left).filter(|left| *left >= MIN_CONSEQUENCE_WIDTH_POINTS);
        Table { name_width, consequence_width, sought }
    }

    fn name(self, ui: &mut Ui, (name, tooltip): (&str, &str)) -> Response {
        let label = ui.label(name);
        if self.sought == Some(name) {
            label.scroll_to_me(Some(Align::Center));
        }
        label.on_hover_text(tooltip)
    }

    /// Draws rows: in a grid of three columns, or below each other where consequences have no column.
    pub fn show(self, ui: &mut Ui, name: &str, rows: impl FnOnce(&mut Ui)) {
        match self.consequence_width {
            Some(_) => {
                _ = Grid::new(name).num_columns(3).spacing([COLUMN_GAP_POINTS, 5.0]).striped(true).show(ui, rows)
            }
            None => rows(ui),
        }
    }

    /// A row: the name, what `value` draws, what follows.
    pub fn row<T>(self, ui: &mut Ui, name: (&str, &str), consequence: &str, value: impl FnOnce(&mut Ui, Id) -> T) -> T {
        let consequence = Label::new(consequence).wrap();
        let Some(width) = self.consequence_width else {
            let value = ui.horizontal(|ui| {
                let label = self.name(ui, name);
                ui.add_space((self.name_width - label.rect.width()).max(0.0) + COLUMN_GAP_POINTS);
                value(ui, label.id)
            });
            ui.indent(("consequence", name.0), |ui| ui.add(consequence));
            return value.inner;
        };
        let label = self.name(ui, name);
        let value = value(ui, label.id);
        ui.vertical(|ui| {
            ui.set_max_width(width);
            ui.add(consequence);
        });
        ui.end_row();
        value
    }
}

/// Draws a row: name, number in the unit of `field` and consequence. `size` is that unit in the unit of `value`. Returns whether the number was edited.
pub(super) fn number(
    ui: &mut Ui,
    table: Table,
    field: &Quantity,
    (value, size): (&mut f64, f64),
    consequence: &str,
    is_free: bool,
) -> bool {
    let mut shown = *value / size;
    let is_edited = table.row(ui, (field.name, field.tooltip), consequence, |ui, label| {
        let number = field.field(&mut shown);
        ui.add_enabled(is_free, number).labelled_by(label).on_hover_text(field.tooltip).changed()
    });
    if is_edited {
        *value = shown * size;
    }
    is_edited
}
