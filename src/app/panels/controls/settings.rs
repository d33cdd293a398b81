//! Rows of settings: maps, display, and a detector in place of thresholds.

use crate::app::state::{Command, Directions, EditCommand, RadarCommand, Settings, State, Units, ViewCommand};
use crate::app::widgets::{NumberField, choices, rarely, row, row_of, scientific, tick};
use crate::interact::Snap;
use crate::maps::Normalisation;
use crate::maps::cfar::{Cfar, MAX_CELLS, Statistic};
use crate::picture::ColourMap;
use crate::radar::{DecibelMilliwatts, Decibels, WindowFunction};
use crate::signal::{self, Floor};
use eframe::egui::Ui;

/// Largest seed that a scene file holds: TOML knows no larger whole number.
const MAX_NOISE_SEED: u64 = i64::MAX as u64;

/// Draws the rows of the maps: normalisation, floor, window and the seed of the noise.
pub(super) fn maps(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
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

/// Dynamic range with which the choice of any other begins, dB.
const OTHER_RANGE_DECIBELS: f64 = 80.0;

fn normalisation(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    let tooltip =
        "How magnitudes become Λ in [0, 1]. Min-max is the thesis'; a dynamic range doesn't depend on the floor";
    row_of(ui, "Normalise", tooltip, |ui| {
        let range = |db| Normalisation::DynamicRange(Decibels(db));
        let usual = [
            (Normalisation::MinMax, "Min–max", "Λ is 0 at the smallest cell"),
            (range(40.0), "40 dB", "Λ is 0 at 40 dB below the peak"),
            (range(60.0), "60 dB", "Λ is 0 at 60 dB below the peak"),
            (range(100.0), "100 dB", "Λ is 0 at 100 dB below the peak"),
        ];
        // A drag of the field may pass a usual range, and must go on.
        let held = ui.scope_id().with("other range is held");
        let is_held = ui.data(|d| d.get_temp(held)).unwrap_or(false);
        let is_usual = !is_held && usual.iter().any(|(of, ..)| *of == settings.normalisation);
        let own = if is_usual { range(OTHER_RANGE_DECIBELS) } else { settings.normalisation };
        let of = usual.into_iter().chain([(own, "Other", "Any other dynamic range")]);
        choices(ui, settings.normalisation, of, ViewCommand::Normalise, asked);
        if let (false, Normalisation::DynamicRange(Decibels(mut range))) = (is_usual, settings.normalisation) {
            let drag = ui.add(NumberField::new(&mut range).range(10.0..=300.0).speed(1.0).suffix(" dB"));
            ui.data_mut(|d| d.insert_temp(held, drag.dragged() || drag.has_focus()));
            if drag.changed() {
                asked.push(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(range))).into());
            }
        }
    });
}

const LEVEL_TOOLTIP: &str = "Thermal noise of this level in every sample, for any scene: an empty scene is noise alone. A reflector of σ 1 at \
    20 m has +18 dBm; with a link budget, what the radar equation says";

