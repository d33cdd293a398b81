//! The element that is looked at, and the numbers of the chirp.

use crate::app::state::{ChirpSettings, Command, RadarCommand, ViewCommand};
use crate::app::widgets::number_field::NumberField;
use crate::radar::Radar;
use eframe::egui::{Id, Ui};

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
        let label = ui.label("Element").on_hover_text("The element whose chirp and beat are drawn, from the left");
        ui.add(NumberField::new(&mut settings.element).range(0..=radar.elements - 1).speed(0.3)).labelled_by(label.id);
        let tooltip = "Time that the samples span. No echo at rest depends on it: a beat turns 2RB/c times in a chirp of any length.";
        let label = ui.label("Chirp").on_hover_text(tooltip);
        let mut microseconds = 1e6 * radar.chirp_seconds;
        let range = 1e6 * DRAGGED_SECONDS[0]..=1e6 * DRAGGED_SECONDS[1];
        let field = NumberField::new(&mut microseconds).range(range).speed(0.05).suffix(" µs");
        if ui.add(field).labelled_by(label.id).on_hover_text(tooltip).changed() {
            changed.set_chirp_seconds(1e-6 * microseconds);
        }
        ask(chosen, settings, changed, asked);
    });
    ui.add_enabled_ui(!chosen.is_recorded, |ui| {
        ui.horizontal_wrapped(|ui| {
            let mut changed = chosen.radar.clone();
            let label = ui.label("Samples").on_hover_text("Samples of the beat, and range bins of its spectrum");
            ui.add(NumberField::new(&mut changed.samples).range(1..=65536)).labelled_by(label.id);
            let label = ui.label("Bandwidth").on_hover_text("Drag the end of the chirp up or down");
            gigahertz(ui, &mut changed.bandwidth_hz, label.id);
            let label = ui.label("Carrier").on_hover_text("Drag the beginning of the chirp up or down");
            gigahertz(ui, &mut changed.carrier_hz, label.id);
            ask(chosen, chosen.settings, changed, asked);
        });
    });
}

fn gigahertz(ui: &mut Ui, hertz: &mut f64, label: Id) {
    let mut giga = *hertz / 1e9;
    let field = ui.add(NumberField::new(&mut giga).range(1e-3..=300.0).speed(0.01).suffix(" GHz")).labelled_by(label);
    if field.changed() {
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
