//! Settings: radar and floor, display, reconstruction with its live figures.

mod detector;
mod false_alarms;

pub use false_alarms::{Memory, Search};

use crate::app::jobs::{Refusal, Scores};
use crate::app::state::{
    Command, DifferenceView, EditCommand, Projection, RadarCommand, Settings, Units, ViewCommand, WorkCommand,
};
use crate::app::widgets::levels::{level, with_unit};
use crate::app::widgets::method_menu::{LIST_HEIGHT, Offered, method_list};
use crate::app::widgets::number_field::NumberField;
use crate::app::widgets::numbers::percent;
use crate::app::widgets::progress::progress;
use crate::app::widgets::setting_row::{group, rarely, row, row_of};
use crate::evaluate::eta_text;
use crate::interact::Snap;
use crate::lesson::Uses;
use crate::maps::Normalisation;
use crate::picture::ColourMap;
use crate::radar::{Carrier, DecibelMilliwatts, Decibels, Radar, WindowFunction};
use crate::reconstruct::Reconstructor;
use crate::signal::{self, Floor};
use eframe::egui;
use eframe::egui::{ComboBox, Grid, ScrollArea, Slider, SliderClamping, Ui};
use std::time::Duration;

/// Largest seed that a scene file holds: TOML knows no larger whole number.
const MAX_NOISE_SEED: u64 = i64::MAX as u64;

/// Between one figure and the next, points.
const FIGURES_GAP: f32 = 20.0;

/// What is chosen, and what came of it.
pub struct Input<'a> {
    /// Whether a recording stands in the place of the scene: its floor is its own.
    pub is_recorded: bool,
    /// What the user chose.
    pub settings: &'a Settings,
    /// The radar, which has the carrier and the window.
    pub radar: &'a Radar,
    /// The scene's own seed of the noise beneath it.
    pub noise_seed: u64,
    /// The methods to choose from.
    pub methods: Offered<'a>,
    /// The method in use.
    pub method: Option<&'a dyn Reconstructor>,
    /// Its eta.
    pub eta: f32,
    /// What the target's Lambda spans, decibels, where that is known.
    pub range_db: Option<f64>,
    /// What it does.
    pub run: Run<'a>,
    /// What the lesson being taken uses: the rest is not shown.
    pub uses: Uses,
}

/// How the reconstruction goes.
#[derive(Default)]
pub struct Run<'a> {
    /// The part that is done, while it runs.
    pub progress: Option<f32>,
    /// Why there is no output.
    pub refusal: Option<&'a Refusal>,
    /// The method whose output is shown, and its time.
    pub output: Option<(&'static str, Duration)>,
    /// Figures of that output against the target of the same scene.
    pub scores: Option<Scores>,
    /// Whether that scene is an earlier one.
    pub outdated: bool,
    /// Whether a panel shows an output, or would if there were one.
    pub wanted: bool,
    /// Why the detector in use finds nothing.
    pub detector_error: Option<&'a str>,
    /// How the search for a threshold goes.
    pub search: Search<'a>,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    let settings = input.settings;
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if input.uses.output {
                group(ui, "Reconstruction", |ui| reconstruction(ui, &input, memory, &mut asked));
            } else if input.uses.threshold {
                group(ui, "Threshold", |ui| thresholds(ui, &input, None, memory, &mut asked));
            }
            group(ui, "Maps", |ui| maps(ui, &input, &mut asked));
            group(ui, "Display", |ui| display(ui, settings, input.uses, &mut asked));
        });
    });
    asked
}

fn maps(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    normalisation(ui, input.settings, asked);
    match input.is_recorded {
        true => row(ui, "Floor", "What lies beneath the echoes", |ui| ui.weak("as it was recorded")),
        false => floor(ui, input.settings, asked),
    }
    window(ui, input.radar.window, asked);
    let has_noise = !input.is_recorded && input.settings.floor != Floor::Exact;
    rarely(ui, if has_noise { "Carrier and noise seed" } else { "Carrier" }, |ui| {
        carrier(ui, input.radar.carrier, asked);
        if has_noise {
            noise_seed(ui, input.noise_seed, asked);
        }
    });
}

