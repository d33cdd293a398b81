//! The element that is looked at, and the numbers of the chirp.

use crate::app::state::{ChirpSettings, Command, RadarCommand, ViewCommand};
use crate::app::widgets::labelled::labelled;
use crate::app::widgets::number_field::NumberField;
use crate::radar::Radar;
use eframe::egui::Ui;

/// Shortest and longest chirp that is dragged to, seconds.
pub const DRAGGED_SECONDS: [f64; 2] = [1e-6, 1e-2];

/// What the numbers are of.
pub struct Chosen<'a> {
    /// The radar.
    pub radar: &'a Radar,
    /// Which element.
    pub settings: ChirpSettings,
    /// Whether a recording stands in the place of the scene, whose radar is what it was.
    pub is_recorded: bool,
}

/// Draws the numbers; what is asked of settings and radar.
pub fn show(ui: &mut Ui, chosen: &Chosen<'_>, element: usize, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let (radar, mut settings) = (chosen.radar, ChirpSettings { element });
        let mut changed = radar.clone();
        let number = NumberField::new(&mut settings.element).range(0..=radar.elements - 1).speed(0.3);
        labelled(ui, "Element", "The element whose chirp and beat are drawn, from the left", number);
        let tooltip = "Time that the samples span. No echo at rest depends on it: a beat turns 2RB/c times in a chirp of any length.";
        let mut microseconds = 1e6 * radar.chirp_seconds;
        let range = 1e6 * DRAGGED_SECONDS[0]..=1e6 * DRAGGED_SECONDS[1];
        let field = NumberField::new(&mut microseconds).range(range).speed(0.05).suffix(" µs");
        if labelled(ui, "Chirp", tooltip, field).changed() {
            changed.set_chirp_seconds(1e-6 * microseconds);
        }
        ask(chosen, settings, changed, asked);
    });
    ui.add_enabled_ui(!chosen.is_recorded, |ui| {
        ui.horizontal_wrapped(|ui| {
            let mut changed = chosen.radar.clone();
            let samples = NumberField::new(&mut changed.samples).range(1..=65536);
            labelled(ui, "Samples", "Samples of the beat, and range bins of its spectrum", samples);
            gigahertz(ui, "Bandwidth", "Drag the end of the chirp up or down", &mut changed.bandwidth_hz);
            gigahertz(ui, "Carrier", "Drag the beginning of the chirp up or down", &mut changed.carrier_hz);
            ask(chosen, chosen.settings, changed, asked);
        });
    });
}

fn gigahertz(ui: &mut Ui, name: &str, tooltip: &str, hertz: &mut f64) {
    let mut giga = *hertz / 1e9;
    let field = NumberField::new(&mut giga).range(1e-3..=300.0).speed(0.01).suffix(" GHz");
    if labelled(ui, name, tooltip, field).changed() {
        *hertz = 1e9 * giga;
    }
}

/// Asks for what differs from what is shown.
pub fn ask(chosen: &Chosen<'_>, settings: ChirpSettings, radar: Radar, asked: &mut Vec<Command>) {
    if settings != chosen.settings {
        asked.push(ViewCommand::SetChirp(settings).into());
    }
    if radar != *chosen.radar {
        asked.push(RadarCommand::Set(Box::new(radar)).into());
    }
}
