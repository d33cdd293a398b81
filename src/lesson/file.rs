//! Lesson files: TOML that a teacher writes without Rust. `docs/lessons.md` describes the format with a worked example.

use super::fault::Fault;
use super::question::Answer;
use super::{Challenge, LessonTextError, Question, StepView};
use crate::files::read_bounded;
use crate::radar::Radar;
use crate::scene::presets::Preset;
use crate::scene::{Object, Scene, SceneError};
use serde::Deserialize;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The version of the format this program reads.
pub const FORMAT: u32 = 1;

/// Largest lesson file that is read, bytes: sixty times the longest shipped one.
pub const MAX_LESSON_BYTES: u64 = 1 << 20;

/// A lesson: a few steps, each with a text, a scene, a prediction and a task.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// Version of the format, [`FORMAT`].
    pub format: u32,
    pub title: String,
    /// The lesson's aim: the learner's new knowledge, one sentence.
    pub about: String,
    #[serde(rename = "step")]
    pub steps: Vec<Step>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    pub text: String,
    /// Name of a scene that comes with the program, in place of `object`s.
    pub preset: Option<String>,
    #[serde(default, rename = "object")]
    pub objects: Vec<Object>,
    /// The radar; keys that are left out are table 3.1's.
    #[serde(default)]
    pub radar: Radar,
    #[serde(default)]
    pub view: StepView,
    pub predict: Option<Question>,
    pub challenge: Option<Challenge>,
}

/// An error of opening a lesson: its file, the line and what was expected.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct LessonError {
    path: PathBuf,
    message: String,
}

impl Lesson {
    /// Reads a lesson from TOML and checks every step, without simulating any ([`Lesson::try_out`] does).
    /// # Errors
    /// [`LessonTextError`] names the line, the key or the step, and what was expected.
    pub fn from_toml(text: &str) -> Result<Lesson, LessonTextError> {
        let lesson: Lesson = toml::from_str(text).map_err(|e| LessonTextError {
            line: e.span().map_or(1, |span| line_of(text, span.start)),
            message: e.to_string().lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" "),
        })?;
        let whole = |message: String| LessonTextError { line: 1, message };
        if lesson.format != FORMAT {
            let later = if lesson.format > FORMAT { ", of a later version of apertura" } else { "" };
            return Err(whole(format!("format is {}{later}; this program reads format {FORMAT}", lesson.format)));
        }
        if lesson.steps.is_empty() {
            return Err(whole("there is no [[step]]".to_owned()));
        }
        for (index, step) in lesson.steps.iter().enumerate() {
            step.check().map_err(|fault| fault.in_step(text, index))?;
        }
        Ok(lesson)
    }

    /// Reads a lesson file and tries every step out, which takes a moment ([`Lesson::try_out`]).
    /// # Errors
    /// [`LessonError`] names the file, the line and what was expected.
    pub fn load(path: &Path) -> Result<Lesson, LessonError> {
        let told = |message: String| LessonError { path: path.to_owned(), message };
        let bytes = read_bounded(path, MAX_LESSON_BYTES).map_err(|error| match error.kind() {
            ErrorKind::FileTooLarge => told(format!("larger than {MAX_LESSON_BYTES} bytes, which no lesson is")),
            _ => told(error.to_string()),
        })?;
        let text = String::from_utf8(bytes).map_err(|error| told(error.to_string()))?;
        let lesson = Lesson::from_toml(&text).and_then(|lesson| lesson.try_out(&text).map(|()| lesson));
        lesson.map_err(|error| told(error.to_string()))
    }
}

impl Step {
    /// The scene that the learner sees, or places objects into.
    pub fn scene(&self) -> Scene {
        let preset = self.preset.as_deref().and_then(Preset::by_id).and_then(|p| p.load().ok());
        preset.map_or_else(|| Scene { objects: self.objects.clone(), ..Scene::default() }, |file| file.scene)
    }