/// Choices beside each other.
fn choices<T: PartialEq + Copy, C: Into<Command>>(
    ui: &mut Ui,
    chosen: T,
    of: impl IntoIterator<Item = (T, &'static str, &'static str)>,
    command: impl Fn(T) -> C,
    asked: &mut Vec<Command>,
) {
    for (choice, name, tooltip) in of {
        let mut response = ui.selectable_label(choice == chosen, name);
        if !tooltip.is_empty() {
            response = response.on_hover_text(tooltip);
        }
        if response.clicked() && choice != chosen {
            asked.push(command(choice).into());
        }
    }
}

fn reconstruction(ui: &mut Ui, input: &Input<'_>, memory: &mut Memory, asked: &mut Vec<Command>) {
    let Some(method) = input.method else {
        ui.weak("This build has no reconstruction method.");
        return;
    };
    row(ui, "Method", method.description(), |ui| {
        let combo = ComboBox::from_id_salt("method").width(150.0).height(LIST_HEIGHT).selected_text(method.name());
        let listed = combo.show_ui(ui, |ui| {
            method_list(ui, input.methods, method.name(), |v| Command::View(ViewCommand::Method(v)), asked);
        });
        listed.response
    });
    if input.uses.threshold {
        thresholds(ui, input, Some(method), memory, asked);
    }
    figures(ui, method, &input.run, asked);
}

/// What says which cells are detections: thresholds for the whole map, or a detector.
fn thresholds(
    ui: &mut Ui,
    input: &Input<'_>,
    method: Option<&dyn Reconstructor>,
    memory: &mut Memory,
    asked: &mut Vec<Command>,
) {
    detector::choice(ui, input.settings, asked);
    match &input.settings.cfar {
        Some(cfar) => detector::cells(ui, cfar, input.run.detector_error, asked),
        None => {
            if let Some(method) = method {
                output_eta(ui, input, method, asked);
            }
            target_eta(ui, input, asked);
            if let Some(method) = method {
                false_alarms::show(ui, method.name(), &input.run.search, memory, asked);
            }
        }
    }
}

/// The threshold of the method's output.
fn output_eta(ui: &mut Ui, input: &Input<'_>, method: &dyn Reconstructor, asked: &mut Vec<Command>) {
    row(ui, "η", "Cells of the output above this count as detections", |ui| {
        let mut eta = input.eta;
        let slider = threshold(ui, "η in numbers", &mut eta);
        asked.extend(
            moved(input.eta, eta).map(|eta| Command::View(ViewCommand::SetMethodEta(method.name(), Some(eta)))),
        );
        let own = input.settings.method_eta.contains_key(method.name());
        let reset = ui.add_enabled(own, egui::Button::new("Reset").small());
        let back = match method.reads_eta() {
            true => "Back to the η that fits each output".to_owned(),
            false => format!("Back to the method's own η = {}", eta_text(method.eta())),
        };
        if reset.on_hover_text(back).clicked() {
            asked.push(ViewCommand::SetMethodEta(method.name(), None).into());
        }
        in_decibels(ui, input, input.eta);
        slider
    });
}

/// The threshold of the target.
fn target_eta(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    row(ui, "η'", "Cells of the target above this are drawn in the panel Target > η'", |ui| {
        let mut eta = input.settings.target_eta;
        let slider = threshold(ui, "η' in numbers", &mut eta);
        asked.extend(moved(input.settings.target_eta, eta).map(|v| Command::View(ViewCommand::SetTargetEta(v))));
        in_decibels(ui, input, input.settings.target_eta);
        slider
    });
}

/// A threshold in decibels relative to the target's peak, where these are chosen and known.
fn in_decibels(ui: &mut Ui, input: &Input<'_>, eta: f32) {
    if let Some(range_db) = input.range_db.filter(|_| input.settings.units == Units::Decibels) {
        ui.weak(with_unit(&level(range_db * (f64::from(eta) - 1.0), range_db)));
    }
}

/// The new eta, if it is another.
fn moved(before: f32, after: f32) -> Option<f32> {
    (before != after).then_some(after)
}

