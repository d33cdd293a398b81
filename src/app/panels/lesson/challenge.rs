//! A challenge: its task, and how far the scene meets its criteria.

use super::answer::Symbol;
use super::large::large;
use crate::app::state::{Command, LessonCommand, LessonRun};
use crate::app::widgets::{press, theme};
use crate::lesson::{Challenge, Measured};
use eframe::egui::{self, Sense, Stroke, TextureId, Ui, Vec2};

/// Draws the challenge, its criteria and its buttons.
pub fn requirements(
    ui: &mut Ui,
    run: &LessonRun,
    challenge: &Challenge,
    hidden: Option<TextureId>,
    asked: &mut Vec<Command>,
) {
    ui.label(large(ui, &challenge.ask).strong());
    if let Some(texture) = hidden {
        ui.label("The map to reproduce:");
        let width = ui.available_width().min(420.0);
        ui.image((texture, egui::vec2(width, width / 2.0)));
    }
    match &run.measured {
        None => _ = ui.weak("measuring…"),
        Some(Err(reason)) => _ = ui.label(reason),
        Some(Ok(measured)) => {
            measured.iter().for_each(|measured| criterion(ui, measured));
        }
    }
    if run.gave_up {
        ui.label("The solution was shown: the challenge counts as unsolved.");
        press(
            ui,
            "Start this step again",
            "Puts the step's scene and radar back",
            LessonCommand::Step(run.step),
            asked,
        );
    } else if run.is_met() {
        ui.label(large(ui, "Solved. Keep experimenting or continue.").strong());
    } else {
        let tip = "Puts a scene and a radar on screen that meet it; the challenge then counts as unsolved";
        press(ui, "Show a solution", tip, LessonCommand::ShowSolution, asked);
    }
}

/// Draws a criterion as a sentence with the measured value. A tick or a ring says whether it is met.
fn criterion(ui: &mut Ui, measured: &Measured) {
    let (symbol, verdict) = if measured.holds { (Symbol::Tick, "met") } else { (Symbol::Ring, "not met yet") };
    let ink = if measured.holds { theme::verdict(ui.visuals(), true) } else { ui.visuals().weak_text_color() };
    ui.horizontal(|ui| {
        let (place, _) = ui.allocate_exact_size(Vec2::splat(14.0), Sense::hover());
        symbol.draw(ui.painter(), place.center(), 5.0, Stroke::new(2.0, ink));
        let text = format!("{} (now {}: {verdict})", measured.wanted, measured.found);
        ui.add(egui::Label::new(text).wrap());
    });
}
