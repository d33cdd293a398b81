//! Settings: radar and floor, display, reconstruction with its live figures.

use super::application::App;
use super::command::Command;
use super::jobs;
use super::settings::Projection;
use crate::interact::Snap;
use crate::maps::Normalisation;
use crate::picture::ColourMap;
use crate::radar::{Carrier, Decibels, WindowFunction};
use crate::signal::Floor;
use eframe::egui;
use eframe::egui::{ComboBox, DragValue, Grid, ScrollArea, Slider, SliderClamping, Ui};

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            heading(ui, "Reconstruction");
            reconstruction(app, ui);
            ui.add_space(6.0);
            heading(ui, "Maps");
            Grid::new("maps").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
                normalisation(app, ui);
                floor(app, ui);
                carrier(app, ui);
                window(app, ui);
            });
            ui.add_space(6.0);
            heading(ui, "Display");
            Grid::new("display").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| display(app, ui));
        });
    });
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

fn reconstruction(app: &mut App, ui: &mut Ui) {
    let Some(method) = app.method() else {
        ui.weak("This build has no reconstruction method.");
        return;
    };
    let methods = app.pipeline.methods.clone();
    Grid::new("reconstruction").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
        row(ui, "Method", method.description(), |ui| {
            let mut chosen = method.name().to_owned();
            let response =
                ComboBox::from_id_salt("method").width(150.0).selected_text(method.name()).show_ui(ui, |ui| {
                    for m in &methods {
                        ui.selectable_value(&mut chosen, m.name().to_owned(), m.name()).on_hover_text(m.description());
                    }
                });
            if chosen != method.name() {
                app.settings.method = chosen;
            }
            response.response
        });
        let mut eta = app.output_eta();
        row(ui, "η", "Cells of the output above this count as detections", |ui| {
            ui.horizontal(|ui| {
                let slider = ui.add(threshold(&mut eta));
                if slider.changed() {
                    app.settings.method_eta.insert(method.name().to_owned(), eta);
                }
                let own = app.settings.method_eta.contains_key(method.name());
                let reset = ui.add_enabled(own, egui::Button::new("Reset").small());
                if reset.on_hover_text(format!("Back to the method's own η = {}", method.eta())).clicked() {
                    app.settings.method_eta.remove(method.name());
                }
                slider
            })
            .inner
        });
        row(ui, "η'", "Cells of the target above this are drawn in the panel Target > η'", |ui| {
            ui.add(threshold(&mut app.settings.target_eta))
        });
    });
    figures(app, ui);
}

/// A slider that shows two decimals; what nobody moves keeps all of its own.
fn threshold(eta: &mut f32) -> Slider<'_> {
    Slider::new(eta, 0.0..=1.0).fixed_decimals(2).clamping(SliderClamping::Edits)
}

/// P_D, P_FA and SE, or why there are none.
fn figures(app: &mut App, ui: &mut Ui) {
    if let Some(progress) = app.pipeline.method_progress() {
        if jobs::progress(ui, progress, 150.0, "Stop this reconstruction; the last output stays") {
            app.commands.push(Command::CancelMethod);
        }
    } else if let Some(error) = &app.pipeline.method_error {
        ui.colored_label(ui.visuals().error_fg_color, error);
    } else if let Some(output) = &app.pipeline.output {
        ui.weak(format!("{} took {:.1} ms", output.method, output.took.as_secs_f64() * 1e3));
    } else {
        ui.weak("Show an output panel to reconstruct.");
    }
    let Some(scores) = app.pipeline.result.as_ref().and_then(|r| r.scores) else { return };
    if let (0, Some(method)) = (scores.output_blobs, app.method()) {
        ui.weak(format!("Nothing exceeds η. {}: {}.", method.name(), method.description()));
    }
    let m = scores.metrics;
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
    ui.weak(format!("{} blobs in the target, {} in the output", scores.target_blobs, scores.output_blobs))
        .on_hover_text("Regions of touching cells above η' and η");
}

fn percent(part: f64) -> String {
    format!("{:.2} %", part * 100.0)
}

fn normalisation(app: &mut App, ui: &mut Ui) {
    let settings = &mut app.settings;
    let tooltip =
        "How magnitudes become Λ in [0, 1]. Min-max is the thesis'; a dynamic range doesn't depend on the floor";
    row(ui, "Normalise", tooltip, |ui| {
        ui.horizontal(|ui| {
            let min_max = settings.normalisation == Normalisation::MinMax;
            let response = ui.selectable_label(min_max, "Min–max");
            if response.clicked() {
                settings.normalisation = Normalisation::MinMax;
            }
            if ui.selectable_label(!min_max, "Range").clicked() {
                settings.normalisation = Normalisation::DynamicRange(settings.dynamic_range);
            }
            if let Normalisation::DynamicRange(db) = &mut settings.normalisation {
                ui.add(DragValue::new(&mut db.0).range(10.0..=300.0).speed(1.0).suffix(" dB"));
                settings.dynamic_range = *db;
            }
            response
        })
        .inner
    });
}