/// A slider, and beside it a field called `name` that shows every digit: P_FA is of what is shown.
fn threshold(ui: &mut Ui, name: &str, eta: &mut f32) -> egui::Response {
    let slider = Slider::new(eta, 0.0..=1.0).clamping(SliderClamping::Edits).show_value(false);
    let slider = ui.add(slider);
    let text = eta_text(*eta);
    let field = NumberField::new(eta).range(0.0..=1.0).clamp_existing_to_range(false).speed(0.005).standing_for(&text);
    let field = ui.add(field);
    ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(name));
    slider
}

/// P_D, P_FA and SE, or why there are none.
fn figures(ui: &mut Ui, method: &dyn Reconstructor, run: &Run<'_>, asked: &mut Vec<Command>) {
    // As high with the bar as without: what stands below must not jump when a reconstruction begins.
    ui.horizontal(|ui| {
        ui.set_min_height(ui.spacing().interact_size.y);
        if let Some(part) = run.progress {
            if progress(ui, part, 150.0, "Stop this reconstruction; the last output stays") {
                asked.push(WorkCommand::CancelMethod.into());
            }
        } else if let Some(refusal) = run.refusal {
            let reason = egui::RichText::new(&refusal.reason).color(ui.visuals().error_fg_color);
            ui.add(egui::Label::new(reason).wrap());
        } else if let Some((name, took)) = run.output {
            ui.weak(format!("{name} took {:.1} ms", took.as_secs_f64() * 1e3));
        } else if run.wanted {
            ui.weak("Waiting for the maps…");
        } else {
            ui.weak("Show an output panel to reconstruct.");
        }
    });
    let Some(scores) = run.scores else { return };
    if scores.output_blobs == 0 {
        ui.weak(format!("Nothing is detected. {}: {}.", method.name(), method.description()));
    }
    let m = scores.metrics;
    // Figures of an earlier scene or method are dimmed as their maps are.
    let is_current = !run.outdated || run.progress.is_none();
    ui.add_enabled_ui(is_current, |ui| {
        Grid::new("figures").num_columns(3).spacing([FIGURES_GAP, 2.0]).show(ui, |ui| {
            let detection = m.detection.map_or("–".to_owned(), percent);
            for (name, value, tooltip) in [
                ("P_D", detection, "Part of the target's cells above 0.9 that the output finds"),
                ("P_FA", percent(m.false_alarm), "Part of the other cells where the output exceeds η"),
                ("SE", format!("{:.0}", m.squared_error), "Sum of squared differences over all cells"),
            ] {
                // A name stands nearer to its own value than to the value before.
                ui.horizontal(|ui| {
                    ui.weak(name).on_hover_text(tooltip);
                    ui.monospace(value).on_hover_text(tooltip);
                });
            }
            ui.end_row();
        });
        blobs(ui, scores);
    });
}

