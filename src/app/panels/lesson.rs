//! Lessons: predict first, then look, then change something until a condition holds.

use crate::app::state::{Command, LessonCommand, LessonRun};
use crate::app::widgets::entry::button;
use crate::app::widgets::inline::inline;
use crate::app::widgets::number_field::{NumberField, Wanted};
use crate::app::widgets::theme;
use crate::lesson::question::{Answer, number_text};
use crate::lesson::shipped::Shipped;
use crate::lesson::{Challenge, Guess, Judgement, Lesson, Progress, Question, Truth};
use crate::radar::counted;
use eframe::egui;
use eframe::egui::{
    Color32, ProgressBar, RichText, ScrollArea, Sense, Slider, Stroke, TextEdit, TextureId, Ui, Vec2, pos2, vec2,
};
use std::sync::OnceLock;

/// What is shown.
pub struct Input<'a> {
    /// The lesson being taken; the list of lessons without.
    pub run: Option<&'a LessonRun>,
    /// What the learner did so far.
    pub progress: &'a Progress,
    /// The map that is to be explained, where the step hides something.
    pub hidden: Option<TextureId>,
    /// Whether lessons have the whole screen.
    pub presenting: bool,
}

/// What was typed but not answered yet.
#[derive(Default)]
pub struct Memory {
    number: String,
    eta: f32,
    learner: String,
    /// Whether the judgement was brought into sight.
    told: bool,
    /// Lesson and step these belong to.
    of: Option<(String, usize)>,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    if input.presenting {
        // Read from the last row of a lecture hall.
        ui.style_mut().text_styles.values_mut().for_each(|font| font.size *= 1.4);
    }
    if let Some(run) = input.run {
        let frame = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 6));
        egui::Panel::bottom("steps").frame(frame).show(ui, |ui| steps(ui, run, input.presenting, &mut asked));
    }
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            ui.set_max_width(ui.available_width().min(if input.presenting { 900.0 } else { 620.0 }));
            match input.run {
                None => {
                    whole_screen(ui, input.presenting, &mut asked);
                    list(ui, input.progress, memory, &mut asked);
                }
                Some(run) => {
                    let of = Some((run.id.clone(), run.step));
                    if memory.of != of {
                        *memory =
                            Memory { of, eta: 0.5, learner: std::mem::take(&mut memory.learner), ..Memory::default() };
                    }
                    step(ui, run, &input, memory, &mut asked);
                }
            }
        });
    });
    asked
}

/// The shipped lessons, read once.
fn shipped() -> &'static [(&'static Shipped, Lesson)] {
    static READ: OnceLock<Vec<(&'static Shipped, Lesson)>> = OnceLock::new();
    READ.get_or_init(|| crate::lesson::shipped::ALL.iter().filter_map(|s| Some((s, s.load().ok()?))).collect())
}

fn list(ui: &mut Ui, progress: &Progress, memory: &mut Memory, asked: &mut Vec<Command>) {
    ui.label(
        "Each step asks a question before it shows the maps. Guess: a wrong guess teaches as much as a right one.",
    );
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Learner");
        let field =
            ui.add(TextEdit::singleline(&mut memory.learner).desired_width(120.0).char_limit(60).hint_text("anybody"));
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
    for (index, (file, lesson)) in shipped().iter().enumerate() {
        if listed(ui, lesson, done(progress, file.id, lesson)) {
            asked.push(LessonCommand::Begin(index).into());
        }
    }
    ui.add_space(6.0);
    if ui.button("Open a lesson file…").on_hover_text("A TOML file; docs/lessons.md says how to write one").clicked()
    {
        asked.push(LessonCommand::Open.into());
    }
}

/// Asks before it forgets what the learner did.
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

/// A line of the list: the title, how far the lesson was taken, and what it is about. Whether it was clicked.
fn listed(ui: &mut Ui, lesson: &Lesson, done: usize) -> bool {
    ui.separator();
    let (steps, room) = (lesson.steps.len(), ui.available_width());
    let bar = BAR.min(0.4 * room);
    let clicked = ui.horizontal(|ui| {
        let title = RichText::new(&lesson.title).strong();
        let height = ui.spacing().interact_size.y;
        let title = egui::Button::new(title).right_text("").frame_when_inactive(false).truncate();
        let button = ui.add_sized([room - bar - 12.0, height], title);
        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &lesson.title));
        let clicked = button.on_hover_text("Begin this lesson").clicked();
        let text = format!("{done} of {}", counted(steps, "step", "steps"));
        let bar = ProgressBar::new(done as f32 / steps.max(1) as f32).desired_width(bar).text(text);
        // A bar of nothing would still be drawn as a dot.
        ui.add(if done == 0 { bar.fill(Color32::TRANSPARENT) } else { bar });
        clicked
    });
    ui.label(RichText::new(&lesson.about).weak());
    clicked.inner
}

/// How many steps of a lesson are done.
fn done(progress: &Progress, id: &str, lesson: &Lesson) -> usize {
    let steps = lesson.steps.iter().enumerate();
    let done = steps.filter(|(i, step)| {
        let record = progress.record(id, *i);
        (step.predict.is_none() || record.first_guess_right.is_some())
            && (step.challenge.is_none() || record.challenge_met)
    });
    done.count()
}

