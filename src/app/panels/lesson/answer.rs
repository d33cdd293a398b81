//! A question's field or buttons, the given answer and its judgement; a challenge, and how far the scene meets its criteria.

use crate::app::state::{Command, LessonCommand, LessonRun};
use crate::app::widgets::{LARGE_TEXT_RATIO, NumberField, Texture, Wanted, cross, inline, large, press, theme};
use crate::lesson::question::{Answer, number_text};
use crate::lesson::{Challenge, Guess, Judgement, Measured, Question, Truth};
use eframe::egui::{self, Color32, Id, RichText, Sense, Slider, Stroke, TextEdit, TextureId, Ui, Vec2, pos2, vec2};

/// Answers that were typed but not sent, and the state of the layout.
#[derive(Default)]
pub struct LessonMemory {
    /// Texture of the map to reproduce, where a challenge hides its scene.
    pub(super) hidden: Texture,
    pub(super) number: String,
    pub(super) eta: f32,
    pub(super) learner: String,
    /// Whether the judgement was scrolled into sight.
    pub(super) told: bool,
    /// Whether the answer's field had the focus since the step began.
    pub(super) focused: bool,
    /// Whether text and question together are higher than the panel.
    pub(super) overflows: bool,
    /// Lesson and step that the state belongs to.
    pub(super) of: Option<(String, usize)>,
}

impl LessonMemory {
    /// Resets the state where another step begins. Returns whether one does.
    pub(super) fn begin(&mut self, run: &LessonRun) -> bool {
        let of = Some((run.id.clone(), run.step));
        let begins = self.of != of;
        if begins {
            let (learner, hidden) = (std::mem::take(&mut self.learner), std::mem::take(&mut self.hidden));
            // A step that was answered before starts at its top too.
            let told = run.guess.is_some();
            *self = LessonMemory { of, eta: 0.5, learner, hidden, told, ..LessonMemory::default() };
        }
        begins
    }
}

/// Draws the field or the buttons of an open question, or the request for a click.
pub fn answer(ui: &mut Ui, question: &Question, memory: &mut LessonMemory, asked: &mut Vec<Command>) {
    match &question.answer {
        Answer::Click { map, .. } => {
            ui.label(format!("Click in {}. The maps are hidden until you do.", map.words()));
        }
        Answer::Number { unit, .. } => {
            ui.horizontal(|ui| {
                let digits = stray_digits(ui);
                memory.number.push_str(&digits);
                let id = Id::unique("the number of an answer");
                let text = TextEdit::singleline(&mut memory.number).id(id);
                let field = ui.add(text.desired_width(90.0).hint_text("a number"));
                if !std::mem::replace(&mut memory.focused, true) || !digits.is_empty() {
                    field.request_focus();
                }
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
                press(ui, option, "", LessonCommand::Predict(Guess::Choice(index + 1)), asked);
            }
        }
        Answer::Threshold { .. } => {
            ui.horizontal(|ui| {
                ui.add(Slider::new(&mut memory.eta, 0.0..=1.0).show_value(false).text("threshold"));
                let field = NumberField::new(&mut memory.eta).range(0.0..=1.0).speed(0.005).max_decimals(2);
                let field = ui.add(field);
                ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("threshold in numbers"));
                press(ui, "Answer", "", LessonCommand::Predict(Guess::Eta(memory.eta)), asked);
            });
        }
    }
}

/// Digits that were typed while no field had the focus: they go to the field of a number.
fn stray_digits(ui: &Ui) -> String {
    if ui.ctx().text_edit_focused() {
        return String::new();
    }
    let of_number = |text: &str| text.chars().all(|c| c.is_ascii_digit() || ".,-−".contains(c));
    ui.input(|input| {
        let typed = input.events.iter().filter_map(|event| match event {
            egui::Event::Text(text) if of_number(text) => Some(text.as_str()),
            _ => None,
        });
        typed.collect()
    })
}

/// Draws the guess beside the truth; places are drawn on their map instead.
pub fn answered(ui: &mut Ui, question: &Question, guess: Guess, judged: Option<&Judgement>) {
    let truth = judged.map(|j| j.truth);
    match (&question.answer, guess) {
        (Answer::Choice { options, .. }, Guess::Choice(chosen)) => {
            let right = if let Some(Truth::Choice(right)) = truth { Some(right) } else { None };
            for (option, number) in options.iter().zip(1..) {
                answered_option(ui, option, number == chosen, right.map(|right| right == number));
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

/// Draws an option of an answered question. The right one is the most visible; it and a wrong choice have a symbol.
fn answered_option(ui: &mut Ui, option: &str, is_chosen: bool, is_right: Option<bool>) {
    let (text, said, symbol) = match (is_chosen, is_right) {
        (true, Some(true)) => (large(ui, option).strong(), "your answer, right", Some(Symbol::Tick)),
        (false, Some(true)) => (large(ui, option).strong(), "the right answer", Some(Symbol::Tick)),
        (true, Some(false)) => (RichText::new(option), "your answer, wrong", Some(Symbol::Cross)),
        (true, None) => (RichText::new(option), "your answer", None),
        (false, _) => (RichText::new(option).weak(), "", None),
    };
    let ink = theme::verdict(ui.visuals(), is_right == Some(true));
    ui.horizontal_wrapped(|ui| {
        let (place, _) = ui.allocate_exact_size(Vec2::splat(16.0), Sense::hover());
        if let Some(symbol) = symbol {
            symbol.draw(ui.painter(), place.center(), 6.0, Stroke::new(2.4, ink));
        }
        ui.label(text);
        ui.label(if symbol.is_some() { RichText::new(said).color(ink) } else { said.into() });
    });
}

/// Draws the chosen threshold on a scale from 0 to 1, with the range of right ones.
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

/// Draws the judgement of the guess, and scrolls to it once.
pub fn judgement(ui: &mut Ui, run: &LessonRun, told: &mut bool) {
    match &run.judgement {
        None => _ = ui.weak("computing…"),
        Some(Err(reason)) => _ = ui.label(format!("This can't be judged: {reason}")),
        Some(Ok(judged)) => {
            verdict(ui, judged.is_right, &judged.distance);
            let sentence = ui.label(inline(ui, &judged.sentence, LARGE_TEXT_RATIO));
            if !std::mem::replace(told, true) {
                sentence.scroll_to_me(None);
            }
        }
    }
}

/// Draws a verdict as a coloured line with a symbol, for readers who can't tell the colours apart.
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

/// Symbol before a verdict or a criterion.
#[derive(Clone, Copy)]
enum Symbol {
    Tick,
    Cross,
    Ring,
}

impl Symbol {
    /// Draws the symbol, `r` points to either side.
    fn draw(self, painter: &egui::Painter, at: egui::Pos2, r: f32, stroke: Stroke) {
        match self {
            Symbol::Ring => _ = painter.circle_stroke(at, 0.8 * r, stroke),
            Symbol::Tick => {
                let points = [vec2(-r, 0.0), vec2(-0.3 * r, 0.7 * r), vec2(r, -0.7 * r)].map(|by| at + by);
                painter.line(points.to_vec(), stroke);
            }
            Symbol::Cross => cross(painter, at, Vec2::splat(0.75 * r), stroke),
        }
    }
}

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
        ui.image((texture, vec2(width, width / 2.0)));
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
        let tip = "Puts the step's scene and radar back";
        press(ui, "Start this step again", tip, LessonCommand::Step(run.step), asked);
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
