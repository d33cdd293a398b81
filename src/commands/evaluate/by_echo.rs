//! Detection by echo, for sets of bodies: what P_D, which counts cells near the strongest, doesn't see.

use crate::evaluate::echoes::{CLASSES, EchoTally};
use crate::evaluate::rows::Row;
use crate::scene::generate::Kind;
use std::fmt::Write;

/// What was counted of each set and method, in the order they came.
#[derive(Debug, Default)]
pub struct ByEcho {
    tallies: Vec<(String, String, EchoTally)>,
}

impl ByEcho {
    /// Adds the echoes of a row's answer, if its set is one of bodies.
    pub fn count(&mut self, row: &Row, echoes: impl FnOnce() -> EchoTally) {
        if !Kind::THINGS.iter().any(|kind| kind.to_string() == row.set) {
            return;
        }
        let same = |(set, method, _): &&mut (String, String, EchoTally)| *set == row.set && *method == row.method;
        match self.tallies.iter_mut().find(same) {
            Some((_, _, tally)) => tally.add(&echoes()),
            None => self.tallies.push((row.set.clone(), row.method.clone(), echoes())),
        }
    }

    /// The counts as a table; `None` where there are none.
    pub fn to_text(&self) -> Option<String> {
        if self.tallies.is_empty() {
            return None;
        }
        let mut text = "echoes found, by dB below the scene's strongest:\n".to_owned();
        let class =
            |i: usize| if i + 1 < CLASSES { format!("{}-{}", 10 * i, 10 * i + 10) } else { format!("{}+", 10 * i) };
        // Writing to a string can't fail.
        let _ = write!(text, "{:<26}{:>9}", "", "all");
        (0..CLASSES).for_each(|i| _ = write!(text, "{:>12}", class(i)));
        text.push('\n');
        for (set, method, tally) in &self.tallies {
            let all = tally.part().map_or("-".to_owned(), |part| format!("{:.1} %", 100.0 * part));
            let _ = write!(text, "{:<26}{all:>9}", format!("{set}, {method}"));
            for (found, there) in tally.found.iter().zip(&tally.there) {
                let _ = write!(text, "{:>12}", format!("{found} of {there}"));
            }
            text.push('\n');
        }
        Some(text)
    }
}
