//! Long work: a bar that shows how far it is, beside the button that stops it.

use eframe::egui::{ProgressBar, Ui};

/// What is shown at the most: a bar that stands says that the work goes on.
const MOST: f32 = 0.99;

/// Draws both; whether the button was pressed. `part` is from 0 to 1; 0 says that nobody knows yet. It never reads 100 %: who draws it knows
/// that there is more to come.
pub fn progress(ui: &mut Ui, part: f32, width: f32, cancel_tooltip: &str) -> bool {
    ui.horizontal(|ui| {
        let bar = if part > 0.0 {
            ProgressBar::new(part.min(MOST)).show_percentage()
        } else {
            ProgressBar::new(0.0).animate(true)
        };
        ui.add(bar.desired_width(width));
        ui.small_button("Cancel").on_hover_text(cancel_tooltip).clicked()
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use egui_kittest::Harness;

    #[test]
    fn work_that_goes_on_never_reads_100_per_cent() {
        let harness = Harness::builder().with_size([400.0, 60.0]).build_ui(|ui| _ = progress(ui, 1.0, 150.0, "stop"));
        let texts = seen::texts(harness.output());
        assert!(texts.iter().any(|t| t.text == "99%"), "{texts:?}");
    }
}
