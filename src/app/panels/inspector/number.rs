//! A number of the selected objects: name, unit and range of its field, and a slider beside some.

use crate::app::widgets::{NumberField, Quantity};
use crate::interact::{Field, FieldChange, SharedField};
use eframe::egui::{Slider, SliderClamping, Ui, WidgetInfo};

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
            (response, slider(ui, shared))
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

/// Largest radius on the slider, metres; larger ones are typed.
const MAX_SLIDER_RADIUS_METRES: f64 = 5.0;

/// Largest roughness on the slider, millimetres: 2 mm already lower a glint by 43 dB.
const MAX_SLIDER_ROUGHNESS_MILLIMETRES: f64 = 2.0;

/// Draws the slider beside a number of a body, whose effect on the maps is best seen while it changes, if the field has one. Returns the change of the number.
fn slider(ui: &mut Ui, shared: &SharedField) -> Option<FieldChange> {
    let (name, range, is_logarithmic) = match shared.field {
        Field::Radius => ("radius slider", 0.01..=MAX_SLIDER_RADIUS_METRES, true),
        Field::Roughness => ("roughness slider", 0.0..=MAX_SLIDER_ROUGHNESS_MILLIMETRES, false),
        _ => return None,
    };
    let mut value = shared.first;
    let drawn = Slider::new(&mut value, range).logarithmic(is_logarithmic).show_value(false);
    // A number beyond the slider's range stays until the slider is moved.
    let response = ui.add(drawn.clamping(SliderClamping::Edits));
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value, name));
    let response = response.on_hover_text("The maps follow while it is dragged");
    response.changed().then_some(FieldChange::To(value))
}

/// Name, tooltip, unit and range of a field.
fn look(field: Field) -> Quantity {
    let metres = Quantity::metres;
    let spread = |name| metres(name, "Standard deviation").with(" m", [0.0, 1e4], 0.02, 3);
    let degrees = |name, tooltip| metres(name, tooltip).with("°", [-360.0, 360.0], 0.5, 2);
    let velocity = |name, tooltip| metres(name, tooltip).with(" m/s", [-1e3, 1e3], 0.05, 2);
    match field {
        Field::X => metres("x", "Along the array; a line's first reflector, a cluster's centre"),
        Field::Y => metres("y", "Ahead of the array; a line's first reflector, a cluster's centre"),
        Field::Range => {
            let tooltip = "From the middle of the array; the direction stays";
            metres("range", tooltip).with(" m", [1e-3, 1e4], 0.02, 3)
        }
        Field::CosTheta => {
            let tooltip = "Of the angle to the array's axis: the range stays";
            metres("cos θ", tooltip).with("", [-1.0, 1.0], 0.002, 4)
        }
        Field::AngleDegrees => {
            let tooltip = "0° straight ahead, positive to the right, beyond ±90° behind the array";
            metres("angle", tooltip).with("°", [-180.0, 180.0], 0.5, 2)
        }
        Field::Spacing => metres("spacing", "Between neighbours").with(" m", [1e-3, 100.0], 0.001, 4),
        Field::Direction => degrees(
            "direction",
            "Where the line leads from its first reflector: 0° straight ahead, 90° along the array to the right",
        ),
        Field::SpreadX => spread("spread in x"),
        Field::SpreadY => spread("spread in y"),
        Field::Length | Field::Width | Field::Angle | Field::Radius | Field::Roughness => look_of_body(field),
        Field::Count => metres("count", "Number of reflectors").with("", [1.0, 10_000.0], 0.2, 0),
        Field::Seed => {
            let tooltip = "Another seed scatters the reflectors, or roughens the surface, otherwise";
            metres("seed", tooltip).with("", [0.0, u64::MAX as f64], 0.05, 0)
        }
        Field::VelocityX => velocity("velocity in x", "Along the array, to the right; metres a second"),
        Field::VelocityY => velocity("velocity in y", "Away from the array; metres a second"),
        Field::CrossSection => {
            let tooltip = "The reflectivity as radar cross section of each reflector: σ 1 is 1 m², 0 dBsm";
            metres("cross section", tooltip).with(" dBsm", [-300.0, 200.0], 0.1, 1)
        }
        Field::Reflectivity => {
            let tooltip = "σ of each reflector, the thesis uses 1; the reflection coefficient of a body, 1 for metal";
            metres("reflectivity", tooltip).with("", [-1e6, 1e6], 0.01, 3)
        }
    }
}

/// The same for the fields of bodies.
fn look_of_body(field: Field) -> Quantity {
    let of = |name, tooltip| Quantity::metres(name, tooltip);
    match field {
        Field::Length => of("length", "Of the wall or the box, metres").with(" m", [1e-3, 1e4], 0.02, 3),
        Field::Width => of("width", "Of the box, across its length").with(" m", [1e-3, 1e4], 0.02, 3),
        Field::Angle => {
            let tooltip = "From the array's axis to the right, counter-clockwise";
            of("angle of the length", tooltip).with("°", [-360.0, 360.0], 0.5, 2)
        }
        Field::Radius => of("radius", "Of the post").with(" m", [0.01, 100.0], 0.005, 3),
        _ => {
            let tooltip = "Standard deviation of the surface's height: 0 is smooth, 1 mm takes 11 dB from a glint";
            of("roughness", tooltip).with(" mm", [0.0, 100.0], 0.01, 3)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use eframe::egui::{Key, Role};

    #[test]
    fn a_length_has_the_digits_that_a_point_of_the_canvas_is_worth() {
        let y = look(Field::Y);
        let shown = |metres_per_point| rounded(3.041_35, &y, metres_per_point);
        assert_eq!([0.1, 0.05, 0.004].map(shown), ["3.0 m", "3.04 m", "3.041 m"].map(|t| Some(t.to_owned())));
        assert_eq!(rounded(3.125, &y, 0.1), None, "what was typed stays as it was typed");
        assert_eq!(rounded(33.333_333, &look(Field::AngleDegrees), 0.1), None);
    }

    #[test]
    fn a_slider_asks_for_the_number_it_is_moved_to() {
        let of = |field, first| {
            let draw = move |ui: &mut Ui, asked: &mut Option<FieldChange>| {
                *asked = slider(ui, &SharedField { field, first, is_same: true }).or(*asked);
            };
            Harness::new_ui_state(draw, None)
        };
        for (field, name, first) in [(Field::Radius, "radius slider", 0.2), (Field::Roughness, "roughness slider", 0.5)]
        {
            let mut drawn = of(field, first);
            drawn.get_by_role_and_label(Role::Slider, name).focus();
            drawn.step();
            drawn.presses(&[Key::ArrowRight]);
            let Some(FieldChange::To(asked)) = *drawn.state() else { panic!("{name}: {:?}", drawn.state()) };
            assert!(asked > first && asked < 2.0 * first, "{name}: {asked}");
        }
        let drawn = of(Field::Length, 4.0);
        assert!(drawn.query_by_role(Role::Slider).is_none(), "a length has none");
        let mut beyond = of(Field::Radius, 50.0);
        beyond.run();
        assert_eq!(*beyond.state(), None, "a number beyond the slider stays");
    }
}
