//! A number of the selected objects.

use super::look::look;
use super::slider;
use crate::app::widgets::{NumberField, Quantity};
use crate::interact::{FieldChange, SharedField};
use eframe::egui::Ui;

/// Draws a number to drag or to type. Returns its change for all selected objects. Where their numbers differ, typing sets all of them to one
/// value, and dragging moves all by the same amount.
pub fn number(ui: &mut Ui, shared: &SharedField, metres_per_point: f64) -> Option<FieldChange> {
    let look = look(shared.field);
    let shown = shared.is_same.then(|| rounded(shared.first, &look, metres_per_point)).flatten();
    let tooltip = match &shown {
        Some(_) => format!("{}; exactly {}{}", look.tooltip, shared.first, look.unit),
        None => look.tooltip.to_owned(),
    };
    let label = ui.label(look.name).on_hover_text(&tooltip);
    let entered = ui.scope_id().with(look.name);
    // A range computed from x and y differs in its last bits from the entered one. The difference must not change the text that is being typed.
    let before: Option<f64> = ui.data(|d| d.get_temp(entered));
    let base = before.filter(|v| (v - shared.first).abs() < 1e-9 * v.abs().max(1.0)).unwrap_or(shared.first);
    let mut asked = None;
    let get_set = |new: Option<f64>| {
        asked = new.or(asked);
        asked.unwrap_or(base)
    };
    let mut drag = NumberField::from_get_set(get_set)
        .range(look.range[0]..=look.range[1])
        .clamp_existing_to_range(false)
        .speed(look.speed)
        .max_decimals(if look.decimals == 0 { 0 } else { 6 })
        .min_decimals(look.decimals)
        .suffix(look.unit);
    if !shared.is_same {
        drag = drag.standing_for("various");
    }
    if let Some(shown) = &shown {
        drag = drag.standing_for(shown);
    }
    let (response, slid) = ui
        .horizontal(|ui| {
            let response = ui.add(drag).labelled_by(label.id).on_hover_text(tooltip);
            (response, slider::show(ui, shared))
        })
        .inner;
    ui.end_row();
    if slid.is_some() {
        return slid;
    }
    let asked = asked?;
    if !shared.is_same && response.dragged() {
        return Some(FieldChange::By(asked - base));
    }
    ui.data_mut(|d| d.insert_temp(entered, asked));
    // A field without an edit returns the rounded number that it showed.
    (!shared.is_same || (asked - base).abs() > 0.5e-6).then_some(FieldChange::To(asked))
}

/// Text of a length, rounded to a point of the canvas; `None` for a length of at most three decimals, such as a typed one.
fn rounded(value: f64, look: &Quantity, metres_per_point: f64) -> Option<String> {
    if look.unit != " m" || (1e3 * value - (1e3 * value).round()).abs() < 1e-6 {
        return None;
    }
    let digits = (-metres_per_point.log10()).ceil().clamp(1.0, 6.0) as usize;
    Some(format!("{value:.digits$}{}", look.unit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::Field;

    #[test]
    fn a_length_has_the_digits_that_a_point_of_the_canvas_is_worth() {
        let y = look(Field::Y);
        let shown = |metres_per_point| rounded(3.041_35, &y, metres_per_point);
        assert_eq!([0.1, 0.05, 0.004].map(shown), ["3.0 m", "3.04 m", "3.041 m"].map(|t| Some(t.to_owned())));
        assert_eq!(rounded(3.125, &y, 0.1), None, "what was typed stays as it was typed");
        assert_eq!(rounded(33.333_333, &look(Field::AngleDegrees), 0.1), None);
    }
}
