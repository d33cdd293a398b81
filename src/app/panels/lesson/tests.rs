use super::*;
use crate::app::state::{Arrangement, Before, MapViews, SceneView, Setup, Task, View};
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::app::widgets::theme;
use crate::lesson::{Guess, Progress, Stage};
use crate::radar::Radar;
use crate::scene::Scene;
use std::sync::Arc;

fn run(lesson: &str, step: usize) -> LessonRun {
    let shipped = crate::lesson::shipped::ALL.iter().find(|s| s.id == lesson).unwrap();
    let setup = Setup { view: View::default(), radar: Radar::default(), scene: Arc::new(Scene::default()), depth: 0 };
    let before = Before { setup, scene_view: SceneView::default(), map_views: MapViews::default(), task: Task::Teach };
    let mut run = LessonRun::new(lesson.to_owned(), Arc::new(shipped.load().unwrap()), before);
    run.go_to(step);
    run
}

type Drawn = (State, LessonMemory, Vec<Command>);

fn harness(run: Option<LessonRun>) -> Harness<'static, Drawn> {
    harness_of([640.0, 1600.0], run, Progress::default(), false)
}

/// The panel at a size, with a learner's progress, on the whole screen or not.
fn harness_of(size: [f32; 2], run: Option<LessonRun>, progress: Progress, presenting: bool) -> Harness<'static, Drawn> {
    let before_presenting = presenting.then(Arrangement::default);
    let state = State { lesson: run, progress, before_presenting, ..State::new(Vec::new()) };
    let draw = move |ui: &mut Ui, (state, memory, asked): &mut Drawn| asked.extend(show(ui, state, None, memory));
    Harness::builder().with_size(size).build_ui_state(draw, (state, LessonMemory::default(), Vec::new()))
}

#[test]
fn every_button_is_one_command() {
    let mut gave_up = run("range-and-bandwidth", 4);
    gave_up.gave_up = true;
    let at = |step| Some(run("range-and-bandwidth", step));
    for (run, button, command) in [
        (None, "Range and bandwidth", LessonCommand::Begin(0)),
        (at(0), "Whole screen", LessonCommand::Present),
        (at(3), "It stays", LessonCommand::Predict(Guess::Choice(3))),
        (at(4), "Show a solution", LessonCommand::ShowSolution),
        (Some(gave_up), "Start this step again", LessonCommand::Step(4)),
    ] {
        let mut panel = harness(run);
        for unknown in ["Correct", "Solved"] {
            assert!(panel.query_by_label_contains(unknown).is_none(), "{button}: {unknown}");
        }
        panel.clicks(&[button]);
        assert_eq!(panel.state().2, [Command::Lesson(command)], "{button}");
    }
}

#[test]
fn what_is_no_number_is_no_answer() {
    let mut panel = harness(Some(run("range-and-bandwidth", 1)));
    panel.enters("Your number", "abc");
    assert!(panel.query_by_label_contains("“abc” is not a number").is_some() && panel.state().2.is_empty());
    assert!(panel.get_by_label("Your number").is_focused(), "the next key goes to the field");
}

#[test]
fn the_field_of_a_number_has_the_focus_when_its_step_begins() {
    let mut panel = harness(Some(run("range-and-bandwidth", 1)));
    panel.run_steps(2);
    assert!(panel.get_by_label("Your number").is_focused());
    panel.event(egui::Event::Text("7,5 cm".to_owned()));
    panel.step();
    panel.clicks(&["Answer"]);
    assert_eq!(panel.state().2, [Command::Lesson(LessonCommand::Predict(Guess::Number(0.075)))]);
}

#[test]
fn a_digit_that_is_typed_elsewhere_goes_to_the_field() {
    let mut panel = harness(Some(run("range-and-bandwidth", 1)));
    panel.run_steps(2);
    panel.ctx.memory_mut(|memory| memory.surrender_focus(egui::Id::unique("the number of an answer")));
    panel.step();
    panel.event(egui::Event::Text("5".to_owned()));
    panel.run_steps(2);
    assert_eq!(panel.state().1.number, "5");
    assert!(panel.get_by_label("Your number").is_focused());
}

