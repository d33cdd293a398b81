//! Settings: radar and floor, display, reconstruction with its live figures.

use crate::app::jobs::{Refusal, Scores};
use crate::app::state::{Command, Projection, Settings};
use crate::app::widgets::progress::progress;
use crate::interact::Snap;
use crate::maps::Normalisation;
use crate::picture::ColourMap;
use crate::radar::{Carrier, Decibels, Radar, WindowFunction};
use crate::reconstruct::Reconstructor;
use crate::signal::Floor;
use eframe::egui;
use eframe::egui::{ComboBox, DragValue, Grid, ScrollArea, Slider, SliderClamping, Ui};
use std::sync::Arc;
use std::time::Duration;

/// Largest seed that a scene file holds: TOML knows no larger whole number.
const MAX_NOISE_SEED: u64 = i64::MAX as u64;

/// What is chosen, and what came of it.
pub struct Input<'a> {
    /// What the user chose.
    pub settings: &'a Settings,
    /// The radar, which has the carrier and the window.
    pub radar: &'a Radar,
    /// The scene's own seed of the noise beneath it.
    pub noise_seed: u64,
    /// The methods to choose from.
    pub methods: &'a [Arc<dyn Reconstructor>],
    /// The method in use.
    pub method: Option<&'a dyn Reconstructor>,
    /// Its eta.
    pub eta: f32,
    /// What it does.
    pub run: Run<'a>,
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
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    let mut asked = Vec::new();
    let settings = input.settings;
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            heading(ui, "Reconstruction");
            reconstruction(ui, &input, &mut asked);
            ui.add_space(6.0);
            heading(ui, "Maps");
            Grid::new("maps").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
                normalisation(ui, settings, &mut asked);
                floor(ui, settings, input.noise_seed, &mut asked);
                carrier(ui, input.radar.carrier, &mut asked);
                window(ui, input.radar.window, &mut asked);
            });
            ui.add_space(6.0);
            heading(ui, "Display");
            Grid::new("display").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| display(ui, settings, &mut asked));
        });
    });
    asked
}

fn heading(ui: &mut Ui, text: &str) {
    ui.strong(text);
}

/// A row: its name, then its widget. The name labels the widget for screen readers.
fn row(ui: &mut Ui, name: &str, tooltip: &str, widget: impl FnOnce(&mut Ui) -> egui::Response) {
    let label = ui.label(name).on_hover_text(tooltip);
    widget(ui).labelled_by(label.id).on_hover_text(tooltip);
    ui.end_row();
}

/// Choices beside each other. The first of them stands for all where a name labels them.
fn choices<T: PartialEq + Copy>(
    ui: &mut Ui,
    chosen: T,
    of: impl IntoIterator<Item = (T, &'static str, &'static str)>,
    command: impl Fn(T) -> Command,
    asked: &mut Vec<Command>,
) -> egui::Response {
    let mut first = None;
    for (choice, name, tooltip) in of {
        let mut response = ui.selectable_label(choice == chosen, name);
        if !tooltip.is_empty() {
            response = response.on_hover_text(tooltip);
        }
        if response.clicked() && choice != chosen {
            asked.push(command(choice));
        }
        first.get_or_insert(response);
    }
    first.unwrap_or_else(|| ui.label(""))
}

