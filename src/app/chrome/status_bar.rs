//! One line at the bottom: where the pointer is, what the scene holds, what the last update cost.

use crate::app::state::Cursor;
use eframe::egui;
use eframe::egui::{Align, Layout, Ui};
use std::time::Duration;

/// What the line says.
pub struct Input {
    /// Where the pointer is, if it is over a map or the scene.
    pub cursor: Option<Cursor>,
    /// Objects of the scene.
    pub objects: usize,
    /// Their reflectors.
    pub reflectors: usize,
    /// Time of the last update of maps and pictures.
    pub took: Option<Duration>,
}

/// Draws the line.
pub fn show(ui: &mut Ui, input: Input) {
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            match input.cursor {
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
                if let Some(took) = input.took {
                    ui.weak(format!("maps {:.1} ms", took.as_secs_f64() * 1e3)).on_hover_text(
                        "Time of the last update of maps and pictures; the Timing panel (F7) has the stages",
                    );
                }
                let Input { objects, reflectors, .. } = input;
                ui.weak(format!("{objects} object{} · {reflectors} reflector{}", plural(objects), plural(reflectors)));
            });
        });
    });
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