#[test]
fn the_question_is_in_view_however_little_room_there_is() {
    for (lesson, step) in [("which-points-a-car-is", 3), ("range-and-bandwidth", 1), ("where-a-wall-shines", 2)] {
        for size in [[360.0, 300.0], [520.0, 480.0]] {
            let run = Some(self::run(lesson, step));
            let mut panel = harness_of(size, run, Progress::default(), true);
            panel.run_steps(3);
            let step = panel.state().0.lesson.as_ref().and_then(LessonRun::current).unwrap().clone();
            let (title, question) = (panel.get_by_label_contains("Step "), step.predict.unwrap());
            let ask = panel.get_by_label(&question.ask).rect();
            assert!(title.rect().top() < 80.0, "{lesson} at {size:?} begins at its top");
            assert!(ask.bottom() < size[1] - 30.0, "{lesson} at {size:?}: the question is at {ask:?}");
        }
    }
}

#[test]
fn a_challenge_is_in_view_however_little_room_there_is() {
    for size in [[360.0, 180.0], [300.0, 230.0], [640.0, 800.0]] {
        let mut panel = harness_of(size, Some(run("range-and-velocity", 3)), Progress::default(), true);
        panel.run_steps(3);
        let step = panel.state().0.lesson.as_ref().and_then(LessonRun::current).unwrap().clone();
        let ask = panel.get_by_label(&step.challenge.unwrap().ask).rect();
        assert!(panel.get_by_label_contains("Step ").rect().top() > 0.0, "it begins at its top: {size:?}");
        assert!(ask.top() > 0.0 && ask.bottom() < size[1] - 30.0, "{size:?}: the challenge is at {ask:?}");
    }
}

#[test]
fn a_step_that_was_answered_starts_at_its_top() {
    let answered = answered_run("range-and-velocity", 2, Guess::Number(-15.0));
    let mut panel = harness_of([360.0, 180.0], Some(answered), Progress::default(), true);
    panel.run_steps(3);
    assert!(panel.get_by_label_contains("Step ").rect().top() > 0.0);
}

#[test]
fn each_step_starts_at_its_top() {
    let mut panel = harness(Some(run("which-points-a-car-is", 4)));
    panel.set_size(egui::vec2(360.0, 200.0));
    panel.run_steps(3);
    let over = panel.get_by_label_contains("Step ").rect().center();
    panel.hover_at(over);
    panel.step();
    let unit = egui::MouseWheelUnit::Point;
    let (delta, modifiers, phase) = (egui::vec2(0.0, -120.0), egui::Modifiers::NONE, egui::TouchPhase::Move);
    panel.event(egui::Event::MouseWheel { unit, delta, modifiers, phase, source: egui::MouseWheelSource::Unknown });
    panel.run_steps(20);
    assert!(panel.get_by_label_contains("Step ").rect().top() < 0.0, "it was scrolled");
    panel.state_mut().0.lesson.as_mut().unwrap().go_to(3);
    panel.run_steps(3);
    assert!(panel.get_by_label_contains("Step ").rect().top() > 0.0);
}

fn answered_run(lesson: &str, step: usize, guess: Guess) -> LessonRun {
    let mut run = run(lesson, step);
    let current = run.current().unwrap();
    let stage = Stage::new(&current.radar, &current.scene(), &current.view, false).unwrap();
    let judged = current.predict.as_ref().unwrap().judge(&stage, guess);
    (run.guess, run.judgement) = (Some(guess), Some(judged));
    run
}

