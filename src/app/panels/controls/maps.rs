//! Settings of the maps: normalisation, floor, window and the seed of the noise.

use crate::app::state::{Command, EditCommand, RadarCommand, Settings, State, ViewCommand};
use crate::app::widgets::{NumberField, choices, rarely, row, row_of};
use crate::maps::Normalisation;
use crate::radar::{DecibelMilliwatts, Decibels, WindowFunction};
use crate::signal::{self, Floor};
use eframe::egui::Ui;

/// Largest seed that a scene file holds: TOML knows no larger whole number.
const MAX_NOISE_SEED: u64 = i64::MAX as u64;

/// Draws the group's rows.
pub(super) fn show(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    let (settings, is_recorded) = (&state.settings, state.is_recorded());
    normalisation(ui, settings, asked);
    match is_recorded {
        true => row(ui, "Floor", "Noise beneath the echoes", |ui| ui.weak("as it was recorded")),
        false => floor(ui, settings, asked),
    }
    window(ui, state.radar().window, asked);
    if !is_recorded && settings.floor != Floor::Exact {
        rarely(ui, "Seed of the noise", |ui| noise_seed(ui, state.editor.scene().noise_seed, asked));
    }
}

fn normalisation(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    let tooltip =
        "How magnitudes become Λ in [0, 1]. Min-max is the thesis'; a dynamic range doesn't depend on the floor";
    row_of(ui, "Normalise", tooltip, |ui| {
        let range = |db| Normalisation::DynamicRange(Decibels(db));
        let of = [
            (Normalisation::MinMax, "Min–max", "Λ is 0 at the smallest cell"),
            (range(40.0), "40 dB", "Λ is 0 at 40 dB below the peak"),
            (range(60.0), "60 dB", "Λ is 0 at 60 dB below the peak"),
            (range(100.0), "100 dB", "Λ is 0 at 100 dB below the peak"),
        ];
        choices(ui, settings.normalisation, of, ViewCommand::Normalise, asked);
        if let Normalisation::DynamicRange(Decibels(mut range)) = settings.normalisation {
            let drag = ui.add(NumberField::new(&mut range).range(10.0..=300.0).speed(1.0).suffix(" dB"));
            if drag.on_hover_text("Any other dynamic range").changed() {
                asked.push(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(range))).into());
            }
        }
    });
}

/// Tooltip of the floor at a chosen level.
const LEVEL: &str = "Thermal noise of this level in every sample, for any scene: an empty scene is noise alone. A reflector of σ 1 at \
    20 m has +18 dBm; with a link budget, what the radar equation says";

/// Tooltip of the floor of the receivers' noise.
const RECEIVER: &str = "The noise of the radar's receivers, kTBF, by its link budget in the panel Radar; by the usual one where it has none";

fn floor(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Floor", "Noise beneath the echoes", |ui| {
        let of = [
            (Floor::Thesis, "Thesis", "The rounding noise of the thesis' f64 evaluation"),
            (Floor::Exact, "Exact", "No noise at all"),
            (
                Floor::Snr(settings.snr),
                "SNR",
                "Thermal noise at a signal-to-noise ratio: it is louder where the scene is",
            ),
            (Floor::Level(settings.level), "dBm", LEVEL),
            (Floor::Thermal, "Receiver", RECEIVER),
        ];
        choices(ui, settings.floor, of, ViewCommand::SetFloor, asked);
        if let Floor::Snr(Decibels(mut snr)) = settings.floor {
            let drag = ui.add(NumberField::new(&mut snr).range(-40.0..=200.0).speed(0.5).suffix(" dB"));
            if drag.changed() {
                asked.push(ViewCommand::SetFloor(Floor::Snr(Decibels(snr))).into());
            }
        }
        if let Floor::Level(DecibelMilliwatts(mut level)) = settings.floor {
            let drag =
                NumberField::new(&mut level).range(signal::floor::LEVEL_DECIBEL_MILLIWATTS).speed(0.5).suffix(" dBm");
            if ui.add(drag).on_hover_text(LEVEL).changed() {
                asked.push(ViewCommand::SetFloor(Floor::Level(DecibelMilliwatts(level))).into());
            }
        }
    });
}

fn noise_seed(ui: &mut Ui, mut seed: u64, asked: &mut Vec<Command>) {
    let tooltip = format!("The same seed gives the same noise; it is saved with the scene. It is {seed}");
    let short = short_seed(seed);
    row(ui, "Noise seed", &tooltip, |ui| {
        let field = NumberField::new(&mut seed).range(0..=MAX_NOISE_SEED).speed(0.05);
        let field = ui.add(if let Some(short) = &short { field.standing_for(short) } else { field });
        if field.changed() {
            asked.push(EditCommand::SetNoiseSeed(seed).into());
        }
        field
    });
}

/// The first and the last digits of a long seed; the tooltip has all digits.
fn short_seed(seed: u64) -> Option<String> {
    let digits = seed.to_string();
    (digits.len() > 8).then(|| format!("{}…{}", &digits[..3], &digits[digits.len() - 3..]))
}

fn window(ui: &mut Ui, window: WindowFunction, asked: &mut Vec<Command>) {
    let tooltip = "Weights of samples and elements in both transforms: low side lobes cost a wide main lobe";
    row_of(ui, "Window", tooltip, |ui| {
        let of = WindowFunction::ALL.map(|choice| {
            let entry = Command::Radar(RadarCommand::SetWindow(choice)).entry();
            (choice, choice.name(), entry.map_or("", |e| e.tooltip))
        });
        choices(ui, window, of, RadarCommand::SetWindow, asked);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_seed_is_shown_by_its_ends() {
        assert_eq!([short_seed(7), short_seed(12_345_678)], [None, None]);
        assert_eq!(short_seed(8_765_432_187_654_321).unwrap(), "876…321");
    }
}
