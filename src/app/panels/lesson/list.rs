//! The list of lessons, with the progress in each.

use super::answer::LessonMemory;
use crate::app::state::{Command, LessonCommand, Purpose};
use crate::app::widgets::press;
use crate::lesson::{Lesson, Progress, shipped};
use crate::radar::counted;
use eframe::egui::{self, Color32, ProgressBar, RichText, TextEdit, Ui};

const PROGRESS_BAR_POINTS: f32 = 120.0;

/// Room for "0 of 5 steps", points.
const MIN_BAR: f32 = 84.0;

pub fn list(ui: &mut Ui, progress: &Progress, memory: &mut LessonMemory, asked: &mut Vec<Command>) {
    ui.label(
        "Each step asks a question before it shows the maps. Guess: a wrong guess teaches as much as a right one.",
    );
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Learner");
        let field = ui
            .add(TextEdit::singleline(&mut memory.learner).desired_width(120.0).char_limit(60).hint_text("your name"));
        if field.labelled_by(name.id).lost_focus() && memory.learner.trim() != progress.learner() {
            asked.push(LessonCommand::SetLearner(memory.learner.clone()).into());
        }
        let (made, right) = progress.score();
        if made > 0 {
            ui.weak(format!("{right} of {made} first guesses right"));
            ui.menu_button("Progress", |ui| start_over(ui, progress, asked));
        }
    });
    ui.add_space(6.0);
    for (index, lesson) in shipped::all_read() {
        if listed(ui, lesson, done(progress, shipped::ALL[*index].id, lesson)) {
            asked.push(LessonCommand::Begin(*index).into());
        }
    }
    ui.add_space(6.0);
    let tip = "A TOML file; docs/lessons.md says how to write one";
    press(ui, "Open a lesson file…", tip, Purpose::OpenLesson, asked);
}

fn start_over(ui: &mut Ui, progress: &Progress, asked: &mut Vec<Command>) {
    let whose = match progress.learner() {
        "" => "Forget every answer that was given here?".to_owned(),
        learner => format!("Forget every answer of {learner}?"),
    };
    ui.menu_button("Start over…", |ui| {
        ui.label(whose);
        ui.horizontal(|ui| {
            if ui.button("Forget them").clicked() {
                asked.push(LessonCommand::ForgetProgress.into());
                ui.close();
            }
            if ui.button("Keep them").clicked() {
                ui.close();
            }
        });
    });
}

/// Draws a line of the list: title, progress and subject. Returns whether it was clicked.
fn listed(ui: &mut Ui, lesson: &Lesson, done: usize) -> bool {
    ui.separator();
    let (steps, room) = (lesson.steps.len(), ui.available_width());
    let bar = PROGRESS_BAR_POINTS.min(0.3 * room).max(MIN_BAR);
    let clicked = ui.horizontal(|ui| {
        let title = egui::Button::new(RichText::new(&lesson.title).strong()).frame_when_inactive(false).wrap();
        let button = ui.scope(|ui| {
            ui.set_width(room - bar - 12.0);
            ui.add(title)
        });
        let button = button.inner;
        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &lesson.title));
        let clicked = button.on_hover_text("Begin this lesson").clicked();
        let text = format!("{done} of {}", counted(steps, "step", "steps"));
        let bar = ProgressBar::new(done as f32 / steps.max(1) as f32).desired_width(bar).text(text);
        // A bar of no progress would be drawn as a dot.
        ui.add(if done == 0 { bar.fill(Color32::TRANSPARENT) } else { bar });
        clicked
    });
    ui.label(RichText::new(&lesson.about).weak());
    clicked.inner
}

fn done(progress: &Progress, id: &str, lesson: &Lesson) -> usize {
    let steps = lesson.steps.iter().enumerate();
    let done = steps.filter(|(i, step)| {
        let record = progress.record(id, *i);
        (step.predict.is_none() || record.first_guess_right.is_some())
            && (step.challenge.is_none() || record.challenge_met)
    });
    done.count()
}
