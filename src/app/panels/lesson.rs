//! The lesson panel: predict first, then look, then change something until a condition holds.

mod answer;
mod list;

use crate::app::content::{Content, Cx};
use crate::app::state::{Command, LessonCommand, LessonRun, State};
use crate::app::widgets::{LARGE_TEXT_RATIO, button, inline, large, press};
pub use answer::LessonMemory;
use answer::{answer, answered, judgement, requirements};
use eframe::egui::{self, ScrollArea, TextureId, TextureOptions, Ui};
use list::list;

pub const PANEL: Content<LessonMemory> = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_, LessonMemory>) -> Vec<Command> {
    let hidden = cx.jobs.lessons.hidden();
    let texture = hidden.map(|image| cx.memory.hidden.of(ui.ctx(), "hidden", image, TextureOptions::NEAREST));
    show(ui, cx.state, texture, cx.memory)
}

/// Draws the lesson, or the list of lessons; `hidden` is the map to reproduce, where a challenge hides its scene.
pub fn show(ui: &mut Ui, state: &State, hidden: Option<TextureId>, memory: &mut LessonMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    let (lesson, presenting) = (state.lesson.as_ref(), state.is_presenting());
    if presenting {
        // Larger text for the last row of a lecture hall, as far as there is room.
        let times = (ui.available_height() / PROJECTED_HEIGHT).clamp(1.0, 1.4);
        ui.style_mut().text_styles.values_mut().for_each(|font| font.size *= times);
    }
    let begins = match lesson {
        Some(run) => memory.begin(run),
        None => false,
    };
    if let Some(run) = lesson {
        let frame = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 6));
        egui::Panel::bottom("steps").frame(frame).show(ui, |ui| steps(ui, run, presenting, &mut asked));
    }
    let asks = |run: &LessonRun| run.is_predicting() || run.current().is_some_and(|step| step.challenge.is_some());
    let is_pinned = memory.overflows && lesson.is_some_and(asks);
    if let Some(run) = lesson.filter(|_| is_pinned) {
        pinned_question(ui, run, hidden, memory, &mut asked);
    }
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
        let mut scroll = ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink([false, false]);
        if begins {
            scroll = scroll.vertical_scroll_offset(0.0);
        }
        let drawn = scroll.show(ui, |ui| {
            ui.set_max_width(ui.available_width().min(if presenting { 900.0 } else { 620.0 }));
            match lesson {
                None => {
                    whole_screen(ui, presenting, &mut asked);
                    list(ui, &state.progress, memory, &mut asked);
                }
                Some(run) => step(ui, run, hidden, is_pinned, memory, &mut asked),
            }
        });
        let overflows = drawn.content_size.y > drawn.inner_rect.height() + 1.0;
        if lesson.is_some() && overflows != memory.overflows && !is_pinned {
            memory.overflows = overflows;
            ui.ctx().request_discard("the question is kept in view");
        }
    });
    asked
}

/// Draws the question or the challenge at the foot of the panel, in view for any length of the text above.
fn pinned_question(
    ui: &mut Ui,
    run: &LessonRun,
    hidden: Option<TextureId>,
    memory: &mut LessonMemory,
    asked: &mut Vec<Command>,
) {
    let Some(step) = run.current() else { return };
    let most = MAX_QUESTION_HEIGHT_PART * ui.available_height();
    let frame = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 6));
    egui::Panel::bottom("question").frame(frame).show(ui, |ui| {
        // The height is that of the question, so that the rest is left for the text above.
        let scroll = ScrollArea::vertical().max_height(most).min_scrolled_height(most).auto_shrink([false, true]);
        scroll.show(ui, |ui| match (&step.predict, &step.challenge) {
            (Some(question), _) if run.is_predicting() => {
                ui.label(large(ui, &question.ask).strong());
                // In rows, which leaves more height for the text.
                ui.horizontal_wrapped(|ui| answer(ui, question, memory, asked));
            }
            (_, Some(challenge)) => requirements(ui, run, challenge, hidden, asked),
            _ => {}
        });
    });
}

/// Largest part of the panel's height that the pinned question takes.
const MAX_QUESTION_HEIGHT_PART: f32 = 0.7;

/// Height of the panel on the whole screen for which text has its usual size, points; text grows with the height.
const PROJECTED_HEIGHT: f32 = 380.0;

fn step(
    ui: &mut Ui,
    run: &LessonRun,
    hidden: Option<TextureId>,
    is_pinned: bool,
    memory: &mut LessonMemory,
    asked: &mut Vec<Command>,
) {
    let Some(step) = run.current() else { return };
    let place = format!("Step {} of {}", run.step + 1, run.lesson.steps.len());
    if is_pinned {
        ui.weak(format!("{} · {place}", run.lesson.title));
    } else {
        ui.heading(&run.lesson.title);
        ui.weak(place);
        ui.add_space(4.0);
    }
    ui.label(inline(ui, &step.text, LARGE_TEXT_RATIO));
    ui.add_space(8.0);
    if let Some(question) = step.predict.as_ref().filter(|_| !(is_pinned && run.is_predicting())) {
        ui.label(large(ui, &question.ask).strong());
        match run.guess {
            None => answer(ui, question, memory, asked),
            Some(guess) => {
                answered(ui, question, guess, run.judgement.as_ref().and_then(|j| j.as_ref().ok()));
                judgement(ui, run, &mut memory.told);
            }
        }
    }
    if let Some(challenge) = step.challenge.as_ref().filter(|_| !is_pinned && !run.is_predicting()) {
        ui.add_space(8.0);
        requirements(ui, run, challenge, hidden, asked);
    }
}

/// Draws the buttons that lead through the lesson, in sight for any length of the text.
fn steps(ui: &mut Ui, run: &LessonRun, presenting: bool, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(run.step > 0, egui::Button::new("Previous")).clicked() {
            asked.push(LessonCommand::Step(run.step - 1).into());
        }
        let is_last = run.step + 1 == run.lesson.steps.len();
        if !is_last {
            press(ui, "Next", "", LessonCommand::Step(run.step + 1), asked);
        }
        let leave = if is_last { "Finish" } else { "Exit lesson" };
        press(ui, leave, "Your scene, settings, panels and zoom come back", LessonCommand::Leave, asked);
        // In a presentation the button is in the bar at the top.
        if !presenting {
            whole_screen(ui, presenting, asked);
        }
    });
}

fn whole_screen(ui: &mut Ui, presenting: bool, asked: &mut Vec<Command>) {
    let label = if presenting { "Back to the window" } else { "Whole screen" };
    button(ui, label, LessonCommand::Present, true, asked);
}

#[cfg(test)]
mod tests;
