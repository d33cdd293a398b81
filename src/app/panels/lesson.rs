//! Lessons: predict first, then look, then change something until a condition holds.

use crate::app::state::{Command, LessonRun};
use crate::app::widgets::entry::button;
use crate::app::widgets::inline::inline;
use crate::app::widgets::number_field::{NumberField, Wanted};
use crate::lesson::question::Answer;
use crate::lesson::shipped::Shipped;
use crate::lesson::{Challenge, Guess, Lesson, Progress, Question};
use eframe::egui;
use eframe::egui::{RichText, ScrollArea, Slider, TextEdit, TextureId, Ui};
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
    ui.label("Each step asks before it shows. Guess: a wrong guess teaches as much as a right one.");
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Learner");
        let field =
            ui.add(TextEdit::singleline(&mut memory.learner).desired_width(120.0).char_limit(60).hint_text("anybody"));
        if field.labelled_by(name.id).lost_focus() && memory.learner.trim() != progress.learner() {
            asked.push(Command::SetLearner(memory.learner.clone()));
        }
        let (made, right) = progress.score();
        if made > 0 {
            ui.weak(format!("{right} of {made} first guesses right"));
            if ui.button("Start over").on_hover_text("Forget what this learner did").clicked() {
                asked.push(Command::ForgetProgress);
            }
        }
    });
    ui.add_space(6.0);
    for (index, (file, lesson)) in shipped().iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            if ui.button(RichText::new(&lesson.title).strong()).on_hover_text(&lesson.about).clicked() {
                asked.push(Command::BeginLesson(index));
            }
            ui.weak(done(progress, file.id, lesson));
        });
        ui.label(&lesson.about);
        ui.add_space(6.0);
    }
    if ui.button("Open a lesson file…").on_hover_text("A TOML file; docs/lessons.md says how to write one").clicked()
    {
        asked.push(Command::OpenLesson);
    }
}

/// How far a lesson was taken.
fn done(progress: &Progress, id: &str, lesson: &Lesson) -> String {
    let steps = lesson.steps.iter().enumerate();
    let done = steps.filter(|(i, step)| {
        let record = progress.record(id, *i);
        (step.predict.is_none() || record.first_guess_right.is_some())
            && (step.challenge.is_none() || record.challenge_met)
    });
    format!("{} of {} steps", done.count(), lesson.steps.len())
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
            Some(_) => judgement(ui, run, &mut memory.told),
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
            asked.push(Command::LessonStep(run.step - 1));
        }
        let is_last = run.step + 1 == run.lesson.steps.len();
        if !is_last && ui.button("Next").clicked() {
            asked.push(Command::LessonStep(run.step + 1));
        }
        let leave = if is_last { "Finish" } else { "Leave" };
        if ui.button(leave).on_hover_text("Your scene and your settings come back").clicked() {
            asked.push(Command::LeaveLesson);
        }
        whole_screen(ui, presenting, asked);
    });
}

/// Text that is to be read first is this much larger than the rest.
const LARGE: f32 = 1.15;

/// Such a text.
fn large(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(LARGE * egui::TextStyle::Body.resolve(ui.style()).size)
}

/// For a projector.
fn whole_screen(ui: &mut Ui, presenting: bool, asked: &mut Vec<Command>) {
    let label = if presenting { "Back to the window" } else { "Whole screen" };
    button(ui, label, Command::PresentLesson, true, asked);
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
                    Ok(number) if clicked || entered => asked.push(Command::Predict(Guess::Number(number))),
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
                    asked.push(Command::Predict(Guess::Choice(index + 1)));
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
                    asked.push(Command::Predict(Guess::Eta(memory.eta)));
                }
            });
        }
    }
}