fn floor(app: &mut App, ui: &mut Ui) {
    let settings = &mut app.settings;
    row(ui, "Floor", "What lies beneath the reflectors", |ui| {
        ui.horizontal(|ui| {
            let response = ui
                .selectable_label(settings.floor == Floor::Thesis, "Thesis")
                .on_hover_text("The rounding noise of the thesis' f64 evaluation");
            if response.clicked() {
                settings.floor = Floor::Thesis;
            }
            let exact = ui.selectable_label(settings.floor == Floor::Exact, "Exact");
            if exact.on_hover_text("No noise at all").clicked() {
                settings.floor = Floor::Exact;
            }
            let noisy = matches!(settings.floor, Floor::Snr(_));
            if ui.selectable_label(noisy, "SNR").on_hover_text("Thermal noise at a signal-to-noise ratio").clicked() {
                settings.floor = Floor::Snr(settings.snr);
            }
            if let Floor::Snr(Decibels(db)) = &mut settings.floor {
                ui.add(DragValue::new(db).range(-40.0..=200.0).speed(0.5).suffix(" dB"));
                settings.snr = Decibels(*db);
            }
            response
        })
        .inner
    });
    if settings.floor != Floor::Exact {
        row(ui, "Noise seed", "The same seed gives the same noise", |ui| {
            ui.add(DragValue::new(&mut settings.seed).speed(0.05))
        });
    }
}

fn carrier(app: &mut App, ui: &mut Ui) {
    let mut carrier = app.settings.carrier;
    row(ui, "Carrier", "One-way is unambiguous; two-way (as equation 3.1 is printed) folds cos θ twice", |ui| {
        ui.horizontal(|ui| {
            let response = ui.selectable_value(&mut carrier, Carrier::OneWay, "One-way");
            ui.selectable_value(&mut carrier, Carrier::TwoWay, "Two-way");
            response
        })
        .inner
    });
    if carrier != app.settings.carrier {
        app.commands.push(Command::SetCarrier(carrier));
    }
}

fn window(app: &mut App, ui: &mut Ui) {
    let mut window = app.settings.window;
    row(
        ui,
        "Window",
        "Weights of samples and elements in both transforms: low side lobes cost a wide main lobe",
        |ui| {
            ui.horizontal(|ui| {
                let mut first = None;
                for choice in WindowFunction::ALL {
                    let tooltip = Command::SetWindow(choice).spec().tooltip;
                    let response = ui.selectable_value(&mut window, choice, choice.name()).on_hover_text(tooltip);
                    first.get_or_insert(response);
                }
                first.unwrap_or_else(|| ui.label(""))
            })
            .inner
        },
    );
    if window != app.settings.window {
        app.commands.push(Command::SetWindow(window));
    }
}

fn display(app: &mut App, ui: &mut Ui) {
    let settings = &mut app.settings;
    row(ui, "Coordinates", "Draw maps over cos θ and range, or over x and y", |ui| {
        ui.horizontal(|ui| {
            let response = ui.selectable_value(&mut settings.projection, Projection::RangeAngle, "Range–angle");
            ui.selectable_value(&mut settings.projection, Projection::Cartesian, "Cartesian");
            response
        })
        .inner
    });
    row(ui, "Colours", "Colours of Λ", |ui| {
        ui.horizontal(|ui| {
            let mut first = None;
            for colours in ColourMap::ALL {
                let response = ui.selectable_value(&mut settings.colours, colours, colours.name());
                first.get_or_insert(response);
            }
            first.unwrap_or_else(|| ui.label(""))
        })
        .inner
    });
    row(ui, "Mark", "What is drawn over maps and scene", |ui| {
        ui.horizontal_wrapped(|ui| {
            let response = ui
                .checkbox(&mut settings.show_reflectors, "reflectors")
                .on_hover_text("The scene's own reflectors, over every map (R)");
            ui.checkbox(&mut settings.show_found, "found").on_hover_text("Reflectors that the method believes in");
            ui.checkbox(&mut settings.show_fields_of_view, "views")
                .on_hover_text("What each end can see, in the scene (V)");
            response
        })
        .inner
    });
    row(ui, "Snap", "Where dragged objects come to rest", |ui| {
        ui.horizontal(|ui| {
            let response = ui.selectable_value(&mut settings.snap, Snap::Off, "Off");
            ui.selectable_value(&mut settings.snap, Snap::Metres(0.5), "0.5 m");
            ui.selectable_value(&mut settings.snap, Snap::Cells, "Cells").on_hover_text("Whole range bins and columns");
            response
        })
        .inner
    });
}
