//! Every lesson taken in the whole app: answered right and wrong by pointer and keyboard, challenges met by the solution that is shown.

use crate::session::*;
use apertura::interact::{Field, FieldChange};
use apertura::lesson::question::Answer;
use apertura::lesson::{Cell, Guess, Lesson, MapName, Question, Stage, Step, Truth, shipped};
use apertura::maps::cfar::Cfar;

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
            let across = step.radar.across_of_column(at.column);
            let up = (at.bin + 0.5) / step.radar.samples as f64;
            let to = pos2(rect.left() + across as f32 * rect.width(), rect.bottom() - up as f32 * rect.height());
            s.hold(to);
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
        (_, other) => s.ask(LessonCommand::Predict(other)),
    }
    s.app.step();
}

fn take(s: &mut Session, lesson: &Lesson, number: usize, right: bool) {
    let (step, place) = (&lesson.steps[number], format!("{}, step {}", lesson.title, number + 1));
    s.ask(LessonCommand::Step(number));
    assert!(s.editor().scene().notes.is_empty(), "{place}: notes tell what is asked for");
    if let Some(question) = &step.predict {
        assert!(!s.shows("Correct: "), "{place}");
        answer(s, step, question, guess(step, question, right));
        let verdict = if right { "Correct: " } else { "Not quite: " };
        step_until(s, &format!("{place}: {verdict}"), |s| s.shows(verdict));
        let sentence = if right { &question.right } else { &question.wrong };
        // Emphasis is drawn, not its marks.
        assert!(s.shows(&sentence.replace(['*', '`'], "")), "{place}: {sentence}");
    }
    if step.challenge.is_some() {
        step_until(s, &format!("{place}: a solution is offered"), |s| s.shows("Show a solution"));
        step_until(s, &format!("{place}: it is measured"), |s| !s.shows("measuring…"));
        assert!(!s.shows("Solved. "), "{place}: met before anything is done");
        s.app.get_by_label("Show a solution").scroll_to_me();
        (0..3).for_each(|_| s.app.step());
        s.app.get_by_label("Show a solution").click();
        step_until(s, &format!("{place}: it counts as unsolved"), |s| s.shows("counts as unsolved"));
        step_until(s, &format!("{place}: met"), |s| {
            s.shows("(now ") && !s.shows("not met yet") && !s.shows("measuring…")
        });
    }
}

fn take_all(right: bool) {
    let mut s = Session::start();
    s.ask(LessonCommand::Present);
    for (index, file) in shipped::ALL.iter().enumerate() {
        let lesson = file.load().unwrap();
        s.ask(LessonCommand::Begin(index));
        for number in 0..lesson.steps.len() {
            take(&mut s, &lesson, number, right);
        }
    }
    let before = s.state().arrangement.is_open(Panel::Controls);
    s.ask(LessonCommand::Leave);
    s.press(Modifiers::NONE, Key::Escape);
    assert!(!before && s.state().arrangement.is_open(Panel::Controls), "the panels are back");
    assert_eq!(s.state().radar().elements, 128, "and so is the scene");
}

#[test]
#[ignore = "long: every step of every lesson twice"]
fn every_step_judges_its_answers() {
    take_all(true);
    take_all(false);
}

/// Begins the lesson called `id` at a step, counted from 1.
fn begin(s: &mut Session, id: &str, step: usize) {
    s.ask(LessonCommand::Begin(shipped::ALL.iter().position(|file| file.id == id).unwrap()));
    s.ask(LessonCommand::Step(step - 1));
}

fn predict(s: &mut Session, guess: Guess, verdict: &str) {
    s.ask(LessonCommand::Predict(guess));
    step_until(s, verdict, |s| s.shows(verdict));
    s.settle();
}

