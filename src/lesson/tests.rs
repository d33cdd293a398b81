//! Every shipped lesson, answered right and wrong.

use super::question::Answer;
use super::*;
use crate::scene::Scene;

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
fn every_lesson_has_its_steps_and_every_file_is_listed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/lessons");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), shipped::ALL.len());
    for (id, lesson) in lessons() {
        assert!((4..=7).contains(&lesson.steps.len()), "{id} has {} steps", lesson.steps.len());
        assert!(lesson.steps.iter().any(|s| s.challenge.is_some()), "{id} challenges nobody");
        assert!(lesson.steps.iter().filter(|s| s.predict.is_some()).count() >= 3, "{id} asks too little");
    }
}

#[test]
fn every_prediction_can_be_right_and_wrong() {
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
fn every_challenge_starts_unmet_and_its_solution_meets_it() {
    let mut failures = Vec::new();
    for (id, lesson) in lessons() {
        for (number, step) in lesson.steps.iter().enumerate() {
            let Some(challenge) = &step.challenge else { continue };
            let place = format!("{id}, step {}", number + 1);
            let output = challenge.needs_output();
            let with_output = challenge.needs_hidden_output();
            let hidden =
                challenge.hidden_scene().map(|s| Stage::new(&step.radar, &s, &step.view, with_output).unwrap());
            let before = challenge.measure(&stage(step, output), hidden.as_ref());
            let unmet = before.as_ref().map_or(true, |m| m.iter().any(|m| !m.holds));
            if !unmet {
                failures.push(format!("{place}: met before anything is done: {before:?}"));
            }
            let mut scene = step.scene();
            if !challenge.solution.objects.is_empty() {
                scene = Scene { objects: challenge.solution.objects.clone(), ..scene };
            }
            let radar = challenge.solution.radar.clone().unwrap_or_else(|| step.radar.clone());
            let solved = Stage::new(&radar, &scene, &step.view, output).unwrap();
            match challenge.measure(&solved, hidden.as_ref()) {
                Ok(after) if after.iter().all(|m| m.holds) => {}
                after => failures.push(format!("{place}: not met by its solution: {after:?}")),
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn the_worked_example_is_a_lesson() {
    let page = include_str!("../../docs/lessons.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    assert_eq!(Lesson::from_toml(example).map(|l| l.steps.len()), Ok(2));
}
