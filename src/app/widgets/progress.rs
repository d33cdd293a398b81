//! Long work: a bar that shows how far it is, beside the button that stops it.

use eframe::egui::{ProgressBar, Ui};

/// Draws both; whether the button was pressed. `part` is from 0 to 1; 0 says that nobody knows yet.
pub fn progress(ui: &mut Ui, part: f32, width: f32, cancel_tooltip: &str) -> bool {
    ui.horizontal(|ui| {
        let bar =
            if part > 0.0 { ProgressBar::new(part).show_percentage() } else { ProgressBar::new(0.0).animate(true) };
        ui.add(bar.desired_width(width));
        ui.small_button("Cancel").on_hover_text(cancel_tooltip).clicked()
    })
    .inner
}