#[test]
fn no_panel_answers_a_question_before_the_learner_does() {
    let mut s = Session::start();
    begin(&mut s, "range-and-bandwidth", 1);
    assert!(s.paints("range, m"), "a question about a place leaves the axes");
    begin(&mut s, "range-and-bandwidth", 3);
    for panel in [Panel::Inspector, Panel::Radar] {
        s.ask(WindowCommand::OpenPanel(panel));
    }
    // The question itself says "maximum range": the Radar panel would say how much.
    for answer in ["range, m", "maximum range 5", "511.67 m", "500 m"] {
        assert!(!s.paints(answer), "{answer}: {:?}", s.painted());
    }
    assert!(s.paints("Hidden until you have predicted."));
    predict(&mut s, Guess::Number(512.0), "Correct: ");
    for told in ["range, m", "maximum range 5"] {
        assert!(s.paints(told), "{told}: {:?}", s.painted());
    }
}

#[test]
fn the_number_of_blobs_is_not_told_while_maps_are_hidden() {
    let mut s = Session::start();
    begin(&mut s, "what-a-network-can-know", 1);
    s.ask(ViewCommand::Method("baseline"));
    s.ask(WindowCommand::OpenPanel(Panel::Controls));
    assert!(!s.shows(" in the target, "));
    predict(&mut s, Guess::Choice(1), "Correct: ");
    step_until(&mut s, "figures come with the maps", |s| s.shows(" in the target, "));
}

#[test]
fn going_back_keeps_the_verdict() {
    let mut s = Session::start();
    begin(&mut s, "range-and-bandwidth", 4);
    predict(&mut s, Guess::Choice(1), "Not quite: the answer is “It stays”.");
    s.click("Previous");
    assert!(!s.shows("Not quite"));
    s.click("Next");
    assert!(s.shows("Not quite") && s.shows("the right answer"));
}

#[test]
fn the_guess_stays_drawn_beside_the_truth() {
    let mut s = Session::start();
    begin(&mut s, "range-and-bandwidth", 1);
    let drawn = |s: &Session| ["your guess", "truth"].map(|text| s.painted().iter().any(|t| t == text));
    assert_eq!(drawn(&s), [false, false]);
    predict(&mut s, Guess::Place(Cell { bin: 100.0, column: 300.0 }), "Not quite: ");
    assert_eq!(drawn(&s), [true, true]);
    s.ask(LessonCommand::Step(1));
    assert_eq!(drawn(&s), [false, false]);
    s.ask(LessonCommand::Step(0));
    assert_eq!(drawn(&s), [true, true]);
}

#[test]
fn a_shown_solution_is_unsolved_until_the_step_is_begun_again() {
    let mut s = Session::start();
    begin(&mut s, "range-and-bandwidth", 5);
    let is_met = |s: &Session| s.state().progress.record("range-and-bandwidth", 4).challenge_met;
    s.ask(LessonCommand::ShowSolution);
    step_until(&mut s, "the solution is measured", |s| s.shows("(now ") && !s.shows("not met yet"));
    assert!(!is_met(&s) && s.shows("counts as unsolved"));
    s.click("Start this step again");
    step_until(&mut s, "the step is as it was", |s| s.shows("not met yet"));
    s.ask(RadarCommand::Set(Box::new(Radar { bandwidth_hz: 0.95e9, ..s.state().radar().clone() })));
    step_until(&mut s, "it is solved", |s| s.shows("Solved. "));
    assert!(is_met(&s));
}

#[test]
fn lessons_close_the_panels_that_they_do_not_use() {
    let mut s = Session::start();
    let is_open = |s: &Session, kind| s.state().arrangement.is_open(Panel::Map(kind));
    let before = s.state().arrangement.shown().clone();
    begin(&mut s, "range-and-bandwidth", 1);
    for kind in [MapKind::Output, MapKind::TargetAbove, MapKind::OutputAbove, MapKind::Difference] {
        assert!(!is_open(&s, kind), "{kind:?}");
    }
    assert!(!s.state().arrangement.is_open(Panel::Roc) && is_open(&s, MapKind::Target));
    assert!(!s.shows("Reconstruction"));
    begin(&mut s, "the-floor", 1);
    assert!(is_open(&s, MapKind::TargetAbove) && !is_open(&s, MapKind::Output));
    begin(&mut s, "what-a-network-can-know", 1);
    assert!(is_open(&s, MapKind::Output) && !is_open(&s, MapKind::OutputAbove));
    s.ask(LessonCommand::Leave);
    s.ask(WindowCommand::ClosePanel(Panel::Lesson));
    assert_eq!(*s.state().arrangement.shown(), before, "what was in sight is in sight again");
}