#[test]
fn an_answer_stands_beside_the_right_one() {
    let (bandwidth, windows) = ("range-and-bandwidth", "windows-and-side-lobes");
    let wrong = ["It shrinks to a third", "your answer, wrong", "It stays", "the right answer"];
    let threshold = "Your answer: 0.01. The green part of the scale is right.";
    let cases: [(_, _, _, &[&str]); 5] = [
        (bandwidth, 1, Guess::Number(0.075), &["Your answer: 0.075 m. Exact: 0.075 m.", "Correct: 0.075 m."]),
        (bandwidth, 1, Guess::Number(0.15), &["Not quite: it is 0.075 m; you were 100 % off."]),
        (bandwidth, 3, Guess::Choice(1), &wrong),
        (bandwidth, 3, Guess::Choice(1), &["Not quite: the answer is “It stays”."]),
        (windows, 1, Guess::Eta(0.01), &[threshold, "Any threshold from"]),
    ];
    for (lesson, step, guess, told) in cases {
        let panel = harness(Some(answered_run(lesson, step, guess)));
        for text in told {
            let count = panel.query_all_by_label(text).count();
            assert!(count == 1 || panel.query_by_label_contains(text).is_some(), "{text}: {count}");
        }
    }
}

#[test]
fn the_right_option_is_the_most_visible() {
    let mut panel = harness(Some(answered_run("range-and-bandwidth", 3, Guess::Choice(1))));
    theme::apply(&panel.ctx, egui::ThemePreference::Dark);
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        panel.ctx.set_theme(theme);
        panel.run_steps(2);
        let visuals = panel.ctx.style_of(theme).visuals.clone();
        let ground = visuals.panel_fill;
        let ink = |option: &str| {
            panel.output().shapes.iter().find_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) if text.galley.text() == option => {
                    let ink = text.galley.job.sections[0].format.color;
                    Some(if ink == egui::Color32::PLACEHOLDER { text.fallback_color } else { ink })
                }
                _ => None,
            })
        };
        let contrast = |option: &str| theme::contrast(ink(option).unwrap_or_else(|| panic!("{option}")), ground);
        let [chosen, right, other] = ["It shrinks to a third", "It stays", "It grows threefold"].map(contrast);
        assert!(right > chosen && chosen > other && other >= 4.5, "{theme:?}: {right}, {chosen}, {other}");
    }
}

#[test]
fn starting_over_asks_before_it_forgets() {
    let mut progress = Progress::default();
    progress.note_guess("range-and-bandwidth", 1, true);
    let mut panel = harness_of([640.0, 1600.0], None, progress, false);
    panel.clicks(&["Progress", "Start over…"]);
    let _question = panel.get_by_label("Forget every answer that was given here?");
    assert!(panel.state().2.is_empty());
    panel.clicks(&["Forget them"]);
    assert_eq!(panel.state().2, [Command::Lesson(LessonCommand::ForgetProgress)]);
}

#[test]
fn every_lesson_of_the_list_shows_how_far_it_was_taken() {
    let mut progress = Progress::default();
    progress.note_guess("range-and-bandwidth", 1, true);
    let panel = harness_of([640.0, 1600.0], None, progress, false);
    let texts = seen::texts(panel.output());
    let bars = texts.iter().filter(|t| t.text.contains(" of ") && t.text.ends_with("steps")).count();
    assert_eq!(bars, crate::lesson::shipped::ALL.len());
    let narrow = harness_of([320.0, 2400.0], None, Progress::default(), false);
    assert!(seen::texts(narrow.output()).iter().all(|t| !t.is_shortened), "titles are whole");
    seen::assert_readable(panel.output());
}

#[test]
fn a_verdict_has_a_colour_and_a_symbol() {
    let symbols = |guess| {
        let panel = harness(Some(answered_run("range-and-bandwidth", 1, guess)));
        let ink = |is_right| theme::verdict(&panel.ctx.style_of(panel.ctx.theme()).visuals, is_right);
        let lines = |is_right| {
            let of = |shape: &egui::Shape| match shape {
                egui::Shape::LineSegment { stroke, .. } => stroke.color == ink(is_right),
                egui::Shape::Path(path) => format!("{:?}", path.stroke.color).contains(&format!("{:?}", ink(is_right))),
                _ => false,
            };
            panel.output().shapes.iter().filter(|s| of(&s.shape)).count()
        };
        (lines(true), lines(false))
    };
    let (tick, none) = symbols(Guess::Number(0.075));
    assert!(tick >= 2 && none == 0, "a tick and a bar: {tick}, {none}");
    let (none, cross) = symbols(Guess::Number(0.15));
    assert!(cross >= 3 && none == 0, "a cross and a bar: {none}, {cross}");
}
