//! A guide: what the maps show and why, each paragraph with a button that sets it up.

use crate::app::state::{Command, MapKind, Panel, Projection};
use crate::maps::Normalisation;
use crate::radar::{Carrier, Decibels, WindowFunction};
use crate::scene::presets;
use crate::signal::Floor;
use eframe::egui;
use eframe::egui::{ScrollArea, Ui};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};

/// The text: chapters that begin with a heading, in the order of [`CHAPTERS`].
const TEXT: &str = include_str!("../../../assets/guide.md");

/// Something to try: what the button says and what it does.
struct Step {
    label: &'static str,
    commands: fn() -> Vec<Command>,
}

/// The buttons beneath each chapter of the text.
const CHAPTERS: &[&[Step]] = &[
    &[Step { label: "Open the street", commands: || scene("street", thesis()) }],
    &[
        Step { label: "One reflector at 20 m", commands: || scene("one-at-20-m", thesis()) },
        Step { label: "A tenth of a radian off", commands: || scene("one-at-20-m-a-tenth-of-a-radian-off", thesis()) },
    ],
    &[Step { label: "Rings around four blobs", commands: || scene("four-reflectors", rings(thesis())) }],
    &[
        Step { label: "Four reflectors, Hann", commands: || scene("four-reflectors", window(WindowFunction::Hann)) },
        Step { label: "No window", commands: || scene("four-reflectors", window(WindowFunction::Rectangular)) },
        Step { label: "Hamming", commands: || scene("four-reflectors", window(WindowFunction::Hamming)) },
    ],
    &[
        Step { label: "Points by a line", commands: || scene("points-by-a-line", thesis()) },
        Step { label: "A point behind a line", commands: || scene("point-behind-a-line", thesis()) },
    ],
    &[
        Step { label: "Two points, two bins apart", commands: || scene("two-close-in-range", thesis()) },
        Step { label: "Show the bounds", commands: || vec![Command::OpenPanel(Panel::Bounds)] },
    ],
    &[
        Step { label: "One-way", commands: || scene("four-reflectors", vec![Command::SetCarrier(Carrier::OneWay)]) },
        Step { label: "Two-way", commands: || scene("four-reflectors", vec![Command::SetCarrier(Carrier::TwoWay)]) },
    ],
    &[
        Step { label: "Beyond the range", commands: || scene("beyond-the-range", thesis()) },
        Step {
            label: "The same, Cartesian",
            commands: || scene("beyond-the-range", vec![Command::SetProjection(Projection::Cartesian)]),
        },
    ],
    &[
        Step { label: "Thesis floor", commands: || floor(Floor::Thesis, Normalisation::MinMax) },
        Step { label: "No floor", commands: || floor(Floor::Exact, Normalisation::MinMax) },
        Step {
            label: "100 dB below the peak",
            commands: || floor(Floor::Exact, Normalisation::DynamicRange(Decibels(100.0))),
        },
        Step { label: "SNR 20 dB", commands: || floor(Floor::Snr(Decibels(20.0)), Normalisation::MinMax) },
    ],
    &[
        Step {
            label: "Difference",
            commands: || scene("test-set-3", vec![Command::OpenPanel(Panel::Map(MapKind::Difference))]),
        },
        Step { label: "ROC", commands: || vec![Command::OpenPanel(Panel::Roc)] },
        Step { label: "Tables", commands: || vec![Command::OpenPanel(Panel::Evaluation)] },
    ],
    &[
        Step { label: "The failing U-Net", commands: || output_by("unet") },
        Step { label: "The thesis' network", commands: || output_by("thesis") },
        Step { label: "The live network", commands: || output_by("live") },
        Step { label: "A search for reflectors", commands: || output_by("hybrid") },
    ],
];

/// Opens a preset, then does the rest.
fn scene(id: &str, then: Vec<Command>) -> Vec<Command> {
    let preset = presets::ALL.iter().position(|p| p.id == id).map(Command::Preset);
    preset.into_iter().chain(then).collect()
}

/// A method, its map in sight.
fn output_by(method: &'static str) -> Vec<Command> {
    vec![Command::OpenPanel(Panel::Map(MapKind::Output)), Command::Method(method)]
}

/// The thesis' conventions.
fn thesis() -> Vec<Command> {
    vec![
        Command::SetFloor(Floor::Thesis),
        Command::Normalise(Normalisation::MinMax),
        Command::SetWindow(WindowFunction::Hann),
        Command::SetCarrier(Carrier::OneWay),
    ]
}

/// The true reflectors over the maps besides.
fn rings(mut then: Vec<Command>) -> Vec<Command> {
    then.push(Command::MarkReflectors);
    then
}

/// A window without a floor, so that its side lobes are all there is to see.
fn window(window: WindowFunction) -> Vec<Command> {
    vec![
        Command::SetFloor(Floor::Exact),
        Command::Normalise(Normalisation::DynamicRange(Decibels(100.0))),
        Command::SetWindow(window),
    ]
}

fn floor(floor: Floor, normalisation: Normalisation) -> Vec<Command> {
    scene("one-at-20-m", vec![Command::SetFloor(floor), Command::Normalise(normalisation)])
}

/// The chapters of [`TEXT`].
fn chapters() -> impl Iterator<Item = &'static str> {
    let starts = TEXT.match_indices("## ").filter(|(i, _)| *i == 0 || TEXT.as_bytes()[i - 1] == b'\n').map(|(i, _)| i);
    let mut starts = starts.peekable();
    std::iter::from_fn(move || {
        let start = starts.next()?;
        Some(&TEXT[start..starts.peek().copied().unwrap_or(TEXT.len())])
    })
}

/// What the text needs from frame to frame.
#[derive(Default)]
pub struct Memory {
    cache: CommonMarkCache,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            ui.set_max_width(ui.available_width().min(620.0));
            for (chapter, steps) in chapters().zip(CHAPTERS) {
                CommonMarkViewer::new().show(ui, &mut memory.cache, chapter);
                ui.horizontal_wrapped(|ui| {
                    for step in *steps {
                        if ui
                            .button(step.label)
                            .on_hover_text("Set it up; undo brings your scene and your settings back")
                            .clicked()
                        {
                            asked.push(Command::Guided((step.commands)()));
                        }
                    }
                });
                ui.add_space(14.0);
            }
        });
    });
    asked
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_button_asks_for_its_preset_and_its_conventions() {
        let draw = |ui: &mut Ui, state: &mut (Memory, Vec<Command>)| {
            let commands = show(ui, &mut state.0);
            state.1.extend(commands);
        };
        let mut guide = Harness::builder().with_size([640.0, 9000.0]).build_ui_state(draw, Default::default());
        guide.get_by_role_and_label(egui::accesskit::Role::Button, "Hamming").click();
        guide.step();
        let steps = scene("four-reflectors", window(WindowFunction::Hamming));
        assert_eq!(guide.state().1, [Command::Guided(steps)]);
    }

    #[test]
    fn every_chapter_has_its_buttons_and_every_button_does_something() {
        assert_eq!(chapters().count(), CHAPTERS.len());
        for (chapter, steps) in chapters().zip(CHAPTERS) {
            assert!(chapter.lines().count() > 1 && !steps.is_empty(), "{chapter}");
            for step in *steps {
                let commands = (step.commands)();
                assert!(!commands.is_empty(), "{}", step.label);
                let opens = matches!(commands[0], Command::Preset(_) | Command::OpenPanel(_));
                assert!(opens, "{}: a preset of that name", step.label);
            }
        }
    }
}