#[test]
fn undo_stops_at_the_scene_of_the_step() {
    let mut s = Session::start();
    let objects = |s: &Session| s.objects().len();
    begin(&mut s, "range-and-bandwidth", 1);
    let of_step = objects(&s);
    s.ask(EditCommand::Add(NewObject::Point, None));
    assert_eq!(objects(&s), of_step + 1);
    for _ in 0..3 {
        s.ask(EditCommand::Undo);
        assert_eq!(objects(&s), of_step, "neither the learner's own scene nor another step");
    }
}

#[test]
fn the_end_of_a_lesson_gives_the_zoom_back() {
    let mut s = Session::start();
    s.app.hover_at(s.handle("Target map"));
    s.app.step();
    s.app.event(Event::Zoom(1.5));
    s.app.run_steps(30);
    s.settle();
    let (views, zoom) = ((s.state().scene_view, s.state().map_views), s.app.ctx.zoom_factor());
    assert_ne!(views.1, Default::default(), "the maps are zoomed");
    begin(&mut s, "range-and-bandwidth", 1);
    assert_eq!(s.state().map_views, Default::default(), "a lesson shows whole maps");
    s.ask(WindowCommand::ZoomIn);
    assert!(s.app.ctx.zoom_factor() > zoom);
    s.ask(LessonCommand::Leave);
    assert_eq!(s.app.ctx.zoom_factor(), zoom);
    s.ask(WindowCommand::ClosePanel(Panel::Lesson));
    assert_eq!((s.state().scene_view, s.state().map_views), views);
}

#[test]
fn a_lesson_is_shared_at_its_step() {
    let mut s = Session::start();
    s.ask(LessonCommand::Begin(3));
    s.ask(LessonCommand::Step(2));
    let radar = s.state().radar().clone();
    let text = s.state().shared_text().unwrap();
    s.ask(LessonCommand::Leave);
    assert_eq!(s.state().radar().elements, 128);
    s.ask(EditCommand::PasteText(text));
    assert!(s.shows("Step 3 of 5"));
    assert_eq!(*s.state().radar(), radar);
    s.ask(EditCommand::PasteText("apertura:1:damaged".to_owned()));
    assert!(s.shows("copy all of it again"));
}

#[test]
fn a_shared_scene_comes_with_its_view_and_time() {
    let mut s = Session::start();
    s.ask(EditCommand::SelectAll);
    s.ask(EditCommand::SetField(Field::VelocityY, FieldChange::To(10.0)));
    let seen = |s: &Session| {
        let settings = &s.state().settings;
        (settings.projection, settings.show_theory, settings.target_eta, settings.cfar)
    };
    let look = |s: &mut Session, eta: f32, cfar: Option<Cfar>| {
        for command in [ViewCommand::ToggleProjection, ViewCommand::ToggleTheory, ViewCommand::SetTargetEta(eta)] {
            s.ask(command);
        }
        s.ask(ViewCommand::SetCfar(cfar));
    };
    look(&mut s, 0.5, Some(Cfar::default()));
    s.ask(ViewCommand::SetTime(0.5));
    let (text, shown) = (s.state().shared_text().unwrap(), seen(&s));
    s.ask(DocumentCommand::Preset(0));
    look(&mut s, 0.9, None);
    let other = (s.editor().scene().clone(), seen(&s));
    s.ask(DocumentCommand::OpenShared(text));
    assert_eq!((s.state().radar().elements, s.state().timeline.seconds, seen(&s)), (128, 0.5, shown));
    assert_eq!(s.state().scene().objects[0].centre_metres(), [0.0, 25.0]);
    s.ask(EditCommand::Undo);
    assert_eq!((s.editor().scene().clone(), seen(&s)), other);
}