fn blobs(ui: &mut Ui, scores: Scores) {
    let plural = if scores.target_blobs == 1 { "" } else { "s" };
    ui.weak(format!("{} blob{plural} in the target, {} in the output", scores.target_blobs, scores.output_blobs))
        .on_hover_text("Regions of touching cells above η' and η");
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

/// What a floor of a level of its own is.
const LEVEL: &str = "Thermal noise of this level in every sample, whatever the scene: an empty scene is noise alone. A reflector of σ 1 at \
    20 m has +18 dBm; with a link budget, what the radar equation says";

/// What the receivers' own noise is.
const RECEIVER: &str = "The noise of the radar's receivers, kTBF, by its link budget in the panel Radar; by the usual one where it has none";

fn floor(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Floor", "What lies beneath the reflectors", |ui| {
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

/// The first and the last digits of a seed that is too long to be read; the tooltip has all.
fn short_seed(seed: u64) -> Option<String> {
    let digits = seed.to_string();
    (digits.len() > 8).then(|| format!("{}…{}", &digits[..3], &digits[digits.len() - 3..]))
}

fn carrier(ui: &mut Ui, carrier: Carrier, asked: &mut Vec<Command>) {
    let tooltip = "One-way: the thesis' convention, unambiguous. Two-way: as equation 3.1 is printed; each column stands for two directions";
    row_of(ui, "Carrier", tooltip, |ui| {
        let of = [(Carrier::OneWay, "One-way", ""), (Carrier::TwoWay, "Two-way", "")];
        choices(ui, carrier, of, RadarCommand::SetCarrier, asked);
    });
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

fn display(ui: &mut Ui, settings: &Settings, uses: Uses, asked: &mut Vec<Command>) {
    row_of(ui, "Coordinates", "Draw maps over cos θ and range, or over x and y", |ui| {
        let of = [(Projection::RangeAngle, "Range–angle", ""), (Projection::Cartesian, "Cartesian", "")];
        choices(ui, settings.projection, of, ViewCommand::SetProjection, asked);
    });
    row_of(ui, "Scale", "What colour bars, cuts, readouts and thresholds are told in (D)", |ui| {
        let of = [(Units::Lambda, "Λ", ""), (Units::Decibels, "dB", "Decibels relative to the map's peak")];
        choices(ui, settings.units, of, ViewCommand::SetUnits, asked);
    });
    row_of(ui, "Colours", "Colours of Λ", |ui| {
        let of = ColourMap::ALL.map(|colours| (colours, colours.name(), ""));
        choices(ui, settings.colours, of, ViewCommand::Colours, asked);
    });
    marks(ui, settings, uses, asked);
    rarely(ui, if uses.output { "Snap, difference and failures" } else { "Snap to" }, |ui| {
        snap(ui, settings, asked);
        if uses.output {
            difference(ui, settings, asked);
            failures(ui, settings, asked);
        }
    });
}

fn snap(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Snap", "Where dragged objects come to rest", |ui| {
        let of = [
            (Snap::Off, "Off", ""),
            (Snap::Metres(0.5), "0.5 m", ""),
            (Snap::Cells, "Cells", "Whole range bins and columns"),
        ];
        choices(ui, settings.snap, of, EditCommand::SetSnap, asked);
    });
}

fn difference(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Difference", "How the panel Difference is drawn", |ui| {
        let DifferenceView { mut absolute, whole } = settings.difference;
        let tip = "Its absolute value, or output minus target";
        if ui.checkbox(&mut absolute, "absolute").on_hover_text(tip).changed() {
            asked.push(ViewCommand::ToggleAbsoluteDifference.into());
        }
        let mut fits = !whole;
        let tip = "On a scale that just holds it, or on one up to 1";
        if ui.checkbox(&mut fits, "automatic scale").on_hover_text(tip).changed() {
            asked.push(ViewCommand::ToggleWholeDifference.into());
        }
    });
}

/// What is drawn over maps and scene.
fn marks(ui: &mut Ui, settings: &Settings, uses: Uses, asked: &mut Vec<Command>) {
    row_of(ui, "Mark", "What is drawn over maps and scene", |ui| {
        let mut mark = |ui: &mut Ui, mut on: bool, name: &str, tooltip: &str, command: ViewCommand| {
            if ui.checkbox(&mut on, name).on_hover_text(tooltip).changed() {
                asked.push(command.into());
            }
        };
        let tooltip = "The scene's own reflectors, over every map (R)";
        mark(ui, settings.show_reflectors, "reflectors", tooltip, ViewCommand::ToggleReflectors);
        if uses.output {
            mark(ui, settings.show_found, "found", "Reflectors that the method found", ViewCommand::ToggleFound);
        }
        let tooltip = "What each end can see, in the scene (V)";
        mark(ui, settings.show_fields_of_view, "views", tooltip, ViewCommand::ToggleFieldsOfView);
        let tooltip = "What the formulas say of the selected reflector, over every map (T)";
        mark(ui, settings.show_theory, "theory", tooltip, ViewCommand::ToggleTheory);
    });
}

fn failures(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Failures", "Kinds of failure", |ui| {
        let mut marked = settings.show_kinds;
        let tip = "What became of every object: found, missed, merged, on the wrong tooth; and ghosts (H)";
        if ui.checkbox(&mut marked, "mark").on_hover_text(tip).changed() {
            asked.push(ViewCommand::ToggleKinds.into());
        }
    });
}

#[cfg(test)]
mod tests;
