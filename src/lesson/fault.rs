//! Mistakes in a lesson's step, with their lines.

/// A fault in a lesson's text, with its line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct LessonTextError {
    /// Line, from 1.
    pub line: usize,
    pub message: String,
}

/// A mistake in a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// Beginning of the line; empty for the step's first line.
    key: &'static str,
    /// Number of the line among those that begin so, from 0.
    number: usize,
    pub(super) message: String,
}

impl Fault {
    /// A fault on the step's first line that begins with `key`.
    pub(super) fn at(key: &'static str, message: impl Into<String>) -> Fault {
        Fault::at_number(key, 0, message)
    }

    /// A fault on line number `number` (from 0) of those that begin with `key`.
    pub(super) fn at_number(key: &'static str, number: usize, message: impl Into<String>) -> Fault {
        Fault { key, number, message: message.into() }
    }

    /// The error of a lesson's text for a fault of step `step` (from 0).
    pub(super) fn in_step(self, text: &str, step: usize) -> LessonTextError {
        LessonTextError { line: self.line(text, step), message: format!("step {}: {}", step + 1, self.message) }
    }

    /// The line in a lesson's text, from 1, for a fault of step `step` (from 0): that of the step where no line begins with the key.
    fn line(&self, text: &str, step: usize) -> usize {
        let is_step = |line: &&str| line.trim_start().starts_with("[[step]]");
        let lines = || text.lines().zip(1usize..);
        let Some((_, first)) = lines().filter(|(line, _)| is_step(line)).nth(step) else { return 1 };
        let of_step = lines().skip(first).take_while(|(line, _)| !is_step(line));
        let mut found = of_step.filter(|(line, _)| !self.key.is_empty() && line.trim_start().starts_with(self.key));
        found.nth(self.number).map_or(first, |(_, line)| line)
    }
}

impl From<String> for Fault {
    fn from(message: String) -> Fault {
        Fault::at("", message)
    }
}

pub(super) fn check_tolerance(key: &'static str, name: &str, value: f64) -> Result<(), Fault> {
    match value.is_finite() && value >= 0.0 {
        true => Ok(()),
        false => Err(Fault::at(key, format!("{name} is {value}; expected a number of at least 0"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_found_on_the_line_of_its_step() {
        let text = "format = 1\n\n[[step]]\nask = 1\n\n[[step]]\nx = 1\n  [a]\nx = 2\n[a]\n[[step]]\n[a]\n";
        assert_eq!(Fault::at("[a]", "").line(text, 1), 8);
        assert_eq!(Fault::at_number("[a]", 1, "").line(text, 1), 10);
        assert_eq!(Fault::at("[a]", "").line(text, 0), 3, "the step's own line where there is none");
        assert_eq!(Fault::from(String::new()).line(text, 2), 11);
    }
}
