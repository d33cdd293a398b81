//! The check of a lesson when it is opened: its questions and challenges are simulated.

use super::fault::Fault;
use super::{Challenge, Lesson, LessonTextError, Measured, Question, Stage, Step, Truth};
use crate::scene::Scene;

impl Lesson {
    /// Simulates every step: each question must have an answer, each challenge must be unmet at the start and met by its solution. `text` is the
    /// lesson's text, for the lines of faults.
    /// # Errors
    /// [`LessonTextError`] names the line, the step and the fault.
    pub fn try_out(&self, text: &str) -> Result<(), LessonTextError> {
        for (index, step) in self.steps.iter().enumerate() {
            step.try_out().map_err(|fault| fault.in_step(text, index))?;
        }
        Ok(())
    }
}

impl Step {
    fn try_out(&self) -> Result<(), Fault> {
        self.predict.iter().try_for_each(|question| ask(self, question))?;
        self.challenge.iter().try_for_each(|challenge| meet(self, challenge))
    }

    fn solved(&self, challenge: &Challenge) -> (Scene, crate::radar::Radar) {
        let (mut scene, solution) = (self.scene(), &challenge.solution);
        if !solution.objects.is_empty() {
            scene.objects.clone_from(&solution.objects);
        }
        (scene, solution.radar.clone().unwrap_or_else(|| self.radar.clone()))
    }
}

fn ask(step: &Step, question: &Question) -> Result<(), Fault> {
    let fault = |message: String| Fault::at("answer", message);
    let stage = Stage::new(&step.radar, &step.scene(), &step.view, question.needs_output());
    let stage = stage.map_err(|e| fault(e.to_string()))?;
    match question.truth(&stage).map_err(fault)? {
        Truth::Etas { low, high } if low >= high => Err(fault(format!(
            "no threshold is right: below {low:.2} too many other cells exceed it, above {high:.2} an object is lost"
        ))),
        _ => Ok(()),
    }
}

/// Sets a challenge as a learner finds it, then as its solution leaves it.
fn meet(step: &Step, challenge: &Challenge) -> Result<(), Fault> {
    let with_output = challenge.needs_output();
    let hidden = challenge.hidden_scene().map(|scene| {
        let stage = Stage::new(&step.radar, &scene, &step.view, challenge.needs_hidden_output());
        stage.map_err(|e| Fault::at("[[step.challenge.hidden]]", format!("the hidden objects: {e}")))
    });
    let hidden = hidden.transpose()?;
    let start = Stage::new(&step.radar, &step.scene(), &step.view, with_output).map_err(|e| e.to_string())?;
    if challenge.measure(&start, hidden.as_ref()).is_ok_and(|measured| measured.iter().all(|m| m.holds)) {
        return Err(Fault::at("[step.challenge]", "the challenge is met before anything is changed"));
    }
    let failed = |message: String| Fault::at("[step.challenge.solution]", message);
    let (scene, radar) = step.solved(challenge);
    radar.validate().map_err(|e| failed(format!("the solution: {e}")))?;
    let end = Stage::new(&radar, &scene, &step.view, with_output).map_err(|e| failed(format!("the solution: {e}")))?;
    let measured = challenge.measure(&end, hidden.as_ref()).map_err(|e| failed(format!("the solution: {e}")))?;
    let missed: Vec<String> = measured.iter().filter(|m| !m.holds).map(told).collect();
    match missed.is_empty() {
        true => Ok(()),
        false => Err(failed(format!("the solution does not meet the challenge: {}", missed.join("; ")))),
    }
}

fn told(measured: &Measured) -> String {
    format!("{} is wanted, and there is {}", measured.wanted, measured.found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"format = 1
title = "T"
about = "A."

[[step]]
text = "A point."
radar = { elements = 64, samples = 64 }
[[step.object]]
kind = "point"
x_metres = 0.0
y_metres = 2.0

[step.predict]
ask = "Which threshold?"
right = "Yes."
wrong = "No."
answer = { kind = "threshold", map = "target", keep = [1], false_alarm_at_most = 0.2 }

[step.challenge]
ask = "Move it beyond 3 m."
[[step.challenge.require]]
measure = { kind = "range", object = 1 }
at_least = 3.0
[step.challenge.solution]
[[step.challenge.solution.object]]
kind = "point"
x_metres = 0.0
y_metres = 3.5
"#;

    #[test]
    fn a_lesson_that_cannot_be_taken_is_refused_with_its_line() {
        // The weak point lies 60 dB below a strong one, whose main lobe exceeds any threshold that keeps it.
        let weak =
            "y_metres = 2.0\nreflectivity = 0.001\n[[step.object]]\nkind = \"point\"\nx_metres = 1.0\ny_metres = 2.0\n";
        let unseen = TEXT.replace("y_metres = 2.0\n", weak).replace("at_most = 0.2", "at_most = 0.0");
        for (text, begins, more) in [
            (TEXT.replace("= 3.5", "= 2.5"), "line 24: step 1: the solution does not meet", ["for point 1", "2.5"]),
            (TEXT.replace("= 3.0", "= 1.0"), "line 19: step 1: the challenge is met before", [""; 2]),
            (unseen, "line 22: step 1: no threshold is right", [""; 2]),
        ] {
            let message = Lesson::from_toml(&text).unwrap().try_out(&text).unwrap_err().to_string();
            assert!(message.starts_with(begins) && more.iter().all(|part| message.contains(part)), "{message}");
        }
    }
}