fn reconstruction(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let Some(method) = input.method else {
        ui.weak("This build has no reconstruction method.");
        return;
    };
    Grid::new("reconstruction").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
        row(ui, "Method", method.description(), |ui| {
            let combo = ComboBox::from_id_salt("method").width(150.0).selected_text(method.name());
            let listed = combo.show_ui(ui, |ui| {
                for m in input.methods {
                    let label = ui.selectable_label(m.name() == method.name(), m.name());
                    if label.on_hover_text(m.description()).clicked() {
                        asked.push(Command::Method(m.name()));
                    }
                }
            });
            listed.response
        });
        row(ui, "η", "Cells of the output above this count as detections", |ui| {
            ui.horizontal(|ui| {
                let mut eta = input.eta;
                let slider = ui.add(threshold(&mut eta));
                asked.extend(moved(input.eta, eta).map(|eta| Command::SetMethodEta(method.name(), Some(eta))));
                let own = input.settings.method_eta.contains_key(method.name());
                let reset = ui.add_enabled(own, egui::Button::new("Reset").small());
                if reset.on_hover_text(format!("Back to the method's own η = {}", method.eta())).clicked() {
                    asked.push(Command::SetMethodEta(method.name(), None));
                }
                slider
            })
            .inner
        });
        row(ui, "η'", "Cells of the target above this are drawn in the panel Target > η'", |ui| {
            let mut eta = input.settings.target_eta;
            let slider = ui.add(threshold(&mut eta));
            asked.extend(moved(input.settings.target_eta, eta).map(Command::SetTargetEta));
            slider
        });
    });
    figures(ui, method, &input.run, asked);
}

/// The new eta, if it looks any different: the field writes back what it shows when the focus only passes through.
fn moved(before: f32, after: f32) -> Option<f32> {
    let shown = |eta: f32| (100.0 * eta).round();
    (shown(before) != shown(after)).then_some(after)
}

/// A slider that shows two decimals; what nobody moves keeps all of its own.
fn threshold(eta: &mut f32) -> Slider<'_> {
    Slider::new(eta, 0.0..=1.0).fixed_decimals(2).clamping(SliderClamping::Edits)
}

/// P_D, P_FA and SE, or why there are none.
fn figures(ui: &mut Ui, method: &dyn Reconstructor, run: &Run<'_>, asked: &mut Vec<Command>) {
    if let Some(part) = run.progress {
        if progress(ui, part, 150.0, "Stop this reconstruction; the last output stays") {
            asked.push(Command::CancelMethod);
        }
    } else if let Some(refusal) = run.refusal {
        ui.colored_label(ui.visuals().error_fg_color, &refusal.reason);
    } else if let Some((name, took)) = run.output {
        ui.weak(format!("{name} took {:.1} ms", took.as_secs_f64() * 1e3));
    } else if run.wanted {
        ui.weak("Waiting for the maps…");
    } else {
        ui.weak("Show an output panel to reconstruct.");
    }
    let Some(scores) = run.scores else { return };
    if scores.output_blobs == 0 {
        ui.weak(format!("Nothing exceeds η. {}: {}.", method.name(), method.description()));
    }
    let m = scores.metrics;
    ui.add_enabled_ui(!run.outdated || run.progress.is_none(), |ui| {
        Grid::new("figures").num_columns(6).spacing([8.0, 2.0]).show(ui, |ui| {
            let detection = m.detection.map_or("–".to_owned(), percent);
            for (name, value, tooltip) in [
                ("P_D", detection, "Part of the target's cells above 0.9 that the output finds"),
                ("P_FA", percent(m.false_alarm), "Part of the other cells where the output exceeds η"),
                ("SE", format!("{:.0}", m.squared_error), "Sum of squared differences over all cells"),
            ] {
                ui.weak(name).on_hover_text(tooltip);
                ui.monospace(value).on_hover_text(tooltip);
            }
            ui.end_row();
        });
    });
    let plural = if scores.target_blobs == 1 { "" } else { "s" };
    ui.weak(format!("{} blob{plural} in the target, {} in the output", scores.target_blobs, scores.output_blobs))
        .on_hover_text("Regions of touching cells above η' and η");
}

fn percent(part: f64) -> String {
    format!("{:.2} %", part * 100.0)
}

fn normalisation(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    let tooltip =
        "How magnitudes become Λ in [0, 1]. Min-max is the thesis'; a dynamic range doesn't depend on the floor";
    row(ui, "Normalise", tooltip, |ui| {
        ui.horizontal(|ui| {
            let range = Normalisation::DynamicRange(settings.dynamic_range);
            let of = [(Normalisation::MinMax, "Min–max", ""), (range, "Range", "")];
            let response = choices(ui, settings.normalisation, of, Command::Normalise, asked);
            if let Normalisation::DynamicRange(Decibels(mut range)) = settings.normalisation {
                let drag = ui.add(DragValue::new(&mut range).range(10.0..=300.0).speed(1.0).suffix(" dB"));
                if drag.changed() {
                    asked.push(Command::Normalise(Normalisation::DynamicRange(Decibels(range))));
                }
            }
            response
        })
        .inner
    });
}

