//! Every shipped lesson, answered right and wrong.

use super::question::Answer;
use super::*;

fn lessons() -> impl Iterator<Item = (&'static str, Lesson)> {
    shipped::ALL.iter().map(|s| (s.id, s.load().unwrap_or_else(|e| panic!("{}: {e}", s.id))))
}

fn stage(step: &Step, output: bool) -> Stage {
    Stage::new(&step.radar, &step.scene(), &step.view, output).unwrap()
}

/// A right and a wrong guess.
fn guesses(question: &Question, truth: Truth, stage: &Stage) -> (Guess, Guess) {
    match truth {
        Truth::Place(at) => {
            let Answer::Click { within_columns, .. } = &question.answer else { panic!("a click") };
            let elsewhere = (at.column + 2.0 * within_columns + 3.0) % stage.radar.elements as f64;
            (Guess::Place(at), Guess::Place(Cell { column: elsewhere, ..at }))
        }
        Truth::Number(exact) => (Guess::Number(exact), Guess::Number(exact * 3.0 + 1.0)),
        Truth::Choice(right) => (Guess::Choice(right), Guess::Choice(if right == 1 { 2 } else { 1 })),
        Truth::Etas { low, high } => (Guess::Eta((low + high) / 2.0), Guess::Eta(high.max(low) + 0.01)),
    }
}

#[test]
fn every_lesson_file_is_listed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/lessons");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), shipped::ALL.len());
    for (id, lesson) in lessons() {
        assert!((4..=7).contains(&lesson.steps.len()), "{id} has {} steps", lesson.steps.len());
        assert!(lesson.steps.iter().any(|s| s.challenge.is_some()), "{id} has no challenge");
        assert!(lesson.steps.iter().filter(|s| s.predict.is_some()).count() >= 3, "{id} asks too little");
    }
}

#[test]
fn every_prediction_can_be_wrong() {
    for (id, lesson) in lessons() {
        for (number, step) in lesson.steps.iter().enumerate() {
            let Some(question) = &step.predict else { continue };
            let stage = stage(step, question.needs_output());
            let place = format!("{id}, step {}", number + 1);
            let truth = question.truth(&stage).unwrap_or_else(|e| panic!("{place}: {e}"));
            if let Truth::Etas { low, high } = truth {
                assert!(low < high, "{place}: no threshold does, {low} to {high}");
            }
            let (right, wrong) = guesses(question, truth, &stage);
            let judged = question.judge(&stage, right).unwrap();
            assert!(judged.is_right && judged.sentence == question.right, "{place}: {judged:?}");
            let judged = question.judge(&stage, wrong).unwrap();
            assert!(!judged.is_right && judged.sentence == question.wrong, "{place}: {judged:?}");
        }
    }
}

#[test]
fn every_lesson_can_be_taken() {
    for file in shipped::ALL {
        assert_eq!(file.load().unwrap().try_out(file.toml), Ok(()), "{}", file.id);
    }
}

#[test]
fn the_thresholds_named_in_a_verdict_are_right() {
    let lesson = Lesson::from_toml(shipped::ALL.iter().find(|s| s.id == "the-floor").unwrap().toml).unwrap();
    let (step, question) = (&lesson.steps[3], lesson.steps[3].predict.as_ref().unwrap());
    let stage = stage(step, false);
    let told = question.judge(&stage, Guess::Eta(0.0)).unwrap().distance;
    let range = told.split("from ").nth(1).and_then(|rest| rest.strip_suffix(" works")).expect(&told);
    let ends: Vec<f32> = range.split(" to ").map(|eta| eta.parse().expect(&told)).collect();
    for eta in &ends {
        assert!(question.judge(&stage, Guess::Eta(*eta)).unwrap().is_right, "{eta}: {told}");
    }
    for eta in [ends[0] - 0.01, ends[1] + 0.01] {
        assert!(!question.judge(&stage, Guess::Eta(eta)).unwrap().is_right, "{eta}: {told}");
    }
}

#[test]
fn lessons_use_only_what_they_ask_for() {
    let used = |id: &str| lessons().find(|(name, _)| *name == id).unwrap().1.uses();
    assert_eq!(used("range-and-bandwidth"), Uses { output: false, threshold: false });
    assert_eq!(used("the-floor"), Uses { output: false, threshold: true });
    assert_eq!(used("what-a-network-can-know"), Uses { output: true, threshold: false });
    assert_eq!(used("points-taken-for-a-line"), Uses { output: true, threshold: true });
}

#[test]
fn the_worked_example_is_a_lesson() {
    let page = include_str!("../../docs/lessons.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    assert_eq!(Lesson::from_toml(example).map(|l| l.steps.len()), Ok(2));
}
