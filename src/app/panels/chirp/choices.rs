//! Fields of the chirp panel: the drawn element, and the duration of the chirp.

use crate::app::state::{ChirpSettings, Command, RadarCommand, ViewCommand};
use crate::app::widgets::{NumberField, labelled};
use crate::radar::Radar;
use eframe::egui::Ui;

/// Shortest and longest chirp duration that dragging reaches, seconds.
pub const DRAGGED_SECONDS: [f64; 2] = [1e-6, 1e-2];

/// Draws the fields of element and chirp duration. `element` is the one on screen.
pub fn show(ui: &mut Ui, radar: &Radar, element: usize, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let mut settings = ChirpSettings { element };
        let number = NumberField::new(&mut settings.element).range(0..=radar.elements - 1).speed(0.3);
        labelled(ui, "Element", "The element whose chirp and beat are drawn, from the left", number);
        if settings.element != element {
            asked.push(ViewCommand::SetChirp(settings).into());
        }
        let tooltip = "Time that the samples span. No echo at rest depends on it: a beat turns 2RB/c times in a chirp of any length.";
        let mut microseconds = 1e6 * radar.chirp_seconds;
        let range = 1e6 * DRAGGED_SECONDS[0]..=1e6 * DRAGGED_SECONDS[1];
        let field = NumberField::new(&mut microseconds).range(range).speed(0.05).suffix(" µs");
        if labelled(ui, "Chirp", tooltip, field).changed() {
            let mut changed = radar.clone();
            changed.set_chirp_seconds(1e-6 * microseconds);
            set(radar, changed, asked);
        }
    });
}

/// Sends the command for a radar, if it differs from the one on screen.
pub fn set(radar: &Radar, changed: Radar, asked: &mut Vec<Command>) {
    if changed != *radar {
        asked.push(RadarCommand::Set(Box::new(changed)).into());
    }
}
