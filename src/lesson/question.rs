//! Predictions: questions, and the judgement of a learner's answer.

use super::fault::{Fault, check_tolerance};
use super::quantity::{ObjectNumber, Quantity};
use super::stage::{Cell, MapName, Stage};
use crate::evaluate::{TARGET_ETA, detection_rates, eta_text};
use serde::Deserialize;

/// A question with the replies to a right and to a wrong answer.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    pub ask: String,
    pub answer: Answer,
    pub right: String,
    pub wrong: String,
}

/// The kind of answer. Its truth comes from the simulation, except for choices.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Answer {
    /// A click at the place of a peak in a map: that of an object's blob, or without an object that of the brightest cell.
    Click {
        map: MapName,
        object: Option<ObjectNumber>,
        within_columns: f64,
        within_bins: f64,
    },
    Number {
        quantity: Quantity,
        object: Option<ObjectNumber>,
        unit: String,
        within_percent: f64,
    },
    /// One of several options; the right one is counted from 1.
    Choice {
        options: Vec<String>,
        right: usize,
    },
    /// A threshold that the blobs of the objects to keep exceed, and at most this part of the cells outside the target's.
    Threshold {
        map: MapName,
        keep: Vec<ObjectNumber>,
        false_alarm_at_most: f64,
    },
}

/// A learner's answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guess {
    Place(Cell),
    Number(f64),
    /// An option, from 1.
    Choice(usize),
    Eta(f32),
}

/// The truth that a guess is compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Truth {
    Place(Cell),
    Number(f64),
    /// An option, from 1.
    Choice(usize),
    Etas {
        low: f32,
        high: f32,
    },
}

/// The verdict on a guess.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    pub is_right: bool,
    /// The distance from the truth, in the question's own terms.
    pub distance: String,
    pub sentence: String,
    pub truth: Truth,
}

impl Question {
    /// Checks that the question can be asked of a scene of `objects` objects.
    pub(super) fn check(&self, objects: usize) -> Result<(), Fault> {
        const KEY: &str = "answer";
        let is_there =
            |number: &ObjectNumber| number.index(objects).map(drop).map_err(|message| Fault::at(KEY, message));
        match &self.answer {
            Answer::Click { object, within_columns, within_bins, .. } => {
                object.iter().try_for_each(is_there)?;
                check_tolerance(KEY, "within_columns", *within_columns)?;
                check_tolerance(KEY, "within_bins", *within_bins)
            }
            Answer::Number { object, within_percent, .. } => {
                object.iter().try_for_each(is_there)?;
                check_tolerance(KEY, "within_percent", *within_percent)
            }
            Answer::Choice { options, right } if options.len() < 2 || !(1..=options.len()).contains(right) => {
                let count = options.len();
                let message = format!("right is {right}; there are options 1 to {count} and at least two are needed");
                Err(Fault::at(KEY, message))
            }
            Answer::Choice { .. } => Ok(()),
            Answer::Threshold { keep, false_alarm_at_most, .. } => {
                keep.iter().try_for_each(is_there)?;
                check_tolerance(KEY, "false_alarm_at_most", *false_alarm_at_most)
            }
        }
    }

    /// Whether the method's output is needed to know the truth.
    pub fn needs_output(&self) -> bool {
        matches!(
            &self.answer,
            Answer::Click { map: MapName::Output, .. } | Answer::Threshold { map: MapName::Output, .. }
        )
    }

    /// The truth, from the simulation.
    /// # Errors
    /// A sentence when the method has no output or an object is missing.
    pub fn truth(&self, stage: &Stage) -> Result<Truth, String> {
        Ok(match &self.answer {
            Answer::Click { map, object: number, .. } => {
                let map = stage.map(*map)?;
                Truth::Place(match number {
                    Some(number) => stage.blob(map, number.of(&stage.scene)?).0,
                    None => stage.brightest(map),
                })
            }
            Answer::Number { quantity, object, .. } => {
                Truth::Number(quantity.of(&stage.radar, &stage.scene, *object)?)
            }
            Answer::Choice { right, .. } => Truth::Choice(*right),
            Answer::Threshold { map, keep, false_alarm_at_most } => {
                let shown = stage.map(*map)?;
                let mut high = 1.0f32;
                for number in keep {
                    high = high.min(stage.blob(shown, number.of(&stage.scene)?).1);
                }
                let target = stage.map(MapName::Target)?;
                let passes = |eta: f32| detection_rates(target, shown, eta).1 <= *false_alarm_at_most;
                let low = (0..=100).map(|i| i as f32 / 100.0).find(|eta| passes(*eta)).unwrap_or(TARGET_ETA);
                Truth::Etas { low, high }
            }
        })
    }

    /// Judges `guess`.
    /// # Errors
    /// A sentence when the truth can't be computed, or the guess is of another kind than the question.
    pub fn judge(&self, stage: &Stage, guess: Guess) -> Result<Judgement, String> {
        let truth = self.truth(stage)?;
        let (is_right, distance) = match (&self.answer, guess, truth) {
            (Answer::Click { within_columns, within_bins, .. }, Guess::Place(at), Truth::Place(peak)) => {
                let width = stage.radar.elements as f64;
                let columns = (at.column - peak.column).abs();
                let columns = columns.min(width - columns);
                let bins = (at.bin - peak.bin).abs();
                let metres = bins * stage.radar.range_resolution_metres();
                let s = if columns.round() == 1.0 { "" } else { "s" };
                let off = format!("{metres:.2} m and {columns:.0} column{s} off");
                (columns <= *within_columns && bins <= *within_bins, off)
            }
            (Answer::Number { within_percent, unit, .. }, Guess::Number(value), Truth::Number(exact)) => {
                let percent = 100.0 * (value - exact).abs() / exact.abs().max(f64::MIN_POSITIVE);
                let is_right = percent <= *within_percent;
                let it_is = if is_right { "" } else { "it is " };
                let off = if percent < 0.5 { String::new() } else { format!("; you were {percent:.0} % off") };
                (is_right, format!("{it_is}{}{off}", number_text(exact, unit)))
            }
            (Answer::Choice { options, .. }, Guess::Choice(chosen), Truth::Choice(right)) => {
                let option = options.get(right - 1).map_or("", String::as_str);
                let told = if chosen == right { option.to_owned() } else { format!("the answer is “{option}”") };
                (chosen == right, told)
            }
            (Answer::Threshold { map, .. }, Guess::Eta(eta), Truth::Etas { low, high }) => {
                let through = 100.0 * detection_rates(stage.map(MapName::Target)?, stage.map(*map)?, eta).1;
                let lost = if eta < high { "keeps what is asked for" } else { "loses what was to be kept" };
                // The highest of two decimals: at `high` itself an object is lost.
                let highest = ((100.0 * high).ceil() - 1.0) / 100.0;
                let told = format!(
                    "{} {lost} and lets {through:.2} % of the dark cells through. Any threshold from {low:.2} to {highest:.2} works",
                    eta_text(eta)
                );
                (eta >= low && eta < high, told)
            }
            _ => return Err("the answer is of another kind than the question".to_owned()),
        };
        let sentence = if is_right { &self.right } else { &self.wrong }.clone();
        Ok(Judgement { is_right, distance, sentence, truth })
    }
}

/// A number with its unit, to three digits or so.
pub fn number_text(value: f64, unit: &str) -> String {
    let decimals = match value.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        v if v >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.decimals$} {unit}").replace('-', "−").trim_end().to_owned()
}