fn floor(ui: &mut Ui, settings: &Settings, mut noise_seed: u64, asked: &mut Vec<Command>) {
    row(ui, "Floor", "What lies beneath the reflectors", |ui| {
        ui.horizontal(|ui| {
            let of = [
                (Floor::Thesis, "Thesis", "The rounding noise of the thesis' f64 evaluation"),
                (Floor::Exact, "Exact", "No noise at all"),
                (Floor::Snr(settings.snr), "SNR", "Thermal noise at a signal-to-noise ratio"),
            ];
            let response = choices(ui, settings.floor, of, Command::SetFloor, asked);
            if let Floor::Snr(Decibels(mut snr)) = settings.floor {
                let drag = ui.add(DragValue::new(&mut snr).range(-40.0..=200.0).speed(0.5).suffix(" dB"));
                if drag.changed() {
                    asked.push(Command::SetFloor(Floor::Snr(Decibels(snr))));
                }
            }
            response
        })
        .inner
    });
    if settings.floor != Floor::Exact {
        row(ui, "Noise seed", "The same seed gives the same noise; it is saved with the scene", |ui| {
            let drag = ui.add(DragValue::new(&mut noise_seed).range(0..=MAX_NOISE_SEED).speed(0.05));
            if drag.changed() {
                asked.push(Command::SetNoiseSeed(noise_seed));
            }
            drag
        });
    }
}

fn carrier(ui: &mut Ui, carrier: Carrier, asked: &mut Vec<Command>) {
    row(ui, "Carrier", "One-way is unambiguous; two-way (as equation 3.1 is printed) folds cos θ twice", |ui| {
        let of = [(Carrier::OneWay, "One-way", ""), (Carrier::TwoWay, "Two-way", "")];
        ui.horizontal(|ui| choices(ui, carrier, of, Command::SetCarrier, asked)).inner
    });
}

fn window(ui: &mut Ui, window: WindowFunction, asked: &mut Vec<Command>) {
    let tooltip = "Weights of samples and elements in both transforms: low side lobes cost a wide main lobe";
    row(ui, "Window", tooltip, |ui| {
        let of = WindowFunction::ALL.map(|choice| {
            let entry = Command::SetWindow(choice).entry();
            (choice, choice.name(), entry.map_or("", |e| e.tooltip))
        });
        ui.horizontal(|ui| choices(ui, window, of, Command::SetWindow, asked)).inner
    });
}

