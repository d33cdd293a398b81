//! Sliders beside some numbers of a body, whose effect on the maps is best seen while they change.

use crate::interact::{Field, FieldChange, SharedField};
use eframe::egui::{Slider, SliderClamping, Ui, WidgetInfo};

/// Largest radius on the slider, metres; larger ones are typed.
const MOST_RADIUS_METRES: f64 = 5.0;

/// Largest roughness on the slider, millimetres: 2 mm already lower a glint by 43 dB.
const MOST_ROUGHNESS_MILLIMETRES: f64 = 2.0;

/// Draws the slider, if the field has one. Returns the change of the number.
pub fn show(ui: &mut Ui, shared: &SharedField) -> Option<FieldChange> {
    let (name, range, is_logarithmic) = match shared.field {
        Field::Radius => ("radius slider", 0.01..=MOST_RADIUS_METRES, true),
        Field::Roughness => ("roughness slider", 0.0..=MOST_ROUGHNESS_MILLIMETRES, false),
        _ => return None,
    };
    let mut value = shared.first;
    let slider = Slider::new(&mut value, range).logarithmic(is_logarithmic).show_value(false);
    // A number beyond the slider's range stays until the slider is moved.
    let response = ui.add(slider.clamping(SliderClamping::Edits));
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value, name));
    let response = response.on_hover_text("The maps follow while it is dragged");
    response.changed().then_some(FieldChange::To(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::User;
    use eframe::egui::{Key, Role};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_slider_asks_for_the_number_it_is_moved_to() {
        let of = |field, first| {
            let draw = move |ui: &mut Ui, asked: &mut Option<FieldChange>| {
                *asked = show(ui, &SharedField { field, first, is_same: true }).or(*asked);
            };
            Harness::new_ui_state(draw, None)
        };
        for (field, name, first) in [(Field::Radius, "radius slider", 0.2), (Field::Roughness, "roughness slider", 0.5)]
        {
            let mut slider = of(field, first);
            slider.get_by_role_and_label(Role::Slider, name).focus();
            slider.step();
            slider.presses(&[Key::ArrowRight]);
            let Some(FieldChange::To(asked)) = *slider.state() else { panic!("{name}: {:?}", slider.state()) };
            assert!(asked > first && asked < 2.0 * first, "{name}: {asked}");
        }
        let slider = of(Field::Length, 4.0);
        assert!(slider.query_by_role(Role::Slider).is_none(), "a length has none");
        let mut beyond = of(Field::Radius, 50.0);
        beyond.run();
        assert_eq!(*beyond.state(), None, "a number beyond the slider stays");
    }
}