fn step(ui: &mut Ui, run: &LessonRun, input: &Input<'_>, memory: &mut Memory, asked: &mut Vec<Command>) {
    let Some(step) = run.current() else { return };
    ui.heading(&run.lesson.title);
    ui.weak(format!("Step {} of {}", run.step + 1, run.lesson.steps.len()));
    ui.add_space(4.0);
    ui.label(inline(ui, &step.text, LARGE));
    ui.add_space(8.0);
    if let Some(question) = &step.predict {
        ui.label(large(ui, &question.ask).strong());
        match run.guess {
            None => answer(ui, question, memory, asked),
            Some(guess) => {
                answered(ui, question, guess, run.judgement.as_ref().and_then(|j| j.as_ref().ok()));
                judgement(ui, run, &mut memory.told);
            }
        }
    }
    if let Some(challenge) = step.challenge.as_ref().filter(|_| !run.is_predicting()) {
        ui.add_space(8.0);
        requirements(ui, run, challenge, input.hidden, asked);
    }
}

/// The way through the lesson: always in sight, however long the text is.
fn steps(ui: &mut Ui, run: &LessonRun, presenting: bool, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(run.step > 0, egui::Button::new("Previous")).clicked() {
            asked.push(LessonCommand::Step(run.step - 1).into());
        }
        let is_last = run.step + 1 == run.lesson.steps.len();
        if !is_last && ui.button("Next").clicked() {
            asked.push(LessonCommand::Step(run.step + 1).into());
        }
        let leave = if is_last { "Finish" } else { "Exit lesson" };
        if ui.button(leave).on_hover_text("Your scene, settings, panels and zoom come back").clicked() {
            asked.push(LessonCommand::Leave.into());
        }
        whole_screen(ui, presenting, asked);
    });
}

/// Width of a bar that shows how far a lesson was taken, points.
const BAR: f32 = 120.0;

/// Text that is to be read first is this much larger than the rest.
const LARGE: f32 = 1.15;

/// Such a text.
fn large(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(LARGE * egui::TextStyle::Body.resolve(ui.style()).size)
}

/// For a projector.
fn whole_screen(ui: &mut Ui, presenting: bool, asked: &mut Vec<Command>) {
    let label = if presenting { "Back to the window" } else { "Whole screen" };
    button(ui, label, LessonCommand::Present, true, asked);
}

fn answer(ui: &mut Ui, question: &Question, memory: &mut Memory, asked: &mut Vec<Command>) {
    match &question.answer {
        Answer::Click { map, .. } => {
            ui.label(format!("Click in {}. The maps are hidden until you do.", map.words()));
        }
        Answer::Number { unit, .. } => {
            ui.horizontal(|ui| {
                let field = ui.add(TextEdit::singleline(&mut memory.number).desired_width(90.0).hint_text("a number"));
                field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Your number"));
                ui.label(unit);
                let read = Wanted { unit: unit.clone(), ..Wanted::any() }.read(&memory.number);
                let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
                let clicked = ui.add_enabled(read.is_ok(), egui::Button::new("Answer")).clicked();
                match read {
                    Ok(number) if clicked || entered => {
                        asked.push(LessonCommand::Predict(Guess::Number(number)).into())
                    }
                    Ok(_) => {}
                    Err(_) if memory.number.trim().is_empty() => {}
                    Err(message) => {
                        _ = ui.colored_label(ui.visuals().error_fg_color, message);
                        if entered {
                            field.request_focus();
                        }
                    }
                }
            });
        }
        Answer::Choice { options, .. } => {
            for (index, option) in options.iter().enumerate() {
                if ui.button(option).clicked() {
                    asked.push(LessonCommand::Predict(Guess::Choice(index + 1)).into());
                }
            }
        }
        Answer::Threshold { .. } => {
            ui.horizontal(|ui| {
                ui.add(Slider::new(&mut memory.eta, 0.0..=1.0).show_value(false).text("threshold"));
                let field = NumberField::new(&mut memory.eta).range(0.0..=1.0).speed(0.005).max_decimals(2);
                let field = ui.add(field);
                ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("threshold in numbers"));
                if ui.button("Answer").clicked() {
                    asked.push(LessonCommand::Predict(Guess::Eta(memory.eta)).into());
                }
            });
        }
    }
}

/// The guess beside the truth: places are drawn on their map instead.
fn answered(ui: &mut Ui, question: &Question, guess: Guess, judged: Option<&Judgement>) {
    let truth = judged.map(|j| j.truth);
    match (&question.answer, guess) {
        (Answer::Choice { options, .. }, Guess::Choice(chosen)) => {
            let right = if let Some(Truth::Choice(right)) = truth { Some(right) } else { None };
            for (option, number) in options.iter().zip(1..) {
                let said = match (number == chosen, right == Some(number)) {
                    (true, true) => "your answer, right",
                    (true, false) if right.is_some() => "your answer, wrong",
                    (true, false) => "your answer",
                    (false, true) => "the right answer",
                    (false, false) => "",
                };
                ui.horizontal(|ui| {
                    ui.add_enabled(false, egui::Button::new(option));
                    ui.label(said);
                });
            }
        }
        (Answer::Number { unit, .. }, Guess::Number(number)) => {
            let exact =
                if let Some(Truth::Number(exact)) = truth { number_text(exact, unit) } else { "…".to_owned() };
            ui.label(format!("Your answer: {}. Exact: {exact}.", number_text(number, unit)));
        }
        (Answer::Threshold { .. }, Guess::Eta(eta)) => {
            let right = if let Some(Truth::Etas { low, high }) = truth { Some((low, high)) } else { None };
            threshold(ui, eta, right);
        }
        _ => {}
    }
}

