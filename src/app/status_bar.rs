//! One line at the bottom: where the pointer is, what the scene holds, what the last update cost.

use super::application::App;
use eframe::egui;
use eframe::egui::{Align, Layout, Ui};

/// Draws the line.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            match app.cursor {
                Some(c) => {
                    let text = format!(
                        "x {:+7.2} m   y {:+7.2} m   range {:6.2} m   cos θ {:+.3}   bin {:5.1}   column {:6.1}",
                        c.place.x_metres, c.place.y_metres, c.range_metres, c.cos_theta, c.bin, c.column
                    );
                    ui.monospace(text);
                }
                None => {
                    ui.weak("Drag a reflector · double-click to add one · scroll to zoom · right-click for more");
                }
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.available_width() < 150.0 {
                    return;
                }
                if let Some(result) = &app.pipeline.result {
                    ui.weak(format!("maps {:.1} ms", result.took.as_secs_f64() * 1e3)).on_hover_text(
                        "Time of the last update of maps and pictures; the Timing panel (F7) has the stages",
                    );
                }
                let scene = app.editor.scene();
                let (objects, reflectors) = (scene.objects.len(), scene.reflector_count());
                ui.weak(format!("{objects} object{} · {reflectors} reflector{}", plural(objects), plural(reflectors)));
            });
        });
    });
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