fn judgement(ui: &mut Ui, run: &LessonRun, told: &mut bool) {
    match &run.judgement {
        None => _ = ui.weak("looking…"),
        Some(Err(reason)) => _ = ui.label(format!("This can't be judged: {reason}")),
        Some(Ok(judged)) => {
            let verdict = if judged.is_right { "Right" } else { "Not quite" };
            ui.label(large(ui, format!("{verdict}: {}", judged.distance)).strong());
            let sentence = ui.label(inline(ui, &judged.sentence, LARGE));
            if !std::mem::replace(told, true) {
                sentence.scroll_to_me(None);
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
        ui.label("The map to be explained:");
        let width = ui.available_width().min(420.0);
        ui.image((texture, egui::vec2(width, width / 2.0)));
    }
    match &run.measured {
        None => _ = ui.weak("measuring…"),
        Some(Err(reason)) => _ = ui.label(reason),
        Some(Ok(measured)) => {
            for m in measured {
                let verdict = if m.holds { "holds" } else { "not yet" };
                ui.label(format!("{}: {:.3}, {} — {verdict}", m.name, m.value, m.bound));
            }
        }
    }
    if run.is_met() {
        ui.label(large(ui, "Done. Change more, or go on.").strong());
    } else if ui.button("Show a way").on_hover_text("Puts a scene and a radar on screen that meet it").clicked() {
        asked.push(Command::ShowSolution);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{Settings, Setup};
    use crate::radar::Radar;
    use crate::scene::Scene;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use std::sync::Arc;

    fn run(lesson: &str, step: usize) -> LessonRun {
        let shipped = crate::lesson::shipped::ALL.iter().find(|s| s.id == lesson).unwrap();
        let before = Setup {
            settings: Settings::default(),
            radar: Radar::default(),
            scene: Arc::new(Scene::default()),
            depth: 0,
        };
        let mut run = LessonRun::new(lesson.to_owned(), shipped.load().unwrap(), before);
        run.go_to(step);
        run
    }

    type Drawn = (Option<LessonRun>, Memory, Vec<Command>);

    fn harness(run: Option<LessonRun>) -> Harness<'static, Drawn> {
        let draw = |ui: &mut Ui, (run, memory, asked): &mut Drawn| {
            asked.extend(show(
                ui,
                Input { run: run.as_ref(), progress: &Progress::default(), hidden: None, presenting: false },
                memory,
            ));
        };
        Harness::builder().with_size([640.0, 1600.0]).build_ui_state(draw, (run, Memory::default(), Vec::new()))
    }

    #[test]
    fn a_lesson_is_begun_from_the_list() {
        let mut panel = harness(None);
        panel.get_by_label("Range and bandwidth").click();
        panel.step();
        assert_eq!(panel.state().2, [Command::BeginLesson(0)]);
    }

    #[test]
    fn what_is_no_number_is_no_answer() {
        let mut panel = harness(Some(run("range-and-bandwidth", 1)));
        panel.get_by_label("Your number").focus();
        panel.step();
        panel.get_by_label("Your number").type_text("abc");
        panel.step();
        panel.key_press(egui::Key::Enter);
        panel.run_steps(3);
        assert!(panel.query_by_label_contains("“abc” is not a number").is_some() && panel.state().2.is_empty());
        assert!(panel.get_by_label("Your number").is_focused(), "the next key goes to the field");
    }

    #[test]
    fn lessons_ask_for_the_whole_screen() {
        let mut panel = harness(Some(run("range-and-bandwidth", 0)));
        panel.get_by_label("Whole screen").click();
        panel.step();
        assert_eq!(panel.state().2, [Command::PresentLesson]);
    }

    #[test]
    fn options_are_predictions_and_results_stay_hidden_before() {
        let mut panel = harness(Some(run("range-and-bandwidth", 3)));
        assert!(panel.query_by_label_contains("Right").is_none());
        panel.get_by_label("It stays").click();
        panel.step();
        assert_eq!(panel.state().2, [Command::Predict(Guess::Choice(3))]);
    }

    #[test]
    fn a_number_is_typed_and_answered() {
        let mut panel = harness(Some(run("range-and-bandwidth", 1)));
        panel.get_by_label("Your number").focus();
        panel.step();
        panel.get_by_label("Your number").type_text("0,075");
        panel.step();
        panel.get_by_label("Answer").click();
        panel.step();
        assert_eq!(panel.state().2, [Command::Predict(Guess::Number(0.075))]);
    }

    #[test]
    fn a_challenge_offers_a_way_until_it_is_met() {
        let mut panel = harness(Some(run("range-and-bandwidth", 4)));
        panel.get_by_label("Show a way").click();
        panel.step();
        assert_eq!(panel.state().2, [Command::ShowSolution]);
    }
}
