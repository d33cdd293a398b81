//! Every lesson taken in the whole app: answered right and wrong by pointer and keyboard, challenges met by the way that is shown.

use crate::session::{Session, step_until};
use apertura::app::Command;
use apertura::lesson::question::Answer;
use apertura::lesson::{Cell, Guess, Lesson, MapName, Question, Stage, Step, Truth, shipped};
use eframe::egui::pos2;
use egui_kittest::kittest::Queryable;

/// Whether a text stands somewhere on screen.
fn shows(s: &Session, text: &str) -> bool {
    s.app.query_all_by_label_contains(text).next().is_some()
}

/// A right guess, or a wrong one.
fn guess(step: &Step, question: &Question, right: bool) -> Guess {
    let stage = Stage::new(&step.radar, &step.scene(), &step.view, question.needs_output()).unwrap();
    let half = step.radar.elements as f64 / 2.0;
    match question.truth(&stage).unwrap() {
        Truth::Place(at) if right => Guess::Place(at),
        Truth::Place(at) => Guess::Place(Cell { column: (at.column + half) % (2.0 * half), ..at }),
        Truth::Number(exact) => Guess::Number(if right { exact } else { 3.0 * exact + 1.0 }),
        Truth::Choice(best) => Guess::Choice(if right { best } else { best % 2 + 1 }),
        Truth::Etas { low, high } => Guess::Eta(if right { (low + high) / 2.0 } else { high + 0.01 }),
    }
}

/// Answers as a learner does.
fn answer(s: &mut Session, step: &Step, question: &Question, guess: Guess) {
    match (&question.answer, guess) {
        (Answer::Click { map, .. }, Guess::Place(at)) => {
            let name = match map {
                MapName::Input0 => "Input 0 map",
                MapName::Input1 => "Input 1 map",
                MapName::Target => "Target map",
                MapName::Output => "Output map",
            };
            let rect = s.app.get_by_label(name).rect();
            let across = (at.column + 0.5) / step.radar.elements as f64;
            let up = (at.bin + 0.5) / step.radar.samples as f64;
            let to = pos2(rect.left() + across as f32 * rect.width(), rect.bottom() - up as f32 * rect.height());
            s.app.hover_at(to);
            s.app.step();
            s.app.drag_at(to);
            s.app.step();
            s.app.drop_at(to);
            s.app.step();
        }
        (Answer::Number { .. }, Guess::Number(number)) => {
            s.app.get_by_label("Your number").focus();
            s.app.step();
            s.app.get_by_label("Your number").type_text(&number.to_string());
            s.app.step();
            s.app.step();
            s.app.get_by_label("Answer").click();
        }
        (Answer::Choice { options, .. }, Guess::Choice(chosen)) => s.app.get_by_label(&options[chosen - 1]).click(),
        (_, other) => s.ask(Command::Predict(other)),
    }
    s.app.step();
}

/// Takes a step: the prediction right or wrong, then the challenge.
fn take(s: &mut Session, lesson: &Lesson, number: usize, right: bool) {
    let (step, place) = (&lesson.steps[number], format!("{}, step {}", lesson.title, number + 1));
    s.ask(Command::LessonStep(number));
    assert!(s.state().editor().scene().notes.is_empty(), "{place}: notes tell what is asked for");
    if let Some(question) = &step.predict {
        assert!(!shows(s, "Right: "), "{place}");
        answer(s, step, question, guess(step, question, right));
        let verdict = if right { "Right: " } else { "Not quite: " };
        step_until(s, &format!("{place}: {verdict}"), |s| shows(s, verdict));
        let sentence = if right { &question.right } else { &question.wrong };
        assert!(shows(s, sentence), "{place}: {sentence}");
    }
    if step.challenge.is_some() {
        step_until(s, &format!("{place}: a way is offered"), |s| shows(s, "Show a way"));
        step_until(s, &format!("{place}: it is measured"), |s| !shows(s, "measuring…"));
        assert!(!shows(s, "Done. "), "{place}: met before anything is done");
        s.app.get_by_label("Show a way").scroll_to_me();
        (0..3).for_each(|_| s.app.step());
        s.app.get_by_label("Show a way").click();
        step_until(s, &format!("{place}: met"), |s| shows(s, "Done. "));
    }
}