const RECEIVER_TOOLTIP: &str = "The noise of the radar's receivers, kTBF, by its link budget in the panel Radar; by the usual one where it has none";

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
            (Floor::Level(settings.level), "dBm", LEVEL_TOOLTIP),
            (Floor::Thermal, "Receiver", RECEIVER_TOOLTIP),
        ];
        choices(ui, settings.floor, of, ViewCommand::SetFloor, asked);
        if let Floor::Snr(Decibels(mut snr)) = settings.floor {
            let drag = ui.add(NumberField::new(&mut snr).range(-40.0..=200.0).speed(0.5).suffix(" dB"));
            if drag.changed() {
                asked.push(ViewCommand::SetFloor(Floor::Snr(Decibels(snr))).into());
            }
        }
        if let Floor::Level(DecibelMilliwatts(mut level)) = settings.floor {
            let drag = NumberField::new(&mut level).range(signal::floor::LEVEL_RANGE_DBM).speed(0.5).suffix(" dBm");
            if ui.add(drag).on_hover_text(LEVEL_TOOLTIP).changed() {
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

/// Draws the rows of the display: units of axes and scales, colours, and snapping of dragged objects.
pub(super) fn display(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Directions", "Unit of the axis of directions, in every map", |ui| {
        let of = [(Directions::Cosine, "cos θ", ""), (Directions::Degrees, "degrees", "From straight ahead")];
        choices(ui, settings.directions, of, ViewCommand::SetDirections, asked);
        let tip =
            "Draw maps of few elements on 256 columns: values between are interpolated, and nothing more is resolved";
        tick(ui, settings.fine_columns, "256 columns", tip, |_| ViewCommand::ToggleFineColumns, asked);
    });
    row_of(ui, "Scale", "Unit of colour bars, cuts, readouts and thresholds (D)", |ui| {
        let of = [(Units::Lambda, "Λ", ""), (Units::Decibels, "dB", "Decibels relative to the map's peak")];
        choices(ui, settings.units, of, ViewCommand::SetUnits, asked);
        let tip = "Inputs, target and output on the scale of the strongest: what is weaker looks weaker";
        tick(ui, settings.one_scale, "one for all", tip, |_| ViewCommand::ToggleOneScale, asked);
    });
    row_of(ui, "Colours", "Colours of Λ", |ui| {
        let of = ColourMap::ALL.map(|colours| (colours, colours.name(), ""));
        choices(ui, settings.colours, of, ViewCommand::Colours, asked);
    });
    row_of(ui, "Snap", "Where dragged objects come to rest", |ui| {
        let of = [
            (Snap::Off, "Off", ""),
            (Snap::Metres(0.5), "0.5 m", ""),
            (Snap::Cells, "Cells", "Whole range bins and columns"),
        ];
        choices(ui, settings.snap, of, EditCommand::SetSnap, asked);
    });
}

pub(super) fn detector(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    let tooltip = "The rule for detected cells in the panels Target > η' and Output > η";
    row_of(ui, "Detect", tooltip, |ui| {
        let of = [
            (None, "Global", "One threshold for the whole map"),
            (
                Some(Statistic::CellAveraging),
                "CA",
                "Cell averaging (CFAR): the threshold of a cell is the mean power of its training cells times a factor",
            ),
            (
                Some(Statistic::OrderedStatistics),
                "OS",
                "Ordered statistics (CFAR): the threshold is the training cell of rank 3/4 times a factor, so that strong \
                 neighbours hide no echo",
            ),
        ];
        let chosen = settings.cfar.map(|cfar| cfar.statistic);
        choices(ui, chosen, of, ViewCommand::Detect, asked);
    });
}

pub(super) fn detector_cells(ui: &mut Ui, cfar: &Cfar, error: Option<&str>, asked: &mut Vec<Command>) {
    let mut changed = *cfar;
    let tooltip = "Cells a side that may hold the echo itself and measure nothing";
    sides(ui, "Guard", tooltip, &mut changed.guard);
    sides(ui, "Training", "Cells a side beyond the guard cells, which measure the noise", &mut changed.training);
    rate(ui, &mut changed.false_alarm);
    if changed != *cfar {
        asked.push(ViewCommand::SetCfar(Some(changed)).into());
    }
    if let Some(error) = error {
        ui.colored_label(ui.visuals().error_fg_color, error);
    }
}

fn sides(ui: &mut Ui, name: &str, tooltip: &str, cells: &mut [usize; 2]) {
    row_of(ui, name, tooltip, |ui| {
        let [bins, columns] = cells;
        for (cells, along, unit) in [(bins, "in range", " bins"), (columns, "in angle", " columns")] {
            let field = NumberField::new(cells).range(0..=MAX_CELLS).speed(0.05).suffix(unit);
            let field = ui.add(field).on_hover_text(format!("{tooltip}, {along}"));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(format!("{name} cells {along}")));
        }
    });
}

fn rate(ui: &mut Ui, false_alarm: &mut f64) {
    let tooltip = "Part of the cells of noise alone that are to be detected. It holds for noise that is independent from cell to \
                   cell: a window function makes neighbours alike.";
    row(ui, "P_FA", tooltip, |ui| {
        let rate = *false_alarm;
        let text = if rate < 1e-3 { scientific(rate, 1) } else { format!("{rate:.3}") };
        let speed = 0.02 * *false_alarm;
        ui.add(NumberField::new(false_alarm).range(1e-12..=0.9).speed(speed).standing_for(&text))
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