    fn check(&self) -> Result<(), Fault> {
        if let Some(id) = &self.preset {
            if !self.objects.is_empty() {
                return Err(Fault::at("preset", "has a preset and objects; expected one of them"));
            }
            let known = || crate::scene::presets::ALL.iter().map(|p| p.id).collect::<Vec<_>>().join(", ");
            let unknown = || format!("preset \"{id}\" is not known; known: {}", known());
            Preset::by_id(id).ok_or_else(|| Fault::at("preset", unknown()))?;
        }
        self.radar.validate().map_err(|e| Fault::at("radar", e.to_string()))?;
        let scene = self.scene();
        scene.validate(&self.radar).map_err(|e: SceneError| e.to_string())?;
        let objects = scene.objects.len();
        if let Some(question) = &self.predict {
            question.check(objects)?;
        }
        if let Some(challenge) = &self.challenge {
            challenge.check(objects)?;
        }
        if self.predict.is_none() && self.challenge.is_none() {
            return Err(Fault::at("", "asks nothing; expected [step.predict] or [step.challenge]"));
        }
        Ok(())
    }
}

fn line_of(text: &str, byte: usize) -> usize {
    text.bytes().take(byte).filter(|b| *b == b'\n').count() + 1
}

/// The parts that a lesson needs beside scene, radar and the maps of ends and whole array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uses {
    /// A method's output: a question or a challenge measures it, or a step names a method of its own.
    pub output: bool,
    /// A threshold: a question asks for one, or a step detects by a detector.
    pub threshold: bool,
}

impl Uses {
    /// All parts, as without a lesson.
    pub const ALL: Uses = Uses { output: true, threshold: true };
}

impl Lesson {
    /// The parts that the lesson's steps need.
    pub fn uses(&self) -> Uses {
        let usual = StepView::default().method;
        let output = self.steps.iter().any(|step| {
            step.view.method != usual
                || step.predict.as_ref().is_some_and(|question| question.needs_output())
                || step.challenge.as_ref().is_some_and(|c| c.needs_output() || c.needs_hidden_output())
        });
        let threshold = self.steps.iter().any(|step| {
            let asks =
                step.predict.as_ref().is_some_and(|question| matches!(question.answer, Answer::Threshold { .. }));
            asks || step.view.cfar.is_some()
        });
        Uses { output, threshold }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
format = 1
title = "T"
about = "A."

[[step]]
text = "Look."
preset = "one-at-20-m"

[step.predict]
ask = "Where?"
right = "Yes."
wrong = "No."
answer = { kind = "click", map = "target", object = 1, within_columns = 30.0, within_bins = 4.0 }
"#;

    #[test]
    fn mistakes_name_their_line() {
        let challenge = "\n[step.challenge]\nask = \"A\"\n[[step.challenge.require]]\nmeasure = { kind = \"objects\" }\n\
                         at_least = 3.0\nat_most = 2.0\n[step.challenge.solution]\n";
        for (text, line, parts) in [
            (GOOD.replace("about", "abuot"), 4, ["abuot", ""]),
            (GOOD.replace("object = 1,", "object = 2,"), 14, ["step 1", "objects 1 to 1"]),
            (GOOD.replace("one-at-20-m", "nowhere"), 8, ["nowhere", "street"]),
            (GOOD.replace("format = 1", "format = 9"), 1, ["format is 9", "format 1"]),
            (GOOD.replace("columns = 30.0", "columns = -1.0"), 14, ["within_columns is -1", "at least 0"]),
            (GOOD.replace("bins = 4.0", "bins = nan"), 14, ["within_bins is NaN", "at least 0"]),
            (format!("{GOOD}{challenge}"), 18, ["at least 3 and at most 2", ""]),
        ] {
            let e = Lesson::from_toml(&text).unwrap_err();
            assert!(parts.iter().all(|part| e.message.contains(part)) && e.line == line, "{e}");
        }
        assert!(Lesson::from_toml(&GOOD[..GOOD.len() / 2]).is_err());
    }

    #[test]
    fn a_large_file_is_refused_before_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large.toml");
        std::fs::write(&path, vec![b'#'; MAX_LESSON_BYTES as usize + 10]).unwrap();
        assert!(Lesson::load(&path).unwrap_err().to_string().contains("larger"));
    }
}