fn display(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row(ui, "Coordinates", "Draw maps over cos θ and range, or over x and y", |ui| {
        let of = [(Projection::RangeAngle, "Range–angle", ""), (Projection::Cartesian, "Cartesian", "")];
        ui.horizontal(|ui| choices(ui, settings.projection, of, Command::SetProjection, asked)).inner
    });
    row(ui, "Colours", "Colours of Λ", |ui| {
        let of = ColourMap::ALL.map(|colours| (colours, colours.name(), ""));
        ui.horizontal(|ui| choices(ui, settings.colours, of, Command::Colours, asked)).inner
    });
    row(ui, "Mark", "What is drawn over maps and scene", |ui| {
        ui.horizontal_wrapped(|ui| {
            let mut mark = |ui: &mut Ui, mut on: bool, name: &str, tooltip: &str, command: Command| {
                let response = ui.checkbox(&mut on, name).on_hover_text(tooltip);
                if response.changed() {
                    asked.push(command);
                }
                response
            };
            let tooltip = "The scene's own reflectors, over every map (R)";
            let first = mark(ui, settings.show_reflectors, "reflectors", tooltip, Command::ToggleReflectors);
            mark(ui, settings.show_found, "found", "Reflectors that the method believes in", Command::ToggleFound);
            let tooltip = "What each end can see, in the scene (V)";
            mark(ui, settings.show_fields_of_view, "views", tooltip, Command::ToggleFieldsOfView);
            let tooltip = "What the formulas say of the selected reflector, over every map (T)";
            mark(ui, settings.show_theory, "theory", tooltip, Command::ToggleTheory);
            first
        })
        .inner
    });
    row(ui, "Snap", "Where dragged objects come to rest", |ui| {
        let of = [
            (Snap::Off, "Off", ""),
            (Snap::Metres(0.5), "0.5 m", ""),
            (Snap::Cells, "Cells", "Whole range bins and columns"),
        ];
        ui.horizontal(|ui| choices(ui, settings.snap, of, Command::SetSnap, asked)).inner
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Metrics;
    use crate::reconstruct::{Baseline, CAPON};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(run: impl Fn() -> Run<'static> + 'static) -> Harness<'static, Vec<Command>> {
        let (settings, radar) = (Settings::default(), Radar::default());
        let methods: Vec<Arc<dyn Reconstructor>> = vec![Arc::new(Baseline), Arc::new(CAPON)];
        let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
            let input = Input {
                settings: &settings,
                radar: &radar,
                noise_seed: 0,
                methods: &methods,
                method: Some(&Baseline),
                eta: Baseline.eta(),
                run: run(),
            };
            asked.extend(show(ui, input));
        };
        Harness::builder().with_size([420.0, 640.0]).build_ui_state(draw, Vec::new())
    }

    #[test]
    fn a_click_is_one_command_and_nothing_else_changes() {
        let mut controls = panel(Run::default);
        controls.run();
        assert!(controls.state().is_empty(), "nobody but the user moves anything: {:?}", controls.state());
        for label in ["hamming", "Two-way", "Exact", "found", "0.5 m", "Normalise"] {
            controls.get_by_label(label).click();
            controls.run();
        }
        let asked = [
            Command::SetWindow(WindowFunction::Hamming),
            Command::SetCarrier(Carrier::TwoWay),
            Command::SetFloor(Floor::Exact),
            Command::ToggleFound,
            Command::SetSnap(Snap::Metres(0.5)),
        ];
        assert_eq!(controls.state(), &asked, "and what is chosen already is not asked for");
    }

    #[test]
    fn the_focus_passes_through_a_threshold_without_rounding_it() {
        assert_eq!((moved(0.851, 0.85), moved(0.851, 0.86)), (None, Some(0.86)));
        let settings = Settings { target_eta: 0.851, ..Settings::default() };
        let (radar, capon) = (Radar::default(), CAPON);
        let draw = |ui: &mut Ui, asked: &mut Vec<Command>| {
            let (eta, run) = (0.123, Run::default());
            let (method, noise_seed): (Option<&dyn Reconstructor>, u64) = (Some(&capon), 0);
            let input = Input { settings: &settings, radar: &radar, noise_seed, methods: &[], method, eta, run };
            asked.extend(show(ui, input));
        };
        let mut controls = Harness::builder().with_size([420.0, 640.0]).build_ui_state(draw, Vec::new());
        for _ in 0..30 {
            controls.key_press(eframe::egui::Key::Tab);
            controls.run();
        }
        assert!(controls.state().is_empty(), "{:?}", controls.state());
    }

    #[test]
    fn figures_stand_beside_the_bar_that_cancels() {
        let metrics = Metrics { squared_error: 321.4, detection: Some(0.5), false_alarm: 0.01 };
        let scores = Scores { metrics, target_blobs: 1, output_blobs: 2 };
        let run = move || Run { progress: Some(0.25), scores: Some(scores), outdated: true, ..Run::default() };
        let mut controls = panel(run);
        let _told = (controls.get_by_label("321"), controls.get_by_label("1 blob in the target, 2 in the output"));
        controls.get_by_label("Cancel").click();
        controls.step();
        assert_eq!(controls.state(), &[Command::CancelMethod]);
    }
}