/// The threshold that was chosen on a scale from 0 to 1, and those that are right.
fn threshold(ui: &mut Ui, eta: f32, right: Option<(f32, f32)>) {
    let (scale, _) = ui.allocate_exact_size(vec2(ui.available_width().min(300.0), 14.0), Sense::hover());
    let at = |value: f32| scale.left() + value.clamp(0.0, 1.0) * scale.width();
    let painter = ui.painter();
    painter.rect_filled(scale, 2.0, ui.visuals().extreme_bg_color);
    if let Some((low, high)) = right.filter(|(low, high)| low < high) {
        let band = egui::Rect::from_x_y_ranges(at(low)..=at(high), scale.y_range());
        painter.rect_filled(band, 2.0, Color32::from_rgb(60, 140, 80));
    }
    let guess = [pos2(at(eta), scale.top()), pos2(at(eta), scale.bottom())];
    painter.line_segment(guess, Stroke::new(3.0, Color32::from_rgb(255, 170, 60)));
    let told = right.map_or_else(String::new, |_| " The green part of the scale is right.".to_owned());
    ui.label(format!("Your answer: {eta:.2}.{told}"));
}

fn judgement(ui: &mut Ui, run: &LessonRun, told: &mut bool) {
    match &run.judgement {
        None => _ = ui.weak("computing…"),
        Some(Err(reason)) => _ = ui.label(format!("This can't be judged: {reason}")),
        Some(Ok(judged)) => {
            verdict(ui, judged.is_right, &judged.distance);
            let sentence = ui.label(inline(ui, &judged.sentence, LARGE));
            if !std::mem::replace(told, true) {
                sentence.scroll_to_me(None);
            }
        }
    }
}

/// A coloured line with a symbol: neither alone tells right from wrong.
fn verdict(ui: &mut Ui, is_right: bool, distance: &str) {
    let (said, symbol) = if is_right { ("Correct", Symbol::Tick) } else { ("Not quite", Symbol::Cross) };
    let ink = theme::verdict(ui.visuals(), is_right);
    let text = large(ui, format!("{said}: {distance}.")).strong().color(ink);
    let frame = egui::Frame::NONE.inner_margin(egui::Margin { left: 8, right: 6, top: 4, bottom: 4 });
    let line = frame.fill(ink.gamma_multiply(0.12)).show(ui, |ui| {
        ui.horizontal(|ui| {
            let (place, _) = ui.allocate_exact_size(Vec2::splat(16.0), Sense::hover());
            symbol.draw(ui.painter(), place.center(), 6.0, Stroke::new(2.4, ink));
            ui.add(egui::Label::new(text).wrap());
        });
    });
    let bar = line.response.rect;
    ui.painter().line_segment([bar.left_top(), bar.left_bottom()], Stroke::new(3.0, ink));
}

/// What stands before a verdict.
#[derive(Clone, Copy)]
enum Symbol {
    Tick,
    Cross,
}

impl Symbol {
    fn draw(self, painter: &egui::Painter, at: egui::Pos2, r: f32, stroke: Stroke) {
        match self {
            Symbol::Tick => {
                let points = [vec2(-r, 0.0), vec2(-0.3 * r, 0.7 * r), vec2(r, -0.7 * r)].map(|by| at + by);
                painter.line(points.to_vec(), stroke);
            }
            Symbol::Cross => {
                for by in [vec2(0.75 * r, 0.75 * r), vec2(0.75 * r, -0.75 * r)] {
                    painter.line_segment([at - by, at + by], stroke);
                }
            }
        }
    }
}

fn requirements(
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
            for m in measured {
                let verdict = if m.holds { "met" } else { "not met yet" };
                ui.label(format!("{}: {:.3}, required {}: {verdict}", m.name, m.value, m.bound));
            }
        }
    }
    if run.gave_up {
        ui.label("The solution was shown: the challenge counts as unsolved.");
        if ui.button("Start this step again").on_hover_text("Puts the step's scene and radar back").clicked() {
            asked.push(LessonCommand::Step(run.step).into());
        }
    } else if run.is_met() {
        ui.label(large(ui, "Solved. Keep experimenting or continue.").strong());
    } else {
        let tip = "Puts a scene and a radar on screen that meet it; the challenge then counts as unsolved";
        if ui.button("Show a solution").on_hover_text(tip).clicked() {
            asked.push(LessonCommand::ShowSolution.into());
        }
    }
}

#[cfg(test)]
mod tests;