fn take_all(right: impl Fn(usize, usize) -> bool) {
    let mut s = Session::start();
    s.ask(Command::PresentLesson);
    for (index, file) in shipped::ALL.iter().enumerate() {
        let lesson = file.load().unwrap();
        s.ask(Command::BeginLesson(index));
        for number in 0..lesson.steps.len() {
            take(&mut s, &lesson, number, right(index, number));
        }
    }
    let before = s.state().arrangement().is_open(apertura::app::Panel::Controls);
    s.ask(Command::LeaveLesson);
    s.press(eframe::egui::Modifiers::NONE, eframe::egui::Key::Escape);
    assert!(!before && s.state().arrangement().is_open(apertura::app::Panel::Controls), "the panels are back");
    assert_eq!(s.state().radar().elements, 128, "and so is the scene");
}

#[test]
#[ignore = "long: minutes in an unoptimised build"]
fn every_lesson_is_taken_with_right_and_wrong_answers_in_turn() {
    take_all(|lesson, step| (lesson + step) % 2 == 0);
}

#[test]
#[ignore = "long: every step of every lesson twice"]
fn every_step_is_answered_right_and_wrong() {
    take_all(|_, _| true);
    take_all(|_, _| false);
}

#[test]
fn a_lesson_is_shared_with_its_step_and_scene() {
    let mut s = Session::start();
    s.ask(Command::BeginLesson(3));
    s.ask(Command::LessonStep(2));
    let radar = s.state().radar().clone();
    let text = s.state().shared_text().unwrap();
    s.ask(Command::LeaveLesson);
    assert_eq!(s.state().radar().elements, 128);
    s.ask(Command::PasteText(text));
    assert!(shows(&s, "Step 3 of 5"));
    assert_eq!(*s.state().radar(), radar);
    s.ask(Command::PasteText("apertura:1:damaged".to_owned()));
    assert!(shows(&s, "copy all of it again"));
}

#[test]
fn a_shared_scene_comes_with_its_view_and_can_be_undone() {
    let mut s = Session::start();
    s.ask(Command::ToggleProjection);
    s.ask(Command::ToggleTheory);
    s.ask(Command::SetTargetEta(0.5));
    let text = s.state().shared_text().unwrap();
    s.ask(Command::Preset(0));
    s.ask(Command::ToggleProjection);
    s.ask(Command::ToggleTheory);
    s.ask(Command::SetTargetEta(0.9));
    let other = s.state().editor().scene().clone();
    s.ask(Command::OpenShared(text));
    assert_eq!(s.state().radar().elements, 128);
    assert_eq!(s.state().settings().projection, apertura::app::Projection::Cartesian);
    assert!(s.state().settings().show_theory && s.state().settings().target_eta == 0.5);
    s.ask(Command::Undo);
    assert_eq!(s.state().editor().scene(), &other);
    assert_eq!(s.state().settings().target_eta, 0.9);
}

#[test]
fn several_maps_and_theory_are_computed_while_they_are_looked_at() {
    let mut s = Session::start();
    s.ask(Command::ToggleTheory);
    s.ask(Command::OpenPanel(apertura::app::Panel::Several));
    step_until(&mut s, "all four windows are there", |s| s.state().several_maps_made() == 4);
    s.app.get_by_label("window: rectangular").click();
    s.settle();
    assert_eq!(s.state().radar().window, apertura::radar::WindowFunction::Rectangular);
    s.press(eframe::egui::Modifiers::COMMAND, eframe::egui::Key::Z);
    assert_eq!(s.state().radar().window, apertura::radar::WindowFunction::Hann);
}
