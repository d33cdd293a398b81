//! A training watched: its loss, and how far it is.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::jobs::Log;
use crate::app::state::{Command, Purpose, WorkCommand};
use crate::app::widgets::axes::Axis;
use crate::app::widgets::chart::Chart;
use crate::app::widgets::entry::button;
use crate::app::widgets::legend::{self, Entry, Sign};
use crate::app::widgets::padded::padded;
use crate::app::widgets::progress::progress;
use crate::app::widgets::theme;
use eframe::egui::{Color32, Grid, Sense, Stroke, Ui};
use egui_plot::LineStyle;
use std::path::Path;

/// What is watched.
pub struct Input<'a> {
    /// The log that is followed.
    pub path: Option<&'a Path>,
    /// What it says.
    pub log: Option<&'a Log>,
    /// What is wrong with it, or how the training ended.
    pub note: Option<&'a str>,
    /// The part that is done of a training started from here.
    pub running: Option<f32>,
}

/// A recipe that a training can be started by.
struct Listed {
    name: &'static str,
    description: String,
}

/// The recipes, read once.
pub struct TrainingMemory {
    recipes: Vec<Listed>,
}

impl Default for TrainingMemory {
    #[cfg(feature = "network")]
    fn default() -> Self {
        use crate::network::recipe::{Recipe, SHIPPED};
        let read = |(name, text): &(&'static str, &'static str)| {
            Recipe::parse(name, text).ok().map(|recipe| Listed { name, description: recipe.description })
        };
        TrainingMemory { recipes: SHIPPED.iter().filter_map(read).collect() }
    }

    #[cfg(not(feature = "network"))]
    fn default() -> Self {
        TrainingMemory { recipes: Vec::new() }
    }
}

/// Draws [`Panel::Training`](crate::app::state::Panel::Training).
pub struct TrainingPanel;

impl Content for TrainingPanel {
    type Asks = Nothing;
    type Remembers = TrainingMemory;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let job = &cx.jobs.training;
        let running = job.is_running().then(|| job.progress().unwrap_or(0.0));
        show(ui, Input { path: job.path(), log: job.log(), note: job.note(), running }, cx.memory)
    }
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut TrainingMemory) -> Vec<Command> {
    padded(ui, |ui, asked| {
        ui.horizontal_wrapped(|ui| {
            button(ui, "Open training log…", Purpose::OpenLog, true, asked);
            match input.running {
                Some(part) => {
                    if progress(ui, part, 140.0, "Stop the training; its last checkpoint stays") {
                        asked.push(WorkCommand::CancelTraining.into());
                    }
                }
                None => start(ui, memory, asked),
            }
        });
        if let Some(note) = input.note {
            ui.colored_label(ui.visuals().warn_fg_color, note);
        }
        match input.log.filter(|l| !l.loss.is_empty()) {
            Some(log) => curves(ui, log),
            None => _ = ui.weak(waiting(&input)),
        }
    })
}

/// What stands where there is no curve yet.
fn waiting(input: &Input<'_>) -> String {
    match input.path {
        // Who was told how it ended waits for nothing.
        Some(path) if input.note.is_none() => format!("Waiting for the first line of {}…", path.display()),
        Some(path) => format!("{} has no line.", path.display()),
        None => "Open the log.csv of a training (apertura train), and watch its loss while it learns.".to_owned(),
    }
}

fn curves(ui: &mut Ui, log: &Log) {
    Grid::new("last").num_columns(8).spacing([10.0, 2.0]).show(ui, |ui| {
        for (i, (name, value)) in log.last.iter().enumerate() {
            ui.weak(name.replace('_', " "));
            ui.monospace(value.parse::<f64>().map_or_else(|_| value.clone(), short));
            if i % 4 == 3 {
                ui.end_row();
            }
        }
    });
    let log10 = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        points.iter().filter(|p| p[1] > 0.0).map(|p| [p[0], p[1].log10()]).collect()
    };
    let lines = [("loss", Color32::GRAY), ("smoothed", theme::Inks::of(ui.visuals()).selected)];
    let entry = |(name, colour): (&str, Color32)| Entry { sign: Sign::Line, colour, name: name.to_owned() };
    legend::row(ui, &lines.map(entry));
    let loss = log10(&log.loss);
    let ends = |axis: usize, room: f64| {
        let (low, high) =
            loss.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        let room = room * (high - low).max(1e-3);
        if low <= high { [low - room, high + room] } else { [0.0, 1.0] }
    };
    let ([first, last], [low, high]) = (ends(0, 0.0), ends(1, 0.05));
    let (x, y) = (Axis::new(first, last.max(first + 1.0), "step"), Axis::new(low, high, "loss, powers of ten"));
    let mut chart = Chart::new("Loss against step", x, y).with_zoom();
    chart.line(loss.iter().copied(), Stroke::new(1.0, Color32::GRAY), LineStyle::Solid);
    chart.line(log10(&log.smoothed), Stroke::new(1.8, lines[1].1), LineStyle::Solid);
    let drawn = chart.show(ui, ui.available_rect_before_wrap(), Sense::click_and_drag());
    drawn.tell(|[step, power]| Some(format!("step {step:.0}\nloss {:.3e}", 10f64.powf(power))));
}

/// A number with as many digits as one looks at.
fn short(value: f64) -> String {
    if value == value.trunc() && value.abs() < 1e9 { format!("{value}") } else { format!("{value:.4e}") }
}

/// A menu of the recipes that can be started.
fn start(ui: &mut Ui, memory: &TrainingMemory, asked: &mut Vec<Command>) {
    if memory.recipes.is_empty() {
        ui.weak("This build can't train.");
        return;
    }
    let menu = ui.menu_button("Train…", |ui| {
        ui.weak("Starts a training on this machine's processor, which it will keep busy for long.");
        for recipe in &memory.recipes {
            if ui.button(recipe.name).on_hover_text(&recipe.description).clicked() {
                ui.close();
                asked.push(WorkCommand::Train(recipe.name).into());
            }
        }
    });
    menu.response.on_hover_text("Start a training by a recipe and watch it");
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(note: Option<&'static str>, running: Option<f32>) -> Harness<'static, (TrainingMemory, Vec<Command>)> {
        let draw = move |ui: &mut Ui, state: &mut (TrainingMemory, Vec<Command>)| {
            let input = Input { path: Some(Path::new("log.csv")), log: None, note, running };
            let commands = show(ui, input, &mut state.0);
            state.1.extend(commands);
        };
        Harness::builder().with_size([500.0, 300.0]).build_ui_state(draw, Default::default())
    }

    #[test]
    fn a_training_that_was_stopped_waits_for_nothing() {
        let mut waits = panel(None, Some(0.0));
        let _waiting = waits.get_by_label_contains("Waiting for the first line");
        waits.get_by_label("Cancel").click();
        waits.step();
        assert_eq!(waits.state().1, [Command::Work(WorkCommand::CancelTraining)]);
        let stopped = panel(Some("stopped"), None);
        assert!(stopped.query_by_label_contains("Waiting").is_none());
    }
}
